// SPDX-License-Identifier: Apache-2.0
// The 3-D view: draws when something changed, a large cloud in steps none of which takes long.
import * as THREE from "three";
import { SceneCamera } from "./camera";
import { CloudView, type Stale } from "./cloud_view";
import { Controls, type Stage } from "./controls";
import { EyeDome } from "./eye_dome";
import { kBody, kOver, Layers } from "./layers";
import { PixelProbe } from "./picking";
import { Pacer } from "./pacer";
import { type Pane, Panes } from "./panes";
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
  private eyeDomes: EyeDome[] | null = null; // one for each view, while surfaces are shaded
  private panes: Panes;
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
    this.panes = new Panes(this.camera);
    this.camera.follow(this.panes.sides);
    this.layers = new Layers(this.camera, this.element, () => this.redraw());
    this.cloud = new CloudView(this.camera, this.scene, (what) => this.ask(what));
    this.scene.add(this.layers.group);
    this.probe = new PixelProbe(this.renderer);
    this.pacer = new Pacer(this.renderer.getContext() as WebGL2RenderingContext);
    this.controls = new Controls(this.element, this.camera, this.stage(), (x, y) => this.under(x, y), () => this.moved());
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

  setFour(four: boolean): void {
    this.panes.show(four);
    this.eyeDomes?.forEach((each) => each.dispose());
    this.eyeDomes &&= this.panes.all.map(() => new EyeDome(this.renderer));
    this.element.dataset["pane"] = this.panes.active.name;
    this.seen();
    this.redraw();
  }

  fit(): void {
    for (const side of this.panes.sides) side.fit();
    this.camera.fit();
  }

  pick(x: number, y: number): Pick | null {
    const { pane, at } = this.lookInto(x, y);
    const [px, py] = at.map(Math.floor) as [number, number];
    if (px < 0 || py < 0 || px >= pane.width || py >= pane.height) return null;
    const size = [pane.width, pane.height] as const;
    this.layers.group.visible = false;
    this.cloud.beginPick(px + 0.5, py + 0.5, size, this.ratio);
    const bytes = this.probe.read(this.scene, pane.eye.camera, px, py, size);
    this.layers.group.visible = true;
    return this.cloud.endPick(PixelProbe.number(bytes));
  }

  hover(x: number, y: number): Pick | null {
    return this.near(x, y, 0);
  }

  picture(): SelectionPicture {
    const { eye, width, height } = this.panes.active;
    eye.update();
    const e = eye.clipWorld().elements;
    const clip_world = Array.from({ length: 16 }, (_, i) => e[4 * (i % 4) + Math.floor(i / 4)]!);
    return { size: [width, height], clip_world, point_size_px: this.cloud.size_px(this.ratio) };
  }

  toPicture(x: number, y: number): [number, number] {
    const [u, v] = this.toCanvas(x, y);
    return [u - this.panes.active.x, v - this.panes.active.y];
  }

  setPointerTool(tool: PointerTool | null): void {
    this.controls.setTool(tool);
  }

  setTheme(dark: boolean): void {
    this.renderer.setClearColor(dark ? kDark : kLight, 1);
    this.redraw();
  }

  setShading(shaded: boolean): void {
    if (shaded === (this.eyeDomes !== null)) return;
    this.eyeDomes?.forEach((each) => each.dispose());
    this.eyeDomes = shaded ? this.panes.all.map(() => new EyeDome(this.renderer)) : null;
    this.redraw();
  }

  dispose(): void {
    this.disposed = true;
    this.eyeDomes?.forEach((each) => each.dispose());
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

  private toCanvas(x: number, y: number): [number, number] {
    const size = this.size();
    return [(x * size[0]) / this.element.clientWidth, (y * size[1]) / this.element.clientHeight];
  }

  /** The view under the cursor, ready to be looked into, and the pixel there. */
  private lookInto(x: number, y: number): { pane: Pane; at: [number, number] } {
    const [u, v] = this.toCanvas(x, y);
    const pane = this.panes.at(u, v);
    pane.eye.update();
    this.cloud.lookFrom(pane.eye);
    return { pane, at: [u - pane.x, v - pane.y] };
  }

  private near(x: number, y: number, reach_px: number): Pick | null {
    const { pane, at } = this.lookInto(x, y);
    return this.cloud.hover(...at, [pane.width, pane.height], this.ratio, reach_px);
  }

  private stage(): Stage {
    const { panes } = this;
    const at = (x: number, y: number) => panes.at(...this.toCanvas(x, y));
    const css = () => this.element.clientWidth / this.size()[0];
    return {
      enter: (x, y) => {
        panes.active = at(x, y);
        this.element.dataset["pane"] = panes.active.name;
      },
      isIn: (x, y) => at(x, y) === panes.active,
      get side() {
        return panes.active.side;
      },
      get area() {
        const { x, y, width, height } = panes.active;
        return { left: x * css(), top: y * css(), width: width * css(), height: height * css() };
      },
    };
  }

  /** Tells the cloud in which pictures it is seen. */
  private seen(): void {
    this.cloud.setPictures(this.panes.all.map(({ eye, height }) => ({ eye, height_px: height })));
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
    this.panes.layOut(width, height);
    this.seen();
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
    const shaded = this.eyeDomes !== null;
    const again = this.drawnMoving && !moving && !shaded && layers.seeThrough;
    // Where only colours changed: the same squares once more over themselves, so that nothing flickers.
    const clear = this.stale === "all" || again;
    const anew = this.stale !== "nothing" || again;
    if (anew) this.drawn = 0;
    this.stale = "nothing";
    const work = layers.work;
    const all = work + cloud.vertices;
    const from = this.drawn;
    const views = this.panes.all.length; // each draws all
    const to = Math.min(all, Math.ceil(this.pacer.upTo(views * from, views * all, moving) / views));
    if (!anew && to === from) return this.tell();

    if (anew) {
      this.began = began;
      this.drawnMoving = moving && to < all;
      for (const { eye } of this.panes.all) eye.update();
    }
    const { shared } = layers;
    shared.width.value = kLine_px * this.ratio;
    shared.size.value = cloud.size_px(this.ratio);
    const share = (vertices: number) => (work > 0 ? Math.min(vertices / work, 1) : vertices > 0 || all === 0 ? 1 : 0);
    const through = moving || shaded ? (all > 0 ? to / all : 1) : to === all ? 1 : 0;
    layers.draw(share(from), share(to), through, anew || shaded);
    this.panes.all.forEach((pane, i) => {
      const size = [pane.width, pane.height] as const;
      shared.height.value = size[1];
      shared.picture.value.set(...size);
      cloud.lookFrom(pane.eye);
      cloud.draw(Math.max(from - work, 0), Math.max(to - work, 0), size, this.ratio);
      this.render(clear, pane, this.eyeDomes?.[i] ?? null);
    });
    this.drawn = to;
    this.pacer.drew(views * (to - from), (ms) => {
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

  private render(clear: boolean, { eye: { camera }, x, y, width, height }: Pane, eyeDome: EyeDome | null): void {
    const { renderer } = this;
    const below = this.size()[1] - y - height;
    renderer.setViewport(x, below, width, height);
    renderer.setScissor(x, below, width, height);
    renderer.setScissorTest(this.panes.four);
    if (eyeDome === null) {
      camera.layers.enableAll();
      if (clear) renderer.clear();
      renderer.render(this.scene, camera);
      return;
    }
    camera.layers.set(kBody);
    eyeDome.begin([width, height], clear);
    renderer.render(this.scene, camera);
    eyeDome.compose(camera, this.ratio, [x, below]);
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
    this.cloud.moved();
    this.redraw();
  }

  private under(x: number, y: number): THREE.Vector3 | null {
    this.camera.update();
    const found = this.cloud.treeReady || this.cloud.vertices > kQuickPick ? (this.hover(x, y) ?? this.near(x, y, kReach_px)) : this.pick(x, y);
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
