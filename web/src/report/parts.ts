// SPDX-License-Identifier: Apache-2.0
// The parts that sections of the page are made of: facts, tiles, legends, links, folds.
import { type Child, h, on } from "../ui/dom";
import type { Files } from "./document";
import { withDefinition } from "./hint";
import { definitionOf } from "./measures";

/** A section of the page, with its entry in the navigation. */
export interface Section {
  id: string;
  title: string;
  element: HTMLElement;
}

/** Parts of the page of a run. */
export interface Report {
  title: string;
  /** Some words on the run, below the title. */
  settings: [name: string, value: string][];
  /** Outcome of the run in one or a few sentences; a line break starts another line. */
  summary: string;
  sections: Section[];
}

export type Fact = readonly [name: string, value: string];

export function section(id: string, title: string, ...children: Child[]): Section {
  const heading = h("h2", { id: `${id}-title` }, title);
  return { id, title, element: h("section", { id, "aria-labelledby": `${id}-title` }, heading, ...children) };
}

/** Names and values; those without a value are left out. null where none is left. */
export function facts(pairs: readonly Fact[], kind = "facts"): HTMLElement | null {
  const known = pairs.filter(([, value]) => value !== "" && value !== "–");
  if (known.length === 0) return null;
  const items = known.map(([name, value]) => {
    const definition = definitionOf(name);
    const term = definition ? withDefinition(h("button", { type: "button", class: "term" }, name), definition) : name;
    return h("div", {}, h("dt", {}, term), h("dd", {}, value));
  });
  return h("dl", { class: kind }, ...items);
}

/** Headline measures: a name, a large value and a line that says more. */
export function tiles(entries: readonly (readonly [name: string, value: string, more?: string])[]): HTMLElement | null {
  const known = entries.filter(([, value]) => value !== "" && value !== "–");
  if (known.length === 0) return null;
  const items = known.map(([name, value, more]) => {
    const definition = definitionOf(name);
    const term = definition ? withDefinition(h("button", { type: "button", class: "term" }, name), definition) : name;
    return h("div", {}, h("dt", {}, term), h("dd", {}, h("strong", {}, value), more ? h("span", {}, more) : null));
  });
  return h("dl", { class: "tiles" }, ...items);
}

/** A part that is folded up at first. Its content is made when it is opened, or printed. */
export function fold(id: string, title: string, line: string, content: () => Child[], open = false): HTMLDetailsElement {
  const body = h("div", { class: "fold-body" });
  const element = h("details", { id, class: "fold" }, h("summary", {}, h("h3", {}, title), h("span", { class: "soft" }, line)), body);
  let made = false;
  const make = () => {
    if (made) return;
    made = true;
    body.append(...content().filter((child): child is Node | string => !!child));
  };
  on(element, { toggle: () => void (element.open && make()) });
  element.addEventListener("saccade-print", make);
  if (open) {
    element.open = true;
    make();
  }
  return element;
}

export interface LegendItem {
  text: string;
  colors: readonly string[];
  shape?: "outline" | "point";
}

const kGain = ["#3e125c", "#2e688e", "#48ba6e", "#fae62c"];
const kTime = ["#7a0e10", "#f78026", "#a6ee4c", "#2c9edc", "#3a1e6c"];
export const kTimeColors: readonly string[] = kTime;

/** Returns the legend of the colours in pictures of views. */
export function viewLegend(hasArm: boolean, more: readonly LegendItem[] = []): HTMLElement {
  return legend([
    { text: "occupied (grey or in colour)", colors: ["#a39a8c"] },
    { text: "unknown", colors: ["#1b1d22"] },
    { text: "region of interest", colors: ["#e07b1a"], shape: "outline" },
    { text: "candidates, by the best gain at each place", colors: kGain },
    { text: "candidates without gain", colors: ["#b0b4bc"], shape: "point" },
    { text: "the chosen view", colors: ["#d61c5c"], shape: "outline" },
    { text: "earlier views", colors: ["#707783"], shape: "outline" },
    ...(hasArm ? [{ text: "the camera's path", colors: ["#1476c4"], shape: "outline" as const }] : []),
    ...more,
  ]);
}

export function legend(items: readonly LegendItem[]): HTMLElement {
  const entries = items.map(({ text, colors, shape }) => {
    const swatch = h("span", { class: `swatch ${shape ?? ""} ${colors.length > 1 ? "wide" : ""}` });
    if (shape === "outline") swatch.style.borderColor = colors[0] ?? "";
    else swatch.style.background = colors.length > 1 ? `linear-gradient(90deg, ${colors.join(", ")})` : (colors[0] ?? "");
    return h("li", {}, swatch, text);
  });
  return h("details", { class: "legend" }, h("summary", {}, "Colours in the pictures"), h("ul", { class: "key" }, ...entries));
}

/** Files beside the page that are there, with what they hold. */
export function links(files: Files, known: readonly Fact[], served: boolean): HTMLElement | null {
  const there = known.filter(([name]) => files.has(name));
  if (there.length === 0) return null;
  const items = there.map(([name, what]) => h("div", {}, h("dt", {}, served ? h("code", {}, name) : h("a", { href: files.address(name) }, name)), h("dd", {}, what)));
  return h("div", {}, h("h3", {}, "Files beside this page"), h("dl", { class: "pairs" }, ...items));
}
