// SPDX-License-Identifier: Apache-2.0
// Views of a run: the table of all, a fold for each with its pictures, and the curves over them.
import { h } from "../ui/dom";
import { against, charts, curve, type Series, stackedBars } from "./curves";
import { type Json, number, object, objects, text } from "./document";
import { type Fact, facts, fold } from "./parts";
import type { Picture, Pictures } from "./pictures";
import { type Column, dataTable } from "./table";
import { count, decimal, gain, kPhases, milliseconds, percent, plural, refusals, signed } from "./words";

/** Context in which views are shown. */
export interface ViewsContext {
  pictures: Pictures;
  /** Folder of the pictures, with its slash; empty: beside the page. */
  folder: string;
  /** Beginning of the ids of this run's elements. */
  prefix: string;
  unit: string;
  /** Coverage and unknown voxels before the first view. */
  before: Json;
  /** Unknown voxels in the region of a view, before it and after it. */
  inRegion?: (view: number) => [number, number] | undefined;
}

export interface View {
  number: number;
  json: Json;
  ms: number;
  promised: number | undefined;
  delivered: number | undefined;
}

export function viewsOf(result: Json): View[] {
  return objects(result["views"]).map((json, i) => ({
    number: i + 1,
    json,
    ms: kPhases.reduce((sum, [phase]) => sum + (number(object(json["ms"])[phase]) ?? 0), 0),
    promised: number(json["gain"]),
    delivered: number(json["gain_observed"]),
  }));
}

const kept = (view: View): number | undefined =>
  view.promised !== undefined && view.delivered !== undefined && view.promised > 0 ? view.delivered / view.promised : undefined;
const yesNo = (value: unknown): string => (value === true ? "yes" : value === false ? "no" : "–");
const refusedIn = (view: View): number => Object.values(object(view.json["refused"])).reduce<number>((sum, n) => sum + (number(n) ?? 0), 0);
export const viewId = (context: ViewsContext, view: number): string => `${context.prefix}view-${view}`;

export function viewsTable(caption: string, views: readonly View[], context: ViewsContext): HTMLElement | null {
  if (views.length === 0) return null;
  const of = (key: string) => (view: View) => number(view.json[key]);
  const columns: (Column<View> & { shown?: boolean })[] = [
    { name: "view", text: (view) => String(view.number), value: (view) => view.number, link: (view) => `#${viewId(context, view.number)}` },
    { name: "region", text: (view) => count((of("region")(view) ?? 0) + 1), value: of("region"), shown: context.inRegion !== undefined },
    { name: `promised, ${context.unit}`, text: (view) => gain(view.promised), value: (view) => view.promised },
    { name: `delivered, ${context.unit}`, text: (view) => gain(view.delivered), value: (view) => view.delivered },
    { name: "kept", text: (view) => percent(kept(view), 0), value: kept },
    { name: "candidates", text: (view) => count(of("candidates")(view)), value: of("candidates"), shown: views.some((view) => (of("candidates")(view) ?? 0) > 0) },
    { name: "refused", text: (view) => count(refusedIn(view)), value: refusedIn, shown: views.some((view) => refusedIn(view) > 0) },
    { name: "coverage", text: (view) => percent(of("coverage")(view)), value: of("coverage") },
    { name: "unknown left", text: (view) => count(of("unknown_left")(view)), value: of("unknown_left") },
    { name: "unknown near objects", text: (view) => count(of("unknown_near_objects")(view)), value: of("unknown_near_objects") },
    { name: "unknown in its region", text: (view) => count(context.inRegion?.(view.number)?.[1]), value: (view) => context.inRegion?.(view.number)?.[1] },
    { name: "reveals an object", text: (view) => yesNo(view.json["points_at_object"]), shown: views.some((view) => typeof view.json["points_at_object"] === "boolean") },
    { name: "motion", text: (view) => `${decimal(of("motion_s")(view), 1)} s`, value: of("motion_s"), shown: views.some((view) => (of("motion_s")(view) ?? 0) > 0) },
    { name: "time", text: (view) => milliseconds(view.ms), value: (view) => view.ms, shown: views.some((view) => view.ms > 0) },
  ];
  const known = columns.filter((column) => column.shown ?? (!column.value || views.some((view) => column.value!(view) !== undefined)));
  return dataTable(caption, known, views);
}

function timeText(view: View): string {
  if (view.ms <= 0) return "";
  const ms = object(view.json["ms"]);
  const phases = kPhases.flatMap(([phase, name]) => ((number(ms[phase]) ?? 0) >= 0.05 ? [`${name} ${milliseconds(number(ms[phase])!)}`] : []));
  return milliseconds(view.ms) + (phases.length > 0 ? ` (${phases.join(", ")})` : "");
}

function attentionText(attention: Json): string {
  const [segment, rank] = [number(attention["segment"]), number(attention["rank"])];
  if (segment === undefined || rank === undefined) return "";
  return `segment ${segment + 1} of ${count(number(attention["segments"]))}, number ${rank + 1} by saliency: ${text(attention["why"])}; ${count(number(attention["contours_of_segment"]))} of ${count(number(attention["contours"]))} contour points`;
}

function trackingText(tracking: Json): string {
  const tracked = number(tracking["tracked"]);
  if (tracked === undefined) return "";
  const moved = number(tracking["correction_m"]);
  return `${plural(tracked, "frame")} tracked${moved === undefined ? "" : `, corrected by up to ${decimal(1000 * moved, 1)} mm`}`;
}

function change(after: number | undefined, before: number | undefined, format: (difference: number) => string): string {
  return after === undefined || before === undefined ? "" : ` (${format(after - before)})`;
}

function viewFacts(view: View, before: Json, context: ViewsContext): Fact[] {
  const { json } = view;
  const [coverage, unknown] = [number(json["coverage"]), number(json["unknown_left"])];
  const region = context.inRegion?.(view.number);
  const tilt = (Array.isArray(json["tilt_rad"]) ? json["tilt_rad"] : []).map((angle) => decimal(((number(angle) ?? 0) * 180) / Math.PI, 1));
  return [
    ["region", context.inRegion ? count((number(json["region"]) ?? 0) + 1) : ""],
    ["unknown in its region", region ? count(region[1]) + change(region[1], region[0], (n) => signed(n, 0)) : ""],
    ["promised", view.promised === undefined ? "" : `${gain(view.promised)} ${context.unit}`],
    ["delivered", view.delivered === undefined ? "" : `${gain(view.delivered)} ${context.unit} (${percent(kept(view), 0)})`],
    ["coverage", coverage === undefined ? "" : percent(coverage) + change(coverage, number(before["coverage"]), (n) => `${signed(100 * n, 1)} points`)],
    ["unknown left", unknown === undefined ? "" : count(unknown) + change(unknown, number(before["unknown_left"]), (n) => signed(n, 0))],
    ["unknown near objects", count(number(json["unknown_near_objects"]))],
    ["reveals an object", yesNo(json["points_at_object"])],
    ["looks at an object", yesNo(json["looks_at_object"])],
    ["attention", attentionText(object(json["attention"]))],
    ["candidates", (number(json["candidates"]) ?? 0) > 0 ? `${count(number(json["candidates"]))}, ${count(number(json["evaluated"]))} evaluated` : ""],
    ["refused", refusals(json["refused"])],
    ["frames", (number(json["frames"]) ?? 0) > 0 ? count(number(json["frames"])) + (tilt.length === 2 ? `, tilted ${tilt[0]}° to ${tilt[1]}°` : "") : ""],
    ["frames on the way", (number(json["frames_on_way"]) ?? 0) > 0 ? count(number(json["frames_on_way"])) : ""],
    ["tracking", trackingText(object(json["tracking"]))],
    ["motion", (number(json["motion_s"]) ?? 0) > 0 ? `${decimal(number(json["motion_s"]), 1)} s, camera's path ${decimal(number(json["path_m"]), 2)} m` : ""],
    ["backed out of a contact for", (number(json["retreat_s"]) ?? 0) > 0 ? `${decimal(number(json["retreat_s"]), 1)} s` : ""],
    ["time", timeText(view)],
  ];
}

/** One fold per view. The pictures of a view are loaded when its fold is opened. */
export function viewFolds(views: readonly View[], context: ViewsContext): HTMLElement {
  let before = context.before;
  const folds = views.map((view) => {
    const earlier = before;
    before = view.json;
    const pictures: Picture[] = context.pictures.ofView(view.number, context.folder);
    const coverage = number(view.json["coverage"]);
    const line = [coverage === undefined ? "" : `coverage ${percent(coverage)}`, view.promised === undefined ? "" : `promised ${gain(view.promised)} ${context.unit}`, milliseconds(view.ms)];
    return fold(viewId(context, view.number), `View ${view.number}`, line.filter((part) => part !== "").join(" · "), () => [
      h("div", { class: "view" }, facts(viewFacts(view, earlier, context)), context.pictures.figures(pictures)),
    ]);
  });
  return h("div", { class: "folds" }, ...folds);
}

/** Coverage, unknown voxels, promised against delivered gain, and time per phase. */
export function viewCharts(views: readonly View[], context: ViewsContext, first = "scan"): HTMLElement | null {
  if (views.length === 0) return null;
  const names = (x: number) => (x === 0 ? first : String(x));
  const over = (key: string, scale = 1): Series => ({
    name: key,
    x: [0, ...views.map((view) => view.number)],
    y: [context.before, ...views.map((view) => view.json)].map((measures) => scale * (number(measures[key]) ?? Number.NaN)),
  });
  const gains = (name: string, of: (view: View) => number | undefined): Series => ({ name, x: views.map((view) => view.number), y: views.map((view) => of(view) ?? Number.NaN) });
  return charts(
    curve({ title: "Coverage", x: "view", y: "coverage, %", y_range: [0, 100], names }, [over("coverage", 100)]),
    curve({ title: "Unknown voxels left", x: "view", y: "voxels", names }, [over("unknown_left")]),
    curve({ title: "Unknown voxels near objects", x: "view", y: "voxels", names }, [over("unknown_near_objects")]),
    curve({ title: "Gain of each view", x: "view", y: context.unit }, [gains("promised", (view) => view.promised), gains("delivered", (view) => view.delivered)]),
    against(
      "Promised against delivered gain",
      `promised, ${context.unit}`,
      `delivered, ${context.unit}`,
      views.map((view) => ({ name: String(view.number), x: view.promised ?? Number.NaN, y: view.delivered ?? Number.NaN })),
    ),
    stackedBars(
      "Time per phase",
      "s",
      views.map((view) => ({ name: String(view.number), parts: kPhases.map(([phase]) => (number(object(view.json["ms"])[phase]) ?? 0) / 1000) })),
      kPhases.map(([, name]) => name),
    ),
  );
}
