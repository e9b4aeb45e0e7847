// SPDX-License-Identifier: Apache-2.0
// Colours as numbers, and which text is read best on one.

/** Red, green and blue, 0 to 255, of "#rrggbb". */
export function toRgb(hex: string): [number, number, number] {
  const value = Number.parseInt(hex.slice(1), 16);
  return [(value >> 16) & 255, (value >> 8) & 255, value & 255];
}

/** Relative luminance, as WCAG 2 has it. */
function luminance(hex: string): number {
  const [r, g, b] = toRgb(hex).map((channel) => {
    const c = channel / 255;
    return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
  }) as [number, number, number];
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

/** Black or white, whichever contrasts more: always 4.5 : 1 at least. */
export function textOn(hex: string): string {
  return luminance(hex) > Math.sqrt(1.05 * 0.05) - 0.05 ? "#000000" : "#ffffff";
}
