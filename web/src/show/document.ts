// SPDX-License-Identifier: Apache-2.0
// Document of layers and steps that the program shows. docs/reference/protocol.md, "Viewer".
import type { LayerInfo } from "../view/types";

/** Numbers of each point that it can be coloured by. */
export interface LayerField {
  name: string;
  width: 1 | 3; // 3: a direction
  buffer: string;
}

export interface Layer extends LayerInfo {
  name: string;
  buffer: string;
  visible: boolean;
  step?: number;
  holds_camera?: boolean; // in the way of who looks through it
  fields?: readonly LayerField[]; // points of a cloud: it can be coloured by these, and by height
  legend?: readonly (readonly [string, string])[]; // text, "#rrggbb"
}

export interface Picture {
  name: string;
  title: string;
}

export type Fact = readonly [string, string];
export type Rows = readonly (readonly number[])[];

export interface Step {
  name: string;
  T_world_camera: Rows | null;
  fov_rad: readonly [number, number]; // zeros: not known
  facts: readonly Fact[];
  pictures: readonly Picture[];
}

export interface SceneDocument {
  title: string;
  kind: "run" | "mesh" | "map" | "cloud";
  live: boolean;
  report?: boolean; // the program serves one, at report.html
  up: readonly [number, number, number];
  towards_viewer?: readonly [number, number, number]; // where it was seen from
  bounds: readonly number[];
  facts: readonly Fact[];
  layers: readonly Layer[];
  steps: readonly Step[];
}

/** Returns the length that a layer's buffer must have, in bytes. */
export function bufferBytes(layer: Layer): number {
  const color = layer.colors ? 4 : 0;
  switch (layer.kind) {
    case "triangles":
      return (layer.vertices ?? 0) * (12 + color) + layer.count * 12;
    case "points":
    case "voxels":
      return layer.count * (12 + color + (layer.diameters === true ? 4 : 0));
    case "lines":
      return layer.count * 2 * (12 + color);
    case "views":
      return layer.count * 17 * 4;
  }
}

/** Returns the key of a layer's switch: layers that mean the same in every step (the arm, say) share one. */
export function layerKey(layer: Layer): string {
  return layer.step === undefined ? layer.id : `step ${layer.kind} ${layer.name}`;
}

/** The layers of a step, and those of no step. */
export function layersOf(document: SceneDocument, step: number): Layer[] {
  return document.layers.filter((layer) => layer.step === undefined || layer.step === step);
}

export const kUsualFov_rad: readonly [number, number] = [1.0, 0.79];

/** Horizontal and vertical; what a camera usually has, where the step does not know. */
export function fovOf(step: Step): readonly [number, number] {
  return step.fov_rad[0] > 0 && step.fov_rad[1] > 0 ? step.fov_rad : kUsualFov_rad;
}

export const kNoColor = "#9aa0a6";

export const pictureAddress = (name: string): string => `data/picture?name=${encodeURIComponent(name)}`;
