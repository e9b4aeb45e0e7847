// SPDX-License-Identifier: Apache-2.0
// Parts of the picture: one, or four views of the same scene with their own cameras. One of them is in use.
import type { SceneCamera } from "./camera";
import { type Eye, SideCamera } from "./side_camera";
import type { PaneName } from "./types";

/** Pixels of the picture, from its upper left corner. */
export interface Pane {
  readonly name: PaneName;
  readonly eye: Eye;
  readonly side: SideCamera | null; // null: the free view
  x: number;
  y: number;
  width: number;
  height: number;
}

export class Panes {
  readonly sides: readonly SideCamera[];
  readonly all: Pane[];
  active: Pane;
  private readonly free: Pane;
  private readonly around: readonly Pane[];
  private size: readonly [number, number] = [1, 1];

  constructor(private readonly camera: SceneCamera) {
    const pane = (name: PaneName, side: SideCamera | null): Pane => ({ name, eye: side ?? camera, side, x: 0, y: 0, width: 1, height: 1 });
    this.free = pane("free", null);
    this.around = (["top", "front", "side"] as const).map((side) => pane(side, new SideCamera(camera, side)));
    this.sides = this.around.map(({ side }) => side!);
    this.all = [this.free];
    this.active = this.free;
  }

  get four(): boolean {
    return this.all.length > 1;
  }

  show(four: boolean): void {
    this.all.splice(0, this.all.length, ...(four ? [this.around[0]!, this.free, ...this.around.slice(1)] : [this.free]));
    if (!four) this.active = this.free;
    this.layOut(...this.size);
  }

  /** Top and free above, front and side below. */
  layOut(width: number, height: number): void {
    this.size = [width, height];
    const place = (pane: Pane, x: number, y: number, right: number, bottom: number) => {
      Object.assign(pane, { x, y, width: Math.max(1, right - x), height: Math.max(1, bottom - y) });
      pane.side?.setAspect(pane.width / pane.height);
    };
    if (!this.four) place(this.free, 0, 0, width, height);
    else {
      const [x, y] = [Math.floor(width / 2), Math.floor(height / 2)];
      place(this.around[0]!, 0, 0, x, y);
      place(this.free, x, 0, width, y);
      place(this.around[1]!, 0, y, x, height);
      place(this.around[2]!, x, y, width, height);
    }
    this.camera.camera.aspect = this.free.width / this.free.height;
  }

  at(x: number, y: number): Pane {
    return this.all.find((pane) => x >= pane.x && y >= pane.y && x < pane.x + pane.width && y < pane.y + pane.height) ?? this.active;
  }
}
