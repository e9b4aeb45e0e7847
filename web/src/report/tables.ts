// SPDX-License-Identifier: Apache-2.0
// The report of reproduced tables: Saccade's figures beside those of the thesis.
import { h } from "../ui/dom";
import { type Json, list, objects, type ReportDocument, text } from "./document";
import { facts, type Report, section, type Section } from "./parts";
import type { Pictures } from "./pictures";
import { type Column, dataTable } from "./table";
import { capital, plural } from "./words";

/** The number that a cell begins with; what the table is sorted by. */
function leading(cell: string): number | undefined {
  const found = /^[\u2212-]?\d[\d\u202f]*(\.\d+)?/.exec(cell);
  return found ? Number(found[0].replace("\u2212", "-").replaceAll("\u202f", "")) : undefined;
}

function tableOf(table: Json, caption: string): HTMLElement | null {
  const names = list(table["columns"]).map(String);
  const rows = list(table["cells"]).map((row) => list(row).map(String));
  if (names.length === 0 || rows.length === 0) return null;
  const columns: Column<string[]>[] = names.map((name, i) => {
    const numeric = rows.some((row) => leading(row[i] ?? "") !== undefined) && i > 0;
    const column: Column<string[]> = { name, text: (row) => row[i] ?? "", left: !numeric };
    if (numeric) column.value = (row) => leading(row[i] ?? "");
    return column;
  });
  return dataTable(caption, columns, rows);
}

/** A caption is "Table 4.3: …" or "Fig. 3.24: …"; its beginning becomes the title. */
function sectionOf(table: Json, pictures: Pictures): Section {
  const [title = "", ...said] = text(table["caption"]).split(": ");
  const caption = capital(said.join(": "));
  const drawn = list(table["drawings"]).map(String).filter((name) => pictures.files.has(name));
  const shown = tableOf(table, caption || title);
  const notes = list(table["notes"]).map((note) => h("li", {}, String(note)));
  return section(
    `table-${text(table["table"]).replaceAll(".", "-")}`,
    title,
    shown === null ? h("p", {}, caption) : null,
    table["complete"] === false ? h("p", { class: "soft" }, "This table was interrupted; rows are missing.") : null,
    shown,
    pictures.figures(drawn.map((name) => ({ name, title: name, alt: `${title}: ${name}`, kind: "figure" }))),
    notes.length > 0 ? h("ul", { class: "notes" }, ...notes) : null,
  );
}

export function tablesReport(document: ReportDocument, pictures: Pictures): Report {
  const tables = objects(document.record.result["tables"]);
  const sections = tables.map((table) => sectionOf(table, pictures));
  const { record } = document;
  sections.push(section("run", "Run", facts([["seed", String(record.seed ?? "")], ["threads", String(record.threads ?? "")], ["Saccade", record.version ?? ""]], "pairs")));
  return { title: "Tables of the thesis", settings: [], summary: `${plural(tables.length, "table")}, Saccade's figures beside those of the thesis.`, sections };
}
