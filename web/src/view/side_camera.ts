// SPDX-License-Identifier: Apache-2.0
// Orthographic views of the scene: from the top, the front or the side. They are moved and zoomed, never turned.
import * as THREE from "three";
import type { SceneCamera } from "./camera";
import { type Side, standpoint } from "./standpoint";

const kRoom = 1.08; // around the scene

/** Camera of a picture. */
export interface Eye {
  readonly camera: THREE.PerspectiveCamera | THREE.OrthographicCamera;
  /** Matrices are right after it. */
  update(): void;
  clipScene(): THREE.Matrix4;
  clipWorld(): THREE.Matrix4;
}

export function isOrthographic(clip_scene: THREE.Matrix4): boolean {
  const e = clip_scene.elements;
  return e[3] === 0 && e[7] === 0 && e[11] === 0;
}

/** Factors of x, y, z and 1 whose sum is how far in front a place is: w, or of an orthographic view metres from its near plane. */
export function depthRow(clip_scene: THREE.Matrix4): [number, number, number, number] {
  const e = clip_scene.elements as unknown as number[];
  if (!isOrthographic(clip_scene)) return [e[3]!, e[7]!, e[11]!, e[15]!];
  const m = 1 / Math.hypot(e[2]!, e[6]!, e[10]!);
  return [m * e[2]!, m * e[6]!, m * e[10]!, m * (e[14]! + 1)];
}

export class SideCamera implements Eye {
  readonly camera = new THREE.OrthographicCamera();
  private height_m = 2; // height of the picture
  private aspect = 1;
  private moved = false; // since fit()

  constructor(
    private readonly scene: SceneCamera,
    readonly side: Side,
  ) {}

  /** Whole scene in view. */
  fit(): void {
    const { scene, camera } = this;
    const towards = new THREE.Vector3(...standpoint(scene.up.toArray(), this.side)).normalize();
    const middle = scene.box.getCenter(new THREE.Vector3());
    camera.up.copy(Math.abs(towards.dot(scene.up)) > 0.999 ? scene.upFromAbove() : scene.up);
    camera.position.copy(middle).add(towards);
    camera.lookAt(middle);
    const turn = camera.quaternion.clone().invert();
    const corners = scene.corners().map((corner) => corner.sub(middle).applyQuaternion(turn));
    const [width_m, height_m] = (["x", "y"] as const).map((axis) => 2 * Math.max(...corners.map((corner) => corner[axis]))) as [number, number];
    this.height_m = Math.max(kRoom * height_m, (kRoom * width_m) / this.aspect, 1e-4 * scene.radius_m);
    this.moved = false;
  }

  setAspect(aspect: number): void {
    this.aspect = aspect;
    if (!this.moved) this.fit();
  }

  /** Brings a place to the middle. */
  goTo(place: THREE.Vector3): void {
    const ahead = this.camera.getWorldDirection(new THREE.Vector3());
    const away = this.camera.position.clone().sub(place).dot(ahead);
    this.camera.position.copy(place).addScaledVector(ahead, away);
    this.moved = true;
  }

  /** By these parts of the picture's height, to the right and down: what is there follows. */
  pan(x: number, y: number): void {
    this.shift(-x * this.height_m, y * this.height_m);
  }

  /** The place at (x, y), −1 to 1, y up, stays where it is. */
  zoom(x: number, y: number, factor: number): void {
    const radius_m = this.scene.radius_m;
    const height_m = Math.min(Math.max(this.height_m * factor, 2e-4 * radius_m), 200 * radius_m);
    const less = 0.5 * (this.height_m - height_m);
    this.shift(x * less * this.aspect, y * less);
    this.height_m = height_m;
  }

  update(): void {
    const { camera, scene } = this;
    camera.updateMatrixWorld();
    const ahead = camera.getWorldDirection(new THREE.Vector3());
    const depths = scene.corners().map((corner) => corner.sub(camera.position).dot(ahead));
    const slack = 0.02 * scene.radius_m;
    camera.near = Math.min(...depths) - slack;
    camera.far = Math.max(...depths) + slack;
    camera.top = 0.5 * this.height_m;
    camera.bottom = -camera.top;
    camera.right = camera.top * this.aspect;
    camera.left = -camera.right;
    camera.updateProjectionMatrix();
  }

  clipScene(): THREE.Matrix4 {
    return new THREE.Matrix4().multiplyMatrices(this.camera.projectionMatrix, this.camera.matrixWorldInverse);
  }

  clipWorld(): THREE.Matrix4 {
    const { x, y, z } = this.scene.origin;
    return this.clipScene().multiply(new THREE.Matrix4().makeTranslation(-x, -y, -z));
  }

  private shift(right_m: number, up_m: number): void {
    const step = new THREE.Vector3(right_m, up_m, 0).applyQuaternion(this.camera.quaternion);
    this.camera.position.add(step);
    this.moved = true;
  }
}
