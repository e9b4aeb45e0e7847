// SPDX-License-Identifier: Apache-2.0
// Vertices for tiles: blocks of one array, the first free ones first.

const kBlock = 512; // vertices

/** Vertices from `at` on. */
export interface Run {
  at: number;
  count: number;
}

export class TileRoom {
  private readonly taken: Uint8Array;
  private first = 0; // no block before is free
  private free: number;

  constructor(vertices: number) {
    this.free = Math.max(1, Math.ceil(vertices / kBlock));
    this.taken = new Uint8Array(this.free);
  }

  get vertices(): number {
    return this.taken.length * kBlock;
  }

  fits(count: number): boolean {
    return Math.ceil(count / kBlock) <= this.free;
  }

  /** Expects that it fits. */
  take(count: number): Run[] {
    const runs: Run[] = [];
    for (let left = count; left > 0; ) {
      while (this.taken[this.first] === 1) ++this.first;
      this.taken[this.first] = 1;
      --this.free;
      const here = Math.min(left, kBlock);
      const at = this.first * kBlock;
      const last = runs.at(-1);
      if (last && last.at + last.count === at) last.count += here;
      else runs.push({ at, count: here });
      left -= here;
    }
    return runs;
  }

  release(runs: readonly Run[]): void {
    for (const { at, count } of runs) {
      for (let block = at / kBlock; block * kBlock < at + count; ++block) {
        this.taken[block] = 0;
        ++this.free;
        this.first = Math.min(this.first, block);
      }
    }
  }
}
