// SPDX-License-Identifier: Apache-2.0
// The nearest point whose square is under the cursor, by a bounding volume hierarchy.
import * as THREE from "three";
import { depthRow, isOrthographic } from "./side_camera";
import { INTERSECTED, NOT_INTERSECTED, PointsBVH } from "three-mesh-bvh";

/** Parts of a hierarchy that go from the worker to the page. */
export interface TreeParts {
  _roots: ArrayBuffer[];
  _indirectBuffer: Uint32Array | Uint16Array;
}

export interface BuiltTree {
  job: number;
  roots: ArrayBuffer[];
  order: Uint32Array | Uint16Array;
}

interface Shapecast {
  boundsTraverseOrder: (box: THREE.Box3) => number;
  intersectsBounds: (box: THREE.Box3) => number;
  intersectsPoint: (point: THREE.Vector3, index: number) => boolean;
}

export class HoverTree {
  private worker: Worker | null = null;
  private job = 0;
  private tree: PointsBVH | null = null;
  private order: Uint32Array | Uint16Array = new Uint32Array();

  /** Begins to build; what there was stays until it is done. */
  build(positions: Float32Array, done: () => void): void {
    const job = ++this.job;
    this.worker?.terminate();
    this.worker = new Worker(new URL("./hover.worker.ts", import.meta.url), { type: "module" });
    this.worker.onmessage = (event: MessageEvent<BuiltTree>) => {
      if (event.data.job !== this.job) return;
      this.worker?.terminate(); // its memory is large
      this.worker = null;
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(positions.subarray(0, 3), 3));
      const tree = new PointsBVH(geometry, { indirect: true } as object); // holds one point until it gets the parts
      geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
      const parts = tree as unknown as TreeParts;
      parts._roots = event.data.roots;
      parts._indirectBuffer = event.data.order;
      this.order = event.data.order;
      this.tree = tree;
      done();
    };
    const copy = positions.slice();
    this.worker.postMessage({ positions: copy, job }, [copy.buffer]);
  }

  get ready(): boolean {
    return this.tree !== null;
  }

  /**
   * Calls for each vertex whose centre is less than `half_px` from (x, y) in the picture, in no order; depth is as depthRow() has it.
   * Where `visit` answers a depth, what is farther than that is left out.
   */
  around(
    x: number,
    y: number,
    half_px: number,
    clip_scene: THREE.Matrix4,
    size: readonly [number, number],
    visit: (vertex: number, depth: number) => number,
  ): boolean {
    if (this.tree === null) return false;
    const e = clip_scene.elements;
    const [width, height] = size;
    const [left, right] = [(2 * (x - half_px)) / width - 1, (2 * (x + half_px)) / width - 1];
    const [top, bottom] = [1 - (2 * (y - half_px)) / height, 1 - (2 * (y + half_px)) / height];
    // Planes a·p + b ≥ 0 of what is in the square, and in front.
    const row = (i: number) => [e[i]!, e[4 + i]!, e[8 + i]!, e[12 + i]!];
    const [rx, ry, rz, rw] = [row(0), row(1), row(2), row(3)];
    const plane = (r: number[], times: number, sign: number) => r.map((value, i) => sign * (value - times * rw[i]!));
    const planes = [plane(rx, left, 1), plane(rx, right, -1), plane(ry, bottom, 1), plane(ry, top, -1), plane(rz, -1, 1)];
    let farthest = Infinity;
    const orthographic = isOrthographic(clip_scene);
    const ahead = depthRow(clip_scene);
    const depthOf = (box: THREE.Box3) =>
      ahead[0] * (ahead[0] > 0 ? box.min.x : box.max.x) +
      ahead[1] * (ahead[1] > 0 ? box.min.y : box.max.y) +
      ahead[2] * (ahead[2] > 0 ? box.min.z : box.max.z) +
      ahead[3];
    const cast: Shapecast = {
      boundsTraverseOrder: depthOf,
      intersectsBounds: (box) => {
        if (depthOf(box) > farthest) return NOT_INTERSECTED;
        for (const [a, b, c, d] of planes as [number, number, number, number][]) {
          const most = a * (a > 0 ? box.max.x : box.min.x) + b * (b > 0 ? box.max.y : box.min.y) + c * (c > 0 ? box.max.z : box.min.z) + d;
          if (most < 0) return NOT_INTERSECTED;
        }
        return INTERSECTED;
      },
      intersectsPoint: (p, index) => {
        const depth = ahead[0] * p.x + ahead[1] * p.y + ahead[2] * p.z + ahead[3];
        if (!(depth > 0) || depth > farthest) return false;
        const w = orthographic ? 1 : depth;
        const u = 0.5 * width * ((e[0]! * p.x + e[4]! * p.y + e[8]! * p.z + e[12]!) / w + 1);
        const v = 0.5 * height * (1 - (e[1]! * p.x + e[5]! * p.y + e[9]! * p.z + e[13]!) / w);
        if (Math.abs(u - x) > half_px || Math.abs(v - y) > half_px) return false;
        if (e[2]! * p.x + e[6]! * p.y + e[10]! * p.z + e[14]! < -w) return false;
        farthest = Math.min(farthest, visit(this.order[index]!, depth));
        return false;
      },
    };
    this.tree.shapecast(cast as unknown as Parameters<PointsBVH["shapecast"]>[0]);
    return true;
  }

  clear(): void {
    ++this.job;
    this.tree = null;
    this.order = new Uint32Array();
  }

  dispose(): void {
    this.clear();
    this.worker?.terminate();
    this.worker = null;
  }
}
