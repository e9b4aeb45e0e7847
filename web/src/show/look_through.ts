// SPDX-License-Identifier: Apache-2.0
// Looking through the camera of a step: the view from its place, with the edges of its picture.
import type { Camera } from "../view/types";
import { h } from "../ui/dom";
import type { Rows } from "./document";

const kShare = 0.9; // greatest share of the page's view that the camera's picture fills
const kOwnFov_rad = (50 * Math.PI) / 180; // field of view of the page, when no camera is looked through

export class LookThrough {
  private readonly edges = h("div", { class: "look-edges" });
  private readonly name = h("span");
  readonly element = h("div", { class: "look", hidden: true, "aria-hidden": "true" }, this.edges, this.name);
  private before: number[][] | null = null;
  private pose: { rows: Rows; fov_rad: readonly [number, number] } | null = null;
  /** Called with true when a camera is looked through, with false when the page has its own view again. */
  changed: (active: boolean) => void = () => undefined;

  constructor(
    private readonly camera: Camera,
    private readonly stage: HTMLElement,
  ) {
    new ResizeObserver(() => this.place()).observe(stage);
    const moved = (event: PointerEvent) => {
      if (event.buttons !== 0) this.end(false);
    };
    stage.addEventListener("pointermove", moved, { capture: true });
    window.addEventListener("keydown", (event) => {
      if (this.camera.navigation === "fly" && /^Key[WASDQE]$/.test(event.code)) this.end(false);
    });
    stage.addEventListener("wheel", () => this.end(false), { capture: true, passive: true });
  }

  get active(): boolean {
    return this.pose !== null;
  }

  /** `name` of what is looked through. */
  through(rows: Rows, fov_rad: readonly [number, number], name: string): void {
    this.before ??= this.camera.poseRows();
    this.pose = { rows, fov_rad };
    this.name.textContent = name;
    this.element.hidden = false;
    this.place();
    this.changed(true);
  }

  /** `back` to where the person was; else from here on. */
  end(back: boolean): void {
    if (!this.active) return;
    const before = this.before;
    this.pose = this.before = null;
    this.element.hidden = true;
    if (back && before) this.camera.setPoseRows(before, kOwnFov_rad);
    this.changed(false);
  }

  private place(): void {
    if (!this.pose) return;
    const { clientWidth: width, clientHeight: height } = this.stage;
    if (width === 0 || height === 0) return;
    const [x, y] = this.pose.fov_rad.map((fov) => Math.tan(fov / 2)) as [number, number];
    const half = Math.max(y, (x * height) / width) / kShare; // tangent of half the view's vertical angle
    this.edges.style.width = `${(height * x) / half}px`;
    this.edges.style.height = `${(height * y) / half}px`;
    this.camera.setPoseRows(this.pose.rows, 2 * Math.atan(half));
  }
}
