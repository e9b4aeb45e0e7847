// SPDX-License-Identifier: Apache-2.0
// A document with every kind of layer, and a program of a few lines that serves it. For tests of the page alone.
import type { Page, WebSocketRoute } from "@playwright/test";
import type { Layer, Rows, SceneDocument, Step } from "../src/show/document";
import { decode, encode } from "../src/protocol";

export interface Mock {
  document: SceneDocument;
  buffers: Map<string, ArrayBuffer>;
}

type Vec = [number, number, number];
const sub = (a: Vec, b: Vec): Vec => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const cross = (a: Vec, b: Vec): Vec => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a: Vec): Vec => {
  const l = Math.hypot(...a);
  return [a[0] / l, a[1] / l, a[2] / l];
};

export const kTarget: Vec = [0, 0, 0.08];

/** x right, y down, z forward. */
export function lookAt(from: Vec, to: Vec = kTarget): number[][] {
  const z = unit(sub(to, from));
  const x = unit(cross(z, [0, 0, 1]));
  const y = cross(z, x);
  return [0, 1, 2].map((i) => [x[i]!, y[i]!, z[i]!, from[i]!]).concat([[0, 0, 0, 1]]);
}

class Builder {
  readonly buffers = new Map<string, ArrayBuffer>();
  readonly layers: Layer[] = [];

  add(layer: Omit<Layer, "buffer" | "visible"> & { visible?: boolean }, ...arrays: (Float32Array | Uint8Array | Uint32Array)[]): void {
    const whole = new Uint8Array(arrays.reduce((sum, a) => sum + a.byteLength, 0));
    let at = 0;
    for (const a of arrays) {
      whole.set(new Uint8Array(a.buffer, a.byteOffset, a.byteLength), at);
      at += a.byteLength;
    }
    const buffer = `b${this.layers.length}`;
    this.buffers.set(buffer, whole.buffer);
    this.layers.push({ visible: true, ...layer, buffer });
  }
}

function height(x: number, y: number): number {
  return Math.max(0, 0.16 - 6 * ((x - 0.05) ** 2 + y ** 2)) + Math.max(0, 0.1 - 14 * ((x + 0.2) ** 2 + (y - 0.12) ** 2));
}

function surface(builder: Builder, n: number): void {
  const positions: number[] = [];
  const colors: number[] = [];
  const faces: number[] = [];
  for (let j = 0; j < n; ++j)
    for (let i = 0; i < n; ++i) {
      const x = (i / (n - 1) - 0.5) * 0.9;
      const y = (j / (n - 1) - 0.5) * 0.9;
      const z = height(x, y);
      positions.push(x, y, z);
      colors.push(...(z > 0.002 ? (x > -0.05 ? [205, 92, 60, 255] : [70, 130, 105, 255]) : [186, 178, 166, 255]));
      if (i + 1 < n && j + 1 < n) {
        const a = j * n + i;
        faces.push(a, a + 1, a + n, a + 1, a + n + 1, a + n);
      }
    }
  builder.add(
    { id: "surface", name: "Surface", kind: "triangles", count: faces.length / 3, vertices: n * n, colors: true },
    new Float32Array(positions), new Uint8Array(colors), new Uint32Array(faces),
  );
}

function box(out: { p: number[]; f: number[] }, c: Vec, h: Vec): void {
  const o = out.p.length / 3;
  for (let k = 0; k < 8; ++k) out.p.push(c[0] + (k & 1 ? h[0] : -h[0]), c[1] + (k & 2 ? h[1] : -h[1]), c[2] + (k & 4 ? h[2] : -h[2]));
  for (const [a, b, d, e] of [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]] as const) out.f.push(o + a, o + b, o + d, o + a, o + d, o + e);
}

function arm(to: Vec): { p: number[]; f: number[] } {
  const out = { p: [] as number[], f: [] as number[] };
  const base: Vec = [-0.75, 0, 0.05];
  const wrist: Vec = [to[0] * 1.25, to[1] * 1.25, to[2] + 0.15]; // behind the camera
  const elbow: Vec = [-0.55, to[1] * 0.5, 0.75];
  for (let i = 0; i <= 12; ++i) {
    const [a, b, t] = i < 6 ? [base, elbow, i / 6] : [elbow, wrist, (i - 6) / 6];
    box(out, [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, a[2] + (b[2] - a[2]) * t], [0.045 - i * 0.002, 0.045 - i * 0.002, 0.05]);
  }
  return out;
}

/** A run of `count` steps. `live`: it goes on. */
export function mockRun(count = 4, live = false, finer = 81): Mock {
  const builder = new Builder();
  surface(builder, finer);
  const voxels: number[] = [];
  for (let i = 0; i < 900; ++i) voxels.push(0.2 + (i % 10) * 0.02, -0.4 + Math.floor(i / 10) * 0.009, 0.05 + ((i * 7) % 5) * 0.02);
  builder.add({ id: "frontier", name: "Frontier of the unknown", kind: "voxels", count: 900, color: "#3b82f6", colors: false, size_m: 0.012 }, new Float32Array(voxels));
  const salient: number[] = [];
  const saliency: number[] = [];
  for (let i = 0; i < 3000; ++i) {
    const [x, y] = [((i * 37) % 100) / 100 * 0.3 - 0.1, (Math.floor(i / 30) / 100 - 0.5) * 0.3];
    const s = Math.max(0, 1 - Math.hypot(x - 0.05, y) * 6);
    salient.push(x, y, height(x, y) + 0.003);
    saliency.push(255, Math.round(230 * (1 - s)), 40, 255);
  }
  builder.add(
    { id: "regions", name: "Regions by saliency", kind: "points", count: 3000, colors: true, size_m: 0.004, legend: [["little salient", "#ffe628"], ["salient", "#ff0028"]] },
    new Float32Array(salient), new Uint8Array(saliency),
  );
  builder.add({ id: "hidden", name: "Unknown", kind: "points", count: 1, colors: false, visible: false, color: "#888888" }, new Float32Array([0, 0, 0.5]));
  const steps: Step[] = [];
  for (let s = 0; s < count; ++s) {
    const angle = 0.6 + s * 1.1;
    const from: Vec = [Math.cos(angle) * 0.6, Math.sin(angle) * 0.6, 0.55];
    const posture = arm(from);
    builder.add({ id: `arm${s}`, name: "Arm", kind: "triangles", step: s, count: posture.f.length / 3, vertices: posture.p.length / 3, colors: false, color: "#e8a33d" }, new Float32Array(posture.p), new Uint32Array(posture.f));
    const poses: number[] = [];
    const gains: number[] = [];
    for (let i = 0; i < 24; ++i) {
      const a = (i / 24) * 2 * Math.PI;
      const r: Vec = [Math.cos(a) * 0.5, Math.sin(a) * 0.5, 0.35 + (i % 3) * 0.12];
      poses.push(...lookAt(r).flat());
      gains.push(i === 5 ? Number.NaN : Math.round(4000 * Math.max(0, Math.cos(a - angle)) + i));
    }
    builder.add({ id: `views${s}`, name: "Candidates", kind: "views", step: s, count: 24, fov_rad: [1.09, 0.86] }, new Float32Array(poses), new Float32Array(gains));
    const hits: number[] = [];
    for (let i = 0; i < 40; ++i) hits.push(...from, (i % 8) * 0.03 - 0.1, Math.floor(i / 8) * 0.04 - 0.1, 0.06);
    builder.add({ id: `rays${s}`, name: "Rays", kind: "lines", step: s, count: 40, colors: false, color: "#22c55e", visible: s % 2 === 0 }, new Float32Array(hits));
    steps.push({
      name: s === 0 ? "Initial scan" : `View ${s}`,
      T_world_camera: lookAt(from),
      fov_rad: [1.09, 0.86],
      facts: [["Gain", `${4000 - s * 700} voxels`], ["Unknown left", `${(38 / (s + 1)).toFixed(1)} %`], ["Planned in", `${120 + s * 9} ms`]],
      pictures: [{ name: `view-${s}-seen`, title: "What the camera saw" }, { name: `view-${s}-choice`, title: "Choice" }],
    });
  }
  return {
    document: {
      title: "tabletop-1", kind: "run", live, up: [0, 0, 1], bounds: [-0.8, -0.5, 0, 0.6, 0.5, 0.9],
      facts: [["Views", String(count)], ["Voxels known", "96.1 %"], ["Surface coverage", "91.4 %"], ["Arm moved", "4.2 m"], ["Strategy", "saliency"]],
      layers: builder.layers, steps,
    },
    buffers: builder.buffers,
  };
}

/** Serves a mock to a page. What it returns changes the document, or breaks the connection. */
export async function serveMock(page: Page, first: Mock): Promise<{ update: (mock: Mock) => void; drop: () => Promise<void>; asked: string[]; pictures: string[] }> {
  let mock = first;
  let revision = 1;
  let socket: WebSocketRoute | undefined;
  const asked: string[] = []; // names of buffers
  const pictures: string[] = []; // fetched with the token
  const send = (ws: WebSocketRoute, head: object, body: Uint8Array = new Uint8Array(0)): void => ws.send(Buffer.concat([Buffer.from(encode(head)), body]));
  await page.routeWebSocket(/\/socket/, (ws) => {
    socket = ws;
    ws.onMessage((message) => {
      if (typeof message === "string") return;
      const { head } = decode(new Uint8Array(message).buffer);
      const answer = { type: "answer", request: head.request, ok: true };
      if (head.type === "hello") send(ws, { ...answer, protocol: 1, version: "0.0.0", mode: "show", title: mock.document.title, document: revision });
      else if (head.type === "document") send(ws, { ...answer, document: mock.document });
      else if (head.type === "buffer") {
        const whole = mock.buffers.get(String(head["name"]));
        const from = Number(head["from"]);
        asked.push(String(head["name"]));
        if (!whole) send(ws, { ...answer, ok: false, error: { code: "not_found", message: "no such buffer", context: "" } });
        else send(ws, { ...answer, from, total: whole.byteLength }, new Uint8Array(whole.slice(from, from + Number(head["bytes"]))));
      }
    });
  });
  await page.addInitScript(() => sessionStorage.setItem("saccade.token", "a-token-for-tests"));
  await page.route(/\/data\/picture/, (route) => {
    const name = new URL(route.request().url()).searchParams.get("name") ?? "";
    if (route.request().headers()["saccade-token"] === "a-token-for-tests") pictures.push(name);
    const hue = (name.charCodeAt(5) * 67) % 360;
    return route.fulfill({
      contentType: "image/svg+xml",
      body: `<svg xmlns="http://www.w3.org/2000/svg" width="640" height="480"><rect width="640" height="480" fill="hsl(${hue} 30% 70%)"/><circle cx="320" cy="260" r="110" fill="hsl(${hue} 60% 40%)"/><text x="20" y="50" font-size="32" font-family="sans-serif">${name}</text></svg>`,
    });
  });
  return {
    update: (next) => {
      mock = next;
      if (socket) send(socket, { type: "document", revision: ++revision });
    },
    drop: async () => void (await socket?.close({ code: 1012, reason: "test" })),
    asked,
    pictures,
  };
}

export type { Rows };
