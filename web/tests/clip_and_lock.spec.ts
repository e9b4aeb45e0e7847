// SPDX-License-Identifier: Apache-2.0
// Locked labels, the clip box, when it was saved and names of people; also when the program is killed.
import { join } from "node:path";
import { kBox, kSphere, kTable, kTops, makeTable } from "./support/clouds";
import { expect, keep, test } from "./support/desk";
import { labelsOfPcd } from "./support/pcd";

test("a locked label keeps its points, for everyone and after a kill", async ({ desk, browser }) => {
  const cloud = makeTable(join(desk.folder, "table.pcd"), { spacing_m: 0.008 });
  const program = await desk.start("annotate", cloud.file);
  const annotator = await desk.open(program, cloud);
  const { page } = annotator;
  await annotator.labelTops([kTable, kBox]);
  await expect(page.getByTestId("saved-at")).toHaveText(/^saved at \d\d:\d\d:\d\d$/);

  const before = labelsOfPcd(await annotator.export("PCD"));
  const boxes = before.filter((label) => label === kBox).length;
  await annotator.chooseLabel(kBox);
  await Promise.all([page.getByRole("button", { name: "Lock this label" }).click(), program.kill()]);
  await program.start();
  await annotator.written();
  await expect(page.getByRole("button", { name: "Unlock this label" })).toHaveAttribute("aria-pressed", "true");

  const other = await browser.newContext();
  const second = await desk.open(program, cloud, other);
  await test.step("another person's paint and control points leave it alone", async () => {
    await second.page.getByRole("button", { name: "More", exact: true }).click();
    await second.page.getByRole("menuitem", { name: /^Your name/ }).click();
    await second.page.getByLabel("Your name", { exact: true }).last().fill("Ada");
    await second.page.keyboard.press("Enter");
    await second.look("above");
    await second.choose("Action", "Set");
    await second.choose("Tool", "Rectangle");
    await second.choose("Depth", "Deep rectangle");
    await second.chooseLabel(8);
    const [x, y] = second.at(kTops[kBox]!);
    await second.dragRectangle([x - 200, y - 200], [x + 200, y + 200]);
    await second.expectLabel(8, { controls: 0 });
    await second.written();
    const labels = labelsOfPcd(await second.export("PCD"));
    expect(labels.filter((label) => label === kBox).length).toBe(boxes);
    await expect(page.locator(".people")).toContainText("Ada: paint, label 8");
    await expect(page.locator(".people")).toHaveAttribute("title", /Ada/);
    await keep(page, "locked");
  });

  await test.step("nothing is done with it until it is unlocked", async () => {
    await page.keyboard.press("p");
    await annotator.click(kTops[kSphere]!);
    await expect(page.locator(".toast").last()).toContainText("Label 2 is locked");
    await page.keyboard.press("Shift+K");
    await expect(page.getByRole("button", { name: "Lock this label" })).toBeVisible();
    await annotator.click(kTops[kSphere]!);
    await annotator.expectLabel(kBox, { controls: 2 });
    await annotator.written();
  });
  await other.close();
});

test("boxes around labels, and as files", async ({ desk }) => {
  const cloud = makeTable(join(desk.folder, "table.pcd"), { spacing_m: 0.008 });
  const program = await desk.start("annotate", cloud.file);
  const annotator = await desk.open(program, cloud);
  await annotator.labelTops([kTable, kBox, kSphere]);
  await annotator.page.keyboard.press("Shift+B");
  await expect(annotator.view).toHaveAttribute("data-boxes", "3");
  await annotator.settled();
  await keep(annotator.page, "boxes");
  const file = JSON.parse((await annotator.export("Boxes around labels, JSON")).toString()) as { boxes: { label: number; size_m: number[]; center_m: number[] }[] };
  const box = file.boxes.find(({ label }) => label === kBox)!;
  for (const [i, size_m] of [0.2, 0.16, 0.2].entries()) expect(Math.abs(box.size_m[i]! - size_m)).toBeLessThan(0.02);
  const lines = (await annotator.export("Boxes around labels, KITTI")).toString().trim().split("\n");
  expect(lines.map((line) => line.split(" ").length)).toEqual([15, 15, 15]);
});

test("the clip box: what is outside is neither drawn nor picked nor selected", async ({ desk }) => {
  const cloud = makeTable(join(desk.folder, "table.pcd"), { spacing_m: 0.008 });
  const program = await desk.start("annotate", cloud.file);
  const annotator = await desk.open(program, cloud);
  const { page } = annotator;
  await annotator.look("above");
  await page.keyboard.press("v");
  await expect(page.getByRole("checkbox", { name: "Clip box" })).toBeChecked();
  await annotator.setSlider("z from", 40);
  const low_m = Number(/-?[\d.]+/.exec((await page.locator(".slider", { hasText: "z from" }).textContent())?.replace("z from", "") ?? "")?.[0]);
  expect(low_m).toBeGreaterThan(0.02);
  await keep(page, "clipped");
  await annotator.settled();

  await annotator.choose("Action", "Set");
  await annotator.choose("Tool", "Rectangle");
  await annotator.choose("Depth", "Deep rectangle");
  await annotator.chooseLabel(4);
  const box = await annotator.box();
  await Promise.all([annotator.dragRectangle([box.x + 5, box.y + 5], [box.x + box.width - 80, box.y + box.height - 80]), program.kill()]);
  await program.start();
  await annotator.written();
  await annotator.expectLabel(4, { controls: 0 });
  const labels = labelsOfPcd(await annotator.export("PCD"));
  const wrong = labels.filter((label, point) => Math.abs(cloud.positions[3 * point + 2]! - low_m) > 0.006 && (label === 4) !== cloud.positions[3 * point + 2]! > low_m);
  expect(wrong.length).toBe(0);

  // The table is not there to be clicked.
  await annotator.choose("Tool", "Point");
  await annotator.chooseLabel(5);
  await annotator.click(kTops[kTable]!);
  await page.keyboard.press("Alt+PageUp");
  await page.keyboard.press("v");
  await annotator.click(kTops[kTable]!);
  await annotator.expectLabel(5, { controls: 1 });
});
