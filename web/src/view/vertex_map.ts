// SPDX-License-Identifier: Apache-2.0
// The vertex of a point: of all points by their numbers, or of few among many by hashing.

const kNone = 0xffffffff;

export interface VertexMap {
  get(point: number): number | undefined;
  set(point: number, vertex: number): void;
  delete(point: number): void;
}

/** Four bytes for each point of the cloud. */
export class DirectMap implements VertexMap {
  private readonly vertices: Uint32Array;

  constructor(points: number) {
    this.vertices = new Uint32Array(points).fill(kNone);
  }

  get(point: number): number | undefined {
    const vertex = this.vertices[point];
    return vertex === kNone ? undefined : vertex;
  }

  set(point: number, vertex: number): void {
    this.vertices[point] = vertex;
  }

  delete(point: number): void {
    this.vertices[point] = kNone;
  }
}

/** Sixteen to thirty-two bytes for each of `room` points, whatever their numbers: open addressing in steps of one. */
export class HashedMap implements VertexMap {
  private readonly mask: number;
  private readonly points: Uint32Array;
  private readonly vertices: Uint32Array;

  constructor(room: number) {
    let size = 16;
    while (size < 2 * room) size *= 2;
    this.mask = size - 1;
    this.points = new Uint32Array(size).fill(kNone);
    this.vertices = new Uint32Array(size);
  }

  get(point: number): number | undefined {
    const at = this.find(point);
    return this.points[at] === point ? this.vertices[at] : undefined;
  }

  set(point: number, vertex: number): void {
    const at = this.find(point);
    this.points[at] = point;
    this.vertices[at] = vertex;
  }

  /** Entries behind the gap that began their search before it move up, so that none is lost. */
  delete(point: number): void {
    const { mask, points, vertices } = this;
    let gap = this.find(point);
    if (points[gap] !== point) return;
    for (let at = (gap + 1) & mask; points[at] !== kNone; at = (at + 1) & mask) {
      const home = this.home(points[at]!);
      if (((at - home) & mask) < ((at - gap) & mask)) continue;
      points[gap] = points[at]!;
      vertices[gap] = vertices[at]!;
      gap = at;
    }
    points[gap] = kNone;
  }

  private home(point: number): number {
    const mixed = Math.imul(point ^ (point >>> 15), 0x9e3779b1);
    return (mixed ^ (mixed >>> 16)) & this.mask;
  }

  /** Where the point is, or would be put. */
  private find(point: number): number {
    let at = this.home(point);
    while (this.points[at] !== kNone && this.points[at] !== point) at = (at + 1) & this.mask;
    return at;
  }
}
