// SPDX-License-Identifier: Apache-2.0
// The report of an exploration.
import { h } from "../ui/dom";
import { type Json, number, object, type ReportDocument, text } from "./document";
import { type Fact, facts, links, type Report, section, tiles, viewLegend } from "./parts";
import type { Pictures } from "./pictures";
import { viewCharts, viewFolds, type ViewsContext, viewsOf, viewsTable } from "./views";
import { cameraText, count, decimal, gain, gainUnit, percent, plural, refusals, stopSentence } from "./words";

export const millimetres = (metres: unknown): string => {
  const value = number(metres);
  return value === undefined ? "" : `${decimal(1000 * value, 2)} mm`;
};

/** What is needed to repeat a run. */
export function runFacts(document: ReportDocument): Fact[] {
  const { record } = document;
  const result = record.result;
  const map = object(result["map"]);
  const voxel = number(map["voxel_size_m"]) ?? number(result["voxel_size_m"]);
  const memory = number(map["memory_bytes"]);
  const least = number(result["min_gain"]);
  return [
    ["seed", record.seed === undefined ? "" : String(record.seed)],
    ["surfels", map["kind"] === "surfels" ? count(number(map["surfels"])) : ""],
    [map["kind"] === "surfels" ? "voxels of free space" : "voxel size", voxel === undefined ? "" : `${+(1000 * voxel).toFixed(2)} mm`],
    ["memory of the map", memory === undefined ? "" : `${decimal(memory / 2 ** 20, 1)} MiB`],
    ["camera", cameraText(object(result["camera"]))],
    ["gain threshold", least === undefined ? "" : `${gain(least)} ${gainUnit(result)}`],
    ["threads", record.threads === undefined ? "" : String(record.threads)],
    ["back end", record.backend ?? ""],
    ["Saccade", record.version ?? ""],
  ];
}

export function finalTiles(final: Json, initial: Json): HTMLElement | null {
  const scan = number(initial["coverage"]);
  const unknown = number(initial["unknown_left"]);
  return tiles([
    ["coverage", percent(number(final["coverage"])), scan === undefined ? "" : `${percent(scan)} after the scan`],
    ["unknown left", count(number(final["unknown_left"])), unknown === undefined ? "" : `${count(unknown)} voxels after the scan`],
    ["unknown near objects", count(number(final["unknown_near_objects"])), "voxels"],
    ["accuracy", millimetres(final["accuracy_m"])],
    ["Chamfer distance", millimetres(final["chamfer_m"])],
    ["F-score", percent(number(final["f_score"])), "at 5 mm"],
  ]);
}

function summaryText(result: Json, views: number, live: boolean): string {
  const [from, to] = [number(object(result["initial"])["coverage"]), number(object(result["final"])["coverage"])];
  const taken = views === 0 ? "No view" : views === 1 ? "One view" : plural(views, "view");
  const coverage = from !== undefined && to !== undefined ? ` Coverage went from ${percent(from)} to ${percent(to)}.` : "";
  const stopped = text(result["stopped_because"]) || (result["unfinished"] === true ? "cancelled" : "");
  const end = live ? "The run goes on." : stopSentence(stopped);
  return `${taken} after the initial scan.${coverage} ${end}`.trim();
}

function endFact(result: Json): Fact {
  const [left, needed] = [number(result["gain_left"]), number(result["gain_needed"])];
  const refused = refusals(result["refused_at_end"]);
  if (refused !== "") return ["refused at the end", refused];
  if (left === undefined || needed === undefined) return ["at the end", ""];
  if (left <= 0) return ["at the end", "no view promises anything"];
  return ["at the end", `the best view left promises ${gain(left)} ${gainUnit(result)}, ${gain(needed)} would be worth the move`];
}

export function exploreReport(document: ReportDocument, pictures: Pictures): Report {
  const result = document.record.result;
  const [initial, final] = [object(result["initial"]), object(result["final"])];
  const views = viewsOf(result);
  const context: ViewsContext = { pictures, folder: "", prefix: "", unit: gainUnit(result), before: initial };
  const robot = text(result["robot"]);
  const hasArm = result["q"] !== null && views.some((view) => Array.isArray(view.json["q"]));
  if (object(result["map"])["kind"] === "surfels") pictures.unknown = "unknown surfels in orange";
  const scan = pictures.ofView(0);
  const last = views.length > 0 ? pictures.ofView(views.length).filter((picture) => picture.kind === "map") : [];
  const beforeAfter = [...scan, ...last.map((picture) => ({ ...picture, title: `The map at the end, ${pictures.unknown}` }))];
  const dry = result["dry_run"] === true;
  return {
    title: `${dry ? "Dry run of" : "Exploration of"} ${text(result["scene"])}`,
    settings: [
      ["strategy", text(result["strategy"])],
      ["robot", robot === "free" ? "free camera" : robot],
      ["noise", typeof result["noise"] === "boolean" ? (result["noise"] ? (text(result["sensor"]) || "on") : "none") : ""],
      ["seed", document.record.seed === undefined ? "" : String(document.record.seed)],
    ],
    summary: summaryText(result, views.length, document.live === true),
    sections: [
      section("summary", "Summary", finalTiles(final, initial), pictures.figures(beforeAfter, { eager: true }), viewCharts(views, context)),
      section(
        "views",
        "Views",
        views.length === 0 ? h("p", { class: "soft" }, "No view was taken yet.") : null,
        viewsTable("Views", views, context),
        views.length > 0 ? viewLegend(hasArm) : null,
        facts([
          ["scan", initial["views"] === undefined ? "" : `${count(number(initial["views"]))} of ${count(number(initial["attempted"]) ?? number(initial["views"]))} poses`],
          ["poses passed over", refusals(initial["refused"])],
        ]),
        viewFolds(views, context),
      ),
      section("run", "Run", facts([...runFacts(document), endFact(result)], "pairs"), links(pictures.files, kRunFiles, document.live !== undefined)),
    ],
  };
}

export const kRunFiles: readonly Fact[] = [
  ["mesh.ply", "the surface, with colours"],
  ["surfels.ply", "the surface as surfels, with colours"],
  ["unknown.ply", "unknown surfels, between empty and unknown space"],
  ["map.sacmap", "the map of occupied, empty and unknown voxels, for saccade nbv"],
  ["before.sacmap", "the map before the task"],
  ["hand.csv", "the hand's trajectory, for saccade attend"],
  ["run.json", "all measures, for programs"],
  ["update.json", "all measures, for programs"],
];
