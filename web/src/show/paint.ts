// SPDX-License-Identifier: Apache-2.0
// Points coloured by their height, or by a field of the file, in place of their own colour.
import { heightsOf, normalColors, rampColors, type Scale, scaleOf } from "../view/ramp";
import { bufferBytes, type Layer, type LayerField } from "./document";

/** "own", "height", or kField and the name of a field. */
export type ColorBy = string;

const kField = "field ";

export interface Painted {
  layer: Layer;
  data: ArrayBuffer;
  scale: Scale | null; // the ramp's; null: the colours are none of a ramp
}

/** Returns the fields that can colour a layer; empty: its own colour only. */
export function choicesOf(layer: Layer): [by: ColorBy, text: string][] {
  if (layer.fields === undefined) return [];
  const own: [ColorBy, string] = ["own", layer.colors === true ? "Own colours" : "One colour"];
  return [own, ["height", "Height"], ...layer.fields.map(({ name }): [ColorBy, string] => [kField + name, titled(name)])];
}

export function usualColor(layer: Layer): ColorBy {
  return layer.fields !== undefined && layer.colors !== true ? "height" : "own";
}

export function fieldOf(layer: Layer, by: ColorBy): LayerField | undefined {
  return layer.fields?.find(({ name }) => kField + name === by);
}

export function fieldBytes(layer: Layer, field: LayerField): number {
  return 4 * field.width * layer.count;
}

/** @param values of the field, where it is coloured by one. */
export function painted(layer: Layer, data: ArrayBuffer, by: ColorBy, values: ArrayBuffer | null, up: readonly number[]): Painted {
  const field = fieldOf(layer, by);
  if (data.byteLength !== bufferBytes(layer) || (by !== "height" && (field === undefined || values === null))) return { layer, data, scale: null };
  const { count } = layer;
  let colors: Uint8Array;
  let scale: Scale | null = null;
  if (field?.width === 3) {
    colors = normalColors(new Float32Array(values!, 0, 3 * count));
  } else {
    const numbers = field === undefined ? heightsOf(new Float32Array(data, 0, 3 * count), up) : new Float32Array(values!, 0, count);
    scale = scaleOf(numbers);
    colors = rampColors(numbers, scale);
  }
  const behind = new Uint8Array(data, 12 * count + (layer.colors === true ? 4 * count : 0)); // diameters
  const whole = new Uint8Array(16 * count + behind.length);
  whole.set(new Uint8Array(data, 0, 12 * count));
  whole.set(colors, 12 * count);
  whole.set(behind, 16 * count);
  return { layer: { ...layer, colors: true }, data: whole.buffer, scale };
}

export function titled(by: ColorBy): string {
  const text = by.replace(kField, "").replaceAll("_", " ");
  return text.charAt(0).toUpperCase() + text.slice(1);
}
