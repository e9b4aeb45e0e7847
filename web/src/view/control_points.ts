// SPDX-License-Identifier: Apache-2.0
// Control points as spheres, and a ring around one point. A sphere is one vertex; its fragments are shaded as a ball's.
import * as THREE from "three";
import type { PointCloud } from "./points";
import { depthRow } from "./side_camera";
import type { ControlPlace } from "./types";

const kLeast_px = 7.5; // radius on the screen, css
const kMost_px = 15;
export const kControlBit = 0x80000000;

const kVertex = /* glsl */ `
precision highp float;
precision highp int;
uniform mat4 projectionMatrix;
uniform mat4 modelViewMatrix;
uniform highp sampler2D palette;
uniform float height;    // px of the picture
uniform vec2 radius;     // px, least and most
uniform float radius_m;
uniform float size;      // px, edge of the points' squares
uniform vec3 low;        // corners of the clip box
uniform vec3 high;
in vec3 position;
in uint slot;
flat out vec3 color;
flat out vec4 id;
flat out float radius_px;
void main() {
  vec4 label = texelFetch(palette, ivec2(slot & 1023u, slot >> 10u), 0);
  vec4 seen = modelViewMatrix * vec4(position, 1.0);
  gl_Position = projectionMatrix * seen;
  float px_per_m = 0.5 * height * projectionMatrix[1][1] / max(gl_Position.w, 1e-9);
  radius_px = clamp(radius_m * px_per_m, radius.x, radius.y);
  // Before the ball's front: the squares around it do not hide it.
  vec4 front = projectionMatrix * vec4(seen.xy, seen.z + (radius_px + 0.5 * size) / px_per_m, 1.0);
  if (front.w > 0.0) gl_Position.z = max(front.z / front.w, -1.0) * gl_Position.w;
  bool inside = all(greaterThanEqual(position, low)) && all(lessThanEqual(position, high));
  if (label.a == 0.0 || !inside) gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
  gl_PointSize = 2.0 * radius_px;
  color = label.rgb;
  uint number = uint(gl_VertexID) + 1u;
  id = vec4(number & 255u, number >> 8u & 255u, number >> 16u & 255u, (number >> 24u) + 128u) / 255.0;
}`;

const kFragment = /* glsl */ `
precision highp float;
flat in vec3 color;
flat in vec4 id;
flat in float radius_px;
uniform vec3 rim;
out vec4 pixel;
void main() {
  vec2 at = 2.0 * gl_PointCoord - 1.0;
  float r = length(at);
  if (r > 1.0) discard;
#ifdef ID
  pixel = id;
#else
  float inside = (1.0 - r) * radius_px;  // px from the border
  float edge = max(1.5, 0.2 * radius_px);
  vec3 normal = vec3(at.x, -at.y, sqrt(1.0 - r * r));
  float light = 0.62 + 0.48 * max(dot(normal, vec3(-0.40, 0.56, 0.72)), 0.0);
  float shine = pow(max(dot(normal, vec3(-0.26, 0.40, 0.88)), 0.0), 40.0);
  vec3 ball = min(color * light, 1.0) + 0.45 * shine;
  vec3 outline = inside < 0.5 * edge ? vec3(0.0) : rim;
  pixel = vec4(inside < edge ? outline : ball, 1.0);
#endif
}`;

export class ControlPoints {
  readonly object = new THREE.Points();
  private known = new Map<number, ControlPlace>(); // by point
  private points: number[] = []; // point of each vertex
  private stale = true;
  private material: THREE.RawShaderMaterial;
  private idMaterial: THREE.RawShaderMaterial;
  private uniforms: Record<string, THREE.IUniform>;

  constructor(private cloud: PointCloud) {
    this.uniforms = {
      palette: cloud.palette.texture,
      height: { value: 1 },
      radius: { value: new THREE.Vector2(kLeast_px, kMost_px) },
      radius_m: { value: 0 },
      size: cloud.uniforms.size,
      low: cloud.uniforms.low,
      high: cloud.uniforms.high,
      rim: { value: new THREE.Color(1, 1, 1) },
    };
    const make = (defines: Record<string, string>) =>
      new THREE.RawShaderMaterial({
        glslVersion: THREE.GLSL3,
        vertexShader: kVertex,
        fragmentShader: kFragment,
        uniforms: this.uniforms,
        defines,
        blending: THREE.NoBlending,
      });
    this.material = make({});
    this.idMaterial = make({ ID: "" });
    this.object.frustumCulled = false;
  }

  setRadius_m(radius_m: number): void {
    this.uniforms.radius_m!.value = radius_m;
  }

  set(control: ControlPlace): void {
    if (control.label === 0) this.known.delete(control.point);
    else this.known.set(control.point, control);
    this.stale = true;
  }

  clear(): void {
    this.known.clear();
    this.stale = true;
  }

  positionOf(point: number): readonly [number, number, number] | undefined {
    return this.known.get(point)?.position;
  }

  pointOfVertex(vertex: number): number | undefined {
    return this.points[vertex];
  }

  get size(): number {
    return this.points.length;
  }

  draw(id: boolean, height_px: number, ratio: number): void {
    if (this.stale) this.build();
    this.uniforms.height!.value = height_px;
    (this.uniforms.radius!.value as THREE.Vector2).set(kLeast_px * ratio, kMost_px * ratio);
    this.object.visible = this.points.length > 0;
    this.object.material = id ? this.idMaterial : this.material;
  }

  /** Returns the nearest of the control points whose spheres cover the place (in the picture's pixels). */
  at(x: number, y: number, clip_scene: THREE.Matrix4, width: number, height: number, ratio: number) {
    if (this.stale) this.build();
    const radius_m = this.uniforms.radius_m!.value as number;
    const [a, b, c, d] = depthRow(clip_scene);
    const px_per_clip = 0.5 * height * this.heightScale(clip_scene);
    const place = new THREE.Vector4();
    let best: { point: number; depth_m: number } | null = null;
    const positions = this.object.geometry.getAttribute("position");
    for (let i = 0; i < this.points.length; ++i) {
      const point = this.points[i]!;
      if (!this.cloud.palette.isVisible(this.cloud.palette.slotOf(this.known.get(point)?.label ?? 0))) continue;
      if (!this.cloud.isInside(positions.getX(i), positions.getY(i), positions.getZ(i))) continue;
      place.set(positions.getX(i), positions.getY(i), positions.getZ(i), 1).applyMatrix4(clip_scene);
      if (place.w <= 0) continue;
      const px_per_m = px_per_clip / place.w;
      const radius_px = Math.min(Math.max(radius_m * px_per_m, kLeast_px * ratio), kMost_px * ratio);
      const u = 0.5 * width * (place.x / place.w + 1) - x;
      const v = 0.5 * height * (1 - place.y / place.w) - y;
      const depth_m = a * positions.getX(i) + b * positions.getY(i) + c * positions.getZ(i) + d - (radius_px + 0.5 * this.cloud.uniforms.size.value) / px_per_m;
      if (u * u + v * v <= radius_px * radius_px && (best === null || depth_m < best.depth_m)) best = { point, depth_m };
    }
    return best;
  }

  dispose(): void {
    this.object.geometry.dispose();
    this.material.dispose();
    this.idMaterial.dispose();
  }

  /** How much larger a metre is in clip coordinates: the length of their row y. */
  private heightScale(clip_scene: THREE.Matrix4): number {
    const e = clip_scene.elements;
    return Math.hypot(e[1]!, e[5]!, e[9]!);
  }

  private build(): void {
    this.stale = false;
    this.points = [];
    const positions: number[] = [];
    const slots: number[] = [];
    for (const { point, label, position } of this.known.values()) {
      this.points.push(point);
      for (const axis of [0, 1, 2] as const) positions.push(position[axis] - this.cloud.origin[axis]);
      slots.push(this.cloud.palette.slotOf(label));
    }
    this.object.geometry.dispose();
    this.object.geometry = new THREE.BufferGeometry();
    this.object.geometry.setAttribute("position", new THREE.Float32BufferAttribute(positions, 3));
    this.object.geometry.setAttribute("slot", new THREE.Uint32BufferAttribute(slots, 1));
  }
}
