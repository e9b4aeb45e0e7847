// SPDX-License-Identifier: Apache-2.0
// Where the picture is seen from: a pose with 6 degrees of freedom in the scene's coordinates (the world's less `origin`).
import * as THREE from "three";
import type { Eye, SideCamera } from "./side_camera";
import type { Camera, Navigation } from "./types";

const kFov_rad = (50 * Math.PI) / 180;
const kRoom = 1.08; // around the scene
const kMove_ms = 260;

export class SceneCamera implements Camera, Eye {
  navigation: Navigation = "orbit";
  readonly camera = new THREE.PerspectiveCamera((kFov_rad * 180) / Math.PI, 1, 0.01, 100);
  readonly origin = new THREE.Vector3();
  readonly box = new THREE.Box3(new THREE.Vector3(-1, -1, -1), new THREE.Vector3(1, 1, 1)); // bounds of the scene
  readonly up = new THREE.Vector3(0, 0, 1);
  /** Point that the camera turns around. */
  readonly pivot = new THREE.Vector3();
  /** There may be things outside of `box`. */
  loose = false;
  private flight = 0;
  private sides: readonly SideCamera[] = [];

  constructor(private changed: () => void) {}

  setBounds(bounds: readonly number[], up: readonly number[], moveOrigin: boolean): void {
    const [x0, y0, z0, x1, y1, z1] = bounds as [number, number, number, number, number, number];
    if (moveOrigin) this.origin.set(Math.fround((x0 + x1) / 2), Math.fround((y0 + y1) / 2), Math.fround((z0 + z1) / 2));
    this.box.min.set(x0, y0, z0).sub(this.origin);
    this.box.max.set(x1, y1, z1).sub(this.origin);
    this.up.fromArray([...up]).normalize();
    if (this.up.lengthSq() === 0) this.up.set(0, 0, 1);
    for (const side of this.sides) side.fit();
  }

  /** Views that begin with the whole scene, and go to the same places. */
  follow(sides: readonly SideCamera[]): void {
    this.sides = sides;
  }

  /** Half of the scene's diagonal. */
  get radius_m(): number {
    return Math.max(0.5 * this.box.min.distanceTo(this.box.max), 1e-3);
  }

  fit(from?: readonly [number, number, number]): void {
    this.stop();
    const { camera } = this;
    const towards = new THREE.Vector3();
    if (from !== undefined) towards.set(...from);
    else towards.copy(this.up).multiplyScalar(0.75).add(this.anySide());
    towards.normalize();
    const middle = this.box.getCenter(new THREE.Vector3());
    camera.fov = (kFov_rad * 180) / Math.PI;
    camera.up.copy(Math.abs(towards.dot(this.up)) > 0.999 ? this.upFromAbove() : this.up);
    camera.position.copy(middle).add(towards);
    camera.lookAt(middle);
    const slope = Math.tan(0.5 * kFov_rad);
    const turn = camera.quaternion.clone().invert();
    const corners = this.corners().map((corner) => corner.sub(middle).applyQuaternion(turn));
    // Returns, for one axis of the picture, the middle and the distance at which both borders are in view.
    const between = (axis: "x" | "y", slope: number): [number, number] => {
      const high = Math.max(...corners.map((corner) => corner[axis] + slope * corner.z));
      const low = Math.max(...corners.map((corner) => -corner[axis] + slope * corner.z));
      return [(high - low) / 2, (high + low) / (2 * slope)];
    };
    const [x, farX] = between("x", (slope * camera.aspect) / kRoom);
    const [y, farY] = between("y", slope / kRoom);
    const away = new THREE.Vector3(x, y, Math.max(farX, farY, 0.1 * this.radius_m));
    camera.position.copy(middle).add(away.applyQuaternion(camera.quaternion));
    this.pivot.copy(middle);
    this.changed();
  }

  goTo(place: readonly [number, number, number]): void {
    const target = new THREE.Vector3(...place).sub(this.origin);
    for (const side of this.sides) side.goTo(target);
    const start = this.camera.position.clone();
    const direction = this.camera.getWorldDirection(new THREE.Vector3());
    const near = Math.min(0.25 * this.radius_m, Math.max(start.distanceTo(target), 1e-6));
    const end = target.clone().addScaledVector(direction, -near);
    this.pivot.copy(target);
    this.stop();
    const flight = this.flight;
    const began = performance.now();
    const length_ms = matchMedia("(prefers-reduced-motion: reduce)").matches ? 0 : kMove_ms;
    const step = () => {
      if (flight !== this.flight) return;
      const spent_ms = performance.now() - began;
      const t = spent_ms < length_ms ? spent_ms / length_ms : 1;
      this.camera.position.lerpVectors(start, end, t * t * (3 - 2 * t));
      this.changed();
      if (t < 1) requestAnimationFrame(step);
    };
    step();
  }

  /** Ends a movement that goes on by itself. */
  stop(): void {
    ++this.flight;
  }

  poseRows(): number[][] {
    this.camera.updateMatrixWorld();
    const e = this.camera.matrixWorld.elements;
    const o = this.origin.toArray();
    const row = (i: 0 | 1 | 2) => [e[i]!, -e[4 + i]!, -e[8 + i]!, e[12 + i]! + o[i]];
    return [row(0), row(1), row(2), [0, 0, 0, 1]];
  }

  setPoseRows(rows: readonly (readonly number[])[], fovVertical_rad?: number): void {
    this.stop();
    const at = (i: number, j: number) => rows[i]?.[j] ?? (i === j ? 1 : 0);
    const turn = new THREE.Matrix4();
    turn.set(at(0, 0), -at(0, 1), -at(0, 2), 0, at(1, 0), -at(1, 1), -at(1, 2), 0, at(2, 0), -at(2, 1), -at(2, 2), 0, 0, 0, 0, 1);
    this.camera.quaternion.setFromRotationMatrix(turn);
    this.camera.position.set(at(0, 3), at(1, 3), at(2, 3)).sub(this.origin);
    if (fovVertical_rad !== undefined) this.camera.fov = (fovVertical_rad * 180) / Math.PI;
    const ahead = this.camera.getWorldDirection(new THREE.Vector3());
    const middle = this.box.getCenter(new THREE.Vector3()).sub(this.camera.position).dot(ahead);
    this.pivot.copy(this.camera.position).addScaledVector(ahead, Math.max(middle, 0.1 * this.radius_m));
    this.changed();
  }

  /** Planes as near to the scene as can be, for the depth's precision; matrices are right after it. */
  update(): void {
    const { camera } = this;
    camera.updateMatrixWorld();
    const ahead = camera.getWorldDirection(new THREE.Vector3());
    let near = Infinity;
    let far = -Infinity;
    for (const corner of this.corners()) {
      const depth = corner.sub(camera.position).dot(ahead);
      near = Math.min(near, depth);
      far = Math.max(far, depth);
    }
    const slack = (this.loose ? 3 : 0.02) * this.radius_m;
    camera.far = Math.max(far + slack, 0.1 * this.radius_m);
    camera.near = Math.max(near - slack, 1e-4 * camera.far, 1e-5 * this.radius_m);
    camera.updateProjectionMatrix();
  }

  /** Clip from world, in doubles. */
  clipWorld(): THREE.Matrix4 {
    const { x, y, z } = this.origin;
    return this.clipScene().multiply(new THREE.Matrix4().makeTranslation(-x, -y, -z));
  }

  clipScene(): THREE.Matrix4 {
    return new THREE.Matrix4().multiplyMatrices(this.camera.projectionMatrix, this.camera.matrixWorldInverse);
  }

  /** y where z is up; as cameras have it, z. */
  upFromAbove(): THREE.Vector3 {
    const side = Math.abs(this.up.y) < 0.9 ? new THREE.Vector3(0, 1, 0) : new THREE.Vector3(0, 0, -Math.sign(this.up.y));
    return side.addScaledVector(this.up, -side.dot(this.up)).normalize();
  }

  corners(): THREE.Vector3[] {
    const { min, max } = this.box;
    return Array.from({ length: 8 }, (_, i) => new THREE.Vector3(i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z));
  }

  private anySide(): THREE.Vector3 {
    const side = new THREE.Vector3(0.45, -1, 0.1);
    return side.addScaledVector(this.up, -side.dot(this.up)).normalize();
  }
}
