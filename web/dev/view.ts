// SPDX-License-Identifier: Apache-2.0
// The 3-D view without a program: a made cloud, for the tests and for trying things. `npx vite`, then /dev/view.html.
import type { CloudInfo, PointChunk, Rgb, Viewer } from "../src/view/types";
import { createViewer } from "../src/view/viewer";
import { random } from "./random";

const kChunk = 1 << 18;
export const kLabelColors: readonly Rgb[] = [[0, 0, 0], [230, 60, 60], [40, 120, 230], [250, 190, 40], [60, 180, 90]];

export interface MadeCloud {
  info: CloudInfo;
  chunks: PointChunk[];
}

/** A table with four balls on it, 2 m wide, in random order; labels 0 (table) and 1 to 4. */
export function makeCloud(count: number, offset: readonly [number, number, number] = [0, 0, 0]): MadeCloud {
  const next = random(7);
  const chunks: PointChunk[] = [];
  for (let from = 0; from < count; from += kChunk) {
    const n = Math.min(kChunk, count - from);
    const positions = new Float32Array(3 * n);
    const points = new Uint32Array(n);
    const colors = new Uint8Array(4 * n);
    const labels = new Uint32Array(n);
    for (let i = 0; i < n; ++i) {
      points[i] = from + i;
      const ball = Math.floor(next() * 8) - 3; // half of the points are the table's
      let [x, y, z] = [2 * next() - 1, 2 * next() - 1, 0];
      let color = [150 + 60 * Math.sin(9 * x), 130, 100 + 40 * Math.cos(7 * y)];
      if (ball > 0) {
        const up = 2 * next() - 1;
        const angle = 2 * Math.PI * next();
        const wide = Math.sqrt(1 - up * up);
        const radius = 0.12 + 0.05 * ball;
        x = 0.5 * (ball % 2 ? 1 : -1) + radius * wide * Math.cos(angle);
        y = 0.5 * (ball > 2 ? 1 : -1) + radius * wide * Math.sin(angle);
        z = radius * (1 + up);
        color = [90 + 30 * ball, 200 - 25 * ball, 120 + 60 * up];
      }
      positions.set([x + offset[0], y + offset[1], z + offset[2]], 3 * i);
      colors.set([...color, 255], 4 * i);
      labels[i] = Math.max(ball, 0);
    }
    chunks.push({ positions, points, colors, labels });
  }
  const bounds = [-1, -1, 0, 1, 1, 0.64].map((value, i) => value + offset[i % 3]!);
  const spacing_m = 2 / Math.sqrt(count);
  return { info: { points: count, shown: count, bounds, up: [0, 0, 1], spacing_m }, chunks };
}

export function load(viewer: Viewer, cloud: MadeCloud): void {
  viewer.cloud.begin(cloud.info);
  kLabelColors.forEach((color, label) => viewer.cloud.setLabelColor(label, color));
  for (const chunk of cloud.chunks) viewer.cloud.append(chunk);
}

const viewer = createViewer(document.querySelector<HTMLElement>("#view")!);

export const api = { viewer, makeCloud, load, random };
declare global {
  interface Window {
    dev: typeof api;
  }
}
window.dev = api;

const count = Number(new URLSearchParams(location.search).get("points") ?? 0);
if (count > 0) load(viewer, makeCloud(count));
