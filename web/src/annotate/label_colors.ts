// SPDX-License-Identifier: Apache-2.0
// Colours of labels that the program has not named yet: the same as its DistinctColors (lib/saccade/annotate/label_table.hpp).
import type { Rgb } from "../view/types";

const kWellApart = 256;
const kChannelStep = 17;
const kLeastChroma = 30;
const kLeastLightness = 30;
const kMostLightness = 92;

export function cielab(color: Rgb): [number, number, number] {
  const [r, g, b] = color.map((channel) => {
    const c = channel / 255;
    return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
  }) as [number, number, number];
  const f = (t: number) => (t > 216 / 24389 ? Math.cbrt(t) : ((24389 / 27) * t + 16) / 116);
  const x = f((0.4124564 * r + 0.3575761 * g + 0.1804375 * b) / 0.95047);
  const y = f(0.2126729 * r + 0.7151522 * g + 0.072175 * b);
  const z = f((0.0193339 * r + 0.119192 * g + 0.9503041 * b) / 1.08883);
  return [116 * y - 16, 500 * (x - y), 200 * (y - z)];
}

function wholeLab(color: Rgb): [number, number, number] {
  return cielab(color).map((c) => Math.round(256 * c)) as [number, number, number];
}

function colorfulGrid(): Rgb[] {
  const colors: Rgb[] = [];
  for (let r = 0; r < 256; r += kChannelStep)
    for (let g = 0; g < 256; g += kChannelStep)
      for (let b = 0; b < 256; b += kChannelStep) {
        const [lightness, a, yellow] = cielab([r, g, b]);
        const apart = Math.hypot(a, yellow) >= kLeastChroma;
        if (lightness >= kLeastLightness && lightness <= kMostLightness && apart) colors.push([r, g, b]);
      }
  return colors;
}

/** Each of the first 256 is as far as can be from those before it and from greys. */
function distinctColors(): Rgb[] {
  const colors = colorfulGrid();
  const labs = colors.map(wholeLab);
  const nearest = new Float64Array(colors.length).fill(Infinity);
  const keepAwayFrom = (taken: readonly number[], first: number) => {
    for (let i = first; i < labs.length; i++) {
      const lab = labs[i]!;
      const squared = (lab[0] - taken[0]!) ** 2 + (lab[1] - taken[1]!) ** 2 + (lab[2] - taken[2]!) ** 2;
      if (squared < nearest[i]!) nearest[i] = squared;
    }
  };
  for (const grey of [0, 128, 255]) keepAwayFrom(wholeLab([grey, grey, grey]), 0);
  for (let next = 0; next < kWellApart; next++) {
    let chosen = next;
    for (let i = next + 1; i < labs.length; i++) if (nearest[i]! > nearest[chosen]!) chosen = i;
    [colors[next], colors[chosen]] = [colors[chosen]!, colors[next]!];
    [labs[next], labs[chosen]] = [labs[chosen]!, labs[next]!];
    [nearest[next], nearest[chosen]] = [nearest[chosen]!, nearest[next]!];
    keepAwayFrom(labs[next]!, next + 1);
  }
  return colors;
}

/** Well mixed bits of a number (the finaliser of SplitMix64). */
function mixed(label: number): bigint {
  const word = (x: bigint) => BigInt.asUintN(64, x);
  let x = BigInt(label);
  x = word((x ^ (x >> 30n)) * 0xbf58476d1ce4e5b9n);
  x = word((x ^ (x >> 27n)) * 0x94d049bb133111ebn);
  return x ^ (x >> 31n);
}

let made: Rgb[] | null = null;

export function generatedColor(label: number): Rgb {
  made ??= distinctColors();
  if (label >= 1 && label <= kWellApart) return made[label - 1]!;
  return made[Number(mixed(label) % BigInt(made.length))]!;
}

export function toHex(color: Rgb): string {
  return `#${color.map((channel) => channel.toString(16).padStart(2, "0")).join("")}`;
}

export function toRgb(hex: string): Rgb {
  const value = Number.parseInt(hex.slice(1), 16);
  return [(value >> 16) & 255, (value >> 8) & 255, value & 255];
}

/** Whether text on this colour is better black. */
export function isBright(color: Rgb): boolean {
  return cielab(color)[0] > 62;
}
