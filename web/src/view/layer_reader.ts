// SPDX-License-Identifier: Apache-2.0
import * as THREE from "three";

/** Arrays of a buffer one after the other; `short` where it ended before them. */
export class LayerReader {
  short = false;
  private at = 0;

  constructor(
    private buffer: ArrayBuffer,
    private origin: THREE.Vector3,
  ) {}

  floats(count: number): Float32Array {
    return this.take(4 * count) ? new Float32Array(this.buffer, this.at - 4 * count, count) : new Float32Array();
  }

  numbers(count: number): Uint32Array {
    return this.take(4 * count) ? new Uint32Array(this.buffer, this.at - 4 * count, count) : new Uint32Array();
  }

  /** r, g, b, a of each. */
  colors(count: number): Uint8Array {
    return this.take(4 * count) ? new Uint8Array(this.buffer, this.at - 4 * count, 4 * count) : new Uint8Array();
  }

  /** x, y, z of each, in the scene's coordinates. */
  places(count: number): Float32Array {
    const places = this.floats(3 * count);
    const { x, y, z } = this.origin;
    if (x === 0 && y === 0 && z === 0) return places;
    const moved = new Float32Array(places.length);
    for (let i = 0; i < places.length; i += 3) {
      moved[i] = places[i]! - x;
      moved[i + 1] = places[i + 1]! - y;
      moved[i + 2] = places[i + 2]! - z;
    }
    return moved;
  }

  private take(bytes: number): boolean {
    this.short ||= this.at + bytes > this.buffer.byteLength;
    this.at += bytes;
    return !this.short;
  }
}
