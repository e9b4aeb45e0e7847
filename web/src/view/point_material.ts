// SPDX-License-Identifier: Apache-2.0
// Points as squares of their colour with a smaller square of their label's inside (thesis, Fig. 4.15).
import * as THREE from "three";

export interface PointUniforms {
  [name: string]: THREE.IUniform;
  palette: THREE.IUniform<THREE.DataTexture>;
  size: THREE.IUniform<number>; // px
  heat: THREE.IUniform<boolean>; // margins are shown
  low: THREE.IUniform<THREE.Vector3>; // corners of the clip box
  high: THREE.IUniform<THREE.Vector3>;
  spacing: THREE.IUniform<number>; // m, times the pixels that a metre is wide 1 m away
}

// A point's state: slot of its label, margin, and whether it stands out; or that no point is there.
const kVertex = /* glsl */ `
precision highp float;
precision highp int;
uniform mat4 projectionMatrix;
uniform mat4 modelViewMatrix;
uniform float size;
uniform highp sampler2D palette;
uniform bool heat;
uniform float spacing;
uniform vec3 low;
uniform vec3 high;
in vec3 position;
in vec4 color;
in uint state;
invariant gl_Position;
#ifdef ID
flat out vec4 id;
#else
flat out vec3 outer;
#ifdef TWO_SQUARES
flat out vec4 inner;  // alpha: half its edge, of the outer's
#endif
#endif

// From blue to yellow, lighter and lighter: read without telling red from green. annotate.css has the same as a legend.
vec3 heated(vec3 own, float doubt) {
  vec3 sure = vec3(0.10, 0.16, 0.34) + 0.26 * dot(own, vec3(0.3, 0.59, 0.11));
  vec3 hot = mix(vec3(0.80, 0.32, 0.44), vec3(1.0, 0.87, 0.22), clamp(2.0 * doubt - 1.0, 0.0, 1.0));
  return mix(sure, hot, clamp(2.0 * doubt, 0.0, 1.0));
}

vec3 tinted(vec3 own, vec3 label, float much) {
  float light = 0.4 + 0.85 * dot(own, vec3(0.3, 0.59, 0.11));
  return mix(own, min(label * light, 1.0), 0.62 * min(1.7 * much, 1.0));
}

void main() {
  uint slot = state & 0xfffffu;
  vec4 label = texelFetch(palette, ivec2(slot & 1023u, slot >> 10u), 0);
  gl_Position = projectionMatrix * (modelViewMatrix * vec4(position, 1.0));
  bool inside = all(greaterThanEqual(position, low)) && all(lessThanEqual(position, high));
  bool empty = (state >> 29u & 1u) != 0u;
  if (label.a == 0.0 || empty || !inside) gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
  gl_PointSize = size;
#ifdef ID
  uint number = uint(gl_VertexID) + 1u;
  id = vec4(number & 255u, number >> 8u & 255u, number >> 16u & 255u, number >> 24u) / 255.0;
#else
  bool out_stands = (state >> 28u & 1u) != 0u;
  vec3 own = color.rgb;
  if (heat) own = heated(own, 1.0 - float(state >> 20u & 255u) / 255.0);
#ifdef LABELS_ONLY
  outer = heat ? own : label.rgb;
#elif defined(CLOUD_ONLY)
  outer = own;
#elif defined(TWO_SQUARES)
  // Where squares cover each other's middles, from afar, they are tinted instead.
  float covered = clamp(1.0 - spacing / (gl_Position.w * size), 0.0, 1.0);
  outer = slot == 0u || heat ? own : tinted(own, label.rgb, covered);
  inner = vec4(mix(label.rgb, outer, 0.8 * covered * covered), slot == 0u || heat ? 0.0 : INNER);
#else
  outer = slot == 0u || heat ? own : tinted(own, label.rgb, 1.0);
#endif
  if (out_stands) outer = vec3(1.0, 0.84, 0.04);
#endif
}`;

const kFragment = /* glsl */ `
precision highp float;
#ifdef ID
flat in vec4 id;
#else
flat in vec3 outer;
#ifdef TWO_SQUARES
flat in vec4 inner;
#endif
#endif
out vec4 pixel;
void main() {
#ifdef ID
  pixel = id;
#elif defined(TWO_SQUARES)
  vec2 off = abs(gl_PointCoord - 0.4995);  // a border in the middle of a pixel is on one side's only
  pixel = vec4(max(off.x, off.y) < inner.a ? inner.rgb : outer, 1.0);
#else
  pixel = vec4(outer, 1.0);
#endif
}`;

export type PointMode = "id" | "cloud" | "labels" | "both";

/** Edge of the label's square, as odd or even as the point's, so that it is in the middle. */
export function innerEdge_px(size_px: number): number {
  return size_px - 2 * Math.max(1, Math.round(size_px / 4));
}

export function pointMaterial(mode: PointMode, size_px: number, uniforms: PointUniforms): THREE.RawShaderMaterial {
  const defines: Record<string, string> = {};
  if (mode === "id") defines.ID = "";
  if (mode === "cloud") defines.CLOUD_ONLY = "";
  if (mode === "labels") defines.LABELS_ONLY = "";
  if (mode === "both" && size_px >= 3) {
    defines.TWO_SQUARES = "";
    defines.INNER = ((0.5 * innerEdge_px(size_px)) / size_px).toFixed(6);
  }
  return new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3,
    vertexShader: kVertex,
    fragmentShader: kFragment,
    uniforms,
    defines,
    blending: THREE.NoBlending,
    depthFunc: THREE.LessEqualDepth,
  });
}
