// SPDX-License-Identifier: Apache-2.0
// Labels as slots of a texture: a label's colour or visibility changes in one place, however many points have it.
import * as THREE from "three";
import type { Rgb } from "./types";

const kWidth = 1024;
export const kSlotBits = 20;
const kSlots = 1 << kSlotBits;

export class Palette {
  readonly texture: { value: THREE.DataTexture };
  private slots = new Map<number, number>([[0, 0]]);
  private labels: number[] = [0];
  private data = new Uint8Array(4 * kWidth);

  constructor() {
    this.texture = { value: this.makeTexture() };
    this.data.set([0, 0, 0, 255]); // without a label: black
  }

  /** The slot of a label; labels beyond a million share the last one. */
  slotOf(label: number): number {
    const known = this.slots.get(label);
    if (known !== undefined) return known;
    const slot = Math.min(this.labels.length, kSlots - 1);
    this.slots.set(label, slot);
    this.labels[slot] = label;
    if (4 * slot >= this.data.length) this.grow();
    this.data.set([...someColor(label), 255], 4 * slot);
    this.texture.value.needsUpdate = true;
    return slot;
  }

  labelOf(slot: number): number {
    return this.labels[slot] ?? 0;
  }

  setColor(label: number, color: Rgb): void {
    if (label === 0) return;
    this.data.set(color, 4 * this.slotOf(label));
    this.texture.value.needsUpdate = true;
  }

  setVisible(label: number, visible: boolean): void {
    this.data[4 * this.slotOf(label) + 3] = visible ? 255 : 0;
    this.texture.value.needsUpdate = true;
  }

  isVisible(slot: number): boolean {
    return this.data[4 * slot + 3] !== 0;
  }

  dispose(): void {
    this.texture.value.dispose();
  }

  private grow(): void {
    const larger = new Uint8Array(2 * this.data.length);
    larger.set(this.data);
    this.data = larger;
    this.texture.value.dispose();
    this.texture.value = this.makeTexture();
  }

  private makeTexture(): THREE.DataTexture {
    const texture = new THREE.DataTexture(this.data, kWidth, this.data.length / (4 * kWidth));
    texture.needsUpdate = true;
    return texture;
  }
}

/** Until a label has a colour: one that differs from its neighbours'. */
function someColor(label: number): Rgb {
  const color = new THREE.Color().setHSL((label * 0.618034) % 1, 0.65, 0.55, THREE.LinearSRGBColorSpace);
  return [Math.round(255 * color.r), Math.round(255 * color.g), Math.round(255 * color.b)];
}
