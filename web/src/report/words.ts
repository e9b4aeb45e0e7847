// SPDX-License-Identifier: Apache-2.0
// Numbers and names in words.
import { grouped } from "../ui/figures";
import { type Json, number, object, text } from "./document";

const kMinus = "\u2212";

/** A decimal with a true minus; "–" for what is not known. */
export function decimal(value: number | undefined, digits: number): string {
  if (value === undefined || Number.isNaN(value)) return "–";
  const [whole = "", fraction] = Math.abs(value).toFixed(digits).split(".");
  const size = grouped(Number(whole)) + (fraction === undefined ? "" : `.${fraction}`);
  return value < 0 && /[1-9]/.test(size) ? kMinus + size : size;
}

/** With its sign, "±0" included. */
export function signed(value: number, digits: number): string {
  const size = decimal(Math.abs(value), digits);
  return !/[1-9]/.test(size) ? `±${size}` : value > 0 ? `+${size}` : kMinus + size;
}

export const percent = (share: number | undefined, digits = 1): string => (share === undefined ? "–" : `${decimal(100 * share, digits)} %`);
export const count = (value: number | undefined): string => (value === undefined ? "–" : grouped(value));
/** Gains that are counts have no decimals. */
export const gain = (value: number | undefined): string => decimal(value, value !== undefined && Number.isInteger(value) ? 0 : 1);
export const plural = (n: number, one: string, more = `${one}s`): string => `${grouped(n)} ${n === 1 ? one : more}`;

export function milliseconds(ms: number): string {
  if (ms < 1) return `${decimal(ms, 2)} ms`;
  if (ms < 1000) return `${decimal(ms, ms < 10 ? 1 : 0)} ms`;
  if (ms < 60_000) return `${decimal(ms / 1000, ms < 10_000 ? 2 : 1)} s`;
  return `${Math.floor(ms / 60_000)} min ${decimal((ms % 60_000) / 1000, 0)} s`;
}

export const spaced = (name: string): string => name.replaceAll("_", " ");
export const capital = (word: string): string => word.charAt(0).toUpperCase() + word.slice(1);

/** Phases of a view in the order in which they happen. */
export const kPhases: readonly [key: string, name: string][] = [
  ["forgetting", "forgetting"],
  ["planner_map", "planner's map"],
  ["candidates", "candidates"],
  ["segmentation", "segmentation"],
  ["saliency", "saliency"],
  ["reachability", "reachability"],
  ["evaluation", "evaluation"],
  ["planning", "motion planning"],
  ["motion", "motion"],
  ["fusion", "fusion"],
];

const kRefusals: Record<string, string> = {
  no_ik: "out of reach",
  outside_limits: "beyond a joint's limits",
  goal_in_collision: "in collision there",
  start_in_collision: "in collision at the start",
  no_path: "without a path",
  declined: "declined by the robot",
};

/** "5 868 beyond a joint's limits, 146 in collision there"; empty where nothing was refused. */
export function refusals(refused: unknown): string {
  const reasons = Object.entries(object(refused)).filter(([, n]) => (number(n) ?? 0) > 0);
  return reasons.map(([reason, n]) => `${count(number(n))} ${kRefusals[reason] ?? spaced(reason)}`).join(", ");
}

const kStops: Record<string, string> = {
  regions_done: "It stopped because no view gains enough any more.",
  views_used_up: "It stopped at the number of views it was given.",
  no_candidate: "It stopped because none of the views that gain enough can be reached.",
  cancelled: "It was interrupted.",
  hand_came: "It stopped because the hand came again.",
  nothing_to_do: "There was nothing to look at again.",
};

/** Why a run stopped, as a sentence. */
export function stopSentence(reason: string): string {
  return reason === "" ? "" : (kStops[reason] ?? `It stopped: ${spaced(reason)}.`);
}

const kEnds: Record<string, string> = {
  done: "complete",
  out_of_reach: "out of reach",
  outside_workspace: "outside the workspace",
  not_begun: "not begun",
};

export const regionEnd = (end: string): string => kEnds[end] ?? spaced(end);

/** "640 × 480, f = 525 px, 0.5–2 m". */
export function cameraText(camera: Json): string {
  const [width, height, fx] = [number(camera["width"]), number(camera["height"]), number(camera["fx"])];
  if (width === undefined || height === undefined || fx === undefined) return "";
  const range = [number(camera["min_range_m"]), number(camera["max_range_m"])];
  const reach = range[0] !== undefined && range[1] !== undefined ? `, ${+range[0].toFixed(2)}–${+range[1].toFixed(2)} m` : "";
  return `${width} × ${height}, f = ${+fx.toFixed(1)} px${reach}`;
}

/** The unit of gains. Records of older programs do not say it. */
export function gainUnit(result: Json): string {
  return text(result["gain_unit"]) || (result["strategy"] === "surface" ? "cm²" : "rays");
}
