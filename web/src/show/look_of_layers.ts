// SPDX-License-Identifier: Apache-2.0
// How the person wants layers to look. Layers of several steps that have one name have one switch.
import { type Layer, layerKey } from "./document";

export class Look {
  private readonly eyes = new Map<string, boolean>();
  private readonly opacities = new Map<string, number>();
  private readonly scales = new Map<string, number>();
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

  /** Of points and voxels: their size beside what the document says. */
  scale(layer: Layer): number {
    return this.scales.get(layerKey(layer)) ?? 1;
  }
  setScale(layer: Layer, scale: number): void {
    this.scales.set(layerKey(layer), scale);
  }

  /** What becomes of the layer's own keys. */
  changes(layer: Layer): { opacity?: number; size_m?: number } {
    const opacity = this.opacities.get(layerKey(layer));
    return {
      ...(opacity === undefined ? {} : { opacity }),
      ...(layer.size_m === undefined ? {} : { size_m: layer.size_m * this.scale(layer) }),
    };
  }
}
