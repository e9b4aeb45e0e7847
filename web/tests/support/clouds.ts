// SPDX-License-Identifier: Apache-2.0
// Made clouds whose true labels a test knows: a table with four objects.
import { writeFileSync } from "node:fs";

export type Place = readonly [number, number, number];
export type Color = readonly [number, number, number];

/** The truth's labels. */
export const kTable = 1;
export const kBox = 2;
export const kCylinder = 3;
export const kSphere = 4;
export const kFlatBox = 5;

/** Places on what is seen from above, well inside. */
export const kTops: Readonly<Record<number, Place>> = {
  [kTable]: [0.0, -0.25, 0],
  [kBox]: [-0.35, -0.1, 0.2],
  [kCylinder]: [0.0, 0.2, 0.24],
  [kSphere]: [0.35, -0.15, 0.22],
  [kFlatBox]: [0.36, 0.24, 0.1],
};

export interface MadeCloud {
  file: string;
  positions: Float32Array; // x, y, z
  truth: Uint32Array;
}

/** Numbers in [0, 1) that are the same every time (mulberry32). */
export function randomOf(seed: number): () => number {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let t = Math.imul(state ^ (state >>> 15), state | 1);
    t ^= t + Math.imul(t ^ (t >>> 7), t | 61);
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

interface Surface {
  label: number;
  color: Color;
  u_m: number; // how large it is
  v_m: number;
  at(u: number, v: number): Place | null; // 0 to 1; null: nothing there
}

const kHalf: readonly [number, number] = [0.6, 0.45]; // half sides of the table, in metres
const kWhere = {
  box: { x: -0.35, y: -0.1, half: [0.1, 0.08], z: 0.2 },
  flatBox: { x: 0.36, y: 0.24, half: [0.1, 0.08], z: 0.1 },
  cylinder: { x: 0.0, y: 0.2, r: 0.09, z: 0.24 },
  sphere: { x: 0.35, y: -0.15, r: 0.11 },
} as const;

function inBox(box: typeof kWhere.box | typeof kWhere.flatBox, x: number, y: number): boolean {
  return Math.abs(x - box.x) < box.half[0] && Math.abs(y - box.y) < box.half[1];
}

function table(): Surface {
  const { box, flatBox, cylinder, sphere } = kWhere;
  const at = (u: number, v: number): Place | null => {
    const x = (2 * u - 1) * kHalf[0];
    const y = (2 * v - 1) * kHalf[1];
    const covered =
      inBox(box, x, y) ||
      inBox(flatBox, x, y) ||
      Math.hypot(x - cylinder.x, y - cylinder.y) < cylinder.r ||
      Math.hypot(x - sphere.x, y - sphere.y) < 0.045;
    return covered ? null : [x, y, 0];
  };
  return { label: kTable, color: [150, 112, 78], u_m: 2 * kHalf[0], v_m: 2 * kHalf[1], at };
}

function boxSides(label: number, color: Color, box: typeof kWhere.box | typeof kWhere.flatBox): Surface[] {
  const [hx, hy] = box.half;
  const side = (u_m: number, v_m: number, at: (u: number, v: number) => Place): Surface => ({ label, color, u_m, v_m, at });
  const across = (u: number, half: number) => (2 * u - 1) * half;
  return [
    side(2 * hx, 2 * hy, (u, v) => [box.x + across(u, hx), box.y + across(v, hy), box.z]),
    ...[-1, 1].map((s) => side(2 * hx, box.z, (u, v) => [box.x + across(u, hx), box.y + s * hy, v * box.z])),
    ...[-1, 1].map((s) => side(2 * hy, box.z, (u, v) => [box.x + s * hx, box.y + across(u, hy), v * box.z])),
  ];
}

function cylinderSides(color: Color): Surface[] {
  const { x, y, r, z } = kWhere.cylinder;
  const around = (u: number, radius: number, height: number): Place => {
    const angle = 2 * Math.PI * u;
    return [x + radius * Math.cos(angle), y + radius * Math.sin(angle), height];
  };
  const disc = (u: number, v: number): Place | null => {
    const [a, b] = [2 * u - 1, 2 * v - 1];
    return Math.hypot(a, b) < 1 ? [x + r * a, y + r * b, z] : null;
  };
  return [
    { label: kCylinder, color, u_m: 2 * Math.PI * r, v_m: z, at: (u, v) => around(u, r, v * z) },
    { label: kCylinder, color, u_m: 2 * r, v_m: 2 * r, at: disc },
  ];
}

/** Equal areas by Archimedes: the height is even. */
function sphere(color: Color): Surface {
  const { x, y, r } = kWhere.sphere;
  const at = (u: number, v: number): Place => {
    const height = 2 * v - 1;
    const across = Math.sqrt(1 - height * height);
    return [x + r * across * Math.cos(2 * Math.PI * u), y + r * across * Math.sin(2 * Math.PI * u), r + r * height];
  };
  return { label: kSphere, color, u_m: 2 * Math.PI * r, v_m: 2 * r, at };
}

const kSurfaces: readonly Surface[] = [
  table(),
  ...boxSides(kBox, [196, 60, 52], kWhere.box),
  ...cylinderSides([70, 150, 80]),
  sphere([60, 96, 190]),
  ...boxSides(kFlatBox, [208, 190, 70], kWhere.flatBox),
];

/** As a PCD: about 64,000 points at 5 mm; their number goes with 1 / spacing². */
export function makeTable(file: string, options: { spacing_m?: number; seed?: number; turn_rad?: number } = {}): MadeCloud {
  const { spacing_m = 0.005, seed = 1, turn_rad = 0 } = options;
  const random = randomOf(seed);
  const noise = (size: number) => (random() + random() + random() - 1.5) * size;
  const [cos, sin] = [Math.cos(turn_rad), Math.sin(turn_rad)];
  const most = kSurfaces.reduce((sum, { u_m, v_m }) => sum + Math.ceil(u_m / spacing_m) * Math.ceil(v_m / spacing_m), 0);
  const bytes = Buffer.alloc(16 * most);
  const positions = new Float32Array(3 * most);
  const truth = new Uint32Array(most);
  let count = 0;
  for (const { label, color, u_m, v_m, at } of kSurfaces) {
    const [columns, rows] = [Math.ceil(u_m / spacing_m), Math.ceil(v_m / spacing_m)];
    for (let i = 0; i < columns * rows; ++i) {
      const place = at(((i % columns) + random()) / columns, (Math.floor(i / columns) + random()) / rows);
      if (!place) continue;
      const [x, y, z] = [place[0] + noise(0.0008), place[1] + noise(0.0008), place[2] + noise(0.0008)];
      positions.set([cos * x - sin * y, sin * x + cos * y, z], 3 * count);
      const [r, g, b] = color.map((c) => Math.max(0, Math.min(255, Math.round(c + noise(8))))) as [number, number, number];
      for (const axis of [0, 1, 2]) bytes.writeFloatLE(positions[3 * count + axis]!, 16 * count + 4 * axis);
      bytes.writeUInt32LE((r << 16) | (g << 8) | b, 16 * count + 12);
      truth[count++] = label;
    }
  }
  const head = `# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH ${count}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS ${count}\nDATA binary\n`;
  writeFileSync(file, Buffer.concat([Buffer.from(head, "latin1"), bytes.subarray(0, 16 * count)]));
  return { file, positions: positions.slice(0, 3 * count), truth: truth.slice(0, count) };
}

export function positionOf(cloud: MadeCloud, point: number): Place {
  return [cloud.positions[3 * point]!, cloud.positions[3 * point + 1]!, cloud.positions[3 * point + 2]!];
}
