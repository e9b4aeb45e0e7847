// SPDX-License-Identifier: Apache-2.0
// The mouse and the keyboard's cursor in the view: which tool they have, and what is under them.
import { h, on, takesText } from "../ui/dom";
import type { Pick, Viewer } from "../view/types";
import type { Edits } from "./edits";
import { Overlay, type ScreenPoint } from "./overlay";
import type { Segments } from "./segments";
import { type State, type Store, rowOf } from "./store";
import { BrushTool, LassoTool, PointTool, PolylineTool, RectangleTool, SplitTool, type Tools, listenForClicks } from "./tools";

const kTreeRest_ms = 120; // the cursor rests this long before a tree is asked for
const kCursorStep_px = 12;
const kNear_px = [3, 6];

export class Pointer {
  readonly overlay = new Overlay();
  readonly readout = h("div", { class: "readout number", "aria-live": "off" });
  private readonly tools: Tools;
  private tool: PointTool | RectangleTool | LassoTool | PolylineTool | BrushTool | SplitTool | null = null;
  private navigating = false; // while Space is held
  private frame = 0;
  private at: ScreenPoint | null = null;
  private cursor: ScreenPoint | null = null; // moved by the keyboard
  private treeTimer = 0;
  private treeOf: number | null = null;
  private segment = 0; // that stands out

  constructor(
    private readonly viewer: Viewer,
    private readonly store: Store,
    private readonly edits: Edits,
    private readonly segments: Segments,
  ) {
    this.tools = { viewer, overlay: this.overlay, edits, store };
    const view = viewer.element;
    listenForClicks(view, (x, y) => {
      if (!this.navigating && isClicked(store.state)) this.click(x, y);
    });
    on(view, {
      pointermove: (event) => {
        const box = view.getBoundingClientRect();
        this.at = [event.clientX - box.left, event.clientY - box.top];
        this.moveCursor(null);
        if (event.buttons === 0) this.frame ||= requestAnimationFrame(() => this.look());
        else this.forgetTree();
      },
      pointerleave: () => {
        this.at = null;
        this.readout.textContent = "";
        this.forgetTree();
        this.showSegment(null);
        this.overlay.brush(null, 0);
      },
    });
    store.watch(["action", "tool", "brush", "brushUnit", "wholeTree"], () => this.choose());
    window.addEventListener("keydown", (event) => {
      if (event.key === " " && !takesText(event.target) && !(event.target instanceof HTMLButtonElement)) {
        event.preventDefault();
        this.navigate(true);
      }
    });
    window.addEventListener("keyup", (event) => event.key === " " && this.navigate(false));
    window.addEventListener("blur", () => this.navigate(false));
    on(view, { keydown: (event) => this.key(event) });
  }

  /** Ends what is drawn. @return false where nothing is. */
  giveUp(): boolean {
    const drawing = this.tool instanceof PolylineTool && this.tool.drawing;
    if (drawing) this.tool?.cancel();
    return drawing;
  }

  finish(): boolean {
    if (!(this.tool instanceof PolylineTool) || !this.tool.drawing) return false;
    this.tool.finish();
    return true;
  }

  back(): boolean {
    if (!(this.tool instanceof PolylineTool) || !this.tool.drawing) return false;
    this.tool.back();
    return true;
  }

  private choose(): void {
    const { action, tool } = this.store.state;
    this.tool?.cancel();
    this.forgetTree();
    this.showSegment(null);
    if (tool === "segment") void this.segments.bring().then(() => this.renew());
    if (action === "none" || this.navigating) this.tool = null;
    else if (tool === "point" || tool === "segment" || action === "pick") this.tool = new PointTool(this.tools, "crosshair");
    else if (tool === "rectangle") this.tool = new RectangleTool(this.tools);
    else if (tool === "polyline") this.tool = new PolylineTool(this.tools);
    else if (tool === "split") this.tool = action === "set" ? new SplitTool(this.tools) : null;
    else if (tool === "lasso") this.tool = new LassoTool(this.tools);
    else this.tool = new BrushTool(this.tools);
    this.viewer.setPointerTool(this.tool);
  }

  private navigate(navigating: boolean): void {
    if (this.navigating === navigating) return;
    this.navigating = navigating;
    this.choose();
  }

  private click(x: number, y: number): void {
    if (this.store.state.action === "none") return;
    const pick = this.viewer.pick(x, y) ?? this.near(x, y);
    if (pick) this.edits.click(pick);
  }

  /** Between points, one that is a few pixels away. */
  private near(x: number, y: number): Pick | null {
    for (const distance of kNear_px) {
      for (let turn = 0; turn < 8; turn++) {
        const [dx, dy] = [Math.cos((turn * Math.PI) / 4), Math.sin((turn * Math.PI) / 4)];
        const pick = this.viewer.hover(x + distance * dx, y + distance * dy);
        if (pick) return pick;
      }
    }
    return null;
  }

  /** What is under the mouse: the line in the corner, and the tree that Del would take. */
  private look(): void {
    this.frame = 0;
    if (!this.at) return;
    if (this.tool instanceof BrushTool) this.tool.hover(...this.at);
    const pick = this.viewer.hover(...this.at) ?? this.near(...this.at);
    this.readout.textContent = pick ? describe(this.store.state, pick, this.viewer) : "";
    const { action, tool, wholeTree } = this.store.state;
    const wanted = pick && action === "remove" && tool === "point" && wholeTree ? pick.point : null;
    this.showSegment(pick);
    clearTimeout(this.treeTimer);
    if (wanted === null) this.forgetTree();
    else if (wanted !== this.treeOf) this.treeTimer = window.setTimeout(() => void this.showTree(wanted), kTreeRest_ms);
  }

  /** The segment that a click would take. */
  private showSegment(pick: Pick | null): void {
    const { action, tool } = this.store.state;
    const wanted = pick !== null && tool === "segment" && action !== "none" && action !== "pick" ? this.segments.at(pick.point) : 0;
    if (wanted === this.segment) return;
    this.segment = wanted;
    this.segments.highlight(wanted);
  }

  private async showTree(point: number): Promise<void> {
    this.treeOf = point;
    try {
      const { body } = await this.edits.session.connection.ask({ type: "tree", point });
      if (this.treeOf === point) this.viewer.cloud.highlight(new Uint32Array(body));
    } catch {
      this.forgetTree();
    }
  }

  private forgetTree(): void {
    clearTimeout(this.treeTimer);
    if (this.treeOf !== null) this.viewer.cloud.highlight(new Uint32Array());
    this.treeOf = null;
  }

  /** After changes something else may be under the mouse. */
  renew(): void {
    this.forgetTree();
    this.segment = 0;
    this.frame ||= requestAnimationFrame(() => this.look());
  }

  private key(event: KeyboardEvent): void {
    const steps: Record<string, ScreenPoint> = {
      ArrowLeft: [-1, 0],
      ArrowRight: [1, 0],
      ArrowUp: [0, -1],
      ArrowDown: [0, 1],
    };
    const step = steps[event.key];
    if (step && !event.ctrlKey && !event.altKey && this.store.state.navigation !== "fly") {
      const { clientWidth: width, clientHeight: height } = this.viewer.element;
      const [x, y] = this.cursor ?? [width / 2, height / 2];
      const by = event.shiftKey ? 1 : kCursorStep_px;
      const clamp = (value: number, most: number) => Math.max(0, Math.min(most - 1, value));
      this.moveCursor([clamp(x + by * step[0], width), clamp(y + by * step[1], height)]);
    } else if (event.key === "Enter" && this.cursor && !this.finish()) {
      this.click(...this.cursor);
    } else {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
  }

  private moveCursor(at: ScreenPoint | null): void {
    if (at === null && this.cursor === null) return;
    this.cursor = at;
    this.overlay.cursor(at);
    if (!at) return;
    this.at = at;
    this.frame ||= requestAnimationFrame(() => this.look());
  }
}

function isClicked({ tool, action }: Readonly<State>): boolean {
  return tool === "point" || tool === "segment" || action === "pick";
}

function describe(state: Readonly<State>, pick: Pick, viewer: Viewer): string {
  const control = state.controls.get(pick.point);
  const label = control?.label ?? viewer.cloud.labelOf(pick.point);
  const row = rowOf(state, label);
  const name = label === 0 ? "no label" : row.name ? `${label} ${row.name}` : `label ${label}`;
  const place = pick.position.map((c, axis) => (c + (state.cloud?.offset?.[axis] ?? 0)).toFixed(3)).join("  ");
  return `${name}${control ? ", control point" : ""}   ·   point ${pick.point}   ·   ${place} m`;
}
