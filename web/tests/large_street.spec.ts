// SPDX-License-Identifier: Apache-2.0
// A street of fifty million points: how soon there is something to see, what comes when one goes nearer, how quick a click is, and what
// the page needs. For make evidence: with SACCADE_LARGE=1 alone. SACCADE_STREET_POINTS makes it smaller.
import { join } from "node:path";
import { Annotator } from "./support/annotator";
import { expect, keep, test } from "./support/desk";
import { memoryOf } from "./support/memory";
import { makeStreet } from "./support/street";

const kPoints = Number(process.env["SACCADE_STREET_POINTS"] ?? 50_000_000);
const kFirstPicture_ms = 20_000; // after the page is asked for
const kMostHeap_mb = 1500;

test("a street of fifty million points", async ({ desk, context }) => {
  test.setTimeout(1_200_000);
  const street = makeStreet(join(desk.folder, "street.las"), kPoints);
  const started = performance.now();
  const program = await desk.start("annotate", street.file);
  const listens_ms = performance.now() - started;

  const page = await context.newPage();
  const annotator = new Annotator(page, { file: street.file, positions: new Float32Array([0, 0, 0, street.length_m, 24, 12]), truth: new Uint32Array() });
  const tiles = page.locator("[data-tiles]");
  const held = async () => (await tiles.getAttribute("data-tiles", { timeout: 120_000 }))!;
  const began = performance.now();
  await page.goto(program.url);
  await expect(annotator.view).toBeVisible({ timeout: 60_000 });
  await page.waitForFunction(() => document.querySelector("[data-picture]") !== null && document.querySelector("[data-tiles]") !== null, undefined, { timeout: 120_000 });
  const first_ms = performance.now() - began;
  const first = await held();
  await keep(page, "street-first");

  await page.mouse.move(800, 480);
  for (let i = 0; i < 10; ++i) await page.mouse.wheel(0, -240);
  const nearer = performance.now();
  await page.waitForTimeout(100);
  const near = await held();
  const nearer_ms = performance.now() - nearer;
  await expect(page.locator(".progress")).toBeHidden({ timeout: 900_000 });
  const ready_ms = performance.now() - started;
  await keep(page, "street-near");

  const session = await context.newCDPSession(page);
  await session.send("HeapProfiler.collectGarbage");
  const heap_mb = await page.evaluate(() => (performance as Performance & { memory: { usedJSHeapSize: number } }).memory.usedJSHeapSize / 1048576);
  const memory = memoryOf(process.pid);
  const figures =
    `${kPoints} points: the program listens after ${(listens_ms / 1000).toFixed(1)} s; whole picture ${(first_ms / 1000).toFixed(1)} s after the page is asked for (tiles and points: ${first}); ` +
    `nearer, finer tiles are there after ${(nearer_ms / 1000).toFixed(1)} s (${near}); ready to annotate after ${(ready_ms / 1000).toFixed(1)} s; ` +
    `JavaScript's heap ${heap_mb.toFixed(0)} MiB, the browser ${(memory.get("chromium") ?? NaN).toFixed(0)} MiB, the program ${(memory.get("saccade") ?? NaN).toFixed(0)} MiB once it is ready`;
  console.log(figures);
  test.info().annotations.push({ type: "figures", description: figures });
  expect(first_ms).toBeLessThanOrEqual(kFirstPicture_ms);
  expect(heap_mb).toBeLessThanOrEqual(kMostHeap_mb);
});
