// SPDX-License-Identifier: Apache-2.0
// The 3-D view: draws when something changed, a large cloud in steps none of which takes long.
import * as THREE from "three";
import { SceneCamera } from "./camera";
import { CloudView, type Stale } from "./cloud_view";
import { Controls } from "./controls";
import { EyeDome } from "./eye_dome";
import { kBody, kOver, Layers } from "./layers";
import { PixelProbe } from "./picking";
import { Pacer } from "./pacer";
import type { CameraFrame, Pick, PointerTool, SelectionPicture, Viewer } from "./types";

const kMoving_ms = 180; // since the camera moved last
const kReach_px = 5; // that the camera turns around a point, from the cursor
const kQuickPick = 1_000_000; // points that can be drawn for the camera's sake alone
const kLine_px = 1.75;
const kLight = 0xeceef2;
const kDark = 0x24272d;

/** `smooth`: edges of surfaces and lines are, at some cost; squares of points are drawn to the pixel without. */
export function createViewer(parent: HTMLElement, options: { smooth?: boolean } = {}): Viewer {
  return new SceneViewer(parent, options.smooth === true);
}

class SceneViewer implements Viewer {
  readonly element = document.createElement("div");
  readonly camera: SceneCamera;
  readonly cloud: CloudView;
  readonly layers: Layers;
  readonly stats = { frames: 0, lastFrame_ms: 0, vertices: 0, pictures: 0, lastPicture_ms: 0 };
  private renderer: THREE.WebGLRenderer;
  private scene = new THREE.Scene();
  private probe: PixelProbe;
  private controls: Controls;
  private pacer: Pacer;
  private eyeDome: EyeDome | null = null; // while surfaces are shaded
  private drawnMoving = false; // the picture was begun while the camera moved
  private resized: ResizeObserver;
  private stale: Stale = "all";
  private drawn = 0; // vertices of the cloud that are in the picture
  private began = 0; // when the picture was
  private movedAt = -Infinity;
  private asked = false;
  private disposed = false;

  constructor(parent: HTMLElement, smooth: boolean) {
    THREE.ColorManagement.enabled = false;
    this.element.style.cssText = "position:relative;width:100%;height:100%;overflow:hidden;outline:none;touch-action:none";
    this.element.tabIndex = 0;
    parent.append(this.element);
    // What is drawn stays, so that a picture can be refined.
    this.renderer = new THREE.WebGLRenderer({ antialias: smooth, preserveDrawingBuffer: true, powerPreference: "high-performance" });
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
    this.renderer.autoClear = false;
    const canvas = this.renderer.domElement;
    canvas.style.cssText = "display:block;width:100%;height:100%";
    this.element.append(canvas);
    canvas.addEventListener("webglcontextrestored", () => this.redraw());

    this.camera = new SceneCamera(() => this.moved());
    this.layers = new Layers(this.camera, this.element, () => this.redraw());
    this.cloud = new CloudView(this.camera, this.scene, (what) => this.ask(what));
    this.scene.add(this.layers.group);
    this.probe = new PixelProbe(this.renderer);
    this.pacer = new Pacer(this.renderer.getContext() as WebGL2RenderingContext);
    this.controls = new Controls(this.element, this.camera, (x, y) => this.under(x, y), () => this.moved());
    this.resized = new ResizeObserver(() => this.resize());
    this.resized.observe(this.element);
    this.watchRatio();
    this.setTheme(matchMedia("(prefers-color-scheme: dark)").matches);
    this.camera.fit();
  }

  redraw(): void {
    this.ask("all");
  }

  setBounds(bounds: readonly number[], up: readonly number[]): void {
    this.camera.setBounds(bounds, up, !this.layers.any && this.cloud.vertices === 0);
    this.redraw();
  }

  setFrame(frame: CameraFrame | null): void {
    this.layers.setFrame(frame);
  }

  pick(x: number, y: number): Pick | null {
    const size = this.size();
    const [px, py] = this.toPicture(x, y).map(Math.floor) as [number, number];
    if (px < 0 || py < 0 || px >= size[0] || py >= size[1]) return null;
    this.camera.update();
    this.layers.group.visible = false;
    this.cloud.beginPick(px + 0.5, py + 0.5, size, this.ratio);
    const bytes = this.probe.read(this.scene, this.camera.camera, px, py, size);
    this.layers.group.visible = true;
    return this.cloud.endPick(PixelProbe.number(bytes));
  }

  hover(x: number, y: number): Pick | null {
    this.camera.update();
    return this.cloud.hover(...this.toPicture(x, y), this.size(), this.ratio);
  }

  picture(): SelectionPicture {
    this.camera.update();
    const e = this.camera.clipWorld().elements;
    const clip_world = Array.from({ length: 16 }, (_, i) => e[4 * (i % 4) + Math.floor(i / 4)]!);
    return { size: this.size(), clip_world, point_size_px: this.cloud.size_px(this.ratio) };
  }

  toPicture(x: number, y: number): [number, number] {
    const size = this.size();
    return [(x * size[0]) / this.element.clientWidth, (y * size[1]) / this.element.clientHeight];
  }

  setPointerTool(tool: PointerTool | null): void {
    this.controls.setTool(tool);
  }

  setTheme(dark: boolean): void {
    this.renderer.setClearColor(dark ? kDark : kLight, 1);
    this.redraw();
  }

  setShading(shaded: boolean): void {
    if (shaded === (this.eyeDome !== null)) return;
    this.eyeDome?.dispose();
    this.eyeDome = shaded ? new EyeDome(this.renderer) : null;
    this.redraw();
  }

  dispose(): void {
    this.disposed = true;
    this.eyeDome?.dispose();
    this.resized.disconnect();
    this.controls.dispose();
    this.camera.stop();
    this.cloud.dispose();
    this.layers.dispose();
    this.probe.dispose();
    this.renderer.dispose();
    this.element.remove();
  }

  private get ratio(): number {
    return Math.min(window.devicePixelRatio || 1, 3);
  }

  private size(): [number, number] {
    const { width, height } = this.renderer.domElement;
    return [width, height];
  }

  /** Another screen may have other pixels. */
  private watchRatio(): void {
    if (this.disposed) return;
    this.resize();
    matchMedia(`(resolution: ${window.devicePixelRatio}dppx)`).addEventListener("change", () => this.watchRatio(), { once: true });
  }

  private resize(): void {
    const width = Math.max(1, Math.min(8192, Math.round(this.element.clientWidth * this.ratio)));
    const height = Math.max(1, Math.min(8192, Math.round(this.element.clientHeight * this.ratio)));
    const [oldWidth, oldHeight] = this.size();
    if (width !== oldWidth || height !== oldHeight) this.renderer.setSize(width, height, false);
    this.camera.camera.aspect = width / height;
    this.ask("all");
    // At once: a canvas of a new size is empty.
    if (!this.pacer.busy) this.step();
  }

  private ask(stale: Stale): void {
    if (stale === "all" || this.stale === "nothing") this.stale = stale;
    delete this.element.dataset["picture"];
    if (this.asked || this.disposed) return;
    this.asked = true;
    requestAnimationFrame(() => this.frame());
  }

  private frame(): void {
    this.asked = false;
    if (this.disposed) return;
    if (this.pacer.busy) this.ask("nothing");
    else this.step();
  }

  /** Draws the picture anew, or goes on with it: large layers first, then the cloud. */
  private step(): void {
    const { cloud, layers } = this;
    const began = performance.now();
    const moving = began - this.movedAt < kMoving_ms;
    // What is seen through was drawn over half a picture: at rest it comes last.
    const again = this.drawnMoving && !moving && this.eyeDome === null && layers.seeThrough;
    // Where only colours changed: the same squares once more over themselves, so that nothing flickers.
    const clear = this.stale === "all" || again;
    const anew = this.stale !== "nothing" || again;
    if (anew) this.drawn = 0;
    this.stale = "nothing";
    const work = layers.work;
    const all = work + cloud.vertices;
    const from = this.drawn;
    const to = this.pacer.upTo(from, all, moving);
    if (!anew && to === from) return this.tell();

    if (anew) {
      this.began = began;
      this.drawnMoving = moving && to < all;
      this.camera.update();
    }
    const size = this.size();
    const { shared } = layers;
    shared.height.value = size[1];
    shared.picture.value.set(...size);
    shared.width.value = kLine_px * this.ratio;
    shared.size.value = cloud.size_px(this.ratio);
    const share = (vertices: number) => (work > 0 ? Math.min(vertices / work, 1) : vertices > 0 || all === 0 ? 1 : 0);
    const through = moving || this.eyeDome !== null ? (all > 0 ? to / all : 1) : to === all ? 1 : 0;
    layers.draw(share(from), share(to), through, anew || this.eyeDome !== null);
    cloud.draw(Math.max(from - work, 0), Math.max(to - work, 0), size, this.ratio);
    this.render(clear, size);
    const vertices = to - from;
    this.drawn = to;
    this.pacer.drew(vertices, (ms) => {
      ++this.stats.frames;
      this.stats.lastFrame_ms = ms;
      this.stats.vertices = to;
      const complete = to === layers.work + cloud.vertices;
      if (complete) {
        ++this.stats.pictures;
        this.stats.lastPicture_ms = performance.now() - this.began;
      }
      if (this.stale !== "nothing") this.ask("nothing");
      else if (!complete && !this.disposed) this.step();
      else if (!this.asked) this.tell();
    });
  }

  private render(clear: boolean, size: readonly [number, number]): void {
    const { renderer, eyeDome } = this;
    const { camera } = this.camera;
    if (eyeDome === null) {
      camera.layers.enableAll();
      if (clear) renderer.clear();
      renderer.render(this.scene, camera);
      return;
    }
    camera.layers.set(kBody);
    eyeDome.begin(size, clear);
    renderer.render(this.scene, camera);
    eyeDome.compose(camera, this.ratio);
    camera.layers.set(kOver);
    renderer.render(this.scene, camera);
    camera.layers.enableAll();
  }

  /** The picture is complete, and as everything was asked to be: its number is in the element until that changes. */
  private tell(): void {
    this.element.dataset["picture"] = String(this.stats.pictures);
  }

  private moved(): void {
    this.movedAt = performance.now();
    this.redraw();
  }

  private under(x: number, y: number): THREE.Vector3 | null {
    this.camera.update();
    const found =
      this.cloud.treeReady || this.cloud.vertices > kQuickPick
        ? (this.hover(x, y) ?? this.cloud.hover(...this.toPicture(x, y), this.size(), this.ratio, kReach_px))
        : this.pick(x, y);
    const point = found === null ? null : new THREE.Vector3(...found.position).sub(this.camera.origin);
    const { position } = this.camera.camera;
    const places = this.layers.any ? [this.layerUnder(x, y), this.layers.pointUnder(...this.toPicture(x, y), this.size())] : [];
    let nearest = point;
    for (const place of places) {
      if (place === null || (nearest !== null && position.distanceTo(nearest) <= position.distanceTo(place))) continue;
      nearest = place;
    }
    return nearest;
  }

  /** The place on a layer. */
  private layerUnder(x: number, y: number): THREE.Vector3 | null {
    const size = this.size();
    const [px, py] = this.toPicture(x, y).map(Math.floor) as [number, number];
    this.camera.update();
    this.layers.shared.as_depth.value = true;
    this.layers.drawSurfaces();
    this.cloud.hide();
    const [a, b, c, seen] = this.probe.read(this.scene, this.camera.camera, px, py, size) as unknown as number[];
    this.layers.shared.as_depth.value = false;
    if (seen === 0) return null;
    const depth = (a! + 256 * b! + 65536 * c!) / 16777215;
    const place = new THREE.Vector3((2 * (px + 0.5)) / size[0] - 1, 1 - (2 * (py + 0.5)) / size[1], 2 * depth - 1);
    return place.unproject(this.camera.camera);
  }
}
