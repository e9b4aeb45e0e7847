// SPDX-License-Identifier: Apache-2.0
// Segments of the cloud (--segments): their colours with dark borders, and the one under the cursor, which does not stand
// out where points come in tiles.
import type { Viewer } from "../view/types";
import type { Session } from "./session";
import type { Store } from "./store";

const kChunk = 262_144;
const kNone = 0xffffffff;
const kNoColor = [105, 108, 114] as const;
const kBorder = 0.3; // light of borders, as a share

export class Segments {
  private of = ""; // the cloud that they are of
  private bringing: Promise<boolean> | null = null;
  private segments = new Uint32Array(); // in the order of vertices
  private borders = new Uint8Array();
  private points = new Uint32Array();
  private vertexOf = new Uint32Array();

  constructor(
    private readonly store: Store,
    private readonly session: Session,
    private readonly viewer: Viewer,
  ) {
    // The tool shows them, unless something else than the cloud's own colours is looked at.
    store.watch(["tool"], ({ tool, colorBy, cloud }) => {
      if (tool === "segment" && colorBy === "own" && cloud?.has_segments) store.set({ colorBy: "segments" });
      if (tool !== "segment" && colorBy === "segments") store.set({ colorBy: "own" });
    });
  }

  /** Brings them, once for each cloud. @return false where there are none. */
  bring(): Promise<boolean> {
    const { cloud } = this.store.state;
    const name = cloud ? `${cloud.index} ${cloud.name}` : "";
    if (this.bringing === null || this.of !== name) {
      this.of = name;
      this.bringing = this.load();
      void this.bringing.then((there) => !there && (this.bringing = null));
    }
    return this.bringing;
  }

  colors(first: number, count: number): Uint8Array {
    return segmentColors(count, (i) => this.segments[first + i] ?? 0, (i) => this.borders[first + i] === 1);
  }

  /** 0: none, or not known yet. */
  at(point: number): number {
    const vertex = this.vertexOf[point];
    return vertex === undefined || vertex === kNone ? 0 : this.segments[vertex]!;
  }

  /** Makes a segment stand out; 0: none. */
  highlight(segment: number): void {
    const inside = segment === 0 ? new Uint32Array() : this.points.filter((_, vertex) => this.segments[vertex] === segment);
    this.viewer.cloud.highlight(inside);
  }

  private async load(): Promise<boolean> {
    const { cloud } = this.store.state;
    if (!cloud?.has_segments || cloud.tiles !== undefined) return false;
    const [segments, points] = [new Uint32Array(cloud.shown), new Uint32Array(cloud.shown)];
    const borders = new Uint8Array(cloud.shown);
    const vertexOf = new Uint32Array(cloud.points).fill(kNone);
    for (let from = 0; from < cloud.shown; ) {
      const answer = await this.session.ask({ type: "segments", from, count: kChunk });
      const count = Number(answer?.head["count"]);
      if (answer === null || !(count > 0)) return false;
      points.set(new Uint32Array(answer.body, 0, count), from);
      segments.set(new Uint32Array(answer.body, 4 * count, count), from);
      borders.set(new Uint8Array(answer.body, 8 * count, count), from);
      for (let i = from; i < from + count; ++i) vertexOf[points[i]!] = i;
      from += count;
    }
    [this.segments, this.points, this.borders, this.vertexOf] = [segments, points, borders, vertexOf];
    return true;
  }
}

/** RGBA, bordered points darker. */
export function segmentColors(count: number, segmentOf: (i: number) => number, isBorder: (i: number) => boolean): Uint8Array {
  const colors = new Uint8Array(4 * count);
  for (let i = 0; i < count; ++i) {
    const segment = segmentOf(i);
    const light = isBorder(i) ? kBorder : 1;
    const color = segment === 0 ? kNoColor : colorOf(segment);
    for (let k = 0; k < 3; ++k) colors[4 * i + k] = Math.round(light * color[k]!);
    colors[4 * i + 3] = 255;
  }
  return colors;
}

/** A colour of middle light; neighbours by number are far apart. */
function colorOf(segment: number): readonly [number, number, number] {
  const hue = (segment * 0.61803398875) % 1;
  const light = 0.8 + 0.2 * ((segment * 0.7548776662) % 1);
  const part = (shift: number) => {
    const away = Math.abs(((hue + shift) % 1) * 6 - 3) - 1;
    return 255 * light * (0.45 + 0.5 * Math.min(Math.max(away, 0), 1));
  };
  return [part(0), part(2 / 3), part(1 / 3)];
}
