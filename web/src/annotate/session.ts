// SPDX-License-Identifier: Apache-2.0
// The cloud that is open: brings it here, keeps it as the program has it, and sends actions.
import { type Connection, Disconnected } from "../connection";
import type { ControlPoint, LabelRow, Message } from "../protocol";
import { Refusal } from "../protocol";
import type { BusySign } from "../ui/busy";
import { toast } from "../ui/toast";
import type { Viewer } from "../view/types";
import { type ActionObject, ActionQueue, type ActionResult } from "./action_queue";
import { toRgb } from "../ui/colors";
import { isNumber, recall } from "../ui/settings";
import { firstLook } from "../view/standpoint";
import { TileLoader } from "./tile_loader";
import { type OpenCloud, type Store, isEmpty } from "./store";

const kFirstChunk = 65_536; // something to see soon
const kChunk = 262_144;
const kInFlight = 3;
const kFlash_ms = 450;
const kControlWords = 6;
const kActionTexts: Record<string, string> = {
  set: "Spreading the label",
  paint: "Painting the area",
  remove: "Removing",
  erase: "Removing paint",
  clear: "Clearing all labels",
  undo: "Undoing",
  redo: "Redoing",
  lock: "Locking the label",
  unlock: "Unlocking the label",
  carry: "Carrying the labels over",
};
const kQuestionTexts: Record<string, string> = {
  margins: "Finding where labels are in doubt",
  next_best_click: "Looking for the best place for a click",
  root: "Finding the control point",
  tree: "Finding what the control point labels",
  save: "Writing the labels",
  boxes: "Laying boxes around the labels",
  field: "Bringing the numbers of the field",
};
const kClosed = "The program was started anew and does not let this page in any more. Open the address that it printed.";

/** Points that this page holds: about 100 bytes each, on both sides of the graphics driver. */
export function pointBudget(): number {
  const chosen = recall("pointBudget", 0, isNumber);
  if (chosen > 0) return chosen;
  const memory_gb = (navigator as Navigator & { deviceMemory?: number }).deviceMemory ?? 8;
  return memory_gb >= 8 ? 4_000_000 : memory_gb >= 4 ? 2_000_000 : 1_000_000;
}

export class Session {
  readonly queue: ActionQueue;
  readonly tiles: TileLoader;
  private flashTimer = 0;
  private opening = 0; // counts up: an older one gives up
  private wanted = 0; // the cloud that is open, or will be
  private sequence = -1;
  private complete = false; // all points are here
  private bringing = false; // they are coming
  private readonly changeListeners: (() => void)[] = [];

  constructor(
    readonly connection: Connection,
    private readonly store: Store,
    private readonly viewer: Viewer,
    readonly busy: BusySign,
  ) {
    this.queue = new ActionQueue(connection, (pending, answer) => {
      store.set({ pending });
      if (answer) store.set({ savedAt: new Date().toTimeString().slice(0, 8) });
      if (answer) this.takeUndo(answer);
    });
    this.tiles = new TileLoader(connection, viewer, (error) => toast(textOf(error), { kind: "error" }));
    connection.on("changes", (message) => this.takeChanges(message));
    connection.on("ready", (message) => this.takeReady(message));
    connection.on("progress", ({ head }) => {
      // While points come, their number says more.
      if (this.bringing || (this.complete && store.state.ready)) return;
      const number = (key: string) => (typeof head[key] === "number" ? head[key] : 0);
      const seen = this.complete;
      store.set({ progress: { stage: String(head["stage"]), done: number("done"), total: number("total"), seen } });
    });
    connection.on("people", ({ head }) => {
      const people = (head["people"] ?? []) as { client: number; name: string }[];
      const others = people.filter(({ client }) => client !== connection.client);
      store.set({ people: Number(head["count"]) || 1, others: others.map(({ name }) => name || "without a name") });
    });
    connection.on("read_only", ({ head }) => store.set({ readOnly: String(head["why"]) }));
    connection.on("reset", () => {
      toast("This annotation was begun anew.");
      this.queue.drop();
      void this.open(this.wanted);
    });
    connection.watch((state) => {
      store.set({ connection: state });
      if (state === "closed") toast(kClosed, { kind: "error", stays_ms: 86_400_000 });
      if (state !== "connected") this.queue.pause();
      else if (this.opening > 0) void this.open(this.wanted);
    });
  }

  /** After every change of labels, and when a cloud was opened. */
  onChange(listener: () => void): void {
    this.changeListeners.push(listener);
  }

  /** @return null where it was refused, which is said. */
  async act(action: ActionObject, options: Record<string, unknown> = {}): Promise<ActionResult | null> {
    if (this.store.state.readOnly) {
      toast(`Nothing can be changed: ${this.store.state.readOnly}`, { kind: "error" });
      return null;
    }
    try {
      return await this.busy.during(kActionTexts[action.do] ?? "Working", this.queue.submit(action, options));
    } catch (error) {
      const nothing = error instanceof Refusal && error.message.startsWith("nothing is selected");
      if (nothing)
        toast(
          action.do === "remove" && !options["trees"]
            ? "There is no control point in the area."
            : "There is nothing in the area.",
        );
      else toast(textOf(error), { kind: "error" });
      return null;
    }
  }

  /** A question whose refusal is said. */
  async ask(question: Record<string, unknown> & { type: string }): Promise<Message | null> {
    try {
      return await this.busy.during(kQuestionTexts[question.type] ?? "Asking the program", this.connection.ask(question));
    } catch (error) {
      toast(error instanceof Disconnected ? "The program cannot be reached at the moment." : textOf(error), {
        kind: "error",
      });
      return null;
    }
  }

  /** Another cloud of the folder. */
  async change(index: number): Promise<void> {
    if (index === this.store.state.cloud?.index || index < 0 || index >= this.store.state.clouds.length) return;
    this.queue.drop();
    await this.open(index);
  }

  /** Opens a cloud, or the same again: then only what differs is brought. */
  async open(index: number): Promise<void> {
    const mine = ++this.opening;
    this.bringing = false;
    this.wanted = index;
    this.queue.pause();
    const name = this.store.state.clouds[index]?.name ?? "";
    if (index !== this.store.state.cloud?.index) this.complete = false;
    if (!this.complete)
      this.store.set({ failure: null, progress: { stage: `Opening ${name}`, done: 0, total: 0, seen: false } });
    await this.load(mine, () => this.connection.ask({ type: "open", cloud: index, budget: pointBudget(), tiles: true }));
  }

  /** An empty annotation of the same cloud; the earlier one stays beside it. */
  async beginAnew(): Promise<void> {
    const mine = ++this.opening;
    this.queue.drop();
    this.complete = false;
    let kept = "";
    await this.load(mine, async () => {
      const answer = await this.connection.ask({ type: "new" });
      kept = String(answer.head["kept"] ?? "");
      return answer;
    });
    if (kept) toast(`A new annotation has begun. The earlier one is kept as ${kept}.`);
  }

  private async load(mine: number, ask: () => Promise<Message>): Promise<void> {
    try {
      const answer = await ask();
      if (mine !== this.opening) return;
      const kept = this.takeOpen(answer);
      if (this.store.state.ready) this.queue.opened(Number(answer.head["client_actions"]) || 0);
      this.bringing = !kept;
      const cloud = this.store.state.cloud!;
      if (cloud.tiles !== undefined) await this.bringTiles(mine);
      else if (!kept) await this.bringPoints(mine, cloud.shown);
      if (mine !== this.opening) return;
      this.bringing = false;
      this.store.set({ progress: this.store.state.ready ? null : { stage: "graph", done: 0, total: 0, seen: true } });
      this.changed();
    } catch (error) {
      // Where the connection ended, the next one opens it again.
      if (mine !== this.opening || error instanceof Disconnected) return;
      this.store.set({ progress: null, cloud: null, failure: textOf(error) });
      toast(textOf(error), { kind: "error" });
    }
  }

  /** @return true where the points that are here are still as they were. */
  private takeOpen({ head, body }: Message): boolean {
    const state = this.store.state;
    const before = state.cloud;
    const cloud = cloudOf(head);
    const labels = new Map(((head["labels"] ?? []) as LabelRow[]).map((row) => [row.number, row]));
    const controls = new Map(
      controlsOf(body, Number(head["control_points"] ?? 0)).map((control) => [control.point, control]),
    );
    const sequence = Number(head["sequence"]);
    const same = before?.index === cloud.index && before.name === cloud.name && before.shown === cloud.shown;
    const kept =
      this.complete &&
      cloud.tiles === undefined && // the program does not know any more which are here
      same &&
      sequence === this.sequence &&
      sameCounts(labels, state.labels) &&
      controls.size === state.controls.size;
    this.sequence = sequence;
    this.store.set({
      cloud,
      labels,
      controls,
      failure: null,
      ready: head["ready"] !== false,
      readOnly: typeof head["read_only"] === "string" ? head["read_only"] : null,
      clouds: state.clouds.map((entry, i) => (i === cloud.index ? { ...entry, begun: true } : entry)),
    });
    if (!same) this.store.set({ clip: null, lastBy: "", savedAt: "", selected: null, hidden: new Set(), startCost: 0 });
    this.takeUndo(head);
    if (!kept) {
      this.complete = false;
      this.beginView(cloud, same || (state.sequence && before !== null));
    }
    return kept;
  }

  /** `stay`: the camera does, in the cloud's frame. */
  private beginView(cloud: OpenCloud, stay: boolean): void {
    this.tiles.end();
    const view = this.viewer.cloud;
    const pose = stay ? this.viewer.camera.poseRows() : null;
    view.begin(cloud);
    view.highlight(new Uint32Array());
    view.mark(null);
    view.clearControlPoints();
    for (const row of this.store.state.labels.values()) view.setLabelColor(row.number, toRgb(row.color));
    for (const control of this.store.state.controls.values()) view.setControlPoint(control);
    for (const label of this.store.state.hidden) view.setLabelVisible(label, false);
    if (pose) this.viewer.camera.setPoseRows(pose);
    else firstLook(this.viewer.camera, cloud.up, cloud.towards_viewer);
  }

  private async bringPoints(mine: number, total: number): Promise<void> {
    const questions: Promise<Message>[] = [];
    let asked = 0;
    let here = 0;
    while (here < total) {
      while (asked < total && questions.length < kInFlight) {
        const count = Math.min(total - asked, asked === 0 ? kFirstChunk : kChunk);
        const question = this.connection.ask({ type: "points", from: asked, count });
        question.catch(() => undefined); // told below, for the first that fails
        questions.push(question);
        asked += count;
      }
      const { head, body } = await questions.shift()!;
      if (mine !== this.opening) return;
      const count = Number(head["count"]);
      if (!(count > 0)) break;
      this.viewer.cloud.append({
        positions: new Float32Array(body, 0, 3 * count),
        points: new Uint32Array(body, 12 * count, count),
        colors: new Uint8Array(body, 16 * count, 4 * count),
        labels: new Uint32Array(body, 20 * count, count),
      });
      here += count;
      this.store.set({ progress: { stage: "points", done: here, total, seen: true } });
    }
    this.complete = true;
  }

  private async bringTiles(mine: number): Promise<void> {
    await this.tiles.begin(pointBudget());
    if (mine === this.opening) this.complete = true;
  }

  /** Takes the facts about a large cloud that were not known when it was opened. */
  private takeReady(message: Message): void {
    const { head } = message;
    this.store.set({ ready: true, readOnly: typeof head["read_only"] === "string" ? head["read_only"] : null });
    this.takeChanges(message);
    this.queue.opened(Number(head["client_actions"]) || 0);
    if (this.complete) this.store.set({ progress: null });
  }

  /** Says, and keeps, the person's name. */
  async rename(name: string): Promise<void> {
    const answer = await this.ask({ type: "name", name });
    if (!answer) return;
    this.connection.name = name;
    this.store.set({ name });
  }

  private takeChanges({ head, body }: Message): void {
    if (!this.store.state.cloud) return;
    const action = head["action"] as { do: string; label?: number } | undefined;
    if (action && head["client"] !== this.connection.client) {
      const label = action.label ? `, label ${action.label}` : "";
      this.store.set({ lastBy: `${String(head["name"] || "Another")}: ${action.do}${label}` });
    }
    this.sequence = Number(head["sequence"]);
    this.takeUndo(head);
    const view = this.viewer.cloud;
    const rows = head["labels"] as LabelRow[];
    if (rows.length > 0) {
      const labels = new Map(this.store.state.labels);
      for (const row of rows) {
        if (!row.defined && isEmpty(row)) labels.delete(row.number);
        else labels.set(row.number, row);
        if (row.color) view.setLabelColor(row.number, toRgb(row.color));
      }
      this.store.set({ labels });
    }
    const count = Number(head["control_points"]);
    if (count > 0) {
      const controls = new Map(this.store.state.controls);
      for (const control of controlsOf(body, count)) {
        if (control.label === 0) controls.delete(control.point);
        else controls.set(control.point, control);
        view.setControlPoint(control);
      }
      this.store.set({ controls });
      const selected = this.store.state.selected;
      if (selected !== null && !controls.has(selected)) this.store.set({ selected: null });
    }
    let at = 4 * kControlWords * count;
    const first = at;
    for (const [label, points] of head["groups"] as [number, number][]) {
      view.setLabel(label, new Uint32Array(body, at, points));
      at += 4 * points;
    }
    if (at > first) this.flash(new Uint32Array(body, first, (at - first) / 4));
    this.changed();
  }

  /** Marks what an action changed, for a moment: also what it took from elsewhere. */
  private flash(points: Uint32Array): void {
    const { element, cloud } = this.viewer;
    clearTimeout(this.flashTimer);
    cloud.highlight(points);
    element.dataset["flash"] = String(points.length);
    this.flashTimer = window.setTimeout(() => {
      delete element.dataset["flash"];
      cloud.highlight(new Uint32Array());
    }, kFlash_ms);
  }

  private takeUndo(head: Record<string, unknown>): void {
    if (typeof head["can_undo"] === "boolean") this.store.set({ canUndo: head["can_undo"] });
    if (typeof head["can_redo"] === "boolean") this.store.set({ canRedo: head["can_redo"] });
  }

  private changed(): void {
    for (const listener of this.changeListeners) listener();
  }
}

function cloudOf(head: Record<string, unknown>): OpenCloud {
  const cloud = head["cloud"] as OpenCloud & { graph?: Record<string, unknown> };
  const most = cloud.graph?.["max_path"];
  return { ...cloud, maxPath: typeof most === "number" ? most : 100 };
}

function controlsOf(body: ArrayBuffer, count: number): ControlPoint[] {
  const words = new Uint32Array(body, 0, kControlWords * count);
  const values = new Float32Array(body, 0, kControlWords * count);
  return Array.from({ length: count }, (_, i) => {
    const at = kControlWords * i;
    return {
      point: words[at]!,
      label: words[at + 1]!,
      start_cost: values[at + 2]!,
      position: [values[at + 3]!, values[at + 4]!, values[at + 5]!],
    };
  });
}

function sameCounts(a: ReadonlyMap<number, LabelRow>, b: ReadonlyMap<number, LabelRow>): boolean {
  if (a.size !== b.size) return false;
  for (const [number, row] of a) {
    const other = b.get(number);
    if (!other || other.points !== row.points || other.control_points !== row.control_points) return false;
  }
  return true;
}

export function textOf(error: unknown): string {
  if (error instanceof Refusal) {
    const text = error.message.charAt(0).toUpperCase() + error.message.slice(1);
    return error.context && error.context !== "action" ? `${text} (${error.context})` : text;
  }
  return error instanceof Error ? error.message : String(error);
}
