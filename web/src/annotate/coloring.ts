// SPDX-License-Identifier: Apache-2.0
// Sources of the colours of points: their own colour, their height, their normal, or a number that the file has of each.
import { fill, h, on } from "../ui/dom";
import { rampLegend } from "../ui/ramp_legend";
import type { Painter, Viewer } from "../view/types";
import { heightsOf, normalColors, rampColors, type Scale, scaleOf } from "../view/ramp";
import { type Segments, segmentColors } from "./segments";
import type { Session } from "./session";
import type { OpenCloud, Store } from "./store";

/** "own", "height", "segments", "normal", or kField and the name of a field. */
export type ColorBy = string;

const kField = "field ";
const kChunk = 262_144;

export class Coloring {
  private turn = 0; // counts up: an answer to an earlier choice is dropped
  private of = ""; // which cloud the choices are for
  private readonly select = h("select", { "aria-label": "Colour points by" });
  private readonly legend = h("div", { class: "cloud-legend" });
  readonly element = h(
    "div",
    {},
    h("label", { class: "option" }, h("span", { class: "slider-name" }, "Colour by"), this.select),
    this.legend,
  );

  constructor(
    private readonly store: Store,
    private readonly session: Session,
    private readonly viewer: Viewer,
    private readonly segments: Segments,
  ) {
    on(this.select, { change: () => this.store.set({ colorBy: this.select.value }) });
    store.watch(["shading"], ({ shading }) => viewer.setShading(shading));
    store.watch(["cloud"], ({ cloud }) => {
      if (cloud === null || this.of === `${cloud.index} ${cloud.name}`) return;
      this.of = `${cloud.index} ${cloud.name}`;
      fill(this.select, ...choicesOf(cloud).map(([value, text]) => h("option", { value }, text)));
      // Without colours nothing would be seen but an outline.
      const plain = !cloud.has_colors;
      store.set({ colorBy: plain ? "height" : "own", shading: plain });
    });
    store.watch(["colorBy", "cloud"], () => void this.apply());
  }

  private async apply(): Promise<void> {
    const { cloud, colorBy } = this.store.state;
    const key = `${this.of} ${colorBy}`;
    if (cloud === null || this.select.dataset["now"] === key) return;
    this.select.dataset["now"] = key;
    this.select.value = colorBy;
    const turn = ++this.turn;
    fill(this.legend);
    if (cloud.tiles !== undefined) return this.applyToTiles(cloud, colorBy);
    if (colorBy === "own") return this.viewer.cloud.setPainter(null);
    if (colorBy === "height") return this.viewer.cloud.setPainter(this.byHeight(cloud.up));
    if (colorBy === "segments") {
      const there = await this.segments.bring();
      if (turn !== this.turn) return;
      if (!there) return this.store.set({ colorBy: "own" });
      return this.viewer.cloud.setPainter((_, first, count) => this.segments.colors(first, count));
    }
    const values = await this.bring(colorBy, cloud.shown, turn);
    if (values === null || turn !== this.turn) return;
    if (colorBy === "normal") {
      const colors = normalColors(values);
      this.viewer.cloud.setPainter((_, first, count) => colors.subarray(4 * first, 4 * (first + count)));
      return;
    }
    const scale = scaleOf(values);
    this.say(scale, colorBy.slice(kField.length), "");
    this.viewer.cloud.setPainter((_, first, count) => rampColors(values.subarray(first, first + count), scale));
  }

  /** Values come with the tiles; the coarsest says where the scale ends. */
  private async applyToTiles(cloud: OpenCloud, colorBy: ColorBy): Promise<void> {
    const { viewer, session } = this;
    if (colorBy === "segments") {
      viewer.cloud.setPainter((_positions, _first, count, values) =>
        values === undefined ? null : segmentColors(count, (i) => values[2 * i]!, (i) => values[2 * i + 1] === 1),
      );
      return session.tiles.colorBy("segments");
    }
    const field = colorBy === "normal" || colorBy.startsWith(kField);
    if (colorBy === "height") viewer.cloud.setPainter(this.byHeight(cloud.up));
    else viewer.cloud.setPainter(null);
    if (!field) return session.tiles.colorBy(null);
    const name = colorBy === "normal" ? colorBy : colorBy.slice(kField.length);
    let scale: Scale | null = null;
    viewer.cloud.setPainter((_positions, _first, _count, values) => {
      if (values === undefined) return null;
      if (colorBy === "normal") return normalColors(values);
      if (scale === null) {
        scale = scaleOf(values);
        this.say(scale, name, "");
      }
      return rampColors(values, scale);
    });
    return session.tiles.colorBy({ name, width: colorBy === "normal" ? 3 : 1 });
  }

  /** The first points are an even sample: they say where the scale ends. */
  private byHeight(up: readonly number[]): Painter {
    let scale: Scale | null = null;
    return (positions) => {
      const heights = heightsOf(positions, up);
      if (scale === null) {
        scale = scaleOf(heights);
        this.say(scale, "Height", " m");
      }
      return rampColors(heights, scale);
    };
  }

  private async bring(by: ColorBy, shown: number, turn: number): Promise<Float32Array | null> {
    const width = by === "normal" ? 3 : 1;
    const values = new Float32Array(width * shown);
    const name = by === "normal" ? by : by.slice(kField.length);
    for (let from = 0; from < shown; from += kChunk) {
      const answer = await this.session.ask({ type: "field", name, from, count: kChunk });
      if (answer === null || turn !== this.turn) return null;
      values.set(new Float32Array(answer.body, 0, width * Number(answer.head["count"])), width * from);
    }
    return values;
  }

  private say(scale: Scale, name: string, unit: string): void {
    fill(this.legend, ...rampLegend(name, scale, unit));
  }
}

function choicesOf(cloud: OpenCloud): [ColorBy, string][] {
  const choices: [ColorBy, string][] = [
    ["own", cloud.has_colors ? "Own colours" : "One colour"],
    ["height", "Height"],
  ];
  if (cloud.has_segments) choices.push(["segments", "Segments"]);
  if (cloud.has_normals) choices.push(["normal", "Normal"]);
  for (const name of cloud.fields ?? []) choices.push([kField + name, name.replaceAll("_", " ")]);
  return choices;
}
