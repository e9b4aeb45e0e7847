// SPDX-License-Identifier: Apache-2.0
// The report of a benchmark: our strategies and published figures in one table, then the runs as those of a comparison.
import { h } from "../ui/dom";
import { compareReport } from "./compare";
import { type Json, list, number, object, objects, type ReportDocument, text } from "./document";
import { type Report, section, type Section } from "./parts";
import type { Pictures } from "./pictures";
import { type Column, dataTable } from "./table";

const percent = (share: number | undefined) => (share === undefined ? "" : (100 * share).toFixed(1));

/** "93.1 ± 0.8" of a share; empty where it was not measured. */
function shareText(value: unknown): string {
  const { mean, low } = object(value);
  const [middle, least] = [number(mean), number(low)];
  if (middle === undefined) return "";
  return least === undefined ? percent(middle) : `${percent(middle)} ± ${percent(middle - least)}`;
}

function meanText(value: unknown, decimals: number): string {
  return number(object(value)["mean"])?.toFixed(decimals) ?? "";
}

function source(row: Json): string {
  if (row["published"] !== true) return "this run";
  const year = number(row["year"]);
  return `${year === undefined ? "year not known" : year}, ${text(row["source"])}; ${text(row["object"])}`;
}

function columns(rows: readonly Json[]): Column<Json>[] {
  const has = (key: string) => rows.some((row) => row[key] !== undefined);
  const all: Column<Json>[] = [
    { name: "method", text: (row) => text(row["method"]) },
    { name: "views", text: (row) => (number(row["views"]) ?? 0).toFixed(1).replace(".0", ""), value: (row) => number(row["views"]) },
    { name: has("of_all") ? "of visible, %" : "coverage, %", text: (row) => shareText(row["of_visible"]), value: (row) => number(object(row["of_visible"])["mean"]) },
  ];
  if (has("of_all")) all.push({ name: "of all, %", text: (row) => shareText(row["of_all"]), value: (row) => number(object(row["of_all"])["mean"]) });
  if (has("path_m")) all.push({ name: "path, m", text: (row) => meanText(row["path_m"], 2), value: (row) => number(object(row["path_m"])["mean"]) });
  if (has("motion_s")) all.push({ name: "motion, s", text: (row) => meanText(row["motion_s"], 1), value: (row) => number(object(row["motion_s"])["mean"]) });
  if (has("coverage")) all.push({ name: "published, %", text: (row) => percent(number(row["coverage"])), value: (row) => number(row["coverage"]) });
  all.push({ name: "source", text: source, left: true });
  all.push({ name: "what differs", text: (row) => text(row["differs"]), left: true });
  return all;
}

function tableSection(benchmark: Json): Section {
  const rows = objects(benchmark["table"]);
  const beside = list(benchmark["beside_published"]).map((line) => h("li", {}, String(line)));
  const none = text(benchmark["not_published"]);
  return section(
    "benchmark",
    `${text(benchmark["name"])}, version ${number(benchmark["version"]) ?? ""}`,
    h("p", {}, `${text(benchmark["text"])}. ${text(benchmark["measure"])}.`),
    benchmark["stand_ins"] === true ? h("p", {}, h("strong", {}, "Stand-ins: "), "these objects are made by rule and are not those of the publications, so the figures cannot be compared with theirs.") : null,
    dataTable("Ours and published", columns(rows), rows),
    beside.length > 0 ? h("ul", { class: "notes" }, ...beside) : null,
    none === "" ? null : h("p", { class: "soft" }, `No published figures: ${none}.`),
  );
}

export function benchmarkReport(document: ReportDocument, pictures: Pictures): Report {
  const benchmark = object(document.record.result["benchmark"]);
  const runs = compareReport(document, pictures);
  const lines = list(benchmark["beside_published"]).map(String);
  return { ...runs, title: `Benchmark ${text(benchmark["name"])}`, summary: lines[lines.length - 1] ?? runs.summary, sections: [tableSection(benchmark), ...runs.sections] };
}
