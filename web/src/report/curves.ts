// SPDX-License-Identifier: Apache-2.0
// Curves, bars and points over views, drawn by Observable Plot in the page's colours.
import * as Plot from "@observablehq/plot";
import { h } from "../ui/dom";

export interface Series {
  name: string;
  x: readonly number[];
  y: readonly number[];
  low?: readonly number[];
  high?: readonly number[];
}

export interface Axes {
  title: string;
  x: string;
  y: string;
  x_range?: readonly [number, number];
  y_range?: readonly [number, number];
  /** Names of whole numbers on the x axis, such as "scan" for 0. */
  names?: (x: number) => string;
}

const kColors = 8;
const kDashes = ["", "7 3", "2 3", "9 3 2 3", "4 2", "1 2", "12 4", "6 2 1 2"];
const kHeight = 250;
export const seriesColor = (index: number): string => `var(--series-${index % kColors})`;
export const phaseColor = (index: number): string => `var(--phase-${index % 10})`;

type Draw = (width: number) => Element;

const waiting = new Set<() => void>();
window.addEventListener("beforeprint", () => [...waiting].forEach((start) => start()));

/** Those of a page that is drawn anew are not drawn any more. */
export const forgetCurves = (): void => waiting.clear();

/** A figure that is drawn once it is nearly in view, and anew when its width changes. What it says is also in a table. */
function figure(title: string, draw: Draw, key: HTMLElement | null, describe: string): HTMLElement {
  const place = h("div", { class: "plot", role: "img", "aria-label": `${title}. ${describe}` });
  let drawn = 0;
  const redraw = () => {
    const width = Math.max(240, Math.floor(place.clientWidth));
    if (width === drawn || place.clientWidth === 0) return;
    drawn = width;
    const picture = draw(width);
    picture.querySelectorAll("style").forEach((style) => style.remove()); // the page has its own
    picture.setAttribute("aria-hidden", "true"); // what it shows is in the label
    place.replaceChildren(picture);
  };
  const start = () => {
    waiting.delete(start);
    seen.disconnect();
    redraw();
    new ResizeObserver(redraw).observe(place);
  };
  // Pictures and text come first: a curve is drawn after they are on the screen.
  const seen = new IntersectionObserver((entries) => entries.some((entry) => entry.isIntersecting) && void setTimeout(start), { rootMargin: "600px" });
  waiting.add(start);
  seen.observe(place);
  return h("figure", { class: "curve" }, h("figcaption", {}, title), place, key);
}

function keyOf(entries: readonly { name: string; color: string; dash?: string }[]): HTMLElement | null {
  if (entries.length < 2) return null;
  const items = entries.map(({ name, color, dash }) => {
    const swatch = h("span", { class: dash === undefined ? "swatch" : "stroke" });
    if (dash === undefined) swatch.style.background = color;
    else swatch.style.setProperty("--stroke", color);
    if (dash) swatch.classList.add("dashed");
    return h("li", {}, swatch, name);
  });
  return h("ul", { class: "key" }, ...items);
}

function wholeTicks(low: number, high: number): number[] {
  const step = Math.max(1, Math.ceil((high - low) / 10));
  const ticks: number[] = [];
  for (let x = Math.ceil(low); x <= high; x += step) ticks.push(x);
  return ticks;
}

interface Point {
  x: number;
  y: number;
  low: number;
  high: number;
  name: string;
}

function pointsOf(series: Series): Point[] {
  return series.x.map((x, i) => ({ x, y: series.y[i] ?? Number.NaN, low: series.low?.[i] ?? Number.NaN, high: series.high?.[i] ?? Number.NaN, name: series.name }));
}

const compactNumber = (value: number): string => (Math.abs(value) >= 10_000 ? `${+(value / 1000).toPrecision(4)}k` : `${+value.toPrecision(4)}`);

function described(series: readonly Series[]): string {
  return series
    .map(({ name, x, y }) => `${name}: from ${compactNumber(y[0] ?? Number.NaN)} to ${compactNumber(y.at(-1) ?? Number.NaN)} over ${x.length} points`)
    .join("; ");
}

/** Lines over whole numbers, with a band where there is one. null where nothing is known. */
export function curve(axes: Axes, all: readonly Series[]): HTMLElement | null {
  const series = all.filter(({ y }) => y.some((value) => Number.isFinite(value)));
  if (series.length === 0) return null;
  const points = series.map(pointsOf);
  const xs = points.flat().map(({ x }) => x);
  const [low, high] = axes.x_range ?? [Math.min(...xs), Math.max(...xs, Math.min(...xs) + 1)];
  const name = axes.names ?? String;
  const draw = (width: number) =>
    Plot.plot({
      width,
      height: kHeight,
      marginLeft: 52,
      marginTop: 28,
      marginBottom: 36,
      x: { domain: [low, high], label: axes.x, ticks: wholeTicks(low, high), tickFormat: (x: number) => name(x) },
      y: { ...(axes.y_range ? { domain: [...axes.y_range], clamp: true } : { zero: true, nice: true }), label: axes.y, grid: true, ticks: 5, tickFormat: compactNumber },
      marks: [
        Plot.ruleY([axes.y_range?.[0] ?? 0]),
        ...points.flatMap((of, i) => [
          Plot.areaY(of, { x: "x", y1: "low", y2: "high", fill: seriesColor(i), fillOpacity: 0.14, clip: true }),
          Plot.lineY(of, { x: "x", y: "y", stroke: seriesColor(i), strokeWidth: 2, strokeDasharray: kDashes[i % kColors] ?? "", clip: true }),
          Plot.dot(of, { x: "x", y: "y", fill: seriesColor(i), r: high - low > 40 ? 1.5 : 3 }),
        ]),
        tip(points.flat(), ({ name: of, x, y, low: from, high: to }) => {
          const band = Number.isFinite(from) ? ` (${compactNumber(from)} to ${compactNumber(to)})` : "";
          return `${series.length > 1 ? `${of}\n` : ""}${axes.x} ${name(x)}\n${axes.y}: ${compactNumber(y)}${band}`;
        }),
      ],
    });
  return figure(axes.title, draw, keyOf(series.map((of, i) => ({ name: of.name, color: seriesColor(i), dash: kDashes[i % kColors] ?? "" }))), described(series));
}

function tip<T extends { x: number; y: number }>(points: T[], title: (point: T) => string): Plot.Markish {
  return Plot.tip(points, Plot.pointer({ x: "x", y: "y", title, fill: "var(--raised)", stroke: "var(--line-strong)", textPadding: 6 }));
}

const kLetter = 6.8; // width of a letter of the axis, px
const kNumber = 4; // letters of names that are numbers, of which some are left out
const kTurn = 60; // angle for names that have no room beside each other, degrees

interface NamesBelow {
  tickRotate: number;
  /** One name in this number is shown. */
  every: number;
  below: number;
  left: number;
}

/** Room for the names below bars. Where they are too long, they stand obliquely. */
function namesBelow(names: readonly string[], width: number): NamesBelow {
  const letters = Math.max(...names.map((name) => name.length));
  const longest = kLetter * letters;
  const bar = (width - 72) / names.length;
  if (letters <= kNumber || longest + 8 <= bar) return { tickRotate: 0, every: Math.ceil((longest + 8) / bar), below: 36, left: 52 };
  const angle = (kTurn * Math.PI) / 180;
  const [aside, down] = [Math.cos(angle) * longest, Math.sin(angle) * longest];
  return { tickRotate: -kTurn, every: Math.ceil(16 / bar), below: Math.ceil(down) + 18, left: Math.max(52, Math.ceil(aside - bar / 2) + 8) };
}

/** Bars of parts that lie on top of each other, one bar per name; a part without any amount is left out. */
export function stackedBars(title: string, y: string, bars: readonly { name: string; parts: readonly number[] }[], parts: readonly string[]): HTMLElement | null {
  const used = parts.map((_, i) => bars.some((bar) => (bar.parts[i] ?? 0) > 0));
  if (!used.includes(true)) return null;
  const pieces = bars.flatMap((bar) => parts.flatMap((part, i) => (used[i] ? [{ bar: bar.name, part, amount: bar.parts[i] ?? 0, color: phaseColor(i) }] : [])));
  const names = bars.map((bar) => bar.name);
  const draw = (width: number) => {
    const { tickRotate, every, below, left } = namesBelow(names, width);
    return Plot.plot({
      width,
      height: kHeight - 36 + below,
      marginLeft: left,
      marginTop: 28,
      marginBottom: below,
      color: { type: "identity" },
      x: { domain: names, label: null, tickRotate, tickFormat: (of: string) => (names.indexOf(of) % every === 0 ? of : "") },
      y: { label: y, grid: true, ticks: 5, tickFormat: compactNumber },
      marks: [
        Plot.barY(pieces, Plot.stackY({ x: "bar", y: "amount", fill: "color", order: null })),
        Plot.ruleY([0]),
        Plot.tip(pieces, Plot.pointerX(Plot.stackY({ x: "bar", y: "amount", title: (piece: (typeof pieces)[0]) => `${piece.bar}\n${piece.part}: ${compactNumber(piece.amount)} ${y}`, fill: "var(--raised)", stroke: "var(--line-strong)" }))),
      ],
    });
  };
  const key = keyOf(parts.flatMap((part, i) => (used[i] ? [{ name: part, color: phaseColor(i) }] : [])));
  const total = (bar: { parts: readonly number[] }) => bar.parts.reduce((sum, part) => sum + part, 0);
  return figure(title, draw, key, bars.map((bar) => `${bar.name}: ${compactNumber(total(bar))} ${y}`).join("; "));
}

/** Points beside the line on which both are equal. */
export function against(title: string, x: string, y: string, all: readonly { name: string; x: number; y: number }[]): HTMLElement | null {
  const points = all.filter((point) => Number.isFinite(point.x) && Number.isFinite(point.y));
  if (points.length === 0) return null;
  const most = Math.max(...points.flatMap((point) => [point.x, point.y]), 1e-9) * 1.05;
  const draw = (width: number) =>
    Plot.plot({
      width,
      height: kHeight,
      marginLeft: 52,
      marginTop: 28,
      marginBottom: 36,
      x: { domain: [0, most], label: x, ticks: 5, tickFormat: compactNumber },
      y: { domain: [0, most], label: y, grid: true, ticks: 5, tickFormat: compactNumber },
      marks: [
        Plot.line([[0, 0], [most, most]], { stroke: "var(--text-faint)", strokeDasharray: "4 3" }),
        Plot.dot(points, { x: "x", y: "y", fill: seriesColor(0), r: 4 }),
        points.length <= 20 ? Plot.text(points, { x: "x", y: "y", text: "name", dx: 8, textAnchor: "start", fill: "var(--text-soft)" }) : null,
        tip(points, (point) => `view ${point.name}\n${x}: ${compactNumber(point.x)}\n${y}: ${compactNumber(point.y)}`),
      ],
    });
  return figure(title, draw, null, points.map((point) => `view ${point.name}: ${compactNumber(point.x)} to ${compactNumber(point.y)}`).join("; "));
}

export function charts(...all: (HTMLElement | null)[]): HTMLElement | null {
  const drawn = all.filter((chart) => chart !== null);
  return drawn.length > 0 ? h("div", { class: "charts" }, ...drawn) : null;
}
