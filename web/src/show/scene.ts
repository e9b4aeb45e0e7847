// SPDX-License-Identifier: Apache-2.0
// What is in the 3-D view: the layers of a step, fetched first and exchanged at once.
import type { CameraFrame, Viewer } from "../view/types";
import type { BufferCache } from "./buffers";
import { bufferBytes, fovOf, type Layer, layersOf, type SceneDocument } from "./document";
import { candidatesOf, type Candidates, poseOf } from "./gains";
import type { Look } from "./look_of_layers";
import { fieldBytes, fieldOf, painted } from "./paint";
import type { Scale } from "../view/ramp";
import { trailOf } from "./trail";

interface Data {
  own: ArrayBuffer; // the layer's
  values: ArrayBuffer | null; // those of the field that it is coloured by
}

export class Scene {
  private turn = 0;
  private readonly shown = new Map<string, string>(); // what the view has, id to what it was made of
  private frame: CameraFrame | null = null;
  private cameras: string[] = []; // layers of views, what was made, and what holds the camera
  private camerasShown = true;
  holderShown = false; // something that holds the camera is among them
  private readonly scaleOf = new Map<string, Scale | null>(); // by layer
  private up: readonly number[] = [0, 0, 1];
  private candidates = new Map<string, { layer: Layer; data: ArrayBuffer; gains: Candidates }>();

  constructor(
    private readonly viewer: Viewer,
    private readonly buffers: BufferCache,
    private readonly look: Look,
    private readonly failed: (layer: Layer, error: Error) => void,
  ) {}

  /**
   * Layers as the document and the person want them. A later call takes the place of one that still waits.
   * @return false: another call did.
   */
  async present(document: SceneDocument, step: number): Promise<boolean> {
    const turn = ++this.turn;
    this.buffers.keep(new Set(document.layers.flatMap((layer) => [layer.buffer, ...(layer.fields ?? []).map(({ buffer }) => buffer)])));
    const wanted = layersOf(document, step).filter((layer) => this.look.visible(layer));
    const first = this.shown.size === 0; // nothing to exchange: layers come as they arrive
    const ready = new Map<Layer, Data>();
    this.up = document.up;
    await Promise.all(
      wanted.map(async (layer) => {
        try {
          const field = fieldOf(layer, this.look.colorBy(layer));
          const values = field && (await this.buffers.get(field.buffer, fieldBytes(layer, field)));
          const data = { own: await this.buffers.get(layer.buffer, bufferBytes(layer)), values: values ?? null };
          ready.set(layer, data);
          if (first && turn === this.turn) this.put(layer, data);
        } catch (error) {
          if (turn === this.turn) this.failed(layer, error as Error);
        }
      }),
    );
    if (turn !== this.turn) return false;
    this.exchange(document, step, ready);
    this.prefetch(document, step + 1);
    return true;
  }

  /** Returns a layer of candidates in the view and their gains; undefined: not in the view. */
  candidatesIn(id: string): { layer: Layer; gains: Candidates } | undefined {
    return this.candidates.get(id);
  }

  allCandidates(): { layer: Layer; gains: Candidates }[] {
    return [...this.candidates.values()];
  }

  /** Ranges of the ramps that colour the layers, by layer; null: no ramp colours it. */
  scales(): ReadonlyMap<string, Scale | null> {
    return this.scaleOf;
  }

  poseOf(id: string, item: number): number[][] | undefined {
    const found = this.candidates.get(id);
    return found && item < found.layer.count ? poseOf(found.data, item) : undefined;
  }

  /** Cameras, their path, and an arm: in the way of who looks through one of them. */
  showCameras(shown: boolean): void {
    this.camerasShown = shown;
    this.viewer.setFrame(shown ? this.frame : null);
    for (const id of this.cameras) this.viewer.layers.show(id, shown);
  }

  /** The middle of what stands beside the scene, an arm; undefined: nothing does, or it is not here yet. */
  async beside(document: SceneDocument, step: number): Promise<[number, number, number] | undefined> {
    for (const layer of document.layers) {
      const vertices = layer.vertices ?? 0;
      if (layer.kind !== "triangles" || layer.step !== step || vertices === 0 || !this.shown.has(layer.id)) continue;
      const places = new Float32Array(await this.buffers.get(layer.buffer, bufferBytes(layer)), 0, 3 * vertices);
      const sum: [number, number, number] = [0, 0, 0];
      let outside = 0;
      for (let i = 0; i < places.length; i += 3) {
        let out = false;
        for (const k of [0, 1, 2] as const) {
          const x = places[i + k]!;
          sum[k] += x / vertices;
          out ||= x < (document.bounds[k] ?? 0) || x > (document.bounds[3 + k] ?? 0);
        }
        if (out) ++outside;
      }
      if (outside > vertices / 2) return sum;
    }
    return undefined;
  }

  private exchange(document: SceneDocument, step: number, ready: ReadonlyMap<Layer, Data>): void {
    const made = this.look.trail ? trailOf(document, step) : [];
    const ids = new Set([...[...ready.keys()].map((layer) => layer.id), ...made.map(({ layer }) => layer.id)]);
    for (const id of [...this.shown.keys()]) {
      if (ids.has(id)) continue;
      this.viewer.layers.remove(id);
      this.shown.delete(id);
    }
    this.candidates = new Map();
    for (const [layer, data] of ready) {
      this.put(layer, data);
      if (layer.kind !== "views") continue;
      const gains = candidatesOf(data.own, layer.count);
      this.candidates.set(layer.id, { layer, data: data.own, gains });
      this.viewer.layers.select(layer.id, gains.best >= 0 ? gains.best : null);
    }
    for (const { layer, data } of made) this.put(layer, { own: data, values: null }, String(step));
    const holders = [...ready.keys()].filter((layer) => layer.holds_camera).map((layer) => layer.id);
    this.holderShown = holders.length > 0;
    this.cameras = [...this.candidates.keys(), ...made.map(({ layer }) => layer.id), ...holders];
    const now = document.steps[step];
    this.frame = now?.T_world_camera ? { poseRows: now.T_world_camera, fov_rad: fovOf(now) } : null;
    this.showCameras(this.camerasShown);
  }

  private put(layer: Layer, { own, values }: Data, of = layer.buffer): void {
    const by = this.look.colorBy(layer);
    const made = `${of} ${JSON.stringify(this.look.changes(layer))} ${by}`;
    if (this.shown.get(layer.id) === made) return;
    const { layer: colored, data, scale } = painted(layer, own, by, values, this.up);
    const info = { ...colored, ...this.look.changes(layer), visible: true };
    this.scaleOf.set(layer.id, scale);
    if (own.byteLength === bufferBytes(layer) && this.viewer.layers.add(info, data)) this.shown.set(layer.id, made);
    else this.failed(layer, new Error(`${layer.name}: its ${own.byteLength} bytes are not what a layer of this kind has.`));
  }

  /** So that going on does not wait. */
  private prefetch(document: SceneDocument, step: number): void {
    for (const layer of document.layers) {
      if (layer.step !== step || !this.look.visible(layer)) continue;
      this.buffers.get(layer.buffer, bufferBytes(layer)).catch(() => undefined); // said when it is needed
    }
  }
}
