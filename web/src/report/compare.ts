// SPDX-License-Identifier: Apache-2.0
// The report of a comparison: strategies side by side, scene by scene and over all scenes.
import { h } from "../ui/dom";
import { charts, curve, type Series, stackedBars } from "./curves";
import { type Json, list, number, numbers, object, objects, type ReportDocument, text } from "./document";
import { facts, fold, links, type Report, section, type Section } from "./parts";
import type { Pictures } from "./pictures";
import { slicesSection } from "./slices";
import { type Column, dataTable } from "./table";
import { count, decimal, kPhases, percent, plural, signed, spaced } from "./words";

/** Measure of runs. The page shows its value times `scale`, rounded, with the unit. */
interface Measure {
  name: string;
  text: string;
  unit: string;
  scale: number;
  decimals: number;
}

interface Estimate {
  n: number;
  mean: number | undefined;
  half: number | undefined;
}

/** A column of the table of measures: a strategy, or the paired difference of two. */
interface Group {
  label: string;
  runs: number;
  paired: boolean;
  json: Json;
}

function measuresOf(document: ReportDocument): Measure[] {
  return objects(object(document.details)["measures"]).map((json) => ({
    name: text(json["name"]),
    text: text(json["text"]),
    unit: text(json["unit"]),
    scale: number(json["scale"]) ?? 1,
    decimals: number(json["decimals"]) ?? 0,
  }));
}

function estimate(json: unknown): Estimate {
  const of = object(json);
  const [low, high] = [number(of["low"]), number(of["high"])];
  return { n: number(of["n"]) ?? 0, mean: number(of["mean"]), half: low === undefined || high === undefined ? undefined : (high - low) / 2 };
}

/** "93.1 ± 0.8", with "(7 of 10)" where not all runs have the measure. */
function estimateText(measure: Measure, of: Estimate, runs: number, sign = false): string {
  if (of.n === 0 || of.mean === undefined) return "–";
  const mean = measure.scale * of.mean;
  const value = sign ? signed(mean, measure.decimals) : decimal(mean, measure.decimals);
  const half = of.half === undefined ? "" : ` ± ${decimal(measure.scale * of.half, measure.decimals)}`;
  return value + half + (of.n === runs ? "" : ` (${of.n} of ${runs})`);
}

const named = (measure: Measure): string => (measure.unit === "" ? measure.text : `${measure.text}, ${measure.unit}`);

class Comparison {
  readonly measures: Measure[];
  readonly summaries: Json[];
  readonly gaps: Json[];
  readonly scenes: string[];
  private readonly several: boolean;

  constructor(readonly document: ReportDocument) {
    const { result } = document.record;
    this.measures = measuresOf(document);
    this.summaries = objects(result["summaries"]);
    this.gaps = objects(object(document.details)["gaps"] ?? result["gaps"]);
    this.scenes = [...new Set(this.summaries.map((summary) => text(summary["scene"])).filter((scene) => scene !== ""))];
    this.several = new Set(this.summaries.map((summary) => text(summary["noise"]))).size > 1;
  }

  label(strategy: unknown, noise: unknown): string {
    return this.several ? `${text(strategy)}, ${text(noise)}` : text(strategy);
  }

  /** @param scene empty: all scenes */
  of(scene: string): Group[] {
    const groups = this.summaries
      .filter((summary) => text(summary["scene"]) === scene)
      .map((json) => ({ label: this.label(json["strategy"], json["noise"]), runs: scene === "" ? this.scenes.length : (number(json["runs"]) ?? 0), paired: false, json }));
    const pairs = this.gaps
      .filter((gap) => text(gap["scene"]) === scene)
      .map((json) => ({ label: `${text(json["a"])} \u2212 ${this.label(json["b"], json["noise"])}, paired`, runs: number(object(json["coverage"])["n"]) ?? 0, paired: true, json }));
    return [...groups, ...pairs];
  }
}

function measuresTable(comparison: Comparison, scene: string): HTMLElement | null {
  const groups = comparison.of(scene);
  const cell = (measure: Measure, group: Group) => estimateText(measure, estimate(group.json[measure.name]), group.runs, group.paired);
  const rows = comparison.measures.filter((measure) => groups.some((group) => /[1-9]/.test(cell(measure, group))));
  if (rows.length === 0) return null;
  const columns: Column<Measure>[] = [
    { name: "mean ± 95 % confidence", text: named },
    ...groups.map((group) => ({ name: group.label, text: (measure: Measure) => cell(measure, group), value: (measure: Measure) => estimate(group.json[measure.name]).mean })),
  ];
  return dataTable(`Measures: ${scene || "all scenes"}`, columns, rows);
}

const kTested = ["coverage", "coverage_area", "unknown_near_objects_at_5", "unknown_near_objects", "views"];

/** A test per measure: an interval that leaves out 0 is a difference that chance explains in one of twenty cases. */
function testsTable(comparison: Comparison, scene: string): HTMLElement | null {
  const rows = comparison.of(scene).filter((group) => group.paired).flatMap((group) =>
    comparison.measures
      .filter((measure) => kTested.includes(measure.name) && estimate(group.json[measure.name]).n > 1)
      .map((measure) => ({ group, measure, of: estimate(group.json[measure.name]) })),
  );
  if (rows.length === 0) return null;
  type Row = (typeof rows)[0];
  const differs = ({ of }: Row) => (of.half === undefined || of.mean === undefined ? "–" : Math.abs(of.mean) > of.half ? "yes" : "no");
  return dataTable<Row>(
    `Paired differences: ${scene || "all scenes"}`,
    [
      { name: "difference", text: (row) => row.group.label.replace(/, paired$/, "") },
      { name: "of", text: (row) => named(row.measure), left: true },
      { name: "paired", text: (row) => estimateText(row.measure, row.of, row.of.n, true), value: (row) => row.of.mean },
      { name: "pairs", text: (row) => count(row.of.n), value: (row) => row.of.n },
      { name: "differs from 0", text: differs },
    ],
    rows,
  );
}

/** Scenes have the same axes, so that their curves can be compared by eye. */
function curvesOf(comparison: Comparison, scene: string): HTMLElement | null {
  const all = objects(object(comparison.document.details)["curves"]);
  const seriesOf = (of: Json, what: string): Series[] =>
    objects(of[what]).map((json) => ({ name: text(json["name"]), x: numbers(json["x"]), y: numbers(json["y"]), low: numbers(json["low"]), high: numbers(json["high"]) }));
  const values = (what: string, pick: "y" | "high") => all.flatMap((of) => seriesOf(of, what)).flatMap((series) => [...(series[pick] ?? [])].filter(Number.isFinite));
  const here = all.find((of) => text(of["scene"]) === scene);
  if (!here) return null;
  const least = Math.min(90, ...values("coverage", "y"));
  const most = Math.max(1, ...values("unknown", "y"));
  const names = (x: number) => (x === 0 ? "scan" : String(x));
  return charts(
    curve({ title: `Coverage: ${scene || "mean over all scenes"}`, x: "view", y: "coverage, %", y_range: [10 * Math.floor(least / 10), 100], names }, seriesOf(here, "coverage")),
    curve({ title: `Unknown voxels near objects: ${scene || "mean over all scenes"}`, x: "view", y: "voxels", y_range: [0, 1.1 * most], names }, seriesOf(here, "unknown")),
    stackedBars(
      "Time per phase, mean of a run",
      "s",
      comparison.of(scene).filter((group) => !group.paired).map((group) => ({ name: group.label, parts: kPhases.map(([phase]) => (estimate(group.json[`${phase}_ms`]).mean ?? 0) / 1000) })),
      kPhases.map(([, name]) => name),
    ),
  );
}

function stops(group: Group): string {
  const reasons = Object.entries(object(group.json["stopped_because"]));
  return reasons.map(([reason, runs]) => `${count(number(runs))} of ${count(number(group.json["runs"]))} runs: ${spaced(reason)}`).join(", ");
}

function promises(group: Group): string {
  const of = object(group.json["promises"]);
  const views = number(of["views"]) ?? 0;
  const median = number(of["median_kept"]);
  if (views === 0 || median === undefined) return "";
  const rank = number(of["rank_correlation"]);
  return `${plural(views, "view")} kept ${percent(median, 0)} of what they promised (median)${rank === undefined ? "" : `; rank correlation ${decimal(rank, 2)}`}; ${count(number(of["broken"]))} kept less than a tenth`;
}

function sharesTable(comparison: Comparison, scene: string): HTMLElement | null {
  const rows = comparison.of(scene).filter((group) => !group.paired).map((group) => ({ label: group.label, shares: list(group.json["points_at_object"]).map((share) => estimate(share).mean) }));
  const most = Math.max(0, ...rows.map((row) => row.shares.length));
  if (most === 0) return null;
  type Row = (typeof rows)[0];
  const columns: Column<Row>[] = [{ name: "share of the runs", text: (row) => row.label }];
  for (let k = 0; k < most; ++k) columns.push({ name: `view ${k + 1}`, text: (row) => percent(row.shares[k], 0), value: (row) => row.shares[k] });
  return dataTable(`Views that reveal an object: ${scene || "all scenes"}`, columns, rows);
}

function marksFold(comparison: Comparison, scene: string, id: string): HTMLElement | null {
  const rows = objects(object(comparison.document.details)["marks"]).filter((marks) => text(marks["scene"]) === scene);
  if (rows.length === 0) return null;
  const most = Math.max(...rows.map((row) => list(row["marks"]).length));
  const columns: Column<Json>[] = [{ name: "run", text: (row) => `${text(row["label"])}, seed ${String(number(row["seed"]))}` }];
  const mark = (value: unknown) => (value === undefined ? "" : value === true ? "✓" : "×");
  for (let k = 0; k < most; ++k) columns.push({ name: `view ${k + 1}`, text: (row) => mark(list(row["marks"])[k]) });
  return fold(id, "Run by run", "✓ reveals an object, × does not", () => [dataTable(`Views that reveal an object, run by run: ${scene}`, columns, rows)]);
}

function sceneSection(comparison: Comparison, scene: string, index: number): Section {
  const strategies = comparison.of(scene).filter((group) => !group.paired);
  return section(
    `part-${index}`,
    scene || "All scenes",
    scene === "" ? h("p", { class: "soft" }, "Each scene counts once, with the mean of its runs; the intervals are over scenes.") : null,
    curvesOf(comparison, scene),
    measuresTable(comparison, scene),
    testsTable(comparison, scene),
    sharesTable(comparison, scene),
    marksFold(comparison, scene, `runs-${index}`),
    facts(strategies.flatMap((group) => [[`${group.label}: stopped`, scene === "" ? "" : stops(group)], [`${group.label}: promises`, promises(group)]] as const)),
  );
}

function summaryText(comparison: Comparison): string {
  const { result } = comparison.document.record;
  const runs = object(result["runs"]);
  const [done, planned] = [number(runs["done"]) ?? 0, number(runs["planned"]) ?? 0];
  const inShards = number(runs["in_shards"]) ?? 0;
  const rest = planned - done - inShards;
  const failed = objects(result["slices"]).filter((slice) => text(slice["state"]) === "failed").length;
  const sentences =
    planned === 0
      ? ["No figures yet."]
      :
    inShards > 0
      ? [`${done} of ${planned} runs are merged, ${inShards} more are done in slices, ${rest > 0 ? `${rest} are still to be done` : "none is left"}.`]
      : [done < planned ? `${done} of ${planned} runs; the others are still to be done.` : `${plural(done, "run")}.`];
  const area = comparison.measures.find((measure) => measure.name === "coverage_area");
  if (failed > 0) sentences.push(`${plural(failed, "slice")} failed.`);
  for (const group of comparison.of(comparison.scenes.length > 1 ? "" : (comparison.scenes[0] ?? ""))) {
    const of = estimate(group.json["coverage_area"]);
    if (group.paired && area && of.n > 0) sentences.push(`Area under the coverage, ${group.label.replace(/, paired$/, "")}: ${estimateText(area, of, of.n, true)} points.`);
  }
  return sentences.join(" ");
}

export function compareReport(document: ReportDocument, pictures: Pictures): Report {
  const comparison = new Comparison(document);
  const { record } = document;
  const { result } = record;
  const strategies = [...new Set(comparison.summaries.map((summary) => text(summary["strategy"])))];
  const noises = [...new Set(comparison.summaries.map((summary) => text(summary["noise"])))];
  const slices = slicesSection(document);
  const runs = object(result["runs"]);
  const incomplete = (number(runs["done"]) ?? 0) < (number(runs["planned"]) ?? 1);
  const parts = [...(comparison.scenes.length > 1 ? [""] : []), ...comparison.scenes];
  const about = objects(object(document.details)["facts"]).map((fact) => [text(fact["name"]), text(fact["value"])] as const);
  return {
    title: "Strategies compared",
    settings: [
      ["strategies", strategies.join(", ")],
      ["robot", text(result["robot"]) === "free" ? "free camera" : text(result["robot"])],
      ["noise", noises.join(", ")],
      ["views at most", String(number(result["max_views"]) ?? "")],
    ],
    summary: summaryText(comparison),
    sections: [
      ...(slices && incomplete ? [slices] : []),
      ...parts.map((scene, i) => sceneSection(comparison, scene, i + 1)),
      ...(slices && !incomplete ? [slices] : []),
      section(
        "comparison",
        "Comparison",
        facts([["scenes", comparison.scenes.length > 0 ? String(comparison.scenes.length) : ""], ["seeds", numbers(result["seeds"]).join(", ")], ...about, ["Saccade", record.version ?? ""]], "pairs"),
        links(
          pictures.files,
          [
            ["runs.csv", "a row per run"],
            ["views.csv", "a row per view"],
            ["summary.csv", "means and intervals"],
            ["campaign.sqlite", "all runs ever done in this folder"],
          ],
          document.live !== undefined,
        ),
      ),
    ],
  };
}
