// SPDX-License-Identifier: Apache-2.0
// Where things are on the screen: the page's whole-cloud views, computed again from what the keys promise.
import type { Place } from "./clouds";

const kSlope = Math.tan((25 * Math.PI) / 180); // half the view's height at distance 1
const kRoom = 1.08;

type Vector = [number, number, number];

const sub = (a: Place, b: Place): Vector => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const dot = (a: Place, b: Place) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a: Place, b: Place): Vector => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a: Place): Vector => {
  const length = Math.hypot(...a);
  return [a[0] / length, a[1] / length, a[2] / length];
};

export interface Box {
  x: number;
  y: number;
  width: number;
  height: number;
}

export type From = "first" | "above" | "aside" | "front";

/** Towards the viewer. */
function standpoint(from: From): Vector {
  if (from === "above") return [0, 0, 1];
  if (from === "front") return [0, -1, 0];
  if (from === "first") return unit([0, -1, 0.7]);
  const side = unit([0.45, -1, 0]);
  return unit([side[0], side[1], 0.75]);
}

function boundsOf(positions: Float32Array): [Vector, Vector] {
  const least: Vector = [Infinity, Infinity, Infinity];
  const most: Vector = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < positions.length; ++i) {
    least[i % 3] = Math.min(least[i % 3]!, positions[i]!);
    most[i % 3] = Math.max(most[i % 3]!, positions[i]!);
  }
  return [least, most];
}

export class ScreenCamera {
  private readonly position: Vector;
  private readonly axes: readonly [Vector, Vector, Vector]; // right, up, towards the viewer

  /** Camera of the page for a cloud with z up. @param box place of the view on the page. */
  constructor(positions: Float32Array, from: From, private readonly box: Box) {
    const [least, most] = boundsOf(positions);
    const middle: Vector = [(least[0] + most[0]) / 2, (least[1] + most[1]) / 2, (least[2] + most[2]) / 2];
    const towards = standpoint(from);
    const right = unit(cross(from === "above" ? [0, 1, 0] : [0, 0, 1], towards));
    const axes = [right, cross(towards, right), towards] as const;
    this.axes = axes;
    const corners = Array.from({ length: 8 }, (_, i) => {
      const corner: Vector = [i & 1 ? most[0] : least[0], i & 2 ? most[1] : least[1], i & 4 ? most[2] : least[2]];
      return axes.map((axis) => dot(axis, sub(corner, middle))) as Vector;
    });
    // The scene in the middle of the picture, and as large as there is room for.
    const between = (axis: 0 | 1, slope: number): [number, number] => {
      const high = Math.max(...corners.map((corner) => corner[axis] + slope * corner[2]));
      const low = Math.max(...corners.map((corner) => -corner[axis] + slope * corner[2]));
      return [(high - low) / 2, (high + low) / (2 * slope)];
    };
    const [x, farX] = between(0, (kSlope * box.width) / box.height / kRoom);
    const [y, farY] = between(1, kSlope / kRoom);
    const away = [x, y, Math.max(farX, farY)];
    this.position = [0, 1, 2].map((i) => middle[i]! + axes.reduce((sum, axis, k) => sum + away[k]! * axis[i]!, 0)) as Vector;
  }

  /** Pixels of the page. */
  project(place: Place): [number, number] {
    const seen = sub(place, this.position);
    const [x, y, z] = this.axes.map((axis) => dot(axis, seen)) as Vector;
    const scale = this.box.height / (2 * kSlope * -z);
    return [this.box.x + this.box.width / 2 + scale * x, this.box.y + this.box.height / 2 - scale * y];
  }
}
