// SPDX-License-Identifier: Apache-2.0
// The standpoint from which an arm does not hide the scene.

/** From the other side of something that stands beside the scene, so that it does not hide it; somewhat from above. */
export function acrossFrom(
  bounds: readonly number[],
  up: readonly [number, number, number],
  beside: readonly [number, number, number],
): [number, number, number] | undefined {
  const away = [0, 1, 2].map((i) => ((bounds[i] ?? 0) + (bounds[3 + i] ?? 0)) / 2 - beside[i]!);
  const height = away.reduce((sum, x, i) => sum + x * up[i]!, 0);
  const [x, y, z] = away.map((each, i) => each - height * up[i]!) as [number, number, number];
  const length = Math.hypot(x, y, z);
  if (length < 1e-6) return undefined;
  // Turned a little, so that both are seen from the side.
  const side = [up[1] * z - up[2] * y, up[2] * x - up[0] * z, up[0] * y - up[1] * x];
  return [x, y, z].map((each, i) => (each + 0.45 * side[i]!) / length + 0.75 * up[i]!) as [number, number, number];
}

const kBack = 0.42; // share of the distance
const kAbove = 0.12;

/** Moves a look back and up, so that things above the scene come into the picture. */
export function steppedBack(rows: number[][], bounds: readonly number[]): number[][] {
  let distance = 0;
  rows.slice(0, 3).forEach((row, i) => (distance += (((bounds[i] ?? 0) + (bounds[3 + i] ?? 0)) / 2 - row[3]!) * row[2]!));
  const moved = (row: number[]) => row[3]! - distance * (kBack * row[2]! + kAbove * row[1]!);
  return rows.map((row, i) => (i < 3 ? [...row.slice(0, 3), moved(row)] : row));
}
