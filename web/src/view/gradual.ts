// SPDX-License-Identifier: Apache-2.0
// Layers that are too large for one frame: put into an order whose beginning is an even sample, and drawn piece by piece.
import * as THREE from "three";

const kGradual = 100_000; // vertices; a smaller layer is drawn at once
export const kVoxelVertices = 24;
const kChunks = 64; // voxels are in chunks: WebGL cannot begin in the middle of instances

/** A layer in pieces. Shares are between 0 and 1, of the whole layer. */
export interface Gradual {
  readonly work: number; // vertices
  draw(from: number, to: number): void;
}

/** Places 0 to count − 1 in another order, every beginning of which is spread over all of them. */
export function scattered(count: number): Uint32Array {
  const order = new Uint32Array(count);
  const step = coprimeNear(Math.max(1, Math.round(count * 0.6180339887)), count);
  for (let i = 0, at = 0; i < count; ++i) {
    order[i] = at;
    at += step;
    if (at >= count) at -= count;
  }
  return order;
}

/** The entries, `width` numbers each, in this order. */
export function reordered<T extends Float32Array | Uint8Array | Uint32Array>(entries: T, width: number, order: Uint32Array): T {
  const result = new (entries.constructor as new (length: number) => T)(entries.length);
  for (let i = 0, to = 0; i < order.length; ++i) {
    for (let k = 0, from = width * order[i]!; k < width; ++k) result[to++] = entries[from++]!;
  }
  return result;
}

/** The order that a layer of `count` entries is drawn in; null: it is small enough to be drawn at once. */
export function gradualOrder(count: number, verticesEach: number): Uint32Array | null {
  return count * verticesEach > kGradual ? scattered(count) : null;
}

/** Points, or an index of triangles: a range of its vertices is drawn. */
export function gradualRange(geometry: THREE.BufferGeometry, count: number, each: number): Gradual {
  return {
    work: count * each,
    draw: (from, to) => geometry.setDrawRange(each * Math.floor(from * count), each * (Math.floor(to * count) - Math.floor(from * count))),
  };
}

/** Cubes: chunks are switched on. The material is shared. */
export function gradualCubes(
  make: (from: number, to: number) => THREE.Mesh,
  count: number,
): { object: THREE.Group; gradual: Gradual } {
  const object = new THREE.Group();
  const chunk = Math.ceil(count / kChunks);
  for (let from = 0; from < count; from += chunk) object.add(make(from, Math.min(from + chunk, count)));
  const chunks = object.children;
  return {
    object,
    gradual: {
      work: kVoxelVertices * count,
      draw: (from, to) => {
        const [first, end] = [Math.floor(from * chunks.length), Math.floor(to * chunks.length)];
        chunks.forEach((child, i) => void (child.visible = i >= first && i < end));
      },
    },
  };
}

function coprimeNear(start: number, count: number): number {
  for (let step = start; ; ++step) if (divisor(step, count) === 1) return step % count || 1;
}

function divisor(a: number, b: number): number {
  return b === 0 ? a : divisor(b, a % b);
}
