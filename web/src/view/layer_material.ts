// SPDX-License-Identifier: Apache-2.0
// How layers look: surfaces in the light of a lamp at the camera, squares or discs, and lines.
import * as THREE from "three";

const kSurfaceVertex = /* glsl */ `
precision highp float;
uniform mat4 projectionMatrix;
uniform mat4 modelViewMatrix;
uniform vec4 plain;
in vec3 position;
#ifdef INSTANCED
uniform float size_m;
in vec3 center;
#endif
#ifdef COLORS
in vec4 color;
#endif
#ifdef NORMALS
in vec3 normal;
out vec3 seen_normal;
#endif
out vec3 seen;
out vec4 own;
void main() {
#ifdef INSTANCED
  vec4 at = modelViewMatrix * vec4(center + size_m * position, 1.0);
#else
  vec4 at = modelViewMatrix * vec4(position, 1.0);
#endif
#ifdef NORMALS
  seen_normal = mat3(modelViewMatrix) * normal;
#endif
#ifdef COLORS
  own = vec4(color.rgb, color.a * plain.a);
#else
  own = plain;
#endif
  seen = at.xyz;
  gl_Position = projectionMatrix * at;
}`;

const kPixel = /* glsl */ `
precision highp float;
uniform bool as_depth;  // 24 bits, for what is under the cursor; see-through layers have none
out vec4 pixel;
void show(vec4 color) {
  pixel = color;
  if (!as_depth) return;
  if (color.a < 1.0) discard;
  uint depth = uint(min(gl_FragCoord.z, 1.0) * 16777215.0);
  pixel = vec4(depth & 255u, depth >> 8u & 255u, depth >> 16u, 255u) / 255.0;
}`;

const kSurfaceFragment = /* glsl */ `
in vec3 seen;
in vec4 own;
#ifdef NORMALS
in vec3 seen_normal;
#endif
void main() {
#ifdef NORMALS
  vec3 normal = normalize(seen_normal);
#else
  vec3 normal = normalize(cross(dFdx(seen), dFdy(seen)));
#endif
  if (dot(normal, seen) > 0.0) normal = -normal;  // both sides are lit
  float lamp = max(dot(normal, normalize(vec3(-0.25, 0.45, 1.0))), 0.0);
  show(vec4(own.rgb * (0.42 + 0.62 * lamp), own.a));
}`;

const kSquareVertex = /* glsl */ `
precision highp float;
uniform mat4 projectionMatrix;
uniform mat4 modelViewMatrix;
uniform vec4 plain;
uniform float size_m;
uniform float size;      // px of squares
uniform float height;    // px of the picture
in vec3 position;
#ifdef COLORS
in vec4 color;
#endif
#ifdef DIAMETERS
in float diameter;       // times size_m
#endif
out vec4 own;
void main() {
  gl_Position = projectionMatrix * (modelViewMatrix * vec4(position, 1.0));
  float px_per_m = 0.5 * height * projectionMatrix[1][1] / max(gl_Position.w, 1e-9);
#ifdef DIAMETERS
  gl_PointSize = clamp(size_m * diameter * px_per_m, 1.5, 64.0);
#elif defined(ROUND)
  gl_PointSize = clamp(size_m * px_per_m, 1.0, 64.0);
#else
  gl_PointSize = size;
#endif
#ifdef COLORS
  own = vec4(color.rgb, color.a * plain.a);
#else
  own = plain;
#endif
}`;

// A line is a strip as wide as on the screen; what is behind the camera is cut off.
const kLineVertex = /* glsl */ `
precision highp float;
uniform mat4 projectionMatrix;
uniform mat4 modelViewMatrix;
uniform vec4 plain;
uniform vec2 picture;    // px
uniform float width;     // px
in vec3 position;        // x: 0 at its beginning, 1 at its end; y: the side
in vec3 begin;
in vec3 end;
#ifdef COLORS
in vec4 begin_color;
in vec4 end_color;
#endif
out vec4 own;
void main() {
  vec4 a = modelViewMatrix * vec4(begin, 1.0);
  vec4 b = modelViewMatrix * vec4(end, 1.0);
  float cut = -1.001 * projectionMatrix[3][2] / (projectionMatrix[2][2] - 1.0);
  if (a.z > cut && b.z < cut) a = mix(b, a, (cut - b.z) / (a.z - b.z));
  else if (b.z > cut && a.z < cut) b = mix(a, b, (cut - a.z) / (b.z - a.z));
  a = projectionMatrix * a;
  b = projectionMatrix * b;
  vec2 along = (b.xy / b.w - a.xy / a.w) * picture;
  vec2 side = vec2(-along.y, along.x) / max(length(along), 1e-6);
  gl_Position = position.x < 0.5 ? a : b;
  gl_Position.xy += position.y * side * width / picture * gl_Position.w;
#ifdef COLORS
  vec4 color = position.x < 0.5 ? begin_color : end_color;
  own = vec4(color.rgb, color.a * plain.a);
#else
  own = plain;
#endif
}`;

const kPlainFragment = /* glsl */ `
in vec4 own;
void main() {
#ifdef ROUND
  if (length(gl_PointCoord - 0.5) > 0.5) discard;
#endif
  show(own);
}`;

export interface LayerLook {
  shape: "surface" | "cubes" | "squares" | "discs" | "lines";
  colors: boolean;
  normals?: boolean;
  plain: THREE.Vector4; // 0 to 1
  size_m: number; // how wide cubes and discs are; where each disc has a diameter of its own: times that
  transparent: boolean;
  diameters?: boolean;
}

/** Uniforms that all layers share; lengths in pixels of the picture. */
export interface SharedUniforms {
  as_depth: THREE.IUniform<boolean>;
  size: THREE.IUniform<number>; // side of a square
  height: THREE.IUniform<number>;
  picture: THREE.IUniform<THREE.Vector2>;
  width: THREE.IUniform<number>; // width of a line
}

export function layerMaterial(look: LayerLook, shared: SharedUniforms): THREE.RawShaderMaterial {
  const defines: Record<string, string> = {};
  if (look.colors) defines.COLORS = "";
  if (look.normals === true) defines.NORMALS = "";
  if (look.shape === "cubes") defines.INSTANCED = "";
  if (look.shape === "discs") defines.ROUND = "";
  if (look.diameters === true) defines.DIAMETERS = "";
  const points = look.shape === "squares" || look.shape === "discs";
  const surface = look.shape === "surface" || look.shape === "cubes";
  return new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3,
    vertexShader: surface ? kSurfaceVertex : points ? kSquareVertex : kLineVertex,
    fragmentShader: kPixel + (surface ? kSurfaceFragment : kPlainFragment),
    uniforms: { plain: { value: look.plain }, size_m: { value: look.size_m }, ...shared },
    defines,
    side: look.shape === "cubes" ? THREE.FrontSide : THREE.DoubleSide,
    transparent: look.transparent,
    depthWrite: !look.transparent,
  });
}
