// SPDX-License-Identifier: Apache-2.0
// What is in one pixel: the scene drawn once more with numbers for colours, into a target that is this pixel only.
import * as THREE from "three";

export class PixelProbe {
  private target = new THREE.WebGLRenderTarget(1, 1, {
    minFilter: THREE.NearestFilter,
    magFilter: THREE.NearestFilter,
    depthBuffer: true,
  });
  private bytes = new Uint8Array(4);

  constructor(private renderer: THREE.WebGLRenderer) {}

  /** Draws what the picture of `size` has in its pixel (x, y), y down; its colour's bytes, zeros where nothing is. */
  read(scene: THREE.Scene, camera: THREE.Camera, x: number, y: number, size: readonly [number, number]): Uint8Array {
    const { renderer, target } = this;
    const clear = renderer.getClearColor(new THREE.Color());
    const alpha = renderer.getClearAlpha();
    // Uses the picture's viewport, moved, so that points cover the pixels that they cover in the picture.
    target.viewport.set(-x, y + 1 - size[1], size[0], size[1]);
    renderer.setRenderTarget(target);
    renderer.setClearColor(0, 0);
    renderer.clear();
    renderer.render(scene, camera);
    renderer.readRenderTargetPixels(target, 0, 0, 1, 1, this.bytes);
    renderer.setRenderTarget(null);
    renderer.setClearColor(clear, alpha);
    return this.bytes;
  }

  /** The number that id() in the shaders wrote, less one; undefined where nothing is. */
  static number(bytes: Uint8Array): number | undefined {
    const number = (bytes[0]! | (bytes[1]! << 8) | (bytes[2]! << 16) | (bytes[3]! << 24)) >>> 0;
    return number === 0 ? undefined : number - 1;
  }

  dispose(): void {
    this.target.dispose();
  }
}
