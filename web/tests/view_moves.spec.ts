// SPDX-License-Identifier: Apache-2.0
// The 3-D view alone: the camera by mouse and keys, and tools.
import { expect, test } from "@playwright/test";
import type {} from "../dev/view";
import { open, serve, settled } from "./view_page";

serve();

test("orbit keeps what is under the cursor there, and has no pole", async ({ page }) => {
  await open(page, 200_000);
  await page.waitForFunction(() => window.dev.viewer.hover(640, 420) !== null);
  const under = async (at: readonly [number, number]) =>
    (await page.evaluate(([x, y]) => window.dev.viewer.hover(x, y)!, at)).position;
  // Where a place is seen, css pixels.
  const seen = (place: readonly [number, number, number]) =>
    page.evaluate((position) => {
      const { clip_world: m, size } = window.dev.viewer.picture();
      const [x, y, z] = position;
      const row = (i: number) => m[4 * i]! * x + m[4 * i + 1]! * y + m[4 * i + 2]! * z + m[4 * i + 3]!;
      return [(row(0) / row(3) + 1) * 0.5 * size[0], (1 - row(1) / row(3)) * 0.5 * size[1], row(3)] as const;
    }, place);
  const first = await under([640, 420]);
  const start = await seen(first);

  await page.mouse.move(640, 420);
  await page.mouse.down({ button: "right" });
  for (let i = 1; i <= 40; ++i) await page.mouse.move(640 + i, 420 - 20 * i); // far over the pole
  await page.mouse.up({ button: "right" });
  const turned = await seen(first);
  expect(Math.abs(turned[0] - start[0])).toBeLessThan(1);
  expect(Math.abs(turned[1] - start[1])).toBeLessThan(1);
  const pose = await page.evaluate(() => window.dev.viewer.camera.poseRows());
  const axis = (j: number) => [pose[0]![j]!, pose[1]![j]!, pose[2]![j]!] as const;
  const dot = (a: readonly number[], b: readonly number[]) => a.reduce((sum, value, i) => sum + value * b[i]!, 0);
  expect(Math.abs(dot(axis(0), axis(1)))).toBeLessThan(1e-9);
  expect(Math.abs(dot(axis(2), axis(2)) - 1)).toBeLessThan(1e-9);

  // The wheel comes nearer to what is under the cursor, which stays there.
  const second = await under([turned[0], turned[1]]);
  const far = await seen(second);
  await page.mouse.move(turned[0], turned[1]);
  for (let i = 0; i < 4; ++i) await page.mouse.wheel(0, -120);
  await settled(page);
  const near = await seen(second);
  expect(near[2]).toBeLessThan(0.6 * far[2]);
  expect(Math.hypot(near[0] - far[0], near[1] - far[1])).toBeLessThan(8);

  // The middle button moves it with the cursor.
  const third = await under([turned[0], turned[1]]);
  const held = await seen(third);
  await page.mouse.down({ button: "middle" });
  await page.mouse.move(turned[0] + 100, turned[1] + 50, { steps: 5 });
  await page.mouse.up({ button: "middle" });
  const panned = await seen(third);
  expect(Math.abs(panned[0] - held[0] - 100)).toBeLessThan(3);
  expect(Math.abs(panned[1] - held[1] - 50)).toBeLessThan(3);

  // Ctrl rolls: a quarter around the middle.
  await page.keyboard.down("Control");
  await page.mouse.move(1040, 400);
  await page.mouse.down({ button: "right" });
  for (let i = 1; i <= 18; ++i) await page.mouse.move(640 + 400 * Math.cos((i * Math.PI) / 36), 400 + 300 * Math.sin((i * Math.PI) / 36));
  await page.mouse.up({ button: "right" });
  await page.keyboard.up("Control");
  const rolled = await page.evaluate(() => window.dev.viewer.camera.poseRows());
  expect(Math.abs(dot(axis(2), [rolled[0]![2]!, rolled[1]![2]!, rolled[2]![2]!]) - 1)).toBeLessThan(1e-9);
});

test("a pose comes back as it was set", async ({ page }) => {
  await open(page, 1000);
  const rows = [[0, 0, 1, -3], [-1, 0, 0, 0.2], [0, -1, 0, 0.5], [0, 0, 0, 1]];
  const result = await page.evaluate((rows) => {
    const { viewer } = window.dev;
    viewer.camera.setPoseRows(rows, 0.8);
    const { clip_world: m, size } = viewer.picture();
    const at = (x: number, y: number, z: number) => {
      const row = (i: number) => m[4 * i]! * x + m[4 * i + 1]! * y + m[4 * i + 2]! * z + m[4 * i + 3]!;
      return [(row(0) / row(3) + 1) * 0.5 * size[0], (1 - row(1) / row(3)) * 0.5 * size[1]];
    };
    return { rows: viewer.camera.poseRows(), ahead: at(0, 0.2, 0.5), right: at(0, -0.8, 0.5), up: at(0, 0.2, 1) };
  }, rows);
  result.rows.flat().forEach((value, i) => expect(value).toBeCloseTo(rows.flat()[i]!, 9));
  const [focal_px, middle] = [400 / Math.tan(0.4), [640, 400] as const];
  for (const [seen, dx, dy] of [[result.ahead, 0, 0], [result.right, 1 / 3, 0], [result.up, 0, -0.5 / 3]] as const) {
    expect(seen[0]).toBeCloseTo(middle[0] + focal_px * dx, 4);
    expect(seen[1]).toBeCloseTo(middle[1] + focal_px * dy, 4);
  }
});

test("fly: keys move, dragging looks around, typing does nothing", async ({ page }) => {
  await open(page, 1000);
  const pose = () => page.evaluate(() => window.dev.viewer.camera.poseRows().map((row) => [...row]));
  await page.evaluate(() => {
    window.dev.viewer.camera.navigation = "fly";
    document.body.insertAdjacentHTML("beforeend", '<input style="position:fixed;left:0;top:0" />');
  });
  const start = await pose();
  await page.locator("input").focus();
  await page.keyboard.down("KeyW");
  await page.evaluate(async () => {
    for (let i = 0; i < 10; ++i) await new Promise((done) => requestAnimationFrame(done));
  });
  await page.keyboard.up("KeyW");
  expect(await pose()).toEqual(start);

  await page.mouse.click(600, 500);
  await page.keyboard.down("KeyW");
  const away = async () => Math.hypot(...(await pose()).slice(0, 3).map((row, i) => row[3]! - start[i]![3]!));
  await expect.poll(away).toBeGreaterThan(0.02);
  await page.keyboard.up("KeyW");
  const ahead = await pose();
  const moved = [0, 1, 2].map((i) => ahead[i]![3]! - start[i]![3]!);
  const along = [0, 1, 2].reduce((sum, i) => sum + moved[i]! * start[i]![2]!, 0);
  expect(along).toBeGreaterThan(0.01);
  expect(Math.abs(Math.hypot(...moved) - along)).toBeLessThan(1e-6);

  await page.mouse.move(600, 500);
  await page.mouse.down();
  await page.mouse.move(700, 480, { steps: 4 });
  await page.mouse.up();
  const looked = await pose();
  expect([0, 1, 2].map((i) => looked[i]![3])).toEqual([0, 1, 2].map((i) => ahead[i]![3]));
  expect(Math.abs(looked[2]![0]!)).toBeLessThan(1e-9); // the horizon stays level
  expect(looked[0]![2]).not.toBeCloseTo(ahead[0]![2]!, 2);
});

test("a tool has the left button, the camera the others", async ({ page }) => {
  await open(page, 1000);
  await page.evaluate(() => {
    const said: string[] = [];
    Object.assign(window, { said });
    window.dev.viewer.setPointerTool({
      cursor: "crosshair",
      down: (x, y) => (said.push(`down ${x} ${y}`), x < 1000),
      move: (x, y) => void said.push(`move ${x} ${y}`),
      up: (x, y) => void said.push(`up ${x} ${y}`),
      cancel: () => void said.push("cancel"),
    });
  });
  const pose = () => page.evaluate(() => JSON.stringify(window.dev.viewer.camera.poseRows()));
  const start = await pose();
  await page.mouse.move(300, 200);
  await page.mouse.down();
  await page.mouse.move(320, 210);
  await page.mouse.up();
  expect(await page.evaluate(() => (window as unknown as { said: string[] }).said)).toEqual([
    "move 300 200",
    "down 300 200",
    "move 320 210",
    "up 320 210",
  ]);
  expect(await pose()).toBe(start);
  await page.mouse.move(1100, 200); // the tool does not want it there
  await page.mouse.down();
  await page.mouse.move(1130, 210);
  await page.mouse.up();
  expect(await pose()).not.toBe(start);
  await page.evaluate(() => window.dev.viewer.camera.fit());
  expect(await pose()).toBe(start);
  await page.keyboard.down("Space");
  await page.mouse.move(300, 200);
  await page.mouse.down();
  await page.mouse.move(320, 210);
  await page.mouse.up();
  await page.keyboard.up("Space");
  expect(await pose()).not.toBe(start);
});
