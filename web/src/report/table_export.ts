// SPDX-License-Identifier: Apache-2.0
// Tables as CSV and LaTeX.

/** Quotes cells that need it (RFC 4180). */
export function toCsv(rows: readonly (readonly string[])[]): string {
  const cell = (value: string) => (/[",\r\n]/.test(value) ? `"${value.replaceAll('"', '""')}"` : value);
  return rows.map((row) => row.map(cell).join(",")).join("\r\n") + "\r\n";
}

const kLatex: Record<string, string> = {
  "\\": "\\textbackslash{}",
  "{": "\\{",
  "}": "\\}",
  "&": "\\&",
  "%": "\\%",
  $: "\\$",
  "#": "\\#",
  _: "\\_",
  "~": "\\textasciitilde{}",
  "^": "\\textasciicircum{}",
  "\u2212": "$-$",
  "±": "$\\pm$",
  "×": "$\\times$",
  "²": "$^2$",
  "–": "--",
  "\u202f": "\\,",
  "✓": "$\\checkmark$",
};

const latex = (value: string): string => [...value].map((character) => kLatex[character] ?? character).join("");

/** A tabular with booktabs rules; the first row is the head, the first column is aligned to the left. */
export function toLatex(rows: readonly (readonly string[])[], caption: string): string {
  const [head = [], ...body] = rows;
  const line = (row: readonly string[]) => `    ${row.map(latex).join(" & ")} \\\\`;
  const columns = "l" + "r".repeat(Math.max(0, head.length - 1));
  return [
    "\\begin{table}",
    "  \\centering",
    `  \\caption{${latex(caption)}}`,
    `  \\begin{tabular}{${columns}}`,
    "    \\toprule",
    line(head),
    "    \\midrule",
    ...body.map(line),
    "    \\bottomrule",
    "  \\end{tabular}",
    "\\end{table}",
    "",
  ].join("\n");
}
