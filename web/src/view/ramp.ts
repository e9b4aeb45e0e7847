// SPDX-License-Identifier: Apache-2.0
// Numbers as colours: from dark blue over green to yellow, lighter and lighter, so that it reads without telling red
// from green and in grey.

const kStops = [
  [68, 58, 130],
  [52, 98, 145],
  [34, 138, 141],
  [72, 178, 112],
  [160, 208, 60],
  [250, 225, 70],
] as const;
export const kNotKnown = [150, 154, 160] as const;
const kSteps = 256;
const kOutliers = 0.01; // at either end, beyond the scale
const kSample = 50_000;

export interface Scale {
  low: number;
  high: number;
}

const kTable = makeTable();

/** CSS for a legend: the ramp from left to right. */
export const kRampCss = `linear-gradient(90deg, ${kStops.map((rgb) => `rgb(${rgb.join(" ")})`).join(", ")})`;

/** All values but a few at either end; not a number: none. Zero wide where all are equal. */
export function scaleOf(values: Float32Array): Scale {
  const every = Math.max(1, Math.floor(values.length / kSample));
  const sample: number[] = [];
  for (let i = 0; i < values.length; i += every) if (Number.isFinite(values[i])) sample.push(values[i]!);
  if (sample.length === 0) return { low: 0, high: 0 };
  sample.sort((a, b) => a - b);
  const out = Math.floor(kOutliers * sample.length);
  return { low: sample[out]!, high: sample[sample.length - 1 - out]! };
}

/** r, g, b, 255 of each value. */
export function rampColors(values: Float32Array, { low, high }: Scale): Uint8Array {
  const colors = new Uint8Array(4 * values.length);
  const words = new Uint32Array(colors.buffer);
  const scale = high > low ? (kSteps - 1) / (high - low) : 0;
  for (let i = 0; i < values.length; ++i) {
    const at = (values[i]! - low) * scale;
    words[i] = Number.isNaN(at) ? kTable[kSteps]! : kTable[at <= 0 ? 0 : at >= kSteps - 1 ? kSteps - 1 : Math.round(at)]!;
  }
  return colors;
}

/** How far along `up` each place is: x, y, z one after the other. */
export function heightsOf(places: Float32Array, up: readonly number[], origin: readonly number[] = [0, 0, 0]): Float32Array {
  const [x = 0, y = 0, z = 1] = up;
  const base = x * (origin[0] ?? 0) + y * (origin[1] ?? 0) + z * (origin[2] ?? 0);
  const heights = new Float32Array(places.length / 3);
  for (let i = 0, at = 0; i < heights.length; ++i, at += 3) heights[i] = x * places[at]! + y * places[at + 1]! + z * places[at + 2]! + base;
  return heights;
}

/** Directions as colours: x as red, y as green, z as blue, from −1 to 1. */
export function normalColors(normals: Float32Array): Uint8Array {
  const count = normals.length / 3;
  const colors = new Uint8Array(4 * count);
  for (let i = 0; i < count; ++i) {
    for (let k = 0; k < 3; ++k) {
      const value = normals[3 * i + k]!;
      colors[4 * i + k] = Number.isFinite(value) ? Math.round(127.5 * (1 + Math.min(Math.max(value, -1), 1))) : kNotKnown[k]!;
    }
    colors[4 * i + 3] = 255;
  }
  return colors;
}

/** Little-endian words of r, g, b, 255; the last one is for what is not known. */
function makeTable(): Uint32Array {
  const table = new Uint32Array(kSteps + 1);
  const bytes = new Uint8Array(table.buffer);
  for (let i = 0; i < kSteps; ++i) {
    const at = (i / (kSteps - 1)) * (kStops.length - 1);
    const stop = Math.min(Math.floor(at), kStops.length - 2);
    for (let k = 0; k < 3; ++k) bytes[4 * i + k] = Math.round(kStops[stop]![k]! + (at - stop) * (kStops[stop + 1]![k]! - kStops[stop]![k]!));
    bytes[4 * i + 3] = 255;
  }
  bytes.set([...kNotKnown, 255], 4 * kSteps);
  return table;
}
