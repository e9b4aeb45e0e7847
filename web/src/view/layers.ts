// SPDX-License-Identifier: Apache-2.0
// The layers of a document (docs/protocol.md, Viewer) as things of the scene.
import * as THREE from "three";
import type { SceneCamera } from "./camera";
import { Frusta } from "./frusta";
import { type LayerLook, type SharedUniforms, layerMaterial } from "./layer_material";
import type { CameraFrame, LayerInfo, LayerPick, SceneLayers } from "./types";

const kReach_px = 9;
const kSmoothTriangles = 2_000_000;

interface Layer {
  info: LayerInfo;
  object: THREE.Object3D;
  frusta: Frusta | null;
  selected: number | null;
}

export class Layers implements SceneLayers {
  readonly group = new THREE.Group();
  readonly shared: SharedUniforms = {
    size: { value: 3 },
    height: { value: 1 },
    picture: { value: new THREE.Vector2(1, 1) },
    width: { value: 1.5 },
    as_depth: { value: false },
  };
  private layers = new Map<string, Layer>();
  private frame: THREE.Mesh | null = null;

  constructor(
    private view: SceneCamera,
    private element: HTMLElement,
    private changed: () => void,
  ) {}

  add(info: LayerInfo, buffer: ArrayBuffer): boolean {
    const made = this.make(info, buffer);
    if (made === null) return false;
    this.remove(info.id);
    made.object.visible = info.visible !== false;
    made.object.renderOrder = this.isTransparent(info) ? 1 : 0;
    made.object.traverse((object) => (object.frustumCulled = false));
    this.layers.set(info.id, made);
    this.view.loose = true;
    this.group.add(made.object);
    this.changed();
    return true;
  }

  remove(id: string): void {
    const layer = this.layers.get(id);
    if (layer === undefined) return;
    this.layers.delete(id);
    this.group.remove(layer.object);
    release(layer.object);
    this.changed();
  }

  clear(): void {
    for (const id of this.ids()) this.remove(id);
  }

  has(id: string): boolean {
    return this.layers.has(id);
  }

  ids(): string[] {
    return [...this.layers.keys()];
  }

  show(id: string, visible: boolean): void {
    const layer = this.layers.get(id);
    if (layer === undefined || layer.object.visible === visible) return;
    layer.object.visible = visible;
    this.changed();
  }

  select(id: string, item: number | null): void {
    const layer = this.layers.get(id);
    if (layer?.frusta == null) return;
    if (layer.selected !== null) layer.frusta.paint(layer.selected, false);
    const known = item !== null && item >= 0 && item < layer.frusta.count;
    if (known) layer.frusta.paint(item, true);
    layer.selected = known ? item : null;
    (layer.object as THREE.Mesh).geometry.getAttribute("begin_color").needsUpdate = true;
    this.changed();
  }

  pickView(x: number, y: number): LayerPick | null {
    this.view.update();
    const clip_scene = this.view.clipScene();
    const [width, height] = [this.element.clientWidth, this.element.clientHeight];
    const reach = [(2 * kReach_px) / width, (2 * kReach_px) / height] as const;
    let best: (LayerPick & { depth: number }) | null = null;
    for (const [id, { frusta, object }] of this.layers) {
      if (frusta === null || !object.visible) continue;
      const found = frusta.at((2 * x) / width - 1, 1 - (2 * y) / height, clip_scene, reach);
      if (found === null || (best !== null && best.depth <= found.depth)) continue;
      const tip = new THREE.Vector3(...frusta.tip(found.item)).add(this.view.origin);
      best = { layer: id, item: found.item, position: tip.toArray(), depth: found.depth };
    }
    return best === null ? null : { layer: best.layer, item: best.item, position: best.position };
  }

  setFrame(frame: CameraFrame | null): void {
    if (this.frame !== null) {
      this.group.remove(this.frame);
      release(this.frame);
      this.frame = null;
    }
    if (frame !== null) {
      const poses = frame.poseRows.flat();
      const frusta = new Frusta(poses, [NaN], 1, frame.fov_rad, 0.16 * this.view.radius_m, this.view.origin);
      frusta.paint(0, true);
      this.frame = this.lines(frusta.positions, frusta.colors, new THREE.Vector4(1, 1, 1, 1), false);
      this.group.add(this.frame);
      this.view.loose = true;
    }
    this.changed();
  }

  /** Whether there is something that has a depth under the cursor. */
  get any(): boolean {
    return this.layers.size > 0;
  }

  dispose(): void {
    this.clear();
    this.setFrame(null);
  }

  private make(info: LayerInfo, buffer: ArrayBuffer): Layer | null {
    const reader = new Reader(buffer, this.view.origin);
    const plain = plainColor(info);
    const transparent = this.isTransparent(info);
    const colored = info.colors === true;
    const look = (shape: LayerLook["shape"], normals = false): THREE.RawShaderMaterial =>
      layerMaterial({ shape, colors: colored, normals, plain, size_m: info.size_m ?? 0, transparent }, this.shared);
    const layer = (object: THREE.Object3D, frusta: Frusta | null = null): Layer | null =>
      reader.short ? null : { info, object, frusta, selected: null };

    if (info.kind === "triangles") {
      const vertices = info.vertices ?? 0;
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(reader.places(vertices), 3));
      if (colored) geometry.setAttribute("color", new THREE.BufferAttribute(reader.colors(vertices), 4, true));
      geometry.setIndex(new THREE.BufferAttribute(reader.numbers(3 * info.count), 1));
      const smooth = info.count <= kSmoothTriangles && !reader.short;
      if (smooth) geometry.computeVertexNormals();
      return layer(new THREE.Mesh(geometry, look("surface", smooth)));
    }
    if (info.kind === "views") {
      const poses = reader.floats(16 * info.count);
      const gains = reader.floats(info.count);
      if (reader.short) return null;
      const length_m = 0.07 * this.view.radius_m;
      const frusta = new Frusta(poses, gains, info.count, info.fov_rad ?? [0.8, 0.6], length_m, this.view.origin);
      return layer(this.lines(frusta.positions, frusta.colors, plain, transparent), frusta);
    }
    const count = info.kind === "lines" ? 2 * info.count : info.count;
    const places = reader.places(count);
    const colors = colored ? reader.colors(count) : null;
    if (reader.short) return null;
    if (info.kind === "lines") return layer(this.lines(places, colors, plain, transparent));
    if (info.kind === "points") {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(places, 3));
      if (colors !== null) geometry.setAttribute("color", new THREE.BufferAttribute(colors, 4, true));
      return layer(new THREE.Points(geometry, look("squares")));
    }
    const cube = new THREE.BoxGeometry(1, 1, 1);
    const geometry = new THREE.InstancedBufferGeometry();
    geometry.setIndex(cube.getIndex());
    geometry.setAttribute("position", cube.getAttribute("position"));
    geometry.setAttribute("normal", cube.getAttribute("normal"));
    geometry.setAttribute("center", new THREE.InstancedBufferAttribute(places, 3));
    if (colors !== null) geometry.setAttribute("color", new THREE.InstancedBufferAttribute(colors, 4, true));
    geometry.instanceCount = info.count;
    return layer(new THREE.Mesh(geometry, look("cubes", true)));
  }

  private lines(places: Float32Array, colors: Uint8Array | null, plain: THREE.Vector4, transparent: boolean) {
    const geometry = new THREE.InstancedBufferGeometry();
    geometry.setIndex([0, 1, 2, 2, 1, 3]);
    geometry.setAttribute("position", new THREE.Float32BufferAttribute([0, -1, 0, 0, 1, 0, 1, -1, 0, 1, 1, 0], 3));
    const ends = new THREE.InstancedInterleavedBuffer(places, 6);
    geometry.setAttribute("begin", new THREE.InterleavedBufferAttribute(ends, 3, 0));
    geometry.setAttribute("end", new THREE.InterleavedBufferAttribute(ends, 3, 3));
    if (colors !== null) {
      const both = new THREE.InstancedInterleavedBuffer(colors, 8);
      geometry.setAttribute("begin_color", new THREE.InterleavedBufferAttribute(both, 4, 0, true));
      geometry.setAttribute("end_color", new THREE.InterleavedBufferAttribute(both, 4, 4, true));
    }
    geometry.instanceCount = places.length / 6;
    const look = { shape: "lines", colors: colors !== null, plain, size_m: 0, transparent } as const;
    const object = new THREE.Mesh(geometry, layerMaterial(look, this.shared));
    object.frustumCulled = false;
    return object;
  }

  private isTransparent(info: LayerInfo): boolean {
    return (info.opacity ?? 1) < 1;
  }
}

function plainColor(info: LayerInfo): THREE.Vector4 {
  const color = new THREE.Color(info.color ?? "#9aa4b2");
  return new THREE.Vector4(color.r, color.g, color.b, info.opacity ?? 1);
}

function release(object: THREE.Object3D): void {
  const { geometry, material } = object as THREE.Mesh;
  geometry.dispose();
  (material as THREE.Material).dispose();
}

/** Arrays of a buffer one after the other; `short` where it ended before them. */
class Reader {
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
