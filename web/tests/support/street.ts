// SPDX-License-Identifier: Apache-2.0
// A made street as a LAS, as large as wanted: ground, facades with windows, poles, cars and trees. Its classes are the truth.
import { closeSync, openSync, writeSync } from "node:fs";
import { randomOf } from "./clouds";

/** Classes of the points, as LAS has them where it can. */
export const kGround = 2;
export const kTree = 5;
export const kFacade = 6;
export const kPole = 15;
export const kCar = 20;

export interface Street {
  file: string;
  points: number;
  length_m: number;
  /** A place on the roof of each car. */
  cars: readonly (readonly [number, number, number])[];
}

type Write = (x: number, y: number, z: number, r: number, g: number, b: number, label: number) => void;
interface Part {
  share: number; // part of the points
  add(random: () => number, write: Write): void;
}

const kWidth_m = 24;
const kScale_m = 0.001;
const kRecord = 26; // bytes of a point of format 2
const kHeader = 227;
const kBatch = 1 << 16;
const kNoise_m = 0.006;
const kBlock_m = 12; // along which everything repeats

function parts(length_m: number, cars: (readonly [number, number, number])[]): Part[] {
  const blocks = Math.max(1, Math.floor(length_m / kBlock_m));
  const places = Array.from({ length: blocks }, (_, i) => (i + 0.5) * kBlock_m);
  for (const x of places) cars.push([x, 7.6, 1.45]);
  const any = (random: () => number) => places[Math.floor(random() * blocks)]!;
  const ground: Part = {
    share: 0.45,
    add: (random, write) => {
      const [x, y] = [random() * length_m, random() * kWidth_m];
      const kerb = y < 5 || y > kWidth_m - 5 ? 0.12 : 0;
      const light = kerb > 0 ? 150 : 92;
      write(x, y, kerb + 0.02 * Math.sin(0.3 * x), light, light, light + 4, kGround);
    },
  };
  const facade: Part = {
    share: 0.3,
    add: (random, write) => {
      const [x, z] = [random() * length_m, 12 * random()];
      const side = random() < 0.5 ? 0 : 1;
      const window = x % 3 < 1.4 && z % 3 > 1 && z % 3 < 2.5;
      const house = Math.floor(x / kBlock_m) % 4;
      const y = side === 0 ? (window ? -0.2 : 0) : kWidth_m + (window ? 0.2 : 0);
      if (window) write(x, y, z, 60, 70, 90, kFacade);
      else write(x, y, z, 170 + 15 * house, 140 + 10 * house, 120 - 12 * house, kFacade);
    },
  };
  const pole: Part = {
    share: 0.02,
    add: (random, write) => {
      const angle = 2 * Math.PI * random();
      write(any(random) + 4 + 0.06 * Math.cos(angle), 4.4 + 0.06 * Math.sin(angle), 0.1 + 5 * random(), 70, 74, 78, kPole);
    },
  };
  const car: Part = {
    share: 0.08,
    add: (random, write) => {
      const x = any(random);
      const [u, v, w] = [random(), random(), random()];
      const color = Math.floor(x / kBlock_m) % 3;
      const paint: [number, number, number] = color === 0 ? [180, 40, 40] : color === 1 ? [40, 70, 160] : [210, 210, 205];
      if (w < 0.3) write(x - 1 + 2 * u, 6.9 + 1.4 * v, 1.45, ...paint, kCar);
      else if (w < 0.5) write(x - 2 + 4 * u, 6.7 + 1.8 * v, 0.8, ...paint, kCar);
      else if (w < 0.8) write(x - 2 + 4 * u, v < 0.5 ? 6.7 : 8.5, 0.25 + 0.55 * random(), ...paint, kCar);
      else write(u < 0.5 ? x - 2 : x + 2, 6.7 + 1.8 * v, 0.25 + 0.55 * random(), ...paint, kCar);
    },
  };
  const tree: Part = {
    share: 0.15,
    add: (random, write) => {
      const x = any(random) - 4;
      const angle = 2 * Math.PI * random();
      if (random() < 0.15) return write(x + 0.15 * Math.cos(angle), 20 + 0.15 * Math.sin(angle), 2.6 * random(), 96, 70, 48, kTree);
      const [height, r] = [2 * random() - 1, 2 * Math.cbrt(random())];
      const across = r * Math.sqrt(1 - height * height);
      write(x + across * Math.cos(angle), 20 + across * Math.sin(angle), 4.4 + r * height, 50 + 40 * random(), 110, 50, kTree);
    },
  };
  return [ground, facade, pole, car, tree];
}

function header(points: number, length_m: number): Buffer {
  const bytes = Buffer.alloc(kHeader);
  bytes.write("LASF", 0, "latin1");
  bytes.writeUInt8(1, 24);
  bytes.writeUInt8(2, 25);
  bytes.writeUInt16LE(kHeader, 94);
  bytes.writeUInt32LE(kHeader, 96);
  bytes.writeUInt8(2, 104);
  bytes.writeUInt16LE(kRecord, 105);
  bytes.writeUInt32LE(points, 107);
  for (let axis = 0; axis < 3; ++axis) bytes.writeDoubleLE(kScale_m, 131 + 8 * axis);
  [length_m, 0, kWidth_m, 0, 13, 0].forEach((bound, i) => bytes.writeDoubleLE(bound, 179 + 8 * i));
  return bytes;
}

/** Writes a street of `points` points, each with noise. Its length `length_m` goes with their number, so that their spacing stays. */
export function makeStreet(file: string, points: number, options: { length_m?: number; seed?: number } = {}): Street {
  const { length_m = Math.max(kBlock_m, points / 125_000), seed = 1 } = options;
  const random = randomOf(seed);
  const noise = () => (random() + random() - 1) * kNoise_m;
  const cars: (readonly [number, number, number])[] = [];
  const all = parts(length_m, cars);
  const out = openSync(file, "w");
  writeSync(out, header(points, length_m));
  const batch = Buffer.alloc(kBatch * kRecord);
  let inBatch = 0;
  const write: Write = (x, y, z, r, g, b, label) => {
    const at = kRecord * inBatch++;
    batch.writeInt32LE(Math.round((x + noise()) / kScale_m), at);
    batch.writeInt32LE(Math.round((y + noise()) / kScale_m), at + 4);
    batch.writeInt32LE(Math.round((z + noise()) / kScale_m), at + 8);
    batch.writeUInt16LE(200, at + 12);
    batch.writeUInt8(label, at + 15);
    batch.writeUInt16LE(256 * Math.floor(r), at + 20);
    batch.writeUInt16LE(256 * Math.floor(g), at + 22);
    batch.writeUInt16LE(256 * Math.floor(b), at + 24);
    if (inBatch < kBatch) return;
    writeSync(out, batch);
    inBatch = 0;
  };
  for (let i = 0; i < points; ++i) {
    let share = random();
    let part = 0;
    while (part < all.length - 1 && share >= all[part]!.share) share -= all[part++]!.share;
    all[part]!.add(random, write);
  }
  writeSync(out, batch.subarray(0, inBatch * kRecord));
  closeSync(out);
  return { file, points, length_m, cars };
}
