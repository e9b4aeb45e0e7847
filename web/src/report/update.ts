// SPDX-License-Identifier: Apache-2.0
// The reports of an update: of one task in a simulated scene, or of all tasks of a cell.
import { h } from "../ui/dom";
import { charts, curve } from "./curves";
import { type Json, number, numbers, object, objects, type ReportDocument, text } from "./document";
import { kRunFiles, runFacts } from "./explore";
import { facts, fold, kTimeColors, links, type Report, section, tiles, viewLegend } from "./parts";
import type { Pictures } from "./pictures";
import { type Column, dataTable } from "./table";
import { viewCharts, viewFolds, type ViewsContext, viewsOf, viewsTable } from "./views";
import { count, decimal, gain, percent, plural, refusals, regionEnd, signed, spaced, stopSentence } from "./words";

interface Region {
  number: number;
  json: Json;
  unknown: number[];
}

const kTaskLegend = [
  { text: "the hand's path, from its start to its end", colors: kTimeColors },
  { text: "points of interest and their regions", colors: ["#d61c5c"], shape: "outline" as const },
];

function regionsOf(task: Json): Region[] {
  return objects(task["regions"]).map((json, i) => ({ number: i + 1, json, unknown: numbers(json["unknown"]) }));
}

/** @param of  the task, where the page has several */
function regionsTable(regions: readonly Region[], of: string): HTMLElement | null {
  if (regions.length === 0) return null;
  const share = (key: string) => (region: Region) => number(object(region.json["coverage"])[key]);
  const columns: Column<Region>[] = [
    { name: "region", text: (region) => String(region.number), value: (region) => region.number },
    { name: "ended", text: (region) => regionEnd(text(region.json["end"])), left: true },
    { name: "views", text: (region) => count(number(region.json["views"])), value: (region) => number(region.json["views"]) },
    { name: "unknown after the task", text: (region) => count(region.unknown[0]), value: (region) => region.unknown[0] },
    { name: "unknown at the end", text: (region) => count(region.unknown.at(-1)), value: (region) => region.unknown.at(-1) },
    { name: "objects covered", text: (region) => percent(share("objects")(region)), value: share("objects") },
    { name: "surface covered", text: (region) => percent(share("surfaces")(region)), value: share("surfaces") },
    { name: "gain left, rays", text: (region) => gain(number(region.json["gain_left"])), value: (region) => number(region.json["gain_left"]) },
    { name: "centre, m", text: (region) => numbers(region.json["center_m"]).map((x) => decimal(x, 2)).join(", ") },
    { name: "radius, m", text: (region) => decimal(number(region.json["radius_m"]), 2), value: (region) => number(region.json["radius_m"]) },
    { name: "saliency", text: (region) => decimal(number(region.json["saliency"]), 2), value: (region) => number(region.json["saliency"]) },
    { name: "refused", text: (region) => refusals(region.json["refused"]) || "–", left: true },
    { name: "why", text: (region) => text(region.json["why"]), left: true },
  ];
  const known = columns.filter((column) => !column.name.endsWith("covered") || regions.some((region) => column.value?.(region) !== undefined));
  return dataTable(`Regions of interest${of}`, known, regions);
}

function speedCurve(details: Json): HTMLElement | null {
  const [time, speed] = [numbers(details["time_s"]), numbers(details["speed_m_s"])];
  if (time.length < 2) return null;
  const axes = { title: "Speed of the hand", x: "time, s", y: "m/s", x_range: [time[0]!, time.at(-1)!] as const };
  return charts(curve(axes, [{ name: "speed", x: time, y: speed }]));
}

/** A task: where the hand acted, and the views that looked there again. */
function taskParts(task: Json, pictures: Pictures, folder: string, prefix: string, speed: Json): { during: HTMLElement[]; again: HTMLElement[] } {
  const regions = regionsOf(task);
  const views = viewsOf(task);
  const context: ViewsContext = {
    pictures,
    folder,
    prefix,
    unit: "rays",
    before: { unknown_left: task["unknown_after_task"] },
    inRegion: (view) => {
      const unknown = regions[number(views[view - 1]?.json["region"]) ?? -1]?.unknown;
      const [before, after] = [unknown?.[view - 1], unknown?.[view]];
      return before === undefined || after === undefined ? undefined : [before, after];
    },
  };
  const about = object(task["task"] ?? task);
  const of = prefix === "" ? "" : `, ${prefix.replace(/-(\d+)-$/, " $1")}`;
  const hand = pictures.named(`${folder}hand.png`, "The hand's path, and where it acted", "The map before the task with the hand's trajectory", "hand");
  const forgotten = pictures.named(`${folder}regions.png`, "What was forgotten around each action, in grey", "The map with the regions of interest unknown", "regions");
  const samples = object(about["samples"]);
  const unknown = charts(
    curve(
      { title: "Unknown voxels in the regions", x: "view", y: "voxels", names: (x) => (x === 0 ? "task" : String(x)) },
      regions.map((region) => ({ name: `region ${region.number}`, x: region.unknown.map((_, i) => i), y: region.unknown })),
    ),
  );
  const during = [
    facts([
      ["hand", text(about["trajectory"])],
      ["samples", samples["total"] === undefined ? "" : count(number(samples["total"]))],
      ["duration", number(task["duration_s"]) === undefined ? "" : `${decimal(number(task["duration_s"]), 1)} s`],
      ["actions by", text(about["method"])],
      ["actions", count(objects(about["actions"]).length)],
      ["problem", text(task["problem"])],
    ]),
    pictures.figures([...hand, ...forgotten], { eager: folder === "" }),
    regionsTable(regions, of),
    speedCurve(speed),
  ];
  const again = [
    unknown,
    viewCharts(views, context, "task"),
    viewsTable(`Views${of}`, views, context),
    views.length > 0 ? viewLegend(views.some((view) => Array.isArray(view.json["q"])), kTaskLegend) : h("p", { class: "soft" }, "No view was taken."),
    viewFolds(views, context),
  ];
  const there = (node: HTMLElement | null): node is HTMLElement => node !== null;
  return { during: during.filter(there), again: again.filter(there) };
}

function complete(regions: readonly Region[]): string {
  return `${regions.filter((region) => region.json["end"] === "done").length} of ${regions.length}`;
}

function objectsTable(result: Json): HTMLElement | null {
  const lengths = objects(result["objects"]).flatMap((object_) =>
    (["height_m", "major_m", "minor_m"] as const).map((key) => ({
      object: text(object_["name"]),
      name: { height_m: "height", major_m: "major axis", minor_m: "minor axis" }[key],
      truth: number(object(object_["true"])[key]),
      measured: number(object(object_["measured"])[key]),
    })),
  );
  if (lengths.length === 0) return null;
  type Length = (typeof lengths)[0];
  const mm = (value: number | undefined) => decimal(value === undefined ? undefined : 1000 * value, 1);
  const error = ({ truth, measured }: Length) => (truth === undefined || measured === undefined ? undefined : measured - truth);
  return dataTable<Length>(
    "Objects of the task",
    [
      { name: "object", text: (row) => row.object },
      { name: "length", text: (row) => row.name, left: true },
      { name: "true, mm", text: (row) => mm(row.truth), value: (row) => row.truth },
      { name: "measured, mm", text: (row) => mm(row.measured), value: (row) => row.measured },
      { name: "error, mm", text: (row) => (error(row) === undefined ? "–" : signed(1000 * error(row)!, 1)), value: error },
    ],
    lengths,
  );
}

export function updateReport(document: ReportDocument, pictures: Pictures): Report {
  const result = document.record.result;
  if (Array.isArray(result["tasks"])) return cellReport(document, pictures);
  const isTask = text(result["cell"]) !== "";
  const regions = regionsOf(result);
  const views = viewsOf(result);
  const back = object(result["back"]);
  const contacts = object(result["contacts"]);
  const parts = taskParts(result, pictures, "", "", object(object(document.details)["speed"]));
  const unknown = regions.map((region) => region.unknown.at(-1) ?? 0).reduce((sum, n) => sum + n, 0);
  const forgotten = regions.map((region) => region.unknown[0] ?? 0).reduce((sum, n) => sum + n, 0);
  const maps = [
    ...pictures.named("before.png", "The map before the task, unknown in grey", "The map before the task from outside"),
    ...pictures.named("after.png", "The map after the update, unknown in grey", "The map after the update from outside"),
  ];
  return {
    title: isTask ? `Task ${count(number(result["task_number"]))} of ${text(result["cell"])}` : `Update of ${text(result["scene"])}`,
    settings: [
      ["scene", isTask ? "" : `${text(result["before"])} to ${text(result["scene"])}`],
      ["actions by", text(object(result["task"] ?? result)["method"])],
      ["fused", result["fuse_when"] === "motion" ? "at views and in motion (KFOM)" : "at views (KFOVP)"],
      ["robot", text(result["robot"])],
    ],
    summary: `The hand acted at ${plural(regions.length, "place")}. ${plural(views.length, "view")} looked there again; ${complete(regions)} regions are complete. ${stopSentence(text(result["stopped_because"]))}`,
    sections: [
      section(
        "summary",
        "Summary",
        tiles([
          ["regions complete", complete(regions)],
          ["views", count(views.length)],
          ["unknown in the regions", count(unknown), `${count(forgotten)} voxels after the task`],
          ["contacts", contacts["touching"] === undefined ? "" : count(number(contacts["touching"])), `at ${count(number(contacts["instants"]))} instants of motion`],
        ]),
        pictures.figures(maps, { eager: true }),
        objectsTable(result),
      ),
      section("task", "Task", ...parts.during),
      section("views", "Looking again", ...parts.again),
      section(
        "run",
        "Run",
        facts([...runFacts(document), ["back at its stand-by", back["at_stand_by"] === undefined ? "" : back["at_stand_by"] === true ? "yes" : `no (${spaced(text(back["refused"]))})`], ["forgetting", millisecondsOf(result)]], "pairs"),
        links(pictures.files, kRunFiles, document.live !== undefined),
      ),
    ],
  };
}

function millisecondsOf(result: Json): string {
  const seconds = number(object(result["phases_s"])["forgetting"]);
  return seconds === undefined ? "" : `${decimal(1000 * seconds, 2)} ms`;
}

function cellReport(document: ReportDocument, pictures: Pictures): Report {
  const result = document.record.result;
  const tasks = objects(result["tasks"]).map((json, i) => ({ number: i + 1, json, regions: regionsOf(json), views: viewsOf(json) }));
  type Task = (typeof tasks)[0];
  const sum = (task: Task, of: (unknown: number[]) => number | undefined) => task.regions.reduce((total, region) => total + (of(region.unknown) ?? 0), 0);
  const ended = (task: Task) => text(task.json["problem"]) || stopSentence(text(task.json["stopped_because"]));
  const actions = tasks.reduce((total, task) => total + objects(task.json["actions"]).length, 0);
  const views = tasks.reduce((total, task) => total + task.views.length, 0);
  const table = dataTable<Task>(
    "Tasks",
    [
      { name: "task", text: (task) => String(task.number), value: (task) => task.number, link: (task) => `#task-${task.number}` },
      { name: "duration, s", text: (task) => decimal(number(task.json["duration_s"]), 1), value: (task) => number(task.json["duration_s"]) },
      { name: "actions", text: (task) => count(objects(task.json["actions"]).length), value: (task) => objects(task.json["actions"]).length },
      { name: "regions complete", text: (task) => (task.regions.length > 0 ? complete(task.regions) : "–") },
      { name: "views", text: (task) => count(task.views.length), value: (task) => task.views.length },
      { name: "unknown after the task", text: (task) => count(sum(task, (unknown) => unknown[0])), value: (task) => sum(task, (unknown) => unknown[0]) },
      { name: "unknown at the end", text: (task) => count(sum(task, (unknown) => unknown.at(-1))), value: (task) => sum(task, (unknown) => unknown.at(-1)) },
      { name: "ended", text: ended, left: true },
    ],
    tasks,
  );
  const folds = tasks.map((task) =>
    fold(`task-${task.number}`, `Task ${task.number}`, `${plural(task.views.length, "view")} · ${complete(task.regions)} regions complete`, () => {
      const parts = taskParts(task.json, pictures, `task-${task.number}/`, `task-${task.number}-`, {});
      return [...parts.during, h("h4", {}, "Looking again"), ...parts.again];
    }, tasks.length === 1),
  );
  return {
    title: `Updates of ${text(result["cell"])}`,
    settings: [
      ["robot", text(result["robot"])],
      ["fused", result["fuse_when"] === "motion" ? "at views and in motion (KFOM)" : result["fuse_when"] === undefined ? "" : "at views (KFOVP)"],
    ],
    summary:
      tasks.length === 0
        ? "The hand has not come yet."
        : `The hand came ${plural(tasks.length, "time")} and acted at ${plural(actions, "place")}; the robot took ${plural(views, "view")} to look there again.`,
    sections: [
      section("summary", "The map now", pictures.figures(pictures.named("map.png", "The map now, unknown in grey", "The map from outside"), { eager: true })),
      section("tasks", "Tasks", tasks.length > 0 ? table : null, h("div", { class: "folds" }, ...folds)),
      section("run", "Run", facts(runFacts(document), "pairs"), links(pictures.files, kRunFiles, document.live !== undefined)),
    ],
  };
}
