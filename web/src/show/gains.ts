// SPDX-License-Identifier: Apache-2.0
// Candidates: what a buffer of views holds, and which of them is best.
import { grouped } from "../ui/figures";

export interface Candidates {
  count: number;
  gains: Float32Array; // NaN: not known
  best: number; // -1: no gain is known
  low: number; // the least and the best known gain, 0 without one
  high: number;
}

export function candidatesOf(data: ArrayBuffer, count: number): Candidates {
  const gains = new Float32Array(data, count * 64, count);
  let best = -1;
  let low = Number.POSITIVE_INFINITY;
  let high = Number.NEGATIVE_INFINITY;
  gains.forEach((gain, i) => {
    if (Number.isNaN(gain)) return;
    if (gain < low) low = gain;
    if (gain > high) [best, high] = [i, gain];
  });
  return best < 0 ? { count, gains, best, low: 0, high: 0 } : { count, gains, best, low, high };
}

export function poseOf(data: ArrayBuffer, index: number): number[][] {
  const values = new Float32Array(data, index * 64, 16);
  return [0, 4, 8, 12].map((row) => Array.from(values.subarray(row, row + 4)));
}

/** The place of a candidate among those whose gain is known, from 1. */
export function rankOf(candidates: Candidates, index: number): number {
  const gain = candidates.gains[index] ?? Number.NaN;
  let rank = 1;
  candidates.gains.forEach((other, i) => {
    if (other > gain || (other === gain && i < index)) ++rank;
  });
  return rank;
}

export const gainText = (gain: number): string =>
  Number.isNaN(gain) ? "not known" : Math.abs(gain) < 10 ? String(Number(gain.toFixed(3))) : grouped(gain);
