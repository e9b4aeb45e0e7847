// SPDX-License-Identifier: Apache-2.0
// The octree of a large cloud: which of its nodes the picture needs, and which are here.
import * as THREE from "three";
import { type Eye, isOrthographic } from "./side_camera";
import { type Run, TileRoom } from "./tile_room";
import type { Octree } from "./types";

const kRow = 7; // numbers of a node
const kSqrt3 = Math.sqrt(3);

/** A picture of the cloud. */
export interface SeenFrom {
  eye: Eye;
  height_px: number;
}

export class Tiles {
  readonly room: TileRoom;
  readonly held = new Map<number, Run[]>();
  private readonly loading = new Map<number, Run[]>();
  private readonly used: Float64Array; // turn in which each node was last wanted
  private readonly children: number[][];
  private readonly count: Uint32Array;
  private readonly spacing: Float32Array;
  private readonly middle: Float32Array; // middles of the cubes, in the scene
  private readonly edge: Float32Array;
  private dropped: number[] = []; // not yet told
  private turn = 0;

  constructor(
    octree: Octree,
    origin: readonly [number, number, number],
    vertices: number,
  ) {
    const { nodes, cube } = octree;
    const words = new Uint32Array(nodes);
    const values = new Float32Array(nodes);
    const size = words.length / kRow;
    this.room = new TileRoom(vertices);
    this.used = new Float64Array(size);
    this.children = Array.from({ length: size }, () => []);
    this.count = new Uint32Array(size);
    this.spacing = new Float32Array(size);
    this.middle = new Float32Array(3 * size);
    this.edge = new Float32Array(size);
    for (let node = 0, at = 0; node < size; ++node, at += kRow) {
      const edge = cube[3] / 2 ** words[at + 1]!;
      for (const axis of [0, 1, 2] as const) this.middle[3 * node + axis] = cube[axis] + edge * (words[at + 2 + axis]! + 0.5) - origin[axis];
      this.edge[node] = edge;
      this.count[node] = words[at + 5]!;
      this.spacing[node] = values[at + 6]!;
      if (node > 0) this.children[words[at]!]!.push(node);
    }
  }

  get idle(): boolean {
    return this.loading.size === 0;
  }

  countOf(node: number): number {
    return this.count[node]!;
  }

  /**
   * Nodes to ask for next, with at most `mostPoints` points, and those that make room for them; null: nothing is missing.
   * `finest_px`: a node is wanted where its parent's points are farther apart than that.
   */
  next(views: readonly SeenFrom[], finest_px: number, mostPoints: number): { nodes: number[]; drop: number[] } | null {
    ++this.turn;
    const wanted = this.wanted(views, finest_px);
    for (const node of wanted) this.used[node] = this.turn;
    const nodes: number[] = [];
    let points = 0;
    for (const node of wanted) {
      if (this.held.has(node) || this.loading.has(node)) continue;
      const count = this.count[node]!;
      if (nodes.length > 0 && points + count > mostPoints) break;
      if (!this.room.fits(count) && !this.makeRoom(count)) break;
      this.loading.set(node, this.room.take(count));
      nodes.push(node);
      points += count;
    }
    if (nodes.length === 0) return null;
    const drop = this.dropped;
    this.dropped = [];
    return { nodes, drop };
  }

  /** The node is here; returns its vertices, or nothing where it is no longer awaited. */
  arrived(node: number): Run[] | undefined {
    const runs = this.loading.get(node);
    if (runs === undefined) return undefined;
    this.loading.delete(node);
    this.held.set(node, runs);
    return runs;
  }

  /** Vertices that were given up since the last call. */
  takeFreed(): Run[] {
    const freed = this.freed;
    this.freed = [];
    return freed;
  }
  private freed: Run[] = [];

  /** Gives up everything that is here. */
  drop(): void {
    for (const node of [...this.held.keys()]) this.evict(node);
  }

  /** Calls for the vertices of nodes that may be within half_px of a pixel. */
  near(clip_scene: THREE.Matrix4, x: number, y: number, half_px: number, size: readonly [number, number], found: (run: Run) => void): void {
    const e = clip_scene.elements;
    const orthographic = isOrthographic(clip_scene);
    const scale = Math.max(0.5 * size[1] * Math.hypot(e[1]!, e[5]!, e[9]!), 0.5 * size[0] * Math.hypot(e[0]!, e[4]!, e[8]!));
    for (const [node, runs] of this.held) {
      const [a, b, c] = [this.middle[3 * node]!, this.middle[3 * node + 1]!, this.middle[3 * node + 2]!];
      const radius = 0.5 * kSqrt3 * this.edge[node]!;
      const w = e[3]! * a + e[7]! * b + e[11]! * c + e[15]!;
      if (!orthographic && w + radius <= 0) continue;
      if (orthographic || w > 2 * radius) {
        const reach_px = half_px + (orthographic ? scale * radius : (2 * scale * radius) / (w - radius));
        const u = 0.5 * size[0] * ((e[0]! * a + e[4]! * b + e[8]! * c + e[12]!) / w + 1) - x;
        const v = 0.5 * size[1] * (1 - (e[1]! * a + e[5]! * b + e[9]! * c + e[13]!) / w) - y;
        if (Math.abs(u) > reach_px || Math.abs(v) > reach_px) continue;
      }
      runs.forEach(found);
    }
  }

  /** Nodes in the picture, those first that make it finer by most; as many as there is room for. */
  private wanted(views: readonly SeenFrom[], finest_px: number): number[] {
    if (this.count.length === 0) return [];
    const gains = new Map<number, number>([[0, Infinity]]);
    for (const view of views) {
      for (const [node, gain] of this.gainsIn(view, finest_px)) gains.set(node, Math.max(gain, gains.get(node) ?? 0));
    }
    return this.mostOf(gains);
  }

  /** How many pixels apart the points of its parent are, of each node in a picture. */
  private gainsIn({ eye, height_px }: SeenFrom, finest_px: number): Map<number, number> {
    const { camera } = eye;
    const frustum = new THREE.Frustum().setFromProjectionMatrix(eye.clipScene());
    const focal_px = 0.5 * height_px * camera.projectionMatrix.elements[5]!; // edge of a metre in an orthographic picture
    const orthographic = camera instanceof THREE.OrthographicCamera;
    const sphere = new THREE.Sphere();
    const gains = new Map<number, number>([[0, Infinity]]);
    const open = [0];
    while (open.length > 0) {
      const parent = open.pop()!;
      for (const node of this.children[parent]!) {
        sphere.center.fromArray(this.middle, 3 * node);
        sphere.radius = 0.5 * kSqrt3 * this.edge[node]!;
        if (!frustum.intersectsSphere(sphere)) continue;
        const distance = orthographic ? 1 : Math.max(camera.position.distanceTo(sphere.center) - sphere.radius, 1e-3 * this.edge[node]!);
        const gain = this.spacing[parent]! > 0 ? (this.spacing[parent]! * focal_px) / distance : gains.get(parent)!;
        if (gain < finest_px) continue;
        gains.set(node, gain);
        open.push(node);
      }
    }
    return gains;
  }

  private mostOf(gains: ReadonlyMap<number, number>): number[] {
    const order = [...gains.keys()].sort((a, b) => gains.get(b)! - gains.get(a)! || a - b);
    let left = 0.95 * this.room.vertices; // blocks are not quite full
    const wanted: number[] = [];
    for (const node of order) {
      left -= Math.ceil(this.count[node]! / 512) * 512;
      if (left < 0 && wanted.length > 0) break;
      wanted.push(node);
    }
    return wanted;
  }

  /** Gives up what has not been wanted for longest, never what is wanted now. */
  private makeRoom(count: number): boolean {
    const old = [...this.held.keys()].filter((node) => this.used[node]! < this.turn).sort((a, b) => this.used[a]! - this.used[b]! || b - a);
    for (const node of old) {
      if (this.room.fits(count)) break;
      this.evict(node);
    }
    return this.room.fits(count);
  }

  private evict(node: number): void {
    const runs = this.held.get(node)!;
    this.held.delete(node);
    this.room.release(runs);
    this.freed.push(...runs);
    this.dropped.push(node);
  }
}
