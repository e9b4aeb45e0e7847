// SPDX-License-Identifier: Apache-2.0
// The report of other commands: segments, filtered frames, scores, and any result as facts, tables and pictures.
import { charts, curve, type Series } from "./curves";
import { type Json, number, numbers, object, objects, type ReportDocument, text } from "./document";
import { type Fact, facts, type Report, section, type Section, tiles } from "./parts";
import type { Pictures } from "./pictures";
import { type Column, dataTable } from "./table";
import { capital, count, decimal, percent, plural, spaced } from "./words";

const kTitles: Record<string, string> = { segment: "Segments of", filter: "Filtered frames of", score: "Scores of", fuse: "Fusion of" };

function segmentsTable(result: Json): HTMLElement | null {
  const segments = objects(result["segments"]);
  if (segments.length === 0) return null;
  const of = (key: string) => (row: Json) => number(row[key]);
  const columns: Column<Json>[] = [
    { name: "segment", text: (row) => String(row["id"]), value: of("id") },
    { name: "points", text: (row) => count(of("points")(row)), value: of("points") },
    { name: "saliency", text: (row) => decimal(of("saliency")(row), 3), value: of("saliency") },
    { name: "roundness", text: (row) => decimal(of("roundness")(row), 3), value: of("roundness") },
    { name: "isolation", text: (row) => decimal(of("isolation")(row), 3), value: of("isolation") },
    { name: "size, m", text: (row) => numbers(row["sizes_m"]).map((size) => decimal(size, 3)).join(" × ") },
    { name: "why", text: (row) => text(row["why"]), left: true },
  ];
  const kScrap_m = 0.03; // no longer segments come last, as in the table of the command
  const isScrap = (row: Json) => Math.max(0, ...numbers(row["sizes_m"])) <= kScrap_m;
  const order = (a: Json, b: Json) => Number(isScrap(a)) - Number(isScrap(b)) || (of("saliency")(b) ?? 0) - (of("saliency")(a) ?? 0);
  return dataTable("Segments, the most salient first; specks last", columns, [...segments].sort(order));
}

const kScores: readonly (readonly [key: string, name: string])[] = [
  ["boundary_precision", "boundary precision"],
  ["boundary_recall", "boundary recall"],
  ["boundary_f", "boundary F"],
  ["bce", "consistency error"],
  ["fos", "over-segmentation"],
  ["fus", "under-segmentation"],
  ["wov", "weighted overlap"],
  ["wov_objects", "weighted overlap of objects"],
];

function thresholdCurve(result: Json): HTMLElement | null {
  const points = objects(object(result["curve"])["points"]);
  const x = points.map((point) => number(point["threshold"]) ?? Number.NaN);
  const series = kScores.slice(0, 4).map(([key, name]): Series => ({ name, x, y: points.map((point) => number(point[key]) ?? Number.NaN) }));
  return points.length > 1 ? charts(curve({ title: "Scores over the threshold", x: "threshold", y: "score", y_range: [0, 1], x_range: [x[0]!, x.at(-1)!] }, series)) : null;
}

function filterParts(result: Json): (Node | null)[] {
  const points = number(result["points"]);
  const share = (key: string) => (points && number(result[key]) !== undefined ? `${percent(number(result[key])! / points)} of the points` : "");
  const frames = objects(result["details"]);
  const of = (key: string) => (row: Json) => number(row[key]);
  const columns: Column<Json>[] = [
    { name: "frame", text: (row) => text(row["frame"]) },
    ...(["points", "shadow", "veil", "out_of_range"] as const).map((key) => ({ name: spaced(key), text: (row: Json) => count(of(key)(row)), value: of(key) })),
    { name: "time, ms", text: (row) => decimal(of("ms")(row), 2), value: of("ms") },
  ];
  return [
    tiles([
      ["frames", count(number(result["frames"]))],
      ["shadow points", count(number(result["shadow"])), share("shadow")],
      ["veil points", count(number(result["veil"])), share("veil")],
      ["time per frame", `${decimal(number(object(result["ms_per_frame"])["median"]), 2)} ms`, "median, of the filter alone"],
    ]),
    frames.length > 0 ? dataTable("Frames", columns, frames) : null,
  ];
}

function scoresTable(result: Json): HTMLElement | null {
  const clouds = objects(result["clouds"]);
  if (clouds.length === 0) return null;
  const columns: Column<Json>[] = [
    { name: "cloud", text: (row) => text(row["predicted"]) },
    { name: "points", text: (row) => count(number(row["points"])), value: (row) => number(row["points"]) },
    ...kScores.map(([key, name]) => ({ name, text: (row: Json) => decimal(number(row[key]), 3), value: (row: Json) => number(row[key]) })),
  ];
  return dataTable("Scores", columns, clouds);
}

/** Numbers, words and small objects of a result as facts; lists of objects are tables of their own above. */
function plainFacts(json: Json, prefix = ""): Fact[] {
  return Object.entries(json).flatMap(([key, value]): Fact[] => {
    const name = prefix + spaced(key);
    if (typeof value === "number") return [[name, Number.isInteger(value) ? count(value) : String(+value.toPrecision(5))]];
    if (typeof value === "boolean") return [[name, value ? "yes" : "no"]];
    if (typeof value === "string") return [[name, value]];
    if (Array.isArray(value)) return value.length > 0 && value.length <= 6 && value.every((entry) => typeof entry !== "object") ? [[name, value.join(", ")]] : [];
    return plainFacts(object(value), `${name}: `);
  });
}

function headline(command: string, result: Json): (Node | null)[] {
  if (command === "filter") return filterParts(result);
  if (command === "score") return [tiles(kScores.map(([key, name]) => [name, decimal(number(result[key]), 3)] as const)), scoresTable(result)];
  if (command !== "segment") return [];
  return [
    tiles([
      ["segments", count(number(result["found"]))],
      ["points", count(number(result["points"])), `of ${count(number(result["rows"]))}`],
      ["supervoxels", count(number(result["supervoxels"]))],
    ]),
    thresholdCurve(result),
    segmentsTable(result),
  ];
}

export function otherReport(document: ReportDocument, pictures: Pictures): Report {
  const { record } = document;
  const { command, result } = record;
  const subject = (text(result["input"]) || text(result["out"]) || text(result["scene"])).split("/").at(-1) ?? "";
  const all = pictures.files.all().filter((name) => /\.(png|svg)$/.test(name));
  const apart = all.filter((name) => name.startsWith("pictures/")); // beside filtered frames, which are no pictures
  const drawn = apart.length > 0 ? apart : command === "filter" ? [] : all;
  const figures = pictures.figures(drawn.map((name) => ({ name, title: name, alt: `Picture ${name}`, kind: "picture" })), { eager: true });
  const sections: Section[] = [section("summary", "Summary", figures, ...headline(command, result))];
  sections.push(section("run", "Run", facts([...plainFacts(result), ["seed", String(record.seed ?? "")], ["Saccade", record.version ?? ""]], "pairs")));
  return {
    title: `${kTitles[command] ?? `${capital(command)}:`} ${subject}`.trim(),
    settings: [["method", text(result["method"])]],
    summary: drawn.length > 0 ? `${plural(drawn.length, "picture")} below.` : "",
    sections,
  };
}
