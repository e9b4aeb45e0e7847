// SPDX-License-Identifier: Apache-2.0
// The cloud in the scene: its points, control points, marks, and what of them is under the cursor.
import * as THREE from "three";
import type { SceneCamera } from "./camera";
import { ControlPoints, kControlBit } from "./control_points";
import { HoverTree } from "./hover";
import { Boxes } from "./boxes";
import { kOver } from "./layers";
import { PointCloud } from "./points";
import { Ring } from "./ring";
import { nearPixel } from "./near_pixel";
import type { Eye } from "./side_camera";
import { type SeenFrom, Tiles } from "./tiles";
import type { CloudInfo, CloudLayer, ControlPlace, LabelBox, Octree, Painter, Pick, PointChunk, Rgb } from "./types";

/** Part of the picture that must be drawn again. */
export type Stale = "nothing" | "colors" | "all";

const kSphere_spacings = 1.4; // radius of a control point's sphere, where it is not too small or large on the screen
const kWake_ms = 60; // after the camera moved
const kFinest_sizes = 0.5; // distance of points that is fine enough, of the edge of their squares
const kNoCloud: CloudInfo = { points: 0, shown: 0, bounds: [], up: [], spacing_m: 0 };

export class CloudView implements CloudLayer {
  private points = new PointCloud();
  private controls = new ControlPoints(this.points);
  private ring = new Ring();
  private boxes = new Boxes();
  private few = new THREE.Points(); // some points, in the id buffer
  private tree = new HoverTree();
  private hoverReady = (): void => {};
  private tiles: Tiles | null = null;
  private wake: (() => void) | null = null;
  private waking = 0;
  private pictures: readonly SeenFrom[];
  private eye: Eye; // camera of the picture that is drawn or looked into
  private shown = { cloud: true, labels: true, controls: true };
  private painter: Painter | null = null;
  private clip: { low: readonly number[]; high: readonly number[] } | null = null;
  private size = 4;
  private spacing_m = 0; // distance between neighbouring vertices

  constructor(
    private view: SceneCamera,
    private scene: THREE.Scene,
    private changed: (what: Stale) => void,
  ) {
    this.eye = view;
    this.pictures = [{ eye: view, height_px: 800 }];
    this.few.frustumCulled = false;
    this.few.visible = false;
    this.ring.object.layers.set(kOver);
    this.boxes.object.layers.set(kOver);
    this.scene.add(this.few, this.ring.object, this.boxes.object);
    this.replace(kNoCloud);
  }

  get vertices(): number {
    return this.points.vertices;
  }

  get treeReady(): boolean {
    return this.tree.ready || this.tiles !== null;
  }

  onHoverReady(run: () => void): void {
    this.hoverReady = run;
  }

  /** The pictures that the cloud is seen in. */
  setPictures(pictures: readonly SeenFrom[]): void {
    this.pictures = pictures;
    this.moved();
  }

  /** Sets the camera of the picture that is drawn or looked into next. Expects that it is up to date. */
  lookFrom(eye: Eye): void {
    this.eye = eye;
  }

  begin(cloud: CloudInfo): void {
    this.view.setBounds(cloud.bounds, cloud.up, true);
    this.replace(cloud);
    this.controls.setRadius_m(kSphere_spacings * cloud.spacing_m);
    const share = cloud.tiles === undefined ? cloud.points / Math.max(cloud.shown, 1) : 1;
    this.spacing_m = cloud.spacing_m * Math.sqrt(share); // they lie on surfaces
    this.view.fit();
  }

  append(chunk: PointChunk): void {
    this.points.append(chunk);
    this.changed("nothing"); // the picture is gone on with
    if (this.tiles === null && this.points.vertices === this.points.room) this.buildTree();
  }

  beginTiles(octree: Octree, vertices: number, wake: () => void): void {
    this.tiles = new Tiles(octree, this.points.origin, vertices);
    this.wake = wake;
    this.points.beginTiles(this.tiles.room.vertices);
  }

  nextTiles(mostPoints: number): { nodes: number[]; drop: number[] } | null {
    if (this.tiles === null) return null;
    for (const { eye } of this.pictures) eye.update();
    const next = this.tiles.next(this.pictures, Math.max(1, kFinest_sizes * this.size), mostPoints);
    const freed = this.tiles.takeFreed();
    for (const run of freed) this.points.clear(run);
    if (freed.length > 0) this.changed("all");
    return next;
  }

  addTiles(nodes: readonly number[], chunk: PointChunk): void {
    const before = this.points.vertices;
    let behind = true; // what was drawn already
    let begin = 0;
    for (const node of nodes) {
      let at = begin;
      for (const run of this.tiles?.arrived(node) ?? []) {
        behind &&= run.at >= before;
        this.points.place(chunk, at, run);
        at += run.count;
      }
      begin += this.tiles?.countOf(node) ?? 0;
    }
    this.changed(behind ? "nothing" : "colors");
  }

  heldTiles(): { node: number; count: number }[] {
    return [...(this.tiles?.held.keys() ?? [])].map((node) => ({ node, count: this.tiles!.countOf(node) }));
  }

  dropTiles(): void {
    this.tiles?.drop();
    this.changed("all");
  }

  setTileMargins(nodes: readonly number[], margins: Uint8Array): void {
    let at = 0;
    for (const node of nodes) {
      for (const run of this.tiles?.held.get(node) ?? []) {
        this.points.setMarginsOf(run, margins.subarray(at, at + run.count));
        at += run.count;
      }
    }
    this.changed("colors");
  }

  /** Other tiles may be wanted. */
  moved(): void {
    if (this.wake === null || this.waking !== 0) return;
    this.waking = window.setTimeout(() => {
      this.waking = 0;
      this.wake?.();
    }, kWake_ms);
  }

  setPainter(painter: Painter | null): void {
    this.painter = painter;
    this.points.setPainter(painter);
    this.changed("colors");
  }

  setLabel(label: number, points: Uint32Array): void {
    this.points.setLabel(label, points);
    this.changed("colors");
  }

  setLabelColor(label: number, color: Rgb): void {
    this.points.setLabelColor(label, color);
    this.changed("colors");
  }

  setLabelVisible(label: number, visible: boolean): void {
    this.points.palette.setVisible(label, visible);
    this.changed("all");
  }

  setBoxes(boxes: readonly LabelBox[]): void {
    this.boxes.set(boxes, this.view.origin.toArray());
    this.changed("all");
  }

  setClip(box: { low: readonly number[]; high: readonly number[] } | null): void {
    this.clip = box;
    this.points.setClip(box);
    this.changed("all");
  }

  labelOf(point: number): number {
    return this.points.labelOf(point);
  }

  positionOf(point: number): readonly [number, number, number] | undefined {
    return this.points.positionOf(point);
  }

  setControlPoint(control: ControlPlace): void {
    this.controls.set(control);
    this.changed("all");
  }

  clearControlPoints(): void {
    this.controls.clear();
    this.changed("all");
  }

  setMargins(margins: Uint8Array | null): void {
    this.points.setMargins(margins);
    this.changed("colors");
  }

  highlight(points: Uint32Array): void {
    this.points.highlight(points);
    this.changed("colors");
  }

  mark(place: readonly [number, number, number] | null): void {
    const { x, y, z } = this.view.origin;
    this.ring.set(place && [place[0] - x, place[1] - y, place[2] - z]);
    this.changed("all");
  }

  show(what: { cloud: boolean; labels: boolean; controls: boolean }): void {
    this.shown = { ...what };
    this.changed("all");
  }

  get pointSize(): number {
    return this.size;
  }

  set pointSize(px: number) {
    this.size = Math.min(Math.max(px, 1), 16);
    this.moved();
    this.changed("all");
  }

  /** Edge of the squares in pixels of the picture. */
  size_px(ratio: number): number {
    return Math.min(Math.max(Math.round(this.size * ratio), 1), 64);
  }

  /** Sets the scene up for vertices `from` to `to` and what is not points. */
  draw(from: number, to: number, size: readonly [number, number], ratio: number): void {
    const { cloud, labels, controls } = this.shown;
    const mode = cloud && labels ? "both" : cloud ? "cloud" : "labels";
    this.points.uniforms.spacing.value = 0.5 * size[1] * this.eye.camera.projectionMatrix.elements[5]! * this.spacing_m;
    this.points.draw(mode, this.size_px(ratio), from, cloud || labels ? to : from);
    this.controls.draw(false, size[1], ratio);
    this.controls.object.visible &&= controls;
    this.ring.draw(ratio);
    this.boxes.draw();
  }

  /** Until draw(): nothing of it. */
  hide(): void {
    this.points.object.visible = false;
    this.controls.object.visible = false;
    this.ring.object.visible = false;
    this.boxes.object.visible = false;
  }

  /** Sets the scene up for the id buffer of one pixel. */
  beginPick(x: number, y: number, size: readonly [number, number], ratio: number): void {
    const { cloud, labels, controls } = this.shown;
    this.points.draw("id", this.size_px(ratio), 0, cloud || labels ? this.points.vertices : 0);
    this.controls.draw(true, size[1], ratio);
    this.controls.object.visible &&= controls;
    this.ring.object.visible = false;
    this.boxes.object.visible = false;
    if (!this.points.object.visible) return;
    const near: number[] = [];
    const half_px = 0.5 * this.size_px(ratio) + 1;
    this.around(x, y, half_px, size, (vertex) => {
      near.push(vertex);
      return Infinity;
    });
    near.sort((a, b) => a - b); // the later one of two at one place is seen
    const all = this.points.object;
    for (const name of ["position", "color", "state"]) this.few.geometry.setAttribute(name, all.geometry.getAttribute(name));
    this.few.geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(near), 1));
    this.few.material = all.material;
    this.few.visible = near.length > 0;
    all.visible = false;
  }

  endPick(number: number | undefined): Pick | null {
    this.few.visible = false;
    if (number === undefined) return null;
    // id() of a sphere has the highest bit; it came less one.
    const control = number >= kControlBit;
    const point = control
      ? this.controls.pointOfVertex(number - kControlBit)
      : this.points.pointOfVertex(number);
    return this.pickOf(point, control);
  }

  /** `reach_px`: how far from a point's middle it is found, at least. */
  hover(x: number, y: number, size: readonly [number, number], ratio: number, reach_px = 0): Pick | null {
    if (!this.treeReady && reach_px === 0) return null; // asked for at every move of the mouse
    const clip_scene = this.eye.clipScene();
    let vertex = -1;
    let depth = Infinity;
    if (this.shown.cloud || this.shown.labels) {
      const half_px = Math.max(0.5 * this.size_px(ratio), reach_px * ratio);
      this.around(x, y, half_px, size, (candidate, at) => {
        if (at < depth && this.points.isDrawn(candidate)) {
          vertex = candidate;
          depth = at;
        }
        return depth;
      });
    }
    const sphere = this.shown.controls ? this.controls.at(x, y, clip_scene, size[0], size[1], ratio) : null;
    if (sphere !== null && sphere.depth_m <= depth) return this.pickOf(sphere.point, true);
    return vertex < 0 ? null : this.pickOf(this.points.pointOfVertex(vertex), false);
  }

  dispose(): void {
    this.tree.dispose();
    this.controls.dispose();
    this.points.dispose();
    this.ring.dispose();
    this.boxes.dispose();
    this.few.geometry.dispose();
  }

  private pickOf(point: number | undefined, control: boolean): Pick | null {
    if (point === undefined) return null;
    const position = control ? this.controls.positionOf(point) : this.points.positionOf(point);
    return position === undefined ? null : { point, control, position };
  }

  /** By the tree; until it is there, by looking at all vertices, which takes some 10 ms a million. */
  private around(x: number, y: number, half_px: number, size: readonly [number, number], found: (vertex: number, depth_m: number) => number): void {
    const clip_scene = this.eye.clipScene();
    const { positions, vertices } = this.points;
    if (this.tiles !== null) {
      this.tiles.near(clip_scene, x, y, half_px, size, ({ at, count }) => {
        const places = positions.subarray(3 * at, 3 * (at + count));
        nearPixel(places, count, clip_scene, x, y, half_px, size, (vertex, depth_m) => found(at + vertex, depth_m));
      });
    } else if (this.tree.ready) this.tree.around(x, y, half_px, clip_scene, size, found);
    else nearPixel(positions, vertices, clip_scene, x, y, half_px, size, found);
  }

  private buildTree(): void {
    this.tree.build(this.points.positions, () => this.hoverReady());
  }

  private replace(cloud: CloudInfo): void {
    this.scene.remove(this.points.object, this.controls.object);
    this.controls.dispose();
    this.points.dispose();
    this.tree.clear();
    this.tiles = null;
    this.wake = null;
    this.ring.set(null);
    this.few.geometry.dispose();
    this.few.geometry = new THREE.BufferGeometry();
    this.points = new PointCloud(this.view.origin.toArray());
    this.points.begin(cloud);
    this.points.setPainter(this.painter);
    this.points.setClip(this.clip);
    this.controls = new ControlPoints(this.points);
    this.controls.object.renderOrder = 1;
    this.controls.object.layers.set(kOver);
    this.scene.add(this.points.object, this.controls.object);
    this.changed("all");
  }
}
