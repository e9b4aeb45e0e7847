// SPDX-License-Identifier: Apache-2.0
// How much is drawn at once: what the GPU does in about 40 ms, learnt from how long it took.

const kStep_ms = 40;
const kLeast = 50_000;
const kMost = 1 << 25;

export class Pacer {
  busy = false;
  private atOnce: number; // vertices

  constructor(private gl: WebGL2RenderingContext) {
    this.atOnce = isSoftware(gl) ? 400_000 : 2_000_000;
  }

  /** Of vertices `from` to `all`, the end of those to draw now. */
  upTo(from: number, all: number): number {
    return all - from <= 1.25 * this.atOnce ? all : from + Math.floor(this.atOnce);
  }

  /** Vertices were just drawn; calls back when the GPU is done, with the time that it took. */
  drew(vertices: number, done: (ms: number) => void): void {
    const { gl } = this;
    const began = performance.now();
    const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    this.busy = true;
    const poll = () => {
      const waits =
        fence !== null && !gl.isContextLost() && gl.getSyncParameter(fence, gl.SYNC_STATUS) === gl.UNSIGNALED;
      if (waits) {
        setTimeout(poll, 1);
        return;
      }
      if (fence !== null) gl.deleteSync(fence);
      this.busy = false;
      const ms = performance.now() - began;
      if (vertices >= 0.5 * this.atOnce || ms > 1.5 * kStep_ms) this.learn(vertices, ms);
      done(ms);
    };
    setTimeout(poll, 0);
  }

  private learn(vertices: number, ms: number): void {
    const factor = Math.min(Math.max(kStep_ms / ms, 0.4), 1.6);
    this.atOnce = Math.min(Math.max(Math.max(vertices, kLeast) * factor, kLeast), kMost);
  }
}

function isSoftware(gl: WebGL2RenderingContext): boolean {
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  const name = String(gl.getParameter(info === null ? gl.RENDERER : info.UNMASKED_RENDERER_WEBGL));
  return /swiftshader|llvmpipe|softpipe|software/i.test(name);
}
