// SPDX-License-Identifier: Apache-2.0
// The tools of the left mouse button: click, rectangle, polyline, lasso, brush. Thesis §4.2.2.
import type { PointerTool, Viewer } from "../view/types";
import type { Edits } from "./edits";
import type { Overlay, ScreenPoint } from "./overlay";
import type { Store } from "./store";

const kClick_px = 4; // a press that moves less is a click
const kStep_px = 3; // between points of a lasso or a stroke
const kMostCorners = 4000;

export interface Tools {
  viewer: Viewer;
  overlay: Overlay;
  edits: Edits;
  store: Store;
}

function apart(a: ScreenPoint, b: ScreenPoint): number {
  return Math.hypot(a[0] - b[0], a[1] - b[1]);
}

/** A control point that is dragged goes where it is let go; presses elsewhere are the camera's, clicks are heard besides. */
export class PointTool implements PointerTool {
  private dragged: number | null = null;
  private start: ScreenPoint = [0, 0];

  constructor(
    private readonly tools: Tools,
    readonly cursor: string,
  ) {}

  down(x: number, y: number): boolean {
    const { viewer, store } = this.tools;
    const pick = store.state.action === "set" ? viewer.pick(x, y) : null;
    this.dragged = pick?.control ? pick.point : null;
    this.start = [x, y];
    return this.dragged !== null;
  }

  move(x: number, y: number): void {
    if (this.dragged === null || apart(this.start, [x, y]) < kClick_px) return;
    const { viewer, overlay } = this.tools;
    const under = viewer.hover(x, y);
    overlay.line([this.start, [x, y]], 2);
    if (under) viewer.cloud.mark(under.position);
  }

  up(x: number, y: number): void {
    const { viewer, overlay, edits } = this.tools;
    overlay.clear();
    if (this.dragged === null || apart(this.start, [x, y]) < kClick_px) return;
    viewer.cloud.mark(null);
    const under = viewer.pick(x, y);
    if (under) edits.move(this.dragged, under.point);
    this.dragged = null;
  }

  cancel(): void {
    this.dragged = null;
    this.tools.overlay.clear();
    this.tools.viewer.cloud.mark(null);
  }
}

/** Hears clicks in the view that the camera or a tool may have, too: pressed and let go at about the same place. */
export function listenForClicks(view: HTMLElement, clicked: (x: number, y: number) => void): void {
  let start: ScreenPoint | null = null;
  const place = (event: PointerEvent): ScreenPoint => {
    const box = view.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  view.addEventListener("pointerdown", (event) => void (start = event.button === 0 ? place(event) : null), true);
  view.addEventListener(
    "pointermove",
    (event) => {
      if (start && apart(start, place(event)) >= kClick_px) start = null;
    },
    true,
  );
  view.addEventListener(
    "pointerup",
    (event) => {
      const pressed = start;
      start = null;
      if (pressed && event.button === 0) clicked(...place(event));
    },
    true,
  );
  view.addEventListener("pointercancel", () => void (start = null), true);
}

export class RectangleTool implements PointerTool {
  readonly cursor = "crosshair";
  private start: ScreenPoint | null = null;

  constructor(private readonly tools: Tools) {}

  down(x: number, y: number): boolean {
    this.start = [x, y];
    return true;
  }

  move(x: number, y: number): void {
    if (this.start) this.tools.overlay.rectangle(this.start, [x, y]);
  }

  up(x: number, y: number): void {
    const start = this.start;
    this.cancel();
    if (!start || Math.abs(start[0] - x) < 2 || Math.abs(start[1] - y) < 2) return;
    const { viewer, edits } = this.tools;
    void edits.area({ rectangle: [...viewer.toPicture(...start), ...viewer.toPicture(x, y)] });
  }

  cancel(): void {
    this.start = null;
    this.tools.overlay.clear();
  }
}

export class LassoTool implements PointerTool {
  readonly cursor = "crosshair";
  private line: ScreenPoint[] = [];

  constructor(private readonly tools: Tools) {}

  down(x: number, y: number): boolean {
    this.line = [[x, y]];
    return true;
  }

  move(x: number, y: number): void {
    const last = this.line.at(-1);
    if (!last || apart(last, [x, y]) < kStep_px || this.line.length >= kMostCorners) return;
    this.line.push([x, y]);
    this.tools.overlay.area(this.line);
  }

  up(): void {
    const line = this.line;
    this.cancel();
    if (line.length < 3) return;
    const { viewer, edits } = this.tools;
    void edits.area({ lasso: line.map(([x, y]) => viewer.toPicture(x, y)) });
  }

  cancel(): void {
    this.line = [];
    this.tools.overlay.clear();
  }
}

/** A stroke across a label, from border to border; with Alt let go of, the larger part is taken. */
export class SplitTool implements PointerTool {
  readonly cursor = "crosshair";
  private line: ScreenPoint[] = [];

  constructor(private readonly tools: Tools) {}

  down(x: number, y: number): boolean {
    this.line = [[x, y]];
    return true;
  }

  move(x: number, y: number): void {
    const last = this.line.at(-1);
    if (!last) return;
    const { overlay } = this.tools;
    if (apart(last, [x, y]) >= kStep_px && this.line.length < kMostCorners) this.line.push([x, y]);
    overlay.line(this.line, 2);
    overlay.say("From border to border · Alt: the larger part · Esc gives up");
  }

  up(x: number, y: number, event: PointerEvent): void {
    const line = this.line;
    this.cancel();
    const last = line.at(-1);
    if (last && apart(last, [x, y]) > 0) line.push([x, y]);
    if (line.length < 2) return;
    const { viewer, edits } = this.tools;
    void edits.split(line.map(([u, v]) => viewer.toPicture(u, v)), event.altKey);
  }

  cancel(): void {
    this.line = [];
    this.tools.overlay.clear();
  }
}

/** Corners by clicks; Enter, a double click or a click on the first corner ends it. */
export class PolylineTool implements PointerTool {
  readonly cursor = "crosshair";
  private corners: ScreenPoint[] = [];

  constructor(private readonly tools: Tools) {}

  get drawing(): boolean {
    return this.corners.length > 0;
  }

  down(x: number, y: number): boolean {
    const first = this.corners[0];
    const last = this.corners.at(-1);
    const again = last && apart(last, [x, y]) < kClick_px;
    if (this.corners.length >= 3 && first && (again || apart(first, [x, y]) < 8)) {
      this.finish();
    } else if (!again && this.corners.length < kMostCorners) {
      this.corners.push([x, y]);
      this.draw([x, y]);
    }
    return true;
  }

  move(x: number, y: number): void {
    if (this.drawing) this.draw([x, y]);
  }

  up(): void {}

  back(): void {
    this.corners.pop();
    if (this.drawing) this.draw(this.corners.at(-1)!);
    else this.cancel();
  }

  finish(): void {
    const corners = this.corners;
    this.cancel();
    if (corners.length < 3) return;
    const { viewer, edits } = this.tools;
    void edits.area({ polyline: corners.map(([x, y]) => viewer.toPicture(x, y)) });
  }

  cancel(): void {
    this.corners = [];
    this.tools.overlay.clear();
  }

  private draw(pointer: ScreenPoint): void {
    const { overlay } = this.tools;
    overlay.area([...this.corners, pointer], true);
    overlay.say("Click corners · Enter closes · Backspace takes one back · Esc gives up");
  }
}

export class BrushTool implements PointerTool {
  readonly cursor = "none";
  private line: ScreenPoint[] = [];
  private at: ScreenPoint | null = null;
  private place: readonly [number, number, number] | null = null;

  constructor(private readonly tools: Tools) {}

  down(x: number, y: number): boolean {
    this.line = [[x, y]];
    this.hover(x, y);
    this.draw();
    return true;
  }

  move(x: number, y: number): void {
    this.hover(x, y);
    const last = this.line.at(-1);
    if (!last || apart(last, [x, y]) < kStep_px || this.line.length >= kMostCorners) return;
    this.line.push([x, y]);
    this.draw();
  }

  up(): void {
    const line = this.line;
    this.line = [];
    this.tools.overlay.clear();
    if (line.length === 0) return;
    const { viewer, edits, store } = this.tools;
    const { brush, brushUnit } = store.state;
    const scale = viewer.toPicture(1, 0)[0] - viewer.toPicture(0, 0)[0];
    const radius = brushUnit === "mm" ? { radius_m: brush / 1000 } : { radius_px: brush * scale };
    void edits.area({ brush: { line: line.map(([x, y]) => viewer.toPicture(x, y)), ...radius } });
  }

  cancel(): void {
    this.line = [];
    this.tools.overlay.clear();
    this.tools.overlay.brush(null, 0);
  }

  hover(x: number, y: number): void {
    this.at = [x, y];
    this.tools.overlay.brush([x, y], this.radius_px());
  }

  private draw(): void {
    this.tools.overlay.line(this.line, 2 * this.radius_px());
  }

  /** A ball in millimetres is as large as it looks where the surface under the cursor is. */
  private radius_px(): number {
    const { viewer, store } = this.tools;
    const { brush, brushUnit } = store.state;
    if (brushUnit === "px") return brush;
    if (this.at) this.place = viewer.hover(...this.at)?.position ?? this.place;
    if (!this.place) return 6;
    const { clip_world: clip, size } = viewer.picture();
    const height = size[1] / (viewer.toPicture(1, 0)[0] - viewer.toPicture(0, 0)[0]); // css px
    const row = (i: number) => clip.slice(4 * i, 4 * i + 4) as [number, number, number, number];
    const [a, b, c, d] = row(3);
    const depth = a * this.place[0] + b * this.place[1] + c * this.place[2] + d;
    const focal = Math.hypot(...(row(1).slice(0, 3) as [number, number, number]));
    return Math.max(2, ((brush / 1000) * focal * height) / 2 / depth);
  }
}
