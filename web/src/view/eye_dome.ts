// SPDX-License-Identifier: Apache-2.0
// Eye-dome lighting (Boucheny 2009): what has something nearer beside it is darker. Needs no normals, so that clouds
// without colours have a shape. The scene is drawn into a target, and from there, shaded, into the picture with its depth.
import * as THREE from "three";

const kVertex = /* glsl */ `
in vec3 position;
void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }`;

const kFragment = /* glsl */ `
precision highp float;
uniform sampler2D colors;
uniform highp sampler2D depths;
uniform vec2 range;      // near and far, m
uniform float even_m;    // of an orthographic picture: m that count as the distance; 0: perspective
uniform vec2 corner;     // of the picture's part, px
uniform float reach;     // px
uniform float strength;
out vec4 pixel;
float closeness(float depth) {  // −log2 of the distance
  if (even_m > 0.0) return -depth * (range.y - range.x) / even_m;
  return log2(range.y - depth * (range.y - range.x)) - log2(range.x * range.y);
}
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy - corner);
  ivec2 most = textureSize(depths, 0) - 1;
  float depth = texelFetch(depths, at, 0).r;
  vec3 color = texelFetch(colors, at, 0).rgb;
  gl_FragDepth = depth;
  if (depth < 1.0) {
    float own = closeness(depth);
    int far = int(reach);
    float sum = 0.0;
    for (int i = 0; i < 4; ++i) {
      ivec2 off = i == 0 ? ivec2(far, 0) : i == 1 ? ivec2(-far, 0) : i == 2 ? ivec2(0, far) : ivec2(0, -far);
      float other = texelFetch(depths, clamp(at + off, ivec2(0), most), 0).r;
      if (other < 1.0) sum += max(0.0, closeness(other) - own);
    }
    color *= exp(-strength * min(sum, 0.035));
  }
  pixel = vec4(color, 1.0);
}`;

const kReach_px = 2;
const kStrength = 32;
const kEven = Math.LN2 / 0.93; // as strong as in a perspective picture that is as high at this distance

export class EyeDome {
  private readonly target: THREE.WebGLRenderTarget;
  private readonly scene = new THREE.Scene();
  private readonly camera = new THREE.Camera();
  private readonly material: THREE.RawShaderMaterial;
  private readonly mesh: THREE.Mesh;

  constructor(private readonly renderer: THREE.WebGLRenderer) {
    const depthTexture = new THREE.DepthTexture(1, 1, THREE.UnsignedIntType);
    this.target = new THREE.WebGLRenderTarget(1, 1, {
      minFilter: THREE.NearestFilter,
      magFilter: THREE.NearestFilter,
      depthTexture,
    });
    this.material = new THREE.RawShaderMaterial({
      glslVersion: THREE.GLSL3,
      vertexShader: kVertex,
      fragmentShader: kFragment,
      uniforms: {
        colors: { value: this.target.texture },
        depths: { value: depthTexture },
        range: { value: new THREE.Vector2() },
        even_m: { value: 0 },
        corner: { value: new THREE.Vector2() },
        reach: { value: kReach_px },
        strength: { value: kStrength },
      },
      blending: THREE.NoBlending,
      depthFunc: THREE.AlwaysDepth,
    });
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.Float32BufferAttribute([-1, -1, 0, 3, -1, 0, -1, 3, 0], 3));
    this.mesh = new THREE.Mesh(geometry, this.material);
    this.mesh.frustumCulled = false;
    this.scene.add(this.mesh);
  }

  /** What is drawn goes on here; `clear` begins anew. */
  begin(size: readonly [number, number], clear: boolean): void {
    if (this.target.width !== size[0] || this.target.height !== size[1]) this.target.setSize(...size);
    this.renderer.setRenderTarget(this.target);
    if (clear) this.renderer.clear();
  }

  /** Into the picture, shaded; what is drawn then is behind what is there. */
  compose(camera: THREE.PerspectiveCamera | THREE.OrthographicCamera, ratio: number, corner: readonly [number, number]): void {
    const { uniforms } = this.material;
    const even = camera instanceof THREE.OrthographicCamera;
    uniforms["even_m"]!.value = even ? kEven * (camera.top - camera.bottom) : 0;
    (uniforms["corner"]!.value as THREE.Vector2).set(...corner);
    (uniforms["range"]!.value as THREE.Vector2).set(camera.near, camera.far);
    uniforms["reach"]!.value = Math.max(1, Math.round(kReach_px * ratio));
    this.renderer.setRenderTarget(null);
    this.renderer.render(this.scene, this.camera);
  }

  dispose(): void {
    this.target.dispose();
    this.target.depthTexture?.dispose();
    this.material.dispose();
    this.mesh.geometry.dispose();
  }
}
