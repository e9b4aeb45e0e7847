// SPDX-License-Identifier: Apache-2.0
// The report of a benchmark: our strategies and published figures in one table, how our strategies differ on the same
// objects, then the runs as those of a comparison.
import { h } from "../ui/dom";
import { compareReport } from "./compare";
import { type Json, list, number, object, objects, type ReportDocument, text } from "./document";
import { type Report, section, type Section } from "./parts";
import type { Pictures } from "./pictures";
import { type Column, dataTable } from "./table";
import { count, decimal, plural, signed } from "./words";

const percent = (share: number | undefined) => (share === undefined ? "" : (100 * share).toFixed(1));

/** "93.1 ± 0.8", each times `scale`; empty where it was not measured, and without an interval where there is none. */
function meanText(value: unknown, scale: number, decimals: number): string {
  const { mean, low } = object(value);
  const [middle, least] = [number(mean), number(low)];
  if (middle === undefined) return "";
  const shown = (of: number) => (scale * of).toFixed(decimals);
  return least === undefined ? shown(middle) : `${shown(middle)} ± ${shown(middle - least)}`;
}

function source(row: Json): string {
  if (row["published"] !== true) return "this run";
  const year = number(row["year"]);
  return `${year === undefined ? "year not known" : year}, ${text(row["source"])}; ${text(row["object"])}`;
}

const taken = (row: Json) => number(object(row["views_taken"])["mean"]);

function columns(rows: readonly Json[]): Column<Json>[] {
  const has = (key: string) => rows.some((row) => row[key] !== undefined);
  const mean = (name: string, key: string, scale: number, decimals: number): Column<Json> => ({
    name,
    text: (row) => meanText(row[key], scale, decimals),
    value: (row) => number(object(row[key])["mean"]),
  });
  const all: Column<Json>[] = [
    { name: "method", text: (row) => text(row["method"]), wrap: true },
    { name: "views", text: (row) => (number(row["views"]) ?? 0).toFixed(1).replace(".0", ""), value: (row) => number(row["views"]) },
  ];
  if (has("views_taken")) all.push({ name: "taken", text: (row) => taken(row)?.toFixed(1) ?? "", value: taken });
  all.push(mean(has("of_all") ? "of visible, %" : "coverage, %", "of_visible", 100, 1));
  if (has("of_all")) all.push(mean("of all, %", "of_all", 100, 1));
  if (has("path_m")) all.push(mean("path, m", "path_m", 1, 2));
  if (has("motion_s")) all.push(mean("motion, s", "motion_s", 1, 1));
  if (has("coverage")) all.push({ name: "published, %", text: (row) => percent(number(row["coverage"])), value: (row) => number(row["coverage"]) });
  all.push({ name: "source", text: source, left: true, wrap: true });
  if (has("differs")) all.push({ name: "what differs", text: (row) => text(row["differs"]), left: true, wrap: true });
  return all;
}

/** Runs that the table of an interrupted benchmark is over. null for one that is done, and in records of older programs. */
function incomplete(benchmark: Json): HTMLElement | null {
  if (benchmark["complete"] !== false) return null;
  const runs = object(benchmark["runs"]);
  const each = number(runs["each_strategy"]) ?? 0;
  const over =
    each === 0
      ? "There is no object that all strategies with runs have in common yet."
      : `The table has ${plural(each, "run")} of each strategy: the objects, first views and seeds that all strategies with runs have in common.`;
  return h("p", {}, h("strong", {}, `${count(number(runs["done"]))} of ${count(number(runs["planned"]))} runs so far. `), `${over} Nothing is said beside published figures.`);
}

/** Says why our figures and the published ones are about different objects; null where they are not. */
function otherObjects(from: string): HTMLElement | null {
  const end = "are not those of the publications, so the figures cannot be compared with theirs.";
  if (from === "stand-ins") return h("p", {}, h("strong", {}, "Stand-ins: "), `these objects are made by rule and ${end}`);
  if (from === "own") return h("p", {}, h("strong", {}, "Other objects: "), `these objects ${end}`);
  return null;
}

function tableSection(benchmark: Json): Section {
  const rows = objects(benchmark["table"]);
  const none = text(benchmark["not_published"]);
  return section(
    "benchmark",
    `${text(benchmark["name"])}, version ${number(benchmark["version"]) ?? ""}`,
    h("p", {}, `${text(benchmark["text"])}. ${text(benchmark["measure"])}.`),
    otherObjects(text(benchmark["objects_from"])),
    incomplete(benchmark),
    dataTable("Ours and published", columns(rows), rows),
    none === "" ? null : h("p", { class: "soft" }, `No published figures: ${none}.`),
  );
}

/** "+7.1 ± 4.2", in points; without an interval where there is one object. */
function pointsText(value: unknown): string {
  const { mean, low } = object(value);
  const [middle, least] = [number(mean), number(low)];
  if (middle === undefined) return "";
  return signed(100 * middle, 1) + (least === undefined ? "" : ` ± ${decimal(100 * (middle - least), 1)}`);
}

/** Whether the interval excludes 0; "–" without one. */
const excludesText = (value: unknown): string => ({ true: "yes", false: "no" })[String(object(value)["excludes_0"])] ?? "–";

/** The first strategy beside each other one, object by object. null where there is one strategy, and in records of older programs. */
function differencesSection(benchmark: Json): Section | null {
  const rows = objects(benchmark["differences"]);
  if (rows.length === 0) return null;
  const two = rows.some((row) => row["of_all"] !== undefined);
  const each = two ? "object" : "scene";
  const share = (name: string, key: string): Column<Json>[] => [
    { name: `${name}, points`, text: (row) => pointsText(row[key]), value: (row) => number(object(row[key])["mean"]) },
    { name: two ? `differs from 0, ${name}` : "differs from 0", text: (row) => excludesText(row[key]) },
  ];
  const columns: Column<Json>[] = [
    { name: "difference", text: (row) => `${text(row["method"])} \u2212 ${text(row["beside"])}`, wrap: true },
    { name: "views", text: (row) => count(number(row["views"])), value: (row) => number(row["views"]) },
    { name: `${each}s`, text: (row) => count(number(row["objects"])), value: (row) => number(row["objects"]) },
    ...share(two ? "of visible" : "coverage", "of_visible"),
    ...(two ? share("of all", "of_all") : []),
  ];
  const intervals = rows.filter((row) => number(object(row["of_visible"])["low"]) !== undefined).length;
  const lines = [`Shares of the first strategy minus those of another one, on the same ${each}s; the intervals are over ${each}s.`];
  if (intervals < rows.length) lines.push(`One ${each} has no interval.`);
  if (intervals > 1) lines.push("The intervals are not corrected for the number of comparisons.");
  return section("differences", `Differences by ${each}`, h("p", { class: "soft" }, lines.join(" ")), dataTable(`Differences by ${each}`, columns, rows));
}

export function benchmarkReport(document: ReportDocument, pictures: Pictures): Report {
  const benchmark = object(document.record.result["benchmark"]);
  const runs = compareReport(document, pictures);
  if (document.record.result["benchmark"] === undefined) return { ...runs, title: "Benchmark", summary: `${runs.summary} Figures beside published ones come with the merge.` };
  const lines = list(benchmark["beside_published"]).map(String);
  const differences = differencesSection(benchmark);
  return { ...runs, title: `Benchmark ${text(benchmark["name"])}`, summary: lines.length > 0 ? lines.map((line) => `${line}.`).join("\n") : runs.summary, sections: [tableSection(benchmark), ...(differences ? [differences] : []), ...runs.sections] };
}
