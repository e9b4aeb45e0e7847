// SPDX-License-Identifier: Apache-2.0
// Upright boxes around labels, as lines; a line from the middle of the top shows where the length points.
import * as THREE from "three";
import type { LabelBox } from "./types";

const kEdges = [0, 1, 1, 3, 3, 2, 2, 0, 4, 5, 5, 7, 7, 6, 6, 4, 0, 4, 1, 5, 2, 6, 3, 7];

export class Boxes {
  readonly object = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ vertexColors: true }));
  private any = false;

  constructor() {
    this.object.frustumCulled = false;
    this.object.visible = false;
  }

  set(boxes: readonly LabelBox[], origin: readonly [number, number, number]): void {
    const positions: number[] = [];
    const colors: number[] = [];
    for (const { center, size, axes, color } of boxes) {
      const at = (x: number, y: number, z: number) =>
        [0, 1, 2].map((i) => center[i]! - origin[i]! + x * size[0]! * axes[0]![i]! + y * size[1]! * axes[1]![i]! + z * size[2]! * axes[2]![i]!);
      const corner = (i: number) => at(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5);
      for (const i of kEdges) positions.push(...corner(i));
      positions.push(...at(0, 0, 0.5), ...at(0.5, 0, 0.5));
      for (let i = 0; i < kEdges.length + 2; ++i) colors.push(...color.map((c) => c / 255));
    }
    this.any = boxes.length > 0;
    this.object.geometry.dispose();
    this.object.geometry = new THREE.BufferGeometry();
    this.object.geometry.setAttribute("position", new THREE.Float32BufferAttribute(positions, 3));
    this.object.geometry.setAttribute("color", new THREE.Float32BufferAttribute(colors, 3));
  }

  draw(): void {
    this.object.visible = this.any;
  }

  dispose(): void {
    this.object.geometry.dispose();
    this.object.material.dispose();
  }
}
