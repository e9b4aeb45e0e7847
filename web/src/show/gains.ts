// SPDX-License-Identifier: Apache-2.0
// Candidates: what a buffer of views holds, and which of them is best.

export interface Candidates {
  count: number;
  gains: Float32Array; // NaN: not known
  best: number; // -1: no gain is known
  high: number; // the best one's gain, 0 without one
}

export function candidatesOf(data: ArrayBuffer, count: number): Candidates {
  const gains = new Float32Array(data, count * 64, count);
  let best = -1;
  let high = Number.NEGATIVE_INFINITY;
  gains.forEach((gain, i) => {
    if (Number.isNaN(gain)) return;
    if (gain > high) [best, high] = [i, gain];
  });
  return { count, gains, best, high: best < 0 ? 0 : high };
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
  Number.isNaN(gain) ? "not known" : gain.toLocaleString("en", { maximumFractionDigits: Math.abs(gain) < 10 ? 3 : 0 });
