// SPDX-License-Identifier: Apache-2.0
// Legend of a ramp of colours: its ends as numbers, and the ramp between them.
import { kRampCss, type Scale } from "../view/ramp";
import { h } from "./dom";

export function rampLegend(name: string, { low, high }: Scale, unit: string): HTMLElement[] {
  const ends = [valueText(low), valueText(high) + unit] as const;
  const ramp = h("i", { class: "value-ramp", role: "img", "aria-label": `${name} from ${ends[0]} to ${ends[1]}` });
  ramp.style.backgroundImage = kRampCss;
  return [h("span", {}, ends[0]), ramp, h("span", {}, ends[1])];
}

/** Three digits are enough. */
function valueText(value: number): string {
  return Math.abs(value) >= 1000 || value === 0 ? String(Math.round(value)) : String(Number(value.toPrecision(3)));
}
