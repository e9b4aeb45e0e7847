// SPDX-License-Identifier: Apache-2.0
// How much is drawn at once, learnt from how long it took: what moves is drawn often, what rests in few steps.

const kMoving_ms = 40;
const kResting_ms = 85;
const kLeast = 100_000;
const kLeastResting = 400_000;
const kMost = 1 << 25;

export class Pacer {
  busy = false;
  private perMs: number; // vertices

  constructor(private gl: WebGL2RenderingContext) {
    this.perMs = isSoftware(gl) ? 5_000 : 50_000;
  }

  /** Returns the end of the vertices to draw now, out of those from `from` to `all`. */
  upTo(from: number, all: number, moving: boolean): number {
    const wanted = moving
      ? Math.max(this.perMs * kMoving_ms, kLeast)
      : Math.max(this.perMs * kResting_ms, kLeastResting);
    const atOnce = Math.min(wanted, kMost);
    return all - from <= 1.25 * atOnce ? all : from + Math.floor(atOnce);
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
        setTimeout(poll, 2);
        return;
      }
      if (fence !== null) gl.deleteSync(fence);
      this.busy = false;
      const ms = performance.now() - began;
      if (vertices >= kLeast) this.learn(vertices / Math.max(ms, 1));
      done(ms);
    };
    setTimeout(poll, 0);
  }

  /** Slowly: one step may have waited for something else. */
  private learn(perMs: number): void {
    this.perMs *= Math.min(Math.max(perMs / this.perMs, 0.6), 1.5);
  }
}

function isSoftware(gl: WebGL2RenderingContext): boolean {
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  const name = String(gl.getParameter(info === null ? gl.RENDERER : info.UNMASKED_RENDERER_WEBGL));
  return /swiftshader|llvmpipe|softpipe|software/i.test(name);
}
