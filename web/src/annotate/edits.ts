// SPDX-License-Identifier: Apache-2.0
// Effects of the tools: the actions that a click or an area means with the state as it is.
import { toast } from "../ui/toast";
import type { Pick, Viewer } from "../view/types";
import type { Session } from "./session";
import { type Clip, type State, type Store, rowOf } from "./store";

/** Shape of an area as an action names it: rectangle, lasso, polyline or brush. */
export type Shape = Record<string, unknown>;

interface Definition {
  name: string;
  class: string;
  instance: number;
  color?: string; // else the program's own
}

export class Edits {
  private readonly defining = new Map<number, Definition>(); // on its way to the program

  constructor(
    readonly store: Store,
    readonly session: Session,
    private readonly viewer: Viewer,
  ) {}

  click(pick: Pick): void {
    const { action, tool, label } = this.store.state;
    if (tool === "segment" && (action === "set" || action === "remove")) this.segment(pick.point, action === "set" ? label : 0);
    else if (action === "set") this.set(pick.point);
    else if (action === "remove") void this.removeAt(pick);
    else if (action === "pick") this.pickLabel(pick);
  }

  set(point: number): void {
    const { label, startCost } = this.store.state;
    void this.session.act({ do: "set", label, points: [point], ...(startCost > 0 ? { start_cost: startCost } : {}) });
  }

  /** Takes the whole segment of a point into a label; 0: its paint comes off. */
  segment(point: number, label: number): void {
    void this.session.act({ do: "paint", label, points: [point], segments: true });
  }

  move(from: number, to: number): void {
    if (from !== to) void this.session.act({ do: "move", from, to });
  }

  pickLabel(pick: Pick): void {
    const label =
      this.store.state.controls.get(pick.control ? pick.point : -1)?.label ?? this.viewer.cloud.labelOf(pick.point);
    if (label === 0) toast("This point has no label.");
    else this.store.set({ label });
  }

  removeControl(point: number): void {
    void this.session.act({ do: "remove", points: [point] });
  }

  private async removeAt(pick: Pick): Promise<void> {
    const { controls, wholeTree } = this.store.state;
    if (controls.has(pick.point)) return this.removeControl(pick.point);
    if (!wholeTree) {
      toast("There is no control point. Click its sphere, or choose “Anywhere in its tree”.");
      return;
    }
    const root = await this.session.ask({ type: "root", point: pick.point });
    if (!root) return;
    if (root.head["painted"]) {
      toast("This point is painted. Paint comes off with Del, an area tool and “Paint”.");
    } else if (root.head["control_point"] === null || root.head["control_point"] === undefined) {
      toast("No control point reaches this point.");
    } else {
      void this.session.act({ do: "remove", points: [pick.point] }, { trees: true });
    }
  }

  /** The smaller part, or the larger, of the label under the stroke gets the current one. */
  async split(line: readonly (readonly [number, number])[], larger: boolean): Promise<void> {
    const { label, cloud } = this.store.state;
    if (!cloud) return;
    const split = { line, part: larger ? "larger" : "smaller" };
    await this.session.act({ do: "paint", label, split, view: this.view() }, this.unseen());
  }

  /** The picture in which an action selects. */
  private view(): Record<string, unknown> {
    const { clip_world: clip, ...view } = this.viewer.picture();
    const box = this.store.state.clip;
    const planes = box && { clip_planes: planesOf(box) };
    return { ...view, clip_world: [0, 4, 8, 12].map((i) => clip.slice(i, i + 4)), ...planes };
  }

  /** Labels that the page does not show: their points are neither selected nor in the way. */
  private unseen(): Record<string, unknown> {
    const { hidden } = this.store.state;
    return hidden.size > 0 ? { hidden: [...hidden] } : {};
  }

  /** Set paints what is in the area; Del takes away control points or paint. */
  async area(shape: Shape): Promise<void> {
    const state = this.store.state;
    if (!state.cloud) return;
    const selection = { ...shape, ...depthOf(state, shape), view: this.view() };
    const hidden = this.unseen();
    if (state.action === "set") {
      await this.session.act({ do: "paint", label: state.label, ...selection }, hidden);
    } else if (state.action === "remove" && state.removal === "paint") {
      await this.session.act({ do: "paint", label: 0, ...selection }, hidden);
    } else if (state.action === "remove") {
      await this.session.act(
        { do: "remove", ...selection },
        { ...hidden, ...(state.removal === "trees" ? { trees: true } : {}) },
      );
    }
  }

  undo(): void {
    if (this.store.state.canUndo || this.store.state.pending > 0) void this.session.act({ do: "undo" });
  }

  redo(): void {
    if (this.store.state.canRedo || this.store.state.pending > 0) void this.session.act({ do: "redo" });
  }

  async clear(): Promise<void> {
    const result = await this.session.act({ do: "clear" });
    if (result?.done)
      toast("All labels are gone from the cloud.", { button: { text: "Undo", click: () => this.undo() } });
  }

  /** Locks a label for everyone, or unlocks it. */
  lock(label: number): void {
    const row = rowOf(this.store.state, label);
    if (!row.locked && row.points === 0) toast("There is nothing to lock: no point has this label.");
    else void this.session.act({ do: row.locked ? "unlock" : "lock", label });
  }

  /** Changes what is known of a label. One change may follow another that the program has not answered yet. */
  async define(number: number, change: Partial<Definition>): Promise<void> {
    const row = rowOf(this.store.state, number);
    const known = { name: row.name, class: row.class, instance: row.instance, ...(row.defined ? { color: row.color } : {}) };
    const definition = { ...(this.defining.get(number) ?? known), ...change };
    this.defining.set(number, definition);
    await this.session.act({ do: "labels", labels: [{ number, ...definition }] });
    if (this.defining.get(number) === definition) this.defining.delete(number);
  }

  changeReach(point: number, startCost: number): void {
    const control = this.store.state.controls.get(point);
    if (control) void this.session.act({ do: "set", label: control.label, points: [point], start_cost: startCost });
  }
}

/** Planes (a, b, c, d) whose inner side is the box. */
function planesOf({ low, high }: Clip): number[][] {
  return [0, 1, 2].flatMap((axis) => {
    const towards = (sign: number) => [0, 1, 2].map((i) => (i === axis ? sign : 0));
    return [
      [...towards(1), -low[axis]!],
      [...towards(-1), high[axis]!],
    ];
  });
}

function depthOf(state: Readonly<State>, shape: Shape): { below_m?: number | "any" } {
  const brush = shape["brush"] as Record<string, unknown> | undefined;
  if (brush && "radius_m" in brush) return {};
  if (state.depth === "deep") return { below_m: "any" };
  return state.depth === "below" ? { below_m: state.below_mm / 1000 } : {};
}
