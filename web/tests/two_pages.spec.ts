// SPDX-License-Identifier: Apache-2.0
// Two people on the same cloud: each sees what the other does, and undo is everyone's own.
import { join } from "node:path";
import { around } from "./support/annotator";
import { kBox, kCylinder, kSphere, kTable, kTops, makeTable } from "./support/clouds";
import { expect, keep, test } from "./support/desk";
import { iou, labelsOfPcd } from "./support/pcd";

test("two people on the same cloud", async ({ desk, browser }) => {
  const cloud = makeTable(join(desk.folder, "table.pcd"));
  const program = await desk.start("annotate", cloud.file);
  const others = await browser.newContext();
  const first = await desk.open(program, cloud);
  const second = await desk.open(program, cloud, others);
  for (const one of [first, second]) await expect(one.page.getByLabel("2 pages have this cloud open")).toBeVisible();

  await first.labelTops([kTable, kBox]);
  await second.expectLabel(kBox, { controls: 1 });
  await second.labelTops([kCylinder]);
  await first.expectLabel(kCylinder, { controls: 1 });
  await first.labelTops([kSphere]);
  await second.expectLabel(kSphere, { controls: 1 });

  await test.step("the other's labels and control points are in the picture", async () => {
    await second.setSlider("Point size", 6);
    await second.page.keyboard.press("Shift+C");
    for (const object of [kBox, kCylinder, kSphere]) {
      await second.expectColor(around(kTops[object]!, 0.03).filter((_, i) => i !== 4), await second.colorOf(object));
    }
    await expect(second.page.getByRole("listbox", { name: "Control points" }).getByRole("option")).toHaveCount(4);
    await second.page.mouse.move(...second.at(kTops[kSphere]!));
    await expect(second.page.locator(".readout")).toContainText("label 4, control point");
    await keep(second.page, "annotate-second-page");
  });

  await test.step("names", async () => {
    await second.chooseLabel(kBox);
    await second.page.getByLabel("Name of the label").fill("Tea box");
    await second.page.keyboard.press("Enter");
    await first.expectLabel(kBox, { name: "Tea box" });
    await second.page.keyboard.press("Control+z");
    await expect(first.label(kBox)).toHaveAccessibleName(/^Label 2: 1 control point/);
  });

  await test.step("undo takes back one's own", async () => {
    await second.page.keyboard.press("Control+z"); // the cylinder, though the sphere came later
    await first.expectLabel(kCylinder, { empty: true });
    await first.expectLabel(kSphere, { controls: 1 });
    await expect(second.page.getByRole("button", { name: "Undo" })).toBeDisabled();
    await second.page.keyboard.press("Control+Shift+z");
    await first.expectLabel(kCylinder, { controls: 1 });
    await first.page.keyboard.press("Control+z");
    await second.expectLabel(kSphere, { empty: true });
    await first.page.keyboard.press("Control+Shift+z");
    await second.expectLabel(kSphere, { controls: 1 });
  });

  await test.step("both have the same in the end", async () => {
    await first.written();
    await second.written();
    const [a, b] = [labelsOfPcd(await first.export("PCD")), labelsOfPcd(await second.export("PCD"))];
    expect(a).toEqual(b);
    for (const object of [kBox, kCylinder, kSphere]) expect(iou(a, object, cloud.truth, object)).toBeGreaterThan(0.95);
  });

  await others.close();
  await expect(first.page.getByLabel("2 pages have this cloud open")).toBeHidden();
});

test("a page that comes later sees what there is, and one that begins anew takes the others along", async ({ desk, browser }) => {
  const cloud = makeTable(join(desk.folder, "table.pcd"), { spacing_m: 0.01 });
  const program = await desk.start("annotate", cloud.file);
  const first = await desk.open(program, cloud);
  await first.labelTops([kTable, kBox]);
  const others = await browser.newContext();
  const second = await desk.open(program, cloud, others);
  await second.expectLabel(kBox, { controls: 1 });
  expect(await second.pointsOf(kTable)).toBe(await first.pointsOf(kTable));

  await first.page.getByRole("button", { name: "More" }).click();
  await first.page.getByRole("menuitem", { name: /New annotation/ }).click();
  await first.page.getByRole("button", { name: "Begin anew" }).click();
  await expect(first.page.locator(".toast").filter({ hasText: "is kept as" })).toContainText("table.sacann.1");
  for (const one of [first, second]) {
    await one.expectLabel(kTable, { empty: true });
    await one.expectLabel(kBox, { empty: true });
  }
  await second.labelTops([kCylinder]);
  await first.expectLabel(kCylinder, { controls: 1 });
  await others.close();
});
