// SPDX-License-Identifier: Apache-2.0
// Views as pyramids of lines: the camera at the tip, the picture as the base, a mark where its upper edge is.
import * as THREE from "three";

const kLines = [0, 1, 0, 2, 0, 3, 0, 4, 1, 2, 2, 3, 3, 4, 4, 1, 1, 5, 5, 2];
const kFaces = [0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 1, 1, 2, 3, 1, 3, 4];
const kSelected = [255, 176, 0, 255];
const kUnknown = [140, 146, 156, 255];

/** Tip, base from the upper left clockwise, and the mark; the camera looks along z, y is down. */
function corners(fov_rad: readonly [number, number], length_m: number): THREE.Vector3[] {
  const x = length_m * Math.tan(0.5 * fov_rad[0]);
  const y = length_m * Math.tan(0.5 * fov_rad[1]);
  const at = (u: number, v: number) => new THREE.Vector3(u * x, v * y, length_m);
  return [new THREE.Vector3(), at(-1, -1), at(1, -1), at(1, 1), at(-1, 1), at(0, -1.5)];
}

/** Little gain is blue, much is green, then yellow. */
function gainColor(share: number): number[] {
  const stops = [[74, 92, 168], [38, 150, 148], [110, 200, 92], [250, 220, 50]] as const;
  const at = Math.min(Math.max(share, 0), 1) * (stops.length - 1);
  const i = Math.min(Math.floor(at), stops.length - 2);
  return [0, 1, 2].map((k) => Math.round(stops[i]![k]! + (at - i) * (stops[i + 1]![k]! - stops[i]![k]!))).concat(255);
}

export class Frusta {
  readonly positions: Float32Array; // two per line
  readonly colors: Uint8Array;
  private vertices: Float32Array; // six per view
  private own: number[][];

  /** T_world_camera row by row, 16 numbers each; `origin` is taken from their places. */
  constructor(
    poses: ArrayLike<number>,
    gains: ArrayLike<number>,
    readonly count: number,
    fov_rad: readonly [number, number],
    length_m: number,
    origin: THREE.Vector3,
  ) {
    this.vertices = new Float32Array(18 * count);
    this.positions = new Float32Array(3 * kLines.length * count);
    this.colors = new Uint8Array(4 * kLines.length * count);
    const shape = corners(fov_rad, length_m);
    let least = Infinity;
    let most = -Infinity;
    for (let i = 0; i < count; ++i) {
      if (gains[i]! < least) least = gains[i]!;
      if (gains[i]! > most) most = gains[i]!;
    }
    this.own = Array.from({ length: count }, (_, i) => {
      const gain = gains[i]!;
      return Number.isNaN(gain) ? kUnknown : gainColor(most > least ? (gain - least) / (most - least) : 1);
    });
    const pose = new THREE.Matrix4();
    const at = new THREE.Vector3();
    for (let i = 0; i < count; ++i) {
      const rows = Array.from({ length: 16 }, (_, k) => poses[16 * i + k]!);
      pose.set(...(rows as Parameters<THREE.Matrix4["set"]>));
      shape.forEach((corner, k) => at.copy(corner).applyMatrix4(pose).sub(origin).toArray(this.vertices, 18 * i + 3 * k));
      kLines.forEach((corner, k) => {
        const from = 18 * i + 3 * corner;
        this.positions.set(this.vertices.subarray(from, from + 3), 3 * (kLines.length * i + k));
      });
      this.paint(i, false);
    }
  }

  paint(view: number, selected: boolean): void {
    const color = selected ? kSelected : this.own[view]!;
    for (let k = 0; k < kLines.length; ++k) this.colors.set(color, 4 * (kLines.length * view + k));
  }

  tip(view: number): [number, number, number] {
    return [this.vertices[18 * view]!, this.vertices[18 * view + 1]!, this.vertices[18 * view + 2]!];
  }

  /** The nearest view whose pyramid is at (x, y) of clip coordinates, or its tip within `reach`. */
  at(x: number, y: number, clip_scene: THREE.Matrix4, reach: readonly [number, number]) {
    let best: { item: number; depth: number } | null = null;
    const clip = new THREE.Vector4();
    const seen = new Float64Array(12);
    for (let i = 0; i < this.count; ++i) {
      let depth = Infinity;
      let behind = false;
      for (let k = 0; k < 6; ++k) {
        const from = 18 * i + 3 * k;
        clip.set(this.vertices[from]!, this.vertices[from + 1]!, this.vertices[from + 2]!, 1).applyMatrix4(clip_scene);
        behind ||= clip.w <= 0;
        depth = Math.min(depth, clip.w);
        seen[2 * k] = clip.x / clip.w - x;
        seen[2 * k + 1] = clip.y / clip.w - y;
      }
      if (behind || (best !== null && best.depth <= depth)) continue;
      const near = Math.abs(seen[0]!) < reach[0] && Math.abs(seen[1]!) < reach[1];
      if (near || covers(seen)) best = { item: i, depth };
    }
    return best;
  }
}

/** Whether one of the pyramid's faces, in the plane, has the origin. */
function covers(corners2: Float64Array): boolean {
  for (let f = 0; f < kFaces.length; f += 3) {
    const side = (a: number, b: number) =>
      corners2[2 * a]! * corners2[2 * b + 1]! - corners2[2 * b]! * corners2[2 * a + 1]!;
    const [a, b, c] = [kFaces[f]!, kFaces[f + 1]!, kFaces[f + 2]!];
    const sides = [side(a, b), side(b, c), side(c, a)];
    if (sides.every((s) => s >= 0) || sides.every((s) => s <= 0)) return true;
  }
  return false;
}
