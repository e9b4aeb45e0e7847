// SPDX-License-Identifier: Apache-2.0
// The points of the cloud: arrays of what there is room for, filled as chunks come, of which only what changed is uploaded.
import * as THREE from "three";
import { Palette, kSlotBits } from "./palette";
import { type PointMode, type PointUniforms, pointMaterial } from "./point_material";
import type { Run } from "./tile_room";
import { DirectMap, HashedMap, type VertexMap } from "./vertex_map";
import type { CloudInfo, Painter, PointChunk, Rgb } from "./types";

const kSlotMask = (1 << kSlotBits) - 1;
const kMarginMask = 255 << kSlotBits;
const kStandsOut = 1 << 28;
const kEmpty = 1 << 29; // no point is there
const kFar = 1e30; // m; no clip box
const kBlock = 1024; // vertices that are uploaded together

export class PointCloud {
  readonly palette = new Palette();
  readonly object = new THREE.Points();
  readonly uniforms: PointUniforms = {
    palette: this.palette.texture,
    size: { value: 4 },
    heat: { value: false },
    spacing: { value: 0 },
    low: { value: new THREE.Vector3().setScalar(-kFar) },
    high: { value: new THREE.Vector3().setScalar(kFar) },
  };
  vertices = 0;
  room = 0;
  positions = new Float32Array(); // less `origin`
  private points = new Uint32Array(); // number of each vertex's point in the file
  private vertexOf: VertexMap = new DirectMap(0);
  private colors = new Uint8Array();
  private own: Uint8Array | null = null; // colours of the file, while others are shown
  private painter: Painter | null = null;
  private states = new Uint32Array();
  private changed = new Uint8Array(); // blocks
  private anyChanged = false;
  private standing: Uint32Array = new Uint32Array();
  private materials = new Map<string, THREE.RawShaderMaterial>();

  constructor(readonly origin: readonly [number, number, number] = [0, 0, 0]) {
    this.object.frustumCulled = false;
    this.object.visible = false;
  }

  begin(cloud: CloudInfo): void {
    this.allocate(cloud.shown, new DirectMap(cloud.points));
  }

  /** Room for tiles, which come and go. */
  beginTiles(room: number): void {
    this.allocate(room, new HashedMap(room));
    this.states.fill(kEmpty);
  }

  private allocate(room: number, vertexOf: VertexMap): void {
    this.room = room;
    this.vertexOf = vertexOf;
    this.positions = new Float32Array(3 * this.room);
    this.points = new Uint32Array(this.room);
    this.colors = new Uint8Array(4 * this.room);
    this.states = new Uint32Array(this.room);
    this.changed = new Uint8Array(Math.ceil(this.room / kBlock));
    const geometry = this.object.geometry;
    geometry.setAttribute("position", new THREE.BufferAttribute(this.positions, 3));
    geometry.setAttribute("color", new THREE.BufferAttribute(this.colors, 4, true));
    geometry.setAttribute("state", new THREE.BufferAttribute(this.states, 1));
    geometry.setDrawRange(0, 0);
  }

  append(chunk: PointChunk): void {
    const first = this.vertices;
    this.place(chunk, 0, { at: first, count: Math.min(chunk.points.length, this.room - first) });
  }

  /** Puts the chunk's points from `begin` on at these vertices. */
  place(chunk: PointChunk, begin: number, { at: first, count }: Run): void {
    const { positions, origin, states } = this;
    const end = begin + count;
    for (let i = 3 * begin, at = 3 * first; i < 3 * end; i += 3, at += 3) {
      positions[at] = chunk.positions[i]! - origin[0];
      positions[at + 1] = chunk.positions[i + 1]! - origin[1];
      positions[at + 2] = chunk.positions[i + 2]! - origin[2];
    }
    this.points.set(chunk.points.subarray(begin, end), first);
    const own = chunk.colors.subarray(4 * begin, 4 * end);
    this.own?.set(own, 4 * first);
    const width = chunk.values ? chunk.values.length / chunk.points.length : 0;
    const values = chunk.values?.subarray(width * begin, width * end);
    this.colors.set(this.painter?.(chunk.positions.subarray(3 * begin, 3 * end), first, count, values) ?? own, 4 * first);
    let label = 0;
    let slot = 0;
    for (let i = 0; i < count; ++i) {
      this.vertexOf.set(chunk.points[begin + i]!, first + i);
      if (chunk.labels[begin + i] !== label) {
        label = chunk.labels[begin + i]!;
        slot = this.palette.slotOf(label);
      }
      states[first + i] = slot;
    }
    this.vertices = Math.max(this.vertices, first + count);
    for (const [name, width] of [["position", 3], ["color", 4], ["state", 1]] as const) {
      const attribute = this.attribute(name);
      attribute.addUpdateRange(width * first, width * count);
      attribute.needsUpdate = true;
    }
  }

  /** No points are at these vertices any more. */
  clear({ at: first, count }: Run): void {
    for (let vertex = first; vertex < first + count; ++vertex) {
      this.vertexOf.delete(this.points[vertex]!);
      this.change(vertex, 0xffffffff, kEmpty);
    }
  }

  setPainter(painter: Painter | null): void {
    this.painter = painter;
    if (painter === null && this.own === null) return;
    this.own ??= this.colors.slice();
    const { vertices, origin } = this;
    if (vertices > 0) {
      const places = this.positions.slice(0, 3 * vertices);
      for (let i = 0; i < places.length; ++i) places[i] = places[i]! + origin[i % 3]!;
      this.colors.set(painter?.(places, 0, vertices) ?? this.own);
      const attribute = this.attribute("color");
      attribute.addUpdateRange(0, 4 * vertices);
      attribute.needsUpdate = true;
    }
    if (painter === null) this.own = null;
  }

  setLabel(label: number, points: Uint32Array): void {
    const slot = this.palette.slotOf(label);
    for (const point of points) this.change(this.vertexOf.get(point), kSlotMask, slot);
  }

  labelOf(point: number): number {
    const vertex = this.vertexOf.get(point);
    return vertex === undefined ? 0 : this.palette.labelOf(this.states[vertex]! & kSlotMask);
  }

  positionOf(point: number): [number, number, number] | undefined {
    const vertex = this.vertexOf.get(point);
    return vertex === undefined ? undefined : this.positionOfVertex(vertex);
  }

  positionOfVertex(vertex: number): [number, number, number] {
    const at = 3 * vertex;
    return [
      this.positions[at]! + this.origin[0],
      this.positions[at + 1]! + this.origin[1],
      this.positions[at + 2]! + this.origin[2],
    ];
  }

  pointOfVertex(vertex: number): number {
    return this.points[vertex]!;
  }

  isDrawn(vertex: number): boolean {
    const at = 3 * vertex;
    const inside = this.isInside(this.positions[at]!, this.positions[at + 1]!, this.positions[at + 2]!);
    const state = this.states[vertex]!;
    return inside && (state & kEmpty) === 0 && this.palette.isVisible(state & kSlotMask);
  }

  /** A place less the origin. */
  isInside(x: number, y: number, z: number): boolean {
    const { low, high } = { low: this.uniforms.low.value, high: this.uniforms.high.value };
    return x >= low.x && y >= low.y && z >= low.z && x <= high.x && y <= high.y && z <= high.z;
  }

  setClip(box: { low: readonly number[]; high: readonly number[] } | null): void {
    const of = (sides: readonly number[] | undefined, none: number): [number, number, number] =>
      sides ? [sides[0]! - this.origin[0], sides[1]! - this.origin[1], sides[2]! - this.origin[2]] : [none, none, none];
    this.uniforms.low.value.set(...of(box?.low, -kFar));
    this.uniforms.high.value.set(...of(box?.high, kFar));
  }

  setMargins(margins: Uint8Array | null): void {
    this.uniforms.heat.value = margins !== null;
    if (margins === null) return;
    const count = Math.min(margins.length, this.vertices);
    for (let i = 0; i < count; ++i) this.states[i] = (this.states[i]! & ~kMarginMask) | (margins[i]! << kSlotBits);
    this.changed.fill(1);
    this.anyChanged = true;
  }

  setMarginsOf({ at, count }: Run, margins: Uint8Array): void {
    this.uniforms.heat.value = true;
    for (let i = 0; i < count; ++i) this.change(at + i, kMarginMask, margins[i]! << kSlotBits);
  }

  highlight(points: Uint32Array): void {
    for (const point of this.standing) this.change(this.vertexOf.get(point), kStandsOut, 0);
    for (const point of points) this.change(this.vertexOf.get(point), kStandsOut, kStandsOut);
    this.standing = points;
  }

  setLabelColor(label: number, color: Rgb): void {
    this.palette.setColor(label, color);
  }

  /** Draws these vertices next, as squares of this many pixels. */
  draw(mode: PointMode, size_px: number, from: number, to: number): void {
    this.upload();
    this.object.visible = to > from;
    this.object.geometry.setDrawRange(from, to - from);
    this.uniforms.size.value = size_px;
    const key = mode === "both" ? `both ${size_px}` : mode;
    let material = this.materials.get(key);
    if (material === undefined) {
      material = pointMaterial(mode, size_px, this.uniforms);
      this.materials.set(key, material);
    }
    this.object.material = material;
  }

  dispose(): void {
    this.object.geometry.dispose();
    for (const material of this.materials.values()) material.dispose();
    this.palette.dispose();
  }

  private attribute(name: string): THREE.BufferAttribute {
    return this.object.geometry.getAttribute(name) as THREE.BufferAttribute;
  }

  private change(vertex: number | undefined, mask: number, bits: number): void {
    if (vertex === undefined) return;
    this.states[vertex] = (this.states[vertex]! & ~mask) | bits;
    this.changed[Math.floor(vertex / kBlock)] = 1;
    this.anyChanged = true;
  }

  private upload(): void {
    if (!this.anyChanged) return;
    this.anyChanged = false;
    const attribute = this.attribute("state");
    for (let block = 0; block < this.changed.length; ++block) {
      if (this.changed[block] === 0) continue;
      const first = block;
      while (this.changed[block] === 1) this.changed[block++] = 0;
      attribute.addUpdateRange(first * kBlock, Math.min(block * kBlock, this.room) - first * kBlock);
    }
    attribute.needsUpdate = true;
  }
}
