// SPDX-License-Identifier: Apache-2.0
// A whole annotation as a person would do it: mouse and keyboard alone, then what is in the files.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { around } from "./support/annotator";
import { kBox, kCylinder, kFlatBox, kSphere, kTable, kTops, makeTable } from "./support/clouds";
import { expect, keep, test } from "./support/desk";
import { countOf, iou, labelsOfKitti, labelsOfPcd, labelsOfText, readPcd } from "./support/pcd";

test("a whole annotation", async ({ desk }) => {
  const cloud = makeTable(join(desk.folder, "table.pcd"));
  const annotator = await desk.open(await desk.start("annotate", cloud.file), cloud);
  const { page } = annotator;

  await test.step("what is in the file is in the picture", async () => {
    await keep(page, "annotate-opened");
    await annotator.setSlider("Point size", 6);
    await annotator.expectColor(around(kTops[kBox]!, 0.03), [196, 60, 52], 20);
    await annotator.expectColor(around(kTops[kTable]!, 0.03), [150, 112, 78], 20);
  });

  await test.step("the view turns where it is dragged, and comes back", async () => {
    await annotator.look("above");
    const before = await annotator.settled();
    const [x, y] = annotator.at(kTops[kTable]!);
    await annotator.drag([[x, y], [x + 90, y - 60]]);
    const turned = await annotator.settled();
    expect(turned).not.toBe(before);
    await page.mouse.wheel(0, -300);
    expect(await annotator.settled()).not.toBe(turned);
    await annotator.look("above");
    await page.mouse.move(x, y);
    expect(await annotator.settled()).toBe(before);
  });

  await test.step("without labels everything is black", async () => {
    await page.keyboard.press("Shift+C");
    await annotator.expectColor(Object.values(kTops).flatMap((place) => around(place, 0.02)), [0, 0, 0], 0);
  });

  await test.step("three objects and their table, by a click each", async () => {
    await annotator.labelTops([kTable, kBox, kCylinder, kSphere]);
    for (const object of [kTable, kBox, kCylinder, kSphere]) {
      const color = await annotator.colorOf(object);
      // The control point's sphere is in the middle.
      await annotator.expectColor(around(kTops[object]!, 0.035).filter((_, i) => i !== 4), color);
    }
    await keep(page, "annotate-objects-labels");
    await page.keyboard.press("Shift+C");
    await keep(page, "annotate-objects");
  });

  await test.step("pick", async () => {
    await annotator.choose("Action", "Pick");
    for (const object of [kCylinder, kBox]) {
      await annotator.click([kTops[object]![0] + 0.04, kTops[object]![1] + 0.04, kTops[object]![2]]);
      await expect(page.getByTestId("current-label")).toHaveText(String(object));
    }
  });

  await test.step("undo and redo", async () => {
    const points = await annotator.pointsOf(kSphere);
    await page.keyboard.press("Control+z");
    await annotator.expectLabel(kSphere, { empty: true });
    await page.keyboard.press("Control+z");
    await annotator.expectLabel(kCylinder, { empty: true });
    await page.getByRole("button", { name: "Redo" }).click();
    await annotator.expectLabel(kCylinder, { controls: 1 });
    await page.keyboard.press("Control+Shift+z");
    await annotator.expectLabel(kSphere, { controls: 1 });
    expect(await annotator.pointsOf(kSphere)).toBe(points);
    await expect(page.getByRole("button", { name: "Redo" })).toBeDisabled();
  });

  await test.step("delete by a click anywhere in the tree", async () => {
    await annotator.choose("Action", "Delete");
    await expect(page.getByLabel("Anywhere in its tree")).toBeChecked();
    await annotator.click([kTops[kBox]![0] - 0.06, kTops[kBox]![1] + 0.05, kTops[kBox]![2]]);
    await annotator.expectLabel(kBox, { empty: true });
    await annotator.expectLabel(kTable, { controls: 1 });
    await page.getByRole("button", { name: "Undo" }).click();
    await annotator.expectLabel(kBox, { controls: 1 });
  });

  await test.step("a control point is dragged to another place", async () => {
    await annotator.choose("Action", "Set");
    await annotator.chooseLabel(kFlatBox);
    await annotator.click(kTops[kTable]!.map((c, i) => (i === 0 ? c + 0.2 : c)) as [number, number, number]);
    await annotator.expectLabel(kFlatBox, { controls: 1 });
    await annotator.drag([annotator.at([kTops[kTable]![0] + 0.2, kTops[kTable]![1], 0]), annotator.at(kTops[kFlatBox]!)]);
    await annotator.written();
    await annotator.expectLabel(kFlatBox, { controls: 1 });
    await page.mouse.move(10, 400);
    await page.mouse.move(...annotator.at(kTops[kFlatBox]!));
    await expect(page.locator(".readout")).toContainText("label 5, control point");
  });

  await test.step("names", async () => {
    await annotator.chooseLabel(kBox);
    await page.keyboard.press("F2");
    await page.keyboard.type("Tea box");
    await page.keyboard.press("Enter");
    await annotator.expectLabel(kBox, { name: "Tea box", controls: 1 });
    await annotator.chooseLabel(kCylinder);
    await page.getByLabel("Name of the label").fill("Tin");
    await page.keyboard.press("Enter");
    await annotator.expectLabel(kCylinder, { name: "Tin", controls: 1 });
    await annotator.written();
    await keep(page, "annotate-named");
  });

  await test.step("export and save", async () => {
    const labels = labelsOfPcd(await annotator.export("PCD"));
    for (const object of [kTable, kBox, kCylinder, kSphere, kFlatBox]) {
      expect(iou(labels, object, cloud.truth, object), `label ${object}`).toBeGreaterThan(0.95);
      expect(countOf(labels, object)).toBe(await annotator.pointsOf(object));
    }
    expect(labelsOfText(await annotator.export("Text"))).toEqual(labels);
    expect(labelsOfKitti(await annotator.export("SemanticKITTI")).length).toBe(labels.length);
    const names = JSON.stringify(JSON.parse(String(await annotator.export("Names of labels, JSON"))));
    expect(names).toContain("Tea box");
    expect(names).toContain("Tin");

    await page.keyboard.press("Control+s");
    await expect(page.locator(".toast").filter({ hasText: "Saved" })).toContainText("table_labels.pcd");
    const saved = readFileSync(join(desk.folder, "table_labels.pcd"));
    expect(labelsOfPcd(saved)).toEqual(labels);
    expect([...readPcd(saved).columns.keys()]).toEqual(["x", "y", "z", "rgb", "label"]);
    expect(readPcd(saved).columns.get("x")!.every((x, i) => Math.fround(x) === cloud.positions[3 * i])).toBe(true);
  });

  await test.step("clear, and back", async () => {
    await page.getByRole("button", { name: "More" }).click();
    await page.getByRole("menuitem", { name: "Clear all labels" }).click();
    for (const object of [kTable, kBox, kSphere]) await expect(annotator.label(object)).toHaveAccessibleName(/: empty$/);
    await expect(page.getByText("None yet. Choose Set and click a point.")).toBeVisible();
    await page.keyboard.press("Control+z");
    await annotator.expectLabel(kSphere, { controls: 1 });
    await annotator.expectLabel(kBox, { name: "Tea box", controls: 1 });
  });
});
