// SPDX-License-Identifier: Apache-2.0
// Shapes that a tool draws over the view while it is used. Thesis Fig. 4.16: a yellow rectangle.
import { h, svg } from "../ui/dom";

export type ScreenPoint = readonly [number, number]; // css pixels of the view

export class Overlay {
  private readonly shade = svg("path", { class: "overlay-shade" });
  private readonly edge = svg("path", { class: "overlay-edge" });
  private readonly stroke = svg("path", { class: "overlay-stroke" });
  private readonly circle = svg("circle", { class: "overlay-circle", r: 0 });
  private readonly corners = svg("g", { class: "overlay-corners" });
  private readonly cross = svg("path", { class: "overlay-cross" });
  readonly hint = h("div", { class: "overlay-hint", hidden: true });
  readonly element = svg(
    "svg",
    { class: "overlay", "aria-hidden": "true" },
    this.shade,
    this.edge,
    this.stroke,
    this.circle,
    this.corners,
    this.cross,
  );

  clear(): void {
    for (const path of [this.shade, this.edge, this.stroke]) path.removeAttribute("d");
    this.corners.replaceChildren();
    this.hint.hidden = true;
  }

  rectangle(a: ScreenPoint, b: ScreenPoint): void {
    this.area([a, [b[0], a[1]], b, [a[0], b[1]]]);
  }

  area(corners: readonly ScreenPoint[], marked = false): void {
    const path = pathOf(corners, true);
    this.shade.setAttribute("d", path);
    this.edge.setAttribute("d", path);
    this.corners.replaceChildren(...(marked ? corners.map(([x, y]) => svg("circle", { cx: x, cy: y, r: 3.5 })) : []));
  }

  line(line: readonly ScreenPoint[], width_px: number): void {
    this.stroke.setAttribute("d", pathOf(line.length === 1 ? [line[0]!, line[0]!] : line, false));
    this.stroke.setAttribute("stroke-width", String(width_px));
  }

  /** Where the brush is; null: nowhere. */
  brush(at: ScreenPoint | null, radius_px: number): void {
    this.circle.setAttribute("r", at ? String(radius_px) : "0");
    if (!at) return;
    this.circle.setAttribute("cx", String(at[0]));
    this.circle.setAttribute("cy", String(at[1]));
  }

  /** The cursor of the keyboard; null: none. */
  cursor(at: ScreenPoint | null): void {
    if (!at) this.cross.removeAttribute("d");
    else this.cross.setAttribute("d", `M${at[0] - 12} ${at[1]}h8m8 0h8M${at[0]} ${at[1] - 12}v8m0 8v8`);
  }

  say(text: string): void {
    this.hint.textContent = text;
    this.hint.hidden = false;
  }
}

function pathOf(points: readonly ScreenPoint[], closed: boolean): string {
  const steps = points.map(([x, y], i) => `${i === 0 ? "M" : "L"}${x.toFixed(1)} ${y.toFixed(1)}`);
  return steps.join("") + (closed ? "Z" : "");
}
