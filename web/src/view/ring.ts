// SPDX-License-Identifier: Apache-2.0
// A ring around one place, over everything else.
import * as THREE from "three";

const kVertex = /* glsl */ `
precision highp float;
uniform mat4 projectionMatrix;
uniform mat4 modelViewMatrix;
uniform float size;
in vec3 position;
void main() {
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  gl_Position.z = -gl_Position.w;
  gl_PointSize = size;
}`;

const kFragment = /* glsl */ `
precision highp float;
uniform float size;
uniform float ratio;
out vec4 pixel;
void main() {
  float inside_px = (0.5 - length(gl_PointCoord - 0.5)) * size / ratio;
  if (inside_px < 0.0 || inside_px > 6.0) discard;
  pixel = vec4(inside_px < 1.5 || inside_px > 4.5 ? vec3(0.08) : vec3(1.0, 0.84, 0.04), 1.0);
}`;

const kSize_px = 38;

export class Ring {
  readonly object: THREE.Points;
  private placed = false;
  private uniforms = { size: { value: kSize_px }, ratio: { value: 1 } };

  constructor() {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.Float32BufferAttribute([0, 0, 0], 3));
    const material = new THREE.RawShaderMaterial({
      glslVersion: THREE.GLSL3,
      vertexShader: kVertex,
      fragmentShader: kFragment,
      uniforms: this.uniforms,
      blending: THREE.NoBlending,
      depthFunc: THREE.AlwaysDepth,
    });
    this.object = new THREE.Points(geometry, material);
    this.object.frustumCulled = false;
    this.object.visible = false;
    this.object.renderOrder = 2;
  }

  /** In coordinates of the scene; null: nowhere. */
  set(place: readonly [number, number, number] | null): void {
    this.placed = place !== null;
    if (place !== null) this.object.position.set(...place);
  }

  draw(ratio: number): void {
    this.object.visible = this.placed;
    this.uniforms.ratio.value = ratio;
    this.uniforms.size.value = kSize_px * ratio;
  }

  dispose(): void {
    this.object.geometry.dispose();
    (this.object.material as THREE.Material).dispose();
  }
}
