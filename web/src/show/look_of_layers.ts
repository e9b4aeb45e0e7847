// SPDX-License-Identifier: Apache-2.0
// How the person wants layers to look. Layers of several steps that have one name have one switch.
import { type Layer, layerKey } from "./document";
import { type ColorBy, usualColor } from "./paint";

export class Look {
  private readonly eyes = new Map<string, boolean>();
  private readonly opacities = new Map<string, number>();
  private readonly scales = new Map<string, number>();
  private readonly colorings = new Map<string, ColorBy>();
  trail = true; // earlier views and the path through them

  visible(layer: Layer): boolean {
    return this.eyes.get(layerKey(layer)) ?? layer.visible;
  }
  setVisible(layer: Layer, visible: boolean): void {
    this.eyes.set(layerKey(layer), visible);
  }

  opacity(layer: Layer): number {
    return this.opacities.get(layerKey(layer)) ?? layer.opacity ?? 1;
  }
  setOpacity(layer: Layer, opacity: number): void {
    this.opacities.set(layerKey(layer), opacity);
  }

  /** Returns the size of a layer's points or voxels as a multiple of the document's. */
  scale(layer: Layer): number {
    return this.scales.get(layerKey(layer)) ?? 1;
  }
  setScale(layer: Layer, scale: number): void {
    this.scales.set(layerKey(layer), scale);
  }

  colorBy(layer: Layer): ColorBy {
    return this.colorings.get(layerKey(layer)) ?? usualColor(layer);
  }
  setColorBy(layer: Layer, by: ColorBy): void {
    this.colorings.set(layerKey(layer), by);
  }

  /** Returns the values that replace the layer's own. */
  changes(layer: Layer): { opacity?: number; size_m?: number } {
    const opacity = this.opacities.get(layerKey(layer));
    return {
      ...(opacity === undefined ? {} : { opacity }),
      ...(layer.size_m === undefined ? {} : { size_m: layer.size_m * this.scale(layer) }),
    };
  }
}
