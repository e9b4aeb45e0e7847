// SPDX-License-Identifier: Apache-2.0
// Top, front, side and free view in one window: each is moved, picked and selected in for itself.
import { join } from "node:path";
import type { Annotator } from "./support/annotator";
import { type MadeCloud, type Place, kBox, kFlatBox, kSphere, kTops, makeTable, positionOf } from "./support/clouds";
import { expect, keep, test } from "./support/desk";
import { labelsOfPcd } from "./support/pcd";

type Pane = "top" | "front" | "side";

/** Axes of the cloud to the right and up in a pane, and the pane's column and row. */
const kPanes: Record<Pane, { right: 0 | 1; up: 1 | 2; column: 0 | 1; row: 0 | 1 }> = {
  top: { right: 0, up: 1, column: 0, row: 0 },
  front: { right: 0, up: 2, column: 0, row: 1 },
  side: { right: 1, up: 2, column: 1, row: 1 },
};

/** Where a place is on the page: the whole cloud in the middle of the pane, with some room. */
async function at(annotator: Annotator, pane: Pane, place: Place): Promise<[number, number]> {
  const { right, up, column, row } = kPanes[pane];
  const box = await annotator.box();
  const [width, height] = [box.width / 2, box.height / 2];
  const { positions } = annotator.cloud;
  const range = (axis: number) => {
    const values = Array.from({ length: positions.length / 3 }, (_, i) => positions[3 * i + axis]!);
    return [values.reduce((a, b) => Math.min(a, b)), values.reduce((a, b) => Math.max(a, b))] as const;
  };
  const [x, y] = [range(right), range(up)];
  const high_m = 1.08 * Math.max(y[1] - y[0], ((x[1] - x[0]) * height) / width);
  const px_per_m = height / high_m;
  return [
    box.x + width * (column + 0.5) + px_per_m * (place[right] - (x[0] + x[1]) / 2),
    box.y + height * (row + 0.5) - px_per_m * (place[up] - (y[0] + y[1]) / 2),
  ];
}

async function four(annotator: Annotator): Promise<void> {
  await annotator.page.keyboard.press("Shift+V");
  await expect(annotator.view).toHaveAttribute("data-views", "4");
  await annotator.settled();
}

async function pointAt(annotator: Annotator, [x, y]: readonly [number, number]): Promise<number> {
  await annotator.page.mouse.move(x - 1, y);
  await annotator.page.mouse.move(x, y);
  const readout = annotator.page.getByText(/point \d+/);
  await expect(readout).toBeVisible();
  return Number(/point (\d+)/.exec((await readout.textContent())!)![1]);
}

/** Labels of points, by a rectangle between two places in a pane. */
async function drag(annotator: Annotator, pane: Pane, a: Place, b: Place): Promise<void> {
  await annotator.dragRectangle(await at(annotator, pane, a), await at(annotator, pane, b));
  await annotator.written();
}

function expectBetween(labels: ArrayLike<number>, label: number, cloud: MadeCloud, inside: (place: Place) => number): void {
  let count = 0;
  const wrong: string[] = [];
  for (let point = 0; point < labels.length; ++point) {
    const deep_m = inside(positionOf(cloud, point)); // how far inside; negative: outside
    if (Math.abs(deep_m) < 0.004) continue; // about a pixel
    if ((labels[point] === label) !== deep_m > 0) wrong.push(`point ${point}, ${deep_m} m inside`);
    count += deep_m > 0 ? 1 : 0;
  }
  expect(wrong).toEqual([]);
  expect(count).toBeGreaterThan(100);
}

test("clicks and areas in each of four views", async ({ desk }) => {
  const cloud = makeTable(join(desk.folder, "table.pcd"), { spacing_m: 0.008 });
  const program = await desk.start("annotate", cloud.file);
  const annotator = await desk.open(program, cloud);
  const { page } = annotator;
  const single = await annotator.settled();
  await four(annotator);
  await annotator.choose("Action", "Set");

  await test.step("clicks", async () => {
    const top = await at(annotator, "top", kTops[kBox]!);
    expect(cloud.truth[await pointAt(annotator, top)]).toBe(kBox);
    await annotator.chooseLabel(kBox);
    await page.mouse.click(...top);
    await annotator.expectLabel(kBox, { controls: 1 });
    await expect(annotator.view).toHaveAttribute("data-pane", "top");
    const front: Place = [0.35, -0.26, 0.11]; // the sphere, before the flat box
    expect(cloud.truth[await pointAt(annotator, await at(annotator, "front", front))]).toBe(kSphere);
    await annotator.chooseLabel(kSphere);
    await page.mouse.click(...(await at(annotator, "front", front)));
    await annotator.expectLabel(kSphere, { controls: 1 });
    await expect(annotator.view).toHaveAttribute("data-pane", "front");
    await annotator.written();
    await annotator.settled();
    await keep(page, "four-views");
  });

  await test.step("a deep area in the side view is a slab, by no perspective", async () => {
    await annotator.choose("Tool", "Rectangle");
    await annotator.choose("Depth", "Deep rectangle");
    await annotator.chooseLabel(7);
    await drag(annotator, "side", [0, -0.2, 0.16], [0, 0.25, 0.3]);
    const labels = labelsOfPcd(await annotator.export("PCD"));
    expectBetween(labels, 7, cloud, ([, y, z]) => Math.min(y + 0.2, 0.25 - y, z - 0.16));
  });

  await test.step("an area on the surface in the front view leaves what is behind", async () => {
    await annotator.choose("Depth", "Surface rectangle");
    await annotator.chooseLabel(8);
    await drag(annotator, "front", [0.3, 0, 0.03], [0.4, 0, 0.08]);
    const labels = labelsOfPcd(await annotator.export("PCD"));
    const taken = (object: number) => labels.filter((label, point) => label === 8 && cloud.truth[point] === object).length;
    expect(taken(kSphere)).toBeGreaterThan(50);
    expect(taken(kFlatBox)).toBe(0);
  });

  await test.step("each view is zoomed and moved for itself", async () => {
    const front = await at(annotator, "front", [0.35, -0.26, 0.11]);
    const before = await pointAt(annotator, front);
    const top = await at(annotator, "top", kTops[kBox]!);
    await page.mouse.move(...top);
    await page.mouse.wheel(0, -400);
    await annotator.settled();
    expect(cloud.truth[await pointAt(annotator, top)], "what is under the cursor stays there").toBe(kBox);
    const edge: [number, number] = [top[0] - 40, top[1]];
    const near = await pointAt(annotator, edge);
    await annotator.drag([edge, [edge[0] + 30, edge[1] + 20]], "right");
    await annotator.settled();
    const moved = await pointAt(annotator, [edge[0] + 30, edge[1] + 20]);
    const [a, b] = [positionOf(cloud, near), positionOf(cloud, moved)];
    expect(Math.hypot(a[0] - b[0], a[1] - b[1])).toBeLessThan(0.006);
    expect(await pointAt(annotator, front)).toBe(before);
    await page.keyboard.press("f");
    await annotator.settled();
    expect(cloud.truth[await pointAt(annotator, await at(annotator, "top", kTops[kBox]!))]).toBe(kBox);
  });

  await test.step("the free view is turned as before, and one view alone is what it was", async () => {
    const box = await annotator.box();
    const middle: [number, number] = [box.x + 0.75 * box.width, box.y + 0.25 * box.height];
    await annotator.choose("Tool", "Point");
    expect(await pointAt(annotator, middle)).toBeGreaterThanOrEqual(0);
    await expect(annotator.view).toHaveAttribute("data-pane", "free");
    const seen = await annotator.settled();
    await annotator.drag([middle, [middle[0] + 60, middle[1] + 10]], "right");
    expect(await annotator.settled()).not.toBe(seen);
    await page.keyboard.press("Shift+V");
    await expect(annotator.view).toHaveAttribute("data-views", "1");
    await annotator.look("above");
    expect(cloud.truth[await pointAt(annotator, annotator.at(kTops[kBox]!))]).toBe(kBox);
    expect(await annotator.settled()).not.toBe(single);
  });
});

test("four views of a cloud in tiles, shaded", async ({ desk, context }) => {
  const cloud = makeTable(join(desk.folder, "table.pcd"), { spacing_m: 0.004 });
  await context.addInitScript(() => localStorage.setItem("saccade.pointBudget", "60000"));
  const program = await desk.start("annotate", cloud.file, "--tiles-above", "50000");
  const annotator = await desk.open(program, cloud);
  await four(annotator);
  await annotator.page.getByRole("checkbox", { name: "Shading" }).check();
  await expect(annotator.page.locator("[data-tiles]")).toBeAttached({ timeout: 30_000 });
  await annotator.settled();
  await keep(annotator.page, "four-views-tiles");
  for (const [pane, place, object] of [
    ["top", kTops[kBox]!, kBox],
    ["front", [0.35, -0.26, 0.11], kSphere],
    ["side", [0.46, 0.24, 0.05], kFlatBox],
  ] as [Pane, Place, number][]) {
    expect(cloud.truth[await pointAt(annotator, await at(annotator, pane, place))], pane).toBe(object);
  }
  await annotator.choose("Action", "Set");
  await annotator.choose("Tool", "Rectangle");
  await annotator.choose("Depth", "Deep rectangle");
  await annotator.chooseLabel(7);
  await drag(annotator, "front", [-0.5, 0, 0.12], [0.5, 0, 0.3]);
  const labels = labelsOfPcd(await annotator.export("PCD"));
  expectBetween(labels, 7, cloud, ([x, , z]) => Math.min(x + 0.5, 0.5 - x, z - 0.12));
});
