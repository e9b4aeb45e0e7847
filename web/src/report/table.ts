// SPDX-License-Identifier: Apache-2.0
// DataTable: rows that are sorted by a column, copied as CSV and LaTeX; heads explain themselves.
import { textButton } from "../ui/controls";
import { h, on } from "../ui/dom";
import { definitionOf } from "./measures";
import { toCsv, toLatex } from "./table_export";
import { withDefinition } from "./hint";

export interface Column<Row> {
  name: string;
  text(row: Row): string;
  /** Sort key of the column; the text where it is absent. */
  value?(row: Row): number | undefined;
  link?(row: Row): string | undefined;
  left?: boolean;
  /** Texts of any length: the column is narrow, and they are broken into lines. */
  wrap?: boolean;
}

type Direction = "ascending" | "descending";

export function dataTable<Row>(caption: string, columns: readonly Column<Row>[], rows: readonly Row[]): HTMLElement {
  const table = new DataTable(caption, columns, rows);
  return table.element;
}

class DataTable<Row> {
  readonly element: HTMLElement;
  private readonly body = h("tbody");
  private readonly heads: HTMLTableCellElement[];
  private readonly said = h("span", { class: "table-said", role: "status" });
  private shown: Row[];
  private sortedBy = -1;
  private direction: Direction = "ascending";

  constructor(
    private readonly caption: string,
    private readonly columns: readonly Column<Row>[],
    private readonly rows: readonly Row[],
  ) {
    this.shown = [...rows];
    this.heads = columns.map((column, i) => this.head(column, i));
    const table = h("table", {}, h("caption", {}, caption), h("thead", {}, h("tr", {}, ...this.heads)), this.body);
    const scroll = h("div", { class: "table-scroll", tabindex: 0, role: "region", "aria-label": `${caption}, table` }, table);
    const tools = h(
      "div",
      { class: "table-tools no-print" },
      this.said,
      textButton("Copy CSV", () => void this.copy("CSV"), { icon: "grid", title: "Copy the table as comma-separated values" }),
      textButton("Copy LaTeX", () => void this.copy("LaTeX"), { icon: "list", title: "Copy the table as a LaTeX tabular" }),
    );
    this.element = h("div", { class: "data-table" }, scroll, tools);
    this.draw();
  }

  private head(column: Column<Row>, index: number): HTMLTableCellElement {
    const button = h("button", { type: "button", class: "sort" }, h("span", {}, column.name), h("span", { class: "arrow", "aria-hidden": "true" }));
    on(button, { click: () => this.sortBy(index) });
    withDefinition(button, definitionOf(column.name));
    return h("th", { scope: "col", class: column.left || index === 0 ? "left" : "" }, button);
  }

  private sortBy(index: number): void {
    this.direction = this.sortedBy === index && this.direction === "ascending" ? "descending" : "ascending";
    this.sortedBy = index;
    const column = this.columns[index]!;
    const sign = this.direction === "ascending" ? 1 : -1;
    this.shown = [...this.rows].sort((a, b) => {
      if (!column.value) return sign * column.text(a).localeCompare(column.text(b), "en", { numeric: true });
      const [of_a, of_b] = [column.value(a), column.value(b)];
      if (of_a === undefined || of_b === undefined) return Number(of_a === undefined) - Number(of_b === undefined);
      return sign * (of_a - of_b);
    });
    this.draw();
  }

  private draw(): void {
    this.heads.forEach((head, i) => {
      if (i === this.sortedBy) head.ariaSort = this.direction;
      else head.removeAttribute("aria-sort");
    });
    this.body.replaceChildren(...this.shown.map((row) => this.line(row)));
  }

  private line(row: Row): HTMLElement {
    const cells = this.columns.map((column, i) => {
      const target = column.link?.(row);
      const content = target === undefined ? column.text(row) : h("a", { href: target }, column.text(row));
      const wrap = column.wrap ? "wrap" : "";
      if (i === 0) return h("th", { scope: "row", class: `left ${wrap}` }, content);
      const long = !column.wrap && column.text(row).length > 40;
      return h("td", { class: `${column.left ? "left" : ""} ${wrap} ${long ? "long" : ""}` }, content);
    });
    return h("tr", {}, ...cells);
  }

  private async copy(format: "CSV" | "LaTeX"): Promise<void> {
    const cells = [this.columns.map((column) => column.name), ...this.shown.map((row) => this.columns.map((column) => column.text(row)))];
    const text = format === "CSV" ? toCsv(cells) : toLatex(cells, this.caption);
    this.said.textContent = (await copyText(text)) ? `${format} copied` : "The browser does not let this page copy";
    window.setTimeout(() => (this.said.textContent = ""), 4000);
  }
}

/** Pages from disk may have no clipboard of their own; there a selection is copied. */
async function copyText(text: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    const area = h("textarea", { class: "visually-hidden", "aria-hidden": "true" });
    area.value = text;
    document.body.append(area);
    area.select();
    const copied = document.execCommand("copy");
    area.remove();
    return copied;
  }
}
