// SPDX-License-Identifier: Apache-2.0
// What is shown, and where to look: visibility, sizes, the heat map of doubt, the next best click, control points to jump to.
import { join } from "node:path";
import { type Annotator, around } from "./support/annotator";
import { type Color, kBox, kCylinder, kFlatBox, kSphere, kTable, kTops, makeTable } from "./support/clouds";
import { type Desk, expect, keep, test } from "./support/desk";
import { keepForDocs } from "./support/picture";

async function labelled(desk: Desk): Promise<Annotator> {
  const cloud = makeTable(join(desk.folder, "table.pcd"));
  const annotator = await desk.open(await desk.start("annotate", cloud.file), cloud);
  await annotator.labelTops([kTable, kBox, kCylinder, kSphere]);
  await annotator.setSlider("Point size", 6);
  await annotator.page.keyboard.press("n");
  return annotator;
}

/** Beside the sphere of the control point. */
function beside(object: number) {
  return around(kTops[object]!, 0.03).filter((_, i) => i !== 4);
}

const apart = (a: Color, b: Color) => Math.max(...a.map((c, i) => Math.abs(c - b[i]!)));

test("labels, cloud and control points are hidden and shown", async ({ desk }) => {
  const annotator = await labelled(desk);
  const { page } = annotator;
  const box = await annotator.colorOf(kBox);

  await test.step("a label", async () => {
    await page.keyboard.press("Shift+C");
    await annotator.expectColor(beside(kBox), box);
    await page.keyboard.press("h");
    await expect(page.getByText("1 label is hidden")).toBeVisible();
    await expect(async () => {
      const seen = await annotator.pixels(beside(kBox).map((place) => annotator.at(place)));
      expect(seen.filter((color) => apart(color, box) < 30)).toEqual([]);
    }).toPass();
    await annotator.expectColor(beside(kSphere), await annotator.colorOf(kSphere));
    await page.getByText("1 label is hidden").click();
    await annotator.expectColor(beside(kBox), box);
  });

  await test.step("a label alone, from the list", async () => {
    await annotator.choose("Labels as", "List");
    await page.getByRole("option").filter({ hasText: "No label" }).getByRole("button").click();
    await page.getByRole("option", { selected: true }).getByRole("button").click({ modifiers: ["Alt"] });
    await expect(page.getByText("labels are hidden")).toBeVisible();
    await page.keyboard.press("Shift+H");
    await expect(page.getByText("hidden · Show all")).toBeHidden();
    await annotator.choose("Labels as", "Grid");
  });

  await test.step("control points", async () => {
    const before = await annotator.settled();
    await page.getByRole("button", { name: "Control points", exact: true }).click();
    const [x, y] = annotator.at(kTops[kBox]!);
    await expect(async () => expect(apart((await annotator.pixels([[x, y]]))[0]!, box)).toBeLessThan(3)).toPass();
    await page.keyboard.press("Shift+P");
    await expect.poll(() => annotator.pictureHash()).toBe(before);
  });

  await test.step("the cloud's own colours alone", async () => {
    await page.keyboard.press("Shift+C");
    await page.keyboard.press("Shift+L");
    await annotator.expectColor(beside(kBox), [196, 60, 52], 20);
    await page.keyboard.press("Shift+L");
  });

  await test.step("point size", async () => {
    const hashes = new Set([await annotator.settled()]);
    for (const key of ["+", "+", "-", "-", "-"]) {
      await page.keyboard.press(key);
      hashes.add(await annotator.settled());
    }
    expect(hashes.size).toBe(4); // 6, 7, 8, 5 px
    await expect(page.getByRole("slider", { name: "Point size" })).toHaveValue("5");
  });
});

test("where a click helps, and where control points are", async ({ desk }) => {
  const annotator = await labelled(desk);
  const { page } = annotator;

  await test.step("heat map", async () => {
    const before = await annotator.settled();
    const plain = await annotator.pixels(beside(kSphere).map((place) => annotator.at(place)));
    await page.keyboard.press("m");
    await expect(page.getByRole("button", { name: "Heat map of doubt" })).toHaveAttribute("aria-pressed", "true");
    await expect.poll(() => annotator.pictureHash()).not.toBe(before);
    await annotator.settled();
    await keep(page, "annotate-heat");
    const heated = await annotator.pixels(beside(kSphere).map((place) => annotator.at(place)));
    expect(heated.filter((color, i) => apart(color, plain[i]!) > 8).length).toBeGreaterThan(4);
    await page.keyboard.press("m");
    await expect.poll(() => annotator.pictureHash()).toBe(before);
  });

  await test.step("next best click", async () => {
    const before = await annotator.settled();
    await page.keyboard.press("g");
    await expect(page.locator(".toast").filter({ hasText: "most in doubt" })).toBeVisible();
    await expect.poll(() => annotator.pictureHash()).not.toBe(before);
    // It is in the middle of the view now.
    const { x, y, width, height } = await annotator.box();
    await annotator.settled();
    await page.mouse.move(x + width / 2, y + height / 2);
    await expect(page.locator(".readout")).toContainText("point ");
  });

  await test.step("the list of control points", async () => {
    const list = page.getByRole("listbox", { name: "Control points" });
    await expect(list.getByRole("option")).toHaveCount(4);
    const color = await annotator.colorOf(kSphere);
    await list.getByRole("option").nth(3).click();
    await expect(list.getByRole("option").nth(3)).toHaveAttribute("aria-selected", "true");
    const { x, y, width, height } = await annotator.box();
    await expect(async () => {
      await page.mouse.move(x + width / 2 + 1, y + height / 2);
      await page.mouse.move(x + width / 2, y + height / 2);
      await expect(page.locator(".readout")).toContainText("label 4, control point", { timeout: 1000 });
    }).toPass();
    expect(color).not.toEqual([0, 0, 0]);
    await page.keyboard.press("Delete");
    await annotator.expectLabel(kSphere, { empty: true });
    await expect(list.getByRole("option")).toHaveCount(3);
  });
});

test("pictures for README and docs", async ({ desk }) => {
  const cloud = makeTable(join(desk.folder, "table.pcd"), { spacing_m: 0.0036 });
  const annotator = await desk.open(await desk.start("annotate", cloud.file), cloud);
  const { page } = annotator;
  const labels = [
    { number: kTable, name: "Table", color: "#6f8fb4" },
    { number: kBox, name: "Tea box", color: "#f0653c" },
    { number: kCylinder, name: "Tin", color: "#2fae74" },
    { number: kSphere, name: "Ball", color: "#9a5be0" },
    { number: kFlatBox, name: "Soap", color: "#f2c230" },
  ];
  await annotator.labelTops(labels.map(({ number }) => number));
  for (const { number, name, color } of labels) {
    await annotator.chooseLabel(number);
    await page.getByLabel("Colour of the label").fill(color);
    await page.getByLabel("Name of the label").fill(name);
    await page.keyboard.press("Enter");
    await annotator.expectLabel(number, { name });
    await annotator.written();
    expect(await annotator.colorOf(number)).toEqual([1, 3, 5].map((i) => Number.parseInt(color.slice(i, i + 2), 16)));
  }
  await annotator.choose("Labels as", "List");
  await page.mouse.move(900, 100);
  await page.setViewportSize({ width: 1120, height: 700 });
  await page.reload();
  await annotator.ready();
  await annotator.choose("Action", "Set");
  await annotator.settled();
  await keepForDocs(page, "annotate");
  await page.keyboard.press("Shift+C");
  await annotator.settled();
  await keepForDocs(page, "annotate-labels");
  await page.keyboard.press("Shift+C");
  await page.emulateMedia({ colorScheme: "dark" });
  await expect.poll(() => annotator.settled()).not.toBe(0);
  await keepForDocs(page, "annotate-dark");
});
