// SPDX-License-Identifier: Apache-2.0
// Builds the hierarchy over the points, beside the page.
import { BufferAttribute, BufferGeometry } from "three";
import { PointsBVH } from "three-mesh-bvh";
import type { BuiltTree, TreeParts } from "./hover";

interface Scope {
  onmessage: ((event: MessageEvent<{ positions: Float32Array; job: number }>) => void) | null;
  postMessage(message: BuiltTree, transfer: Transferable[]): void;
}
const scope = self as unknown as Scope;

scope.onmessage = (event) => {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(event.data.positions, 3));
  const tree = new PointsBVH(geometry, { indirect: true, targetLeafSize: 32 } as object) as unknown as TreeParts;
  const built = { job: event.data.job, roots: tree._roots, order: tree._indirectBuffer };
  scope.postMessage(built, [...built.roots, built.order.buffer as ArrayBuffer]);
};
