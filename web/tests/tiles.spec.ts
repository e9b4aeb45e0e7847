// SPDX-License-Identifier: Apache-2.0
// A cloud in tiles: finer where the page looks, with true points, labels and a bounded number of points.
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import type { Page } from "@playwright/test";
import { kBox, kSphere, kTable, kTops, makeTable, positionOf } from "./support/clouds";
import { segmentColors } from "../src/annotate/segments";
import type { Annotator } from "./support/annotator";
import { expect, test } from "./support/desk";

const kBudget = 60_000;

/** Tiles and points that are here, once nothing is on its way. */
async function held(page: Page): Promise<{ tiles: number; points: number }> {
  const view = page.locator("[data-tiles]");
  await expect(view).toBeAttached({ timeout: 30_000 });
  const [tiles, points] = (await view.getAttribute("data-tiles"))!.split(" ").map(Number) as [number, number];
  return { tiles, points };
}

/** The point that the readout names under a place. */
async function pointUnder(annotator: Annotator, at: readonly [number, number]): Promise<{ point: number; text: string }> {
  await annotator.page.mouse.move(at[0] - 1, at[1]);
  await annotator.page.mouse.move(at[0], at[1]);
  const readout = annotator.page.getByText(/point \d+/);
  await expect(readout).toBeVisible();
  const text = (await readout.textContent())!;
  return { point: Number(/point (\d+)/.exec(text)![1]), text };
}

test("tiles of a cloud come where it is looked at", async ({ desk, context }) => {
  const cloud = makeTable(join(desk.folder, "table.pcd"), { spacing_m: 0.0025 });
  await context.addInitScript((budget) => localStorage.setItem("saccade.pointBudget", JSON.stringify(budget)), kBudget);
  const program = await desk.start("annotate", cloud.file, "--tiles-above", "50000");
  const annotator = await desk.open(program, cloud);
  const { page } = annotator;
  expect(cloud.truth.length).toBeGreaterThan(3 * kBudget);

  await annotator.look("above");
  const whole = await held(page);
  expect(whole.tiles).toBeGreaterThanOrEqual(1);
  expect(whole.points).toBeLessThanOrEqual(kBudget);

  // Under the cursor is the point of the file, at its place.
  const place = annotator.at(kTops[kBox]!);
  const { point, text } = await pointUnder(annotator, place);
  expect(cloud.truth[point]).toBe(kBox);
  const [x, y] = positionOf(cloud, point);
  expect(Math.hypot(x - kTops[kBox]![0], y - kTops[kBox]![1])).toBeLessThan(0.02);
  expect(text).toContain(x.toFixed(3));

  // A click labels the object, in all tiles that are here.
  await annotator.labelTops([kTable, kBox]);
  const labelled = await annotator.pointsOf(kBox);
  const truly = cloud.truth.reduce((sum, label) => sum + (label === kBox ? 1 : 0), 0);
  expect(labelled).toBeGreaterThan(0.8 * truly);
  expect((await pointUnder(annotator, place)).text).toMatch(/^label 2/);

  // Nearer, it is finer: more points of the box are here, and what is out of sight goes when there is no room.
  await page.mouse.move(...place);
  for (let i = 0; i < 12; ++i) await page.mouse.wheel(0, -240);
  await page.waitForTimeout(300);
  const near = await held(page);
  expect(near.points).toBeLessThanOrEqual(kBudget);
  expect(near.tiles).toBeGreaterThan(0);
  const finer = await pointUnder(annotator, place);
  expect(finer.text).toMatch(/^label 2/);
  expect(cloud.truth[finer.point]).toBe(kBox);

  // And back: the whole cloud again, with its labels.
  await annotator.look("above");
  await held(page);
  expect((await pointUnder(annotator, place)).text).toMatch(/^label 2/);
});

test("segments are coloured in tiles, too", async ({ desk }) => {
  const cloud = makeTable(join(desk.folder, "table.pcd"), { spacing_m: 0.0025 });
  const segments = join(desk.folder, "segments.txt");
  writeFileSync(segments, `${[...cloud.truth].map((label) => label + 100).join("\n")}\n`);
  const program = await desk.start("annotate", cloud.file, "--tiles-above", "50000", "--segments", segments);
  const annotator = await desk.open(program, cloud);
  await annotator.look("above");
  await annotator.chooseLabel(7);
  await annotator.page.keyboard.press("s");
  await expect(annotator.page.getByLabel("Colour points by")).toHaveValue("segments");
  for (const object of [kBox, kSphere]) {
    const [r, g, b] = segmentColors(1, () => object + 100, () => false);
    await annotator.expectColor([kTops[object]!], [r!, g!, b!], 3);
  }
  await annotator.click(kTops[kBox]!);
  await expect.poll(() => annotator.pointsOf(7)).toBe(cloud.truth.filter((label) => label === kBox).length);
});
