// SPDX-License-Identifier: Apache-2.0
// The layers of a document (docs/reference/protocol.md, Viewer) as things of the scene.
import * as THREE from "three";
import type { SceneCamera } from "./camera";
import { Frusta } from "./frusta";
import { type Gradual, gradualCubes, gradualOrder, gradualRange, kVoxelVertices, reordered } from "./gradual";
import { type LayerLook, type SharedUniforms, layerMaterial } from "./layer_material";
import { LayerReader } from "./layer_reader";
import { nearPixel } from "./near_pixel";
import type { CameraFrame, LayerInfo, LayerPick, SceneLayers } from "./types";

const kReach_px = 9;
const kPoint_px = 1.5; // half of a point, at least
const kSmoothTriangles = 2_000_000;
/** THREE's layers: what is shaded by depth, and what is drawn over it (lines, what one sees through). */
export const kBody = 0;
export const kOver = 1;

interface Layer {
  info: LayerInfo;
  object: THREE.Object3D;
  shown: boolean;
  gradual: Gradual | null;
  places: Float32Array | null; // where points are
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
    made.shown = info.visible !== false;
    const over = this.isTransparent(info) || info.kind === "lines" || info.kind === "views";
    made.object.traverse((object) => {
      object.frustumCulled = false;
      object.renderOrder = this.isTransparent(info) ? 1 : 0;
      object.layers.set(over ? kOver : kBody);
    });
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
    if (layer === undefined || layer.shown === visible) return;
    layer.shown = visible;
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
    for (const [id, { frusta, shown }] of this.layers) {
      if (frusta === null || !shown) continue;
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
      this.frame.layers.set(kOver);
      this.group.add(this.frame);
      this.view.loose = true;
    }
    this.changed();
  }

  /** Whether there is something that has a depth under the cursor. */
  get any(): boolean {
    return this.layers.size > 0;
  }

  /** Vertices of what is drawn piece by piece. */
  get work(): number {
    let sum = 0;
    for (const layer of this.layers.values()) if (layer.shown && !this.isTransparent(layer.info)) sum += layer.gradual?.work ?? 0;
    return sum;
  }

  /** Whether something shown is seen through: it can only be drawn when all that is behind it is there. */
  get seeThrough(): boolean {
    return [...this.layers.values()].some((layer) => layer.shown && this.isTransparent(layer.info));
  }

  /**
   * What is drawn next: of large opaque layers the pieces between these shares, of transparent ones all up to
   * `through`, small ones and lines where `rest` says so.
   */
  draw(from: number, to: number, through: number, rest: boolean): void {
    this.group.visible = true;
    if (this.frame !== null) this.frame.visible = rest;
    for (const { info, object, shown, gradual } of this.layers.values()) {
      const transparent = this.isTransparent(info);
      object.visible = shown && (transparent ? through > 0 : gradual !== null || rest);
      gradual?.draw(transparent ? 0 : from, transparent ? through : to);
    }
  }

  /** All that is shown but points: they are found by pointUnder(). */
  drawSurfaces(): void {
    this.draw(0, 1, 1, true);
    for (const { object, places } of this.layers.values()) if (places !== null) object.visible = false;
  }

  /** The nearest point of a layer that is drawn there, in the scene's coordinates. */
  pointUnder(x: number, y: number, size: readonly [number, number]): THREE.Vector3 | null {
    const reach_px = Math.max(0.5 * this.shared.size.value, kPoint_px);
    const clip_scene = this.view.clipScene();
    let best: Float32Array | null = null;
    let at = 0;
    let depth = Infinity;
    for (const { places, shown } of this.layers.values()) {
      if (places === null || !shown) continue;
      nearPixel(places, places.length / 3, clip_scene, x, y, reach_px, size, (vertex, depth_m) => {
        if (depth_m < depth) [best, at, depth] = [places, 3 * vertex, depth_m];
        return depth;
      });
    }
    return best === null ? null : new THREE.Vector3(best[at], best[at + 1], best[at + 2]);
  }

  dispose(): void {
    this.clear();
    this.setFrame(null);
  }

  private make(info: LayerInfo, buffer: ArrayBuffer): Layer | null {
    const reader = new LayerReader(buffer, this.view.origin);
    const plain = plainColor(info);
    const transparent = this.isTransparent(info);
    const colored = info.colors === true;
    const look = (shape: LayerLook["shape"], normals = false): THREE.RawShaderMaterial =>
      layerMaterial({ shape, colors: colored, normals, plain, size_m: info.size_m ?? 0, transparent }, this.shared);
    const layer = (object: THREE.Object3D, parts: Partial<Layer> = {}): Layer | null =>
      reader.short ? null : { info, object, shown: true, gradual: null, places: null, frusta: null, selected: null, ...parts };

    if (info.kind === "triangles") {
      const vertices = info.vertices ?? 0;
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(reader.places(vertices), 3));
      if (colored) geometry.setAttribute("color", new THREE.BufferAttribute(reader.colors(vertices), 4, true));
      const index = reader.numbers(3 * info.count);
      if (reader.short) return null;
      const order = gradualOrder(info.count, 3);
      geometry.setIndex(new THREE.BufferAttribute(order === null ? index : reordered(index, 3, order), 1));
      const smooth = info.count <= kSmoothTriangles;
      if (smooth) geometry.computeVertexNormals();
      return layer(new THREE.Mesh(geometry, look("surface", smooth)), { gradual: order && gradualRange(geometry, info.count, 3) });
    }
    if (info.kind === "views") {
      const poses = reader.floats(16 * info.count);
      const gains = reader.floats(info.count);
      if (reader.short) return null;
      const length_m = 0.07 * this.view.radius_m;
      const frusta = new Frusta(poses, gains, info.count, info.fov_rad ?? [0.8, 0.6], length_m, this.view.origin);
      return layer(this.lines(frusta.positions, frusta.colors, plain, transparent), { frusta });
    }
    const count = info.kind === "lines" ? 2 * info.count : info.count;
    const inFile = reader.places(count);
    const own = colored ? reader.colors(count) : null;
    const diameters = info.diameters === true ? reader.floats(count) : null;
    if (reader.short) return null;
    if (info.kind === "lines") return layer(this.lines(inFile, own, plain, transparent));
    const order = gradualOrder(count, info.kind === "points" ? 1 : kVoxelVertices);
    const ordered = <T extends Float32Array | Uint8Array>(entries: T, width: number): T =>
      order === null ? entries : reordered(entries, width, order);
    const places = ordered(inFile, 3);
    const colors = own && ordered(own, 4);
    if (info.kind === "points") {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(places, 3));
      if (colors !== null) geometry.setAttribute("color", new THREE.BufferAttribute(colors, 4, true));
      if (diameters !== null) geometry.setAttribute("diameter", new THREE.BufferAttribute(ordered(diameters, 1), 1));
      const shape = info.size_m !== undefined || diameters !== null ? "discs" : "squares";
      const material = layerMaterial(
        { shape, colors: colored, plain, size_m: info.size_m ?? 1, transparent, diameters: diameters !== null },
        this.shared,
      );
      return layer(new THREE.Points(geometry, material), { places, gradual: order && gradualRange(geometry, count, 1) });
    }
    const cube = new THREE.BoxGeometry(1, 1, 1);
    const material = look("cubes", true);
    const cubes = (from: number, to: number): THREE.Mesh => {
      const geometry = new THREE.InstancedBufferGeometry();
      geometry.setIndex(cube.getIndex());
      geometry.setAttribute("position", cube.getAttribute("position"));
      geometry.setAttribute("normal", cube.getAttribute("normal"));
      geometry.setAttribute("center", new THREE.InstancedBufferAttribute(places.subarray(3 * from, 3 * to), 3));
      if (colors !== null) geometry.setAttribute("color", new THREE.InstancedBufferAttribute(colors.subarray(4 * from, 4 * to), 4, true));
      geometry.instanceCount = to - from;
      return new THREE.Mesh(geometry, material);
    };
    if (order === null) return layer(cubes(0, count));
    const { object, gradual } = gradualCubes(cubes, count);
    return layer(object, { gradual });
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
  object.traverse((each) => {
    const { geometry, material } = each as Partial<THREE.Mesh>;
    geometry?.dispose();
    (material as THREE.Material | undefined)?.dispose();
  });
}
