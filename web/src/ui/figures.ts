// SPDX-License-Identifier: Apache-2.0
// Counts as text.

/** A whole number in groups of three with thin spaces between them, as the program writes them. */
export function grouped(count: number): string {
  return String(Math.round(count)).replace(/\B(?=(\d{3})+$)/g, "\u202f");
}

/** A count in four characters: 950, 12k, 1.2M. */
export function compact(count: number): string {
  if (count < 1000) return String(count);
  if (count < 999_500) return count < 9950 ? `${(count / 1000).toFixed(1)}k` : `${Math.round(count / 1000)}k`;
  return count < 9_950_000 ? `${(count / 1e6).toFixed(1)}M` : `${Math.round(count / 1e6)}M`;
}
