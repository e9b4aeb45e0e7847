// SPDX-License-Identifier: Apache-2.0
// From where a cloud is looked at.
import type { Camera } from "./types";

export type Side = "top" | "front" | "side";
type Direction = [number, number, number];

/** Towards the viewer. Up z: the front is seen from −y, the side from +x. Up −y, as cameras have it: from the camera. */
export function standpoint(up: readonly number[], which: Side): Direction {
  const [x = 0, y = 0, z = 1] = up;
  if (which === "top") return [x, y, z];
  const axis = [Math.abs(x), Math.abs(y), Math.abs(z)];
  const most = axis.indexOf(Math.max(...axis));
  if (most === 0) return which === "front" ? [0, -1, 0] : [0, 0, 1];
  if (most === 1) return which === "front" ? [0, 0, y < 0 ? -1 : 1] : [1, 0, 0];
  return which === "front" ? [0, -1, 0] : [1, 0, 0];
}

export function lookFrom(camera: Camera, up: readonly number[], which: Side): void {
  camera.fit(standpoint(up, which));
}

/** The front, a little from above; from where it was seen, where that is known. */
export function firstLook(camera: Camera, up: readonly number[], towards?: readonly [number, number, number]): void {
  const [x, y, z] = towards ?? standpoint(up, "front");
  const seen = towards !== undefined || Math.abs(up[2] ?? 1) <= 0.7;
  const tilt = seen ? 0.3 : 0.7; // what a camera has seen is best seen from where it was
  camera.fit([x + tilt * (up[0] ?? 0), y + tilt * (up[1] ?? 0), z + tilt * (up[2] ?? 1)]);
}
