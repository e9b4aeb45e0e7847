// SPDX-License-Identifier: Apache-2.0
// Five million points without colours in both pages: forty moves of the mouse that turn the view, and how soon the picture is whole
// again. For make evidence: with SACCADE_LARGE=1 alone.
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { random } from "../dev/random";
import { expect, keep, test } from "./support/desk";

const kPoints = 5_000_000;
const kMoves = 40;
const kMostMoves_ms = 20_000; // a page that draws all points for every move needs minutes

/** Rows of a hilly ground as a scanner writes them, in a binary PLY. */
function writeGround(file: string): void {
  const next = random(11);
  const places = new Float32Array(3 * kPoints);
  const wide = Math.ceil(Math.sqrt(kPoints));
  for (let i = 0; i < kPoints; ++i) {
    const x = (2 * (i % wide)) / wide - 1;
    const y = (2 * Math.floor(i / wide)) / wide - 1;
    places.set([x, y, 0.15 * Math.sin(4 * x) * Math.cos(5 * y) + 0.002 * next()], 3 * i);
  }
  const head = `ply\nformat binary_little_endian 1.0\nelement vertex ${kPoints}\nproperty float x\nproperty float y\nproperty float z\nend_header\n`;
  writeFileSync(file, Buffer.concat([Buffer.from(head), Buffer.from(places.buffer)]));
}

test("five million points are turned as quickly in the viewer as on the annotation page", async ({ desk, context }) => {
  test.setTimeout(900_000);
  const file = join(desk.folder, "ground.ply");
  writeGround(file);
  const times = new Map<string, number>();
  for (const mode of ["show", "annotate"]) {
    const program = await desk.start(mode, file);
    const page = await context.newPage();
    await page.goto(program.url);
    const whole = () => page.waitForFunction(() => document.querySelector("[data-picture]") && document.querySelector<HTMLElement>(".progress")?.hidden, undefined, { timeout: 300_000 });
    await whole();
    const button = mode === "annotate" ? "right" : "left";
    await page.mouse.move(700, 420);
    await page.mouse.down({ button });
    const began = performance.now();
    for (let i = 1; i <= kMoves; ++i) await page.mouse.move(700 + 6 * i, 420 + 2 * i);
    const moves_ms = performance.now() - began;
    await page.mouse.up({ button });
    await whole();
    const whole_ms = performance.now() - began;
    times.set(mode, moves_ms);
    await keep(page, `turning-${mode}`);
    console.log(`${mode}: ${kMoves} moves ${moves_ms.toFixed(0)} ms, whole again after ${whole_ms.toFixed(0)} ms`);
    await page.close();
  }
  expect(times.get("show")!).toBeLessThan(kMostMoves_ms);
  expect(times.get("show")!).toBeLessThan(3 * times.get("annotate")! + 2000);
});
