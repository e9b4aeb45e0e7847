// SPDX-License-Identifier: Apache-2.0
// Brings the tiles that the picture needs, two questions at a time, with what points are coloured by: a field, or segments.
import { type Connection, Disconnected } from "../connection";
import type { Message } from "../protocol";
import type { Viewer } from "../view/types";

const kMostPoints = 131_072; // in a question
const kInFlight = 2;

/** A field of the cloud and its numbers per point, or the segments: a segment and whether the point is at a border. */
export type TileValues = { name: string; width: number } | "segments";
const kMostMargins = 262_144; // points whose margins a question may ask for

export class TileLoader {
  private turn = 0; // counts up: answers for an earlier cloud are dropped
  private asked = 0;
  private values: TileValues | null = null;
  private readonly listeners: (() => void)[] = [];

  constructor(
    private readonly connection: Connection,
    private readonly viewer: Viewer,
    private readonly failed: (error: unknown) => void,
  ) {}

  /** After a while in which tiles came. */
  onTiles(listener: () => void): void {
    this.listeners.push(listener);
  }

  end(): void {
    ++this.turn;
    this.asked = 0;
    delete this.viewer.element.dataset["tiles"];
  }

  /** Expects that the view began with the cloud. Resolves once the coarsest tile is there. */
  async begin(vertices: number): Promise<void> {
    this.end();
    const turn = this.turn;
    const { head, body } = await this.connection.ask({ type: "octree" });
    if (turn !== this.turn) return;
    const cube = head["cube"] as [number, number, number, number];
    this.viewer.cloud.beginTiles({ cube, nodes: body }, vertices, () => this.pump(turn));
    await this.bring(turn);
    this.pump(turn);
  }

  /** Brings these values with the points from now on; null: none. All tiles come anew with them. */
  async colorBy(values: TileValues | null): Promise<void> {
    if (nameOf(values) === nameOf(this.values)) return;
    this.values = values;
    if (values === null) return;
    this.viewer.cloud.dropTiles();
    await this.bring(this.turn);
    this.pump(this.turn);
  }

  /** Calls with the margins of all tiles that are here. */
  async margins(): Promise<void> {
    const held = this.viewer.cloud.heldTiles();
    while (held.length > 0) {
      const nodes: number[] = [];
      for (let points = 0; held.length > 0 && points + held[0]!.count <= kMostMargins; ) {
        points += held[0]!.count;
        nodes.push(held.shift()!.node);
      }
      const { head, body } = await this.connection.ask({ type: "margins", nodes });
      this.viewer.cloud.setTileMargins(nodes, new Uint8Array(body, 0, Number(head["count"])));
    }
  }

  private pump(turn: number): void {
    while (turn === this.turn && this.asked < kInFlight) {
      const answer = this.bring(turn);
      if (answer === null) break;
      void answer.then(() => this.pump(turn));
    }
    if (turn === this.turn && this.asked === 0) this.rest();
  }

  private rest(): void {
    const held = this.viewer.cloud.heldTiles();
    const points = held.reduce((sum, { count }) => sum + count, 0);
    this.viewer.element.dataset["tiles"] = `${held.length} ${points}`;
    for (const listener of this.listeners) listener();
  }

  /** null: nothing is missing. */
  private bring(turn: number): Promise<void> | null {
    const next = this.viewer.cloud.nextTiles(kMostPoints);
    if (next === null) return null;
    delete this.viewer.element.dataset["tiles"];
    ++this.asked;
    return this.take(turn, next);
  }

  private async take(turn: number, { nodes, drop }: { nodes: number[]; drop: number[] }): Promise<void> {
    try {
      const values = this.ask(nodes);
      values?.catch(() => undefined); // told below
      const answer = await this.connection.ask({ type: "tiles", nodes, drop });
      if (turn !== this.turn) return;
      this.add(nodes, answer, values && (await values));
    } catch (error) {
      if (turn !== this.turn) return;
      this.end();
      if (!(error instanceof Disconnected)) this.failed(error);
      return;
    }
    if (turn === this.turn) --this.asked;
  }

  /** null: points come without values. */
  private ask(nodes: number[]): Promise<Float32Array> | null {
    const { values, connection } = this;
    if (values === null) return null;
    if (values === "segments") return connection.ask({ type: "segments", nodes }).then(segmentValues);
    return connection.ask({ type: "field", name: values.name, nodes }).then(({ body }) => new Float32Array(body));
  }

  private add(nodes: number[], { head, body }: Message, values: Float32Array | null): void {
    const count = Number(head["count"]);
    this.viewer.cloud.addTiles(nodes, {
      positions: new Float32Array(body, 0, 3 * count),
      points: new Uint32Array(body, 12 * count, count),
      colors: new Uint8Array(body, 16 * count, 4 * count),
      labels: new Uint32Array(body, 20 * count, count),
      ...(values === null ? {} : { values }),
    });
  }
}

const nameOf = (values: TileValues | null) => (values === null || values === "segments" ? values : `field ${values.name}`);

/** Segment and border of each point. Segments beyond 2²⁴ are rounded: only colours depend on them. */
function segmentValues({ head, body }: Message): Float32Array {
  const count = Number(head["count"]);
  const segments = new Uint32Array(body, 4 * count, count);
  const borders = new Uint8Array(body, 8 * count, count);
  const values = new Float32Array(2 * count);
  for (let i = 0; i < count; ++i) {
    values[2 * i] = segments[i]!;
    values[2 * i + 1] = borders[i]!;
  }
  return values;
}
