// SPDX-License-Identifier: Apache-2.0
import type * as THREE from "three";
import { depthRow, isOrthographic } from "./side_camera";

/**
 * Calls `found` with each of the first `count` places whose projection is within `half_px` of a pixel along both axes,
 * and with its depth; goes on with those nearer than what it answers.
 */
export function nearPixel(
  places: Float32Array,
  count: number,
  clip_scene: THREE.Matrix4,
  x: number,
  y: number,
  half_px: number,
  size: readonly [number, number],
  found: (vertex: number, depth_m: number) => number,
): void {
  const e = clip_scene.elements as unknown as [number, number, number, number, number, number, number, number, number, number, number, number, number, number, number, number];
  const [sx, sy] = [0.5 * size[0], 0.5 * size[1]];
  const orthographic = isOrthographic(clip_scene);
  const [a, b, c, d] = depthRow(clip_scene);
  let most = Infinity;
  for (let vertex = 0, at = 0; vertex < count; ++vertex, at += 3) {
    const [px, py, pz] = [places[at]!, places[at + 1]!, places[at + 2]!];
    const depth = a * px + b * py + c * pz + d;
    if (depth <= 0 || depth >= most) continue;
    const w = orthographic ? 1 : depth;
    const u = sx * ((e[0] * px + e[4] * py + e[8] * pz + e[12]) / w + 1) - x;
    if (u > half_px || u < -half_px) continue;
    const v = sy * (1 - (e[1] * px + e[5] * py + e[9] * pz + e[13]) / w) - y;
    if (v > half_px || v < -half_px) continue;
    most = found(vertex, depth);
  }
}
