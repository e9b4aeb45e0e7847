// SPDX-License-Identifier: Apache-2.0
// Where the camera was: its path as lines, its views as frusta, made into layers like those of the document.
import { fovOf, type Layer, type Rows, type SceneDocument } from "./document";

export interface MadeLayer {
  layer: Layer;
  data: ArrayBuffer;
}

export const kTrail = "made trail";
const kPath = "made path";
const kColor = "#8a94a3";

/** The camera's centre in a pose of rows. */
export function centreOf(rows: Rows): [number, number, number] {
  return [rows[0]?.[3] ?? 0, rows[1]?.[3] ?? 0, rows[2]?.[3] ?? 0];
}

/** The steps before this one that have a view. */
export function earlierSteps(document: SceneDocument, step: number): number[] {
  return document.steps.slice(0, step).flatMap((s, i) => (s.T_world_camera ? [i] : []));
}

/**
 * The earlier views, item by item those of earlierSteps(), and the path through them to this one. Where steps bring lines
 * of their own, the camera's way is among these.
 */
export function trailOf(document: SceneDocument, step: number): MadeLayer[] {
  const now = document.steps[step];
  if (!now) return [];
  const poses = earlierSteps(document, step).map((i) => document.steps[i]!.T_world_camera!);
  if (poses.length === 0) return [];
  const values = new Float32Array(poses.length * 17).fill(Number.NaN); // the layer's colour, not a gain's
  poses.forEach((rows, i) => values.set(rows.flat(), i * 16));
  const views: Layer = { id: kTrail, name: "Earlier views", kind: "views", buffer: kTrail, count: poses.length, visible: true, fov_rad: fovOf(now), color: kColor, opacity: 0.5 };
  const made = [{ layer: views, data: values.buffer }];

  if (document.layers.some((layer) => layer.step !== undefined && layer.kind === "lines")) return made;
  const path = [...poses, ...(now.T_world_camera ? [now.T_world_camera] : [])].map(centreOf);
  if (path.length < 2) return made;
  const ends = new Float32Array(path.slice(1).flatMap((end, i) => [...path[i]!, ...end]));
  const lines: Layer = { id: kPath, name: "Path of the camera", kind: "lines", buffer: kPath, count: path.length - 1, visible: true, color: kColor };
  return [...made, { layer: lines, data: ends.buffer }];
}
