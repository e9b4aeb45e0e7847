// SPDX-License-Identifier: Apache-2.0
// Mouse, touchpad, touch and keys move the camera, or go to the tool.
//   left: the tool, else as right     right: turn around what is under the cursor     middle, Shift: pan     Ctrl: roll
//   wheel, pinch: zoom to the cursor  Alt or Space held: left is the camera's          two fingers: pan, zoom and roll
// Fly: W A S D forwards and sideways, Q E down and up, Shift faster; drag to look around; the wheel sets the speed.
import * as THREE from "three";
import type { SceneCamera } from "./camera";
import type { SideCamera } from "./side_camera";
import type { PointerTool } from "./types";

type Gesture = "turn" | "pan" | "roll" | "look" | "tool";

const kTurn_rad_per_px = 0.0055;
const kLook_rad_per_px = 0.0028;
const kSameWheel_ms = 400;
const kFlyKeys: Record<string, readonly [number, number, number]> = {
  KeyW: [0, 0, -1],
  KeyS: [0, 0, 1],
  KeyA: [-1, 0, 0],
  KeyD: [1, 0, 0],
  KeyQ: [0, -1, 0],
  KeyE: [0, 1, 0],
};

/** Which of several views the mouse moves. */
export interface Stage {
  /** The view there is in use from now on. */
  enter(x: number, y: number): void;
  /** Whether the view there is the one in use. */
  isIn(x: number, y: number): boolean;
  readonly side: SideCamera | null; // camera of the view in use; null: it is the free one
  readonly area: { left: number; top: number; width: number; height: number }; // place of the view in use, css px
}

function isTyping(event: KeyboardEvent): boolean {
  const target = event.target;
  return target instanceof HTMLElement && (target.isContentEditable || /^(INPUT|TEXTAREA|SELECT)$/.test(target.tagName));
}

export class Controls {
  private tool: PointerTool | null = null;
  private gesture: Gesture | null = null;
  private pointer = -1;
  private last: [number, number] = [0, 0];
  private touches = new Map<number, [number, number]>();
  private wheel = { at: -Infinity, x: 0, y: 0, target: new THREE.Vector3() };
  private keys = new Set<string>();
  private space = false;
  private fast = false;
  private flying = 0; // when the last step of a flight was; 0: none
  private speed = 1;
  private abort = new AbortController();

  constructor(
    private element: HTMLElement,
    private view: SceneCamera,
    private stage: Stage,
    private under: (x: number, y: number) => THREE.Vector3 | null,
    private changed: () => void,
  ) {
    const { signal } = this.abort;
    element.addEventListener("pointerdown", (event) => this.down(event), { signal });
    element.addEventListener("pointermove", (event) => this.move(event), { signal });
    element.addEventListener("pointerup", (event) => this.up(event), { signal });
    element.addEventListener("pointercancel", (event) => this.cancel(event), { signal });
    element.addEventListener("contextmenu", (event) => event.preventDefault(), { signal });
    element.addEventListener("wheel", (event) => this.wheeled(event), { signal, passive: false });
    window.addEventListener("keydown", (event) => this.key(event, true), { signal, capture: true });
    window.addEventListener("keyup", (event) => this.key(event, false), { signal, capture: true });
    window.addEventListener("blur", () => this.release(), { signal });
  }

  setTool(tool: PointerTool | null): void {
    if (this.gesture === "tool") {
      this.tool?.cancel();
      this.gesture = null;
    }
    this.tool = tool;
    this.element.style.cursor = tool?.cursor ?? "";
  }

  dispose(): void {
    this.abort.abort();
    this.release();
  }

  private place(event: MouseEvent): [number, number] {
    const box = this.element.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  /** The view under the cursor is in use, unless something is under way in another. */
  private enter(x: number, y: number, presses: boolean): void {
    if (this.gesture !== null || this.stage.isIn(x, y)) return;
    if (this.tool?.drawing) {
      if (!presses) return;
      this.tool.cancel();
    }
    this.stage.enter(x, y);
  }

  private down(event: PointerEvent): void {
    this.view.stop();
    this.element.focus({ preventScroll: true });
    const [x, y] = this.place(event);
    this.enter(x, y, true);
    if (event.pointerType === "touch") {
      this.touches.set(event.pointerId, [x, y]);
      if (this.touches.size === 2) this.beginPinch();
      if (this.touches.size > 1) return;
    }
    if (this.gesture !== null) return;
    if (event.button === 1) event.preventDefault(); // no automatic scrolling
    const camera = event.altKey || this.space;
    if (event.button === 0 && this.tool !== null && !camera && this.tool.down(x, y, event)) this.gesture = "tool";
    else if (event.button === 1 || event.shiftKey || (this.stage.side !== null && event.button <= 2)) this.gesture = "pan";
    else if (event.ctrlKey) this.gesture = "roll";
    else if (event.button === 0 || event.button === 2) this.gesture = this.view.navigation === "fly" ? "look" : "turn";
    else return;
    this.pointer = event.pointerId;
    this.last = [x, y];
    this.element.setPointerCapture(event.pointerId);
    const pivots = this.gesture === "turn" || (this.gesture === "pan" && this.stage.side === null);
    if (pivots) this.findPivot(x, y);
    if (this.gesture !== "tool") this.element.style.cursor = "grabbing";
  }

  private move(event: PointerEvent): void {
    const [x, y] = this.place(event);
    if (event.buttons === 0) this.enter(x, y, false);
    if (this.touches.has(event.pointerId) && this.touches.size > 1) {
      this.pinch(event.pointerId, x, y);
      return;
    }
    if (this.gesture === null || this.gesture === "tool") {
      if (this.gesture === null || event.pointerId === this.pointer) this.tool?.move(x, y, event);
      return;
    }
    if (event.pointerId !== this.pointer) return;
    const dx = x - this.last[0];
    const dy = y - this.last[1];
    if (dx === 0 && dy === 0) return;
    if (this.gesture === "turn") this.turn(-dx * kTurn_rad_per_px, -dy * kTurn_rad_per_px);
    else if (this.gesture === "look") this.look(-dx * kLook_rad_per_px, -dy * kLook_rad_per_px);
    else if (this.gesture === "pan") this.pan(dx, dy);
    else this.rollFrom(this.last, [x, y]);
    this.last = [x, y];
    this.changed();
  }

  private up(event: PointerEvent): void {
    this.touches.delete(event.pointerId);
    if (event.pointerId !== this.pointer) return;
    const gesture = this.gesture;
    this.end();
    if (gesture === "tool") this.tool?.up(...this.place(event), event);
  }

  private cancel(event: PointerEvent): void {
    this.touches.delete(event.pointerId);
    if (event.pointerId !== this.pointer) return;
    const gesture = this.gesture;
    this.end();
    if (gesture === "tool") this.tool?.cancel();
  }

  private end(): void {
    this.gesture = null;
    this.pointer = -1;
    this.element.style.cursor = this.tool?.cursor ?? "";
  }

  /** What is under the cursor, else what is there as far away as the pivot. */
  private findPivot(x: number, y: number): THREE.Vector3 {
    const found = this.under(x, y);
    const { camera, pivot } = this.view;
    if (found !== null) return pivot.copy(found);
    const ahead = camera.getWorldDirection(new THREE.Vector3());
    const depth = Math.max(pivot.clone().sub(camera.position).dot(ahead), 0.01 * this.view.radius_m);
    const ray = new THREE.Vector3(...this.inView(x, y), 0.5);
    ray.unproject(camera).sub(camera.position);
    return pivot.copy(camera.position).addScaledVector(ray, depth / ray.dot(ahead));
  }

  /** −1 to 1 across the view in use, y up. */
  private inView(x: number, y: number): [number, number] {
    const { left, top, width, height } = this.stage.area;
    return [(2 * (x - left)) / width - 1, 1 - (2 * (y - top)) / height];
  }

  private rotate(axis: THREE.Vector3, angle_rad: number, around: THREE.Vector3 | null): void {
    const turn = new THREE.Quaternion().setFromAxisAngle(axis, angle_rad);
    const { camera } = this.view;
    camera.quaternion.premultiply(turn).normalize();
    if (around !== null) camera.position.sub(around).applyQuaternion(turn).add(around);
  }

  private axis(x: number, y: number, z: number): THREE.Vector3 {
    return new THREE.Vector3(x, y, z).applyQuaternion(this.view.camera.quaternion);
  }

  /** About the picture's own axes: no direction is special, none is out of reach. */
  private turn(right_rad: number, up_rad: number): void {
    const angle = Math.hypot(right_rad, up_rad);
    this.rotate(this.axis(up_rad / angle, right_rad / angle, 0), angle, this.view.pivot);
  }

  private look(right_rad: number, up_rad: number): void {
    this.rotate(this.axis(0, 1, 0).dot(this.view.up) < 0 ? this.view.up.clone().negate() : this.view.up, right_rad, null);
    this.rotate(this.axis(1, 0, 0), up_rad, null);
  }

  private rollFrom(from: readonly [number, number], to: readonly [number, number]): void {
    const { left, top, width, height } = this.stage.area;
    const [cx, cy] = [left + 0.5 * width, top + 0.5 * height];
    const angle = Math.atan2(to[1] - cy, to[0] - cx) - Math.atan2(from[1] - cy, from[0] - cx);
    this.rotate(this.axis(0, 0, 1), angle, null);
  }

  /** The pivot stays under the cursor. */
  private pan(dx: number, dy: number): void {
    const { side, area } = this.stage;
    if (side !== null) {
      side.pan(dx / area.height, dy / area.height);
      return;
    }
    const { camera, pivot } = this.view;
    const depth = pivot.clone().sub(camera.position).dot(camera.getWorldDirection(new THREE.Vector3()));
    const m_per_px = (2 * Math.max(depth, 1e-6) * Math.tan((camera.fov * Math.PI) / 360)) / area.height;
    camera.position.addScaledVector(this.axis(1, 0, 0), -dx * m_per_px).addScaledVector(this.axis(0, 1, 0), dy * m_per_px);
  }

  private zoom(target: THREE.Vector3, factor: number): void {
    const offset = this.view.camera.position.clone().sub(target);
    const least = 1e-4 * this.view.radius_m;
    const length = Math.min(Math.max(offset.length() * factor, least), 200 * this.view.radius_m);
    this.view.camera.position.copy(target).add(offset.setLength(length));
  }

  private wheeled(event: WheelEvent): void {
    event.preventDefault();
    this.view.stop();
    const [x, y] = this.place(event);
    this.enter(x, y, false);
    const { side } = this.stage;
    const unit = event.deltaMode === 1 ? 32 : event.deltaMode === 2 ? 400 : 1;
    const amount = Math.min(Math.max((event.deltaY || event.deltaX) * unit, -400), 400);
    const factor = Math.exp((event.ctrlKey ? 0.01 : 0.0016) * amount);
    if (side !== null && !event.shiftKey) {
      side.zoom(...this.inView(x, y), factor);
      this.changed();
      return;
    }
    if (side === null && this.view.navigation === "fly" && !event.ctrlKey) {
      this.speed = Math.min(Math.max(this.speed * Math.exp(-0.002 * amount), 0.01), 100);
      return;
    }
    if (event.shiftKey) {
      if (side === null) this.findPivot(x, y);
      this.pan(-event.deltaX * unit, -event.deltaY * unit);
    } else {
      const now = performance.now();
      const same = now - this.wheel.at < kSameWheel_ms && Math.hypot(x - this.wheel.x, y - this.wheel.y) < 4;
      this.wheel = { at: now, x, y, target: same ? this.wheel.target : this.findPivot(x, y).clone() };
      this.zoom(this.wheel.target, factor);
    }
    this.changed();
  }

  private beginPinch(): void {
    if (this.gesture === "tool") this.tool?.cancel();
    this.end();
    const [a, b] = [...this.touches.values()] as [[number, number], [number, number]];
    if (this.stage.side === null) this.findPivot((a[0] + b[0]) / 2, (a[1] + b[1]) / 2);
  }

  private pinch(id: number, x: number, y: number): void {
    const old = this.touches.get(id)!;
    const [otherId, other] = [...this.touches].find(([key]) => key !== id)!;
    this.touches = new Map([[id, [x, y]], [otherId, other]]);
    const before = Math.hypot(old[0] - other[0], old[1] - other[1]);
    const after = Math.hypot(x - other[0], y - other[1]);
    if (before < 1 || after < 1) return;
    this.pan((x - old[0]) / 2, (y - old[1]) / 2);
    if (this.stage.side !== null) {
      this.stage.side.zoom(...this.inView((x + other[0]) / 2, (y + other[1]) / 2), before / after);
      this.changed();
      return;
    }
    this.zoom(this.view.pivot, before / after);
    const angle = Math.atan2(y - other[1], x - other[0]) - Math.atan2(old[1] - other[1], old[0] - other[0]);
    this.rotate(this.axis(0, 0, 1), angle, this.view.pivot);
    this.changed();
  }

  private key(event: KeyboardEvent, pressed: boolean): void {
    this.fast = event.shiftKey;
    if (isTyping(event)) return;
    if (event.code === "Space") this.space = pressed;
    if (!(event.code in kFlyKeys)) return;
    if (!pressed) this.keys.delete(event.code);
    if (this.view.navigation !== "fly" || event.ctrlKey || event.metaKey || event.altKey) return;
    event.stopPropagation();
    event.preventDefault();
    if (!pressed || this.keys.has(event.code)) return;
    this.view.stop();
    this.keys.add(event.code);
    if (this.flying === 0) {
      this.flying = performance.now();
      requestAnimationFrame(() => this.fly());
    }
  }

  private fly(): void {
    if (this.keys.size === 0 || this.view.navigation !== "fly") {
      this.keys.clear();
      this.flying = 0;
      return;
    }
    const now = performance.now();
    const step_s = Math.min((now - this.flying) / 1000, 0.1);
    this.flying = now;
    const along = new THREE.Vector3();
    for (const key of this.keys) along.add(new THREE.Vector3(...kFlyKeys[key]!));
    const length_m = 0.4 * this.view.radius_m * this.speed * (this.fast ? 4 : 1) * step_s;
    if (along.lengthSq() > 0) {
      const move = along.normalize().applyQuaternion(this.view.camera.quaternion).multiplyScalar(length_m);
      this.view.camera.position.add(move);
      this.view.pivot.add(move);
      this.changed();
    }
    requestAnimationFrame(() => this.fly());
  }

  private release(): void {
    this.keys.clear();
    this.space = false;
    this.fast = false;
    this.touches.clear();
    if (this.gesture === "tool") this.tool?.cancel();
    if (this.gesture !== null) this.end();
  }
}
