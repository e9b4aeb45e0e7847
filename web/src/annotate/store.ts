// SPDX-License-Identifier: Apache-2.0
// The state of the tool, and who is told when it changes.
import type { ConnectionState } from "../connection";
import type { ControlPoint, LabelRow } from "../protocol";
import type { CloudInfo, Navigation } from "../view/types";

export type Action = "none" | "set" | "remove" | "pick";
export type Tool = "point" | "rectangle" | "polyline" | "lasso" | "brush" | "segment" | "split";
export type Depth = "surface" | "below" | "deep";
/** Items that Delete removes in an area. */
export type Removal = "control" | "trees" | "paint";

/** Box that is drawn, picked and selected in; metres, in the cloud's frame. */
export interface Clip {
  low: readonly [number, number, number];
  high: readonly [number, number, number];
}

export interface CloudEntry {
  name: string;
  bytes: number;
  begun: boolean;
}

export interface OpenCloud extends CloudInfo {
  index: number;
  name: string;
  finite: number;
  has_colors: boolean;
  has_normals?: boolean;
  has_segments?: boolean;
  fields?: readonly string[]; // numbers of each point
  towards_viewer?: readonly [number, number, number];
  offset?: readonly [number, number, number]; // to add to every place, metres
  maxPath: number; // Ω_max
}

export interface Progress {
  stage: string;
  done: number;
  total: number;
  seen: boolean; // some of the cloud is in the picture already
}

export interface State {
  connection: ConnectionState;
  readOnly: string | null;
  clouds: readonly CloudEntry[];
  sequence: boolean; // labels are carried from cloud to cloud
  cloud: OpenCloud | null;
  failure: string | null; // why no cloud could be opened
  progress: Progress | null;
  ready: boolean; // the graph is there
  pending: number; // actions without an answer
  people: number;
  others: readonly string[]; // names of those who have the cloud open, too
  name: string; // one's own
  lastBy: string; // what another one did last
  savedAt: string; // when the last action came to the disk; empty: none yet
  clip: Clip | null;
  boxes: boolean; // around labels
  four: boolean; // views
  canUndo: boolean;
  canRedo: boolean;
  labels: ReadonlyMap<number, LabelRow>;
  colors: readonly string[]; // default colours of the labels from 1
  controls: ReadonlyMap<number, ControlPoint>; // by point
  action: Action;
  tool: Tool;
  depth: Depth;
  below_mm: number;
  brush: number; // px or mm
  brushUnit: "px" | "mm";
  wholeTree: boolean; // Del with the point tool: a click anywhere in it
  removal: Removal;
  label: number; // 1 and up
  startCost: number;
  selected: number | null; // a control point
  show: Readonly<{ cloud: boolean; labels: boolean; controls: boolean }>;
  hidden: ReadonlySet<number>;
  margins: boolean;
  colorBy: string;
  shading: boolean; // by depth
  navigation: Navigation;
  pointSize: number;
  labelList: boolean; // instead of the grid
}

export const kPage = 20;
export const kMaxLabel = 4294967294;
const kColorToCome = "#9aa0a6"; // shown until a label gets its colour with its first point

export function pageOf(label: number): number {
  return Math.floor((label - 1) / kPage) * kPage + 1;
}

/** Returns the row of any label; for an unused label, the row that it would have. */
export function rowOf(state: Readonly<State>, label: number): LabelRow {
  return (
    state.labels.get(label) ?? {
      number: label,
      name: "",
      class: "",
      instance: 0,
      color: label === 0 ? "#000000" : (state.colors[label - 1] ?? kColorToCome),
      defined: false,
      points: 0,
      control_points: 0,
    }
  );
}

export function isEmpty(row: LabelRow): boolean {
  return row.points === 0 && row.control_points === 0;
}

export class Store {
  private readonly watchers: { keys: readonly (keyof State)[]; listener: (state: Readonly<State>) => void }[] = [];
  private changed = new Set<keyof State>();

  constructor(private current: State) {}

  get state(): Readonly<State> {
    return this.current;
  }

  set(patch: Partial<State>): void {
    for (const key of Object.keys(patch) as (keyof State)[]) {
      if (Object.is(patch[key], this.current[key])) continue;
      if (this.changed.size === 0) queueMicrotask(() => this.tell());
      this.changed.add(key);
    }
    this.current = { ...this.current, ...patch };
  }

  /** Called now, and soon after one of these changed. */
  watch(keys: readonly (keyof State)[], listener: (state: Readonly<State>) => void): void {
    this.watchers.push({ keys, listener });
    listener(this.current);
  }

  private tell(): void {
    const changed = this.changed;
    this.changed = new Set();
    for (const { keys, listener } of this.watchers) if (keys.some((key) => changed.has(key))) listener(this.current);
  }
}
