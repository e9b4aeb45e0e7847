// SPDX-License-Identifier: Apache-2.0
// The keys and their sheet, light and dark, and a small window in which nothing is cut off.
import { join } from "node:path";
import type { Page } from "@playwright/test";
import type { Annotator } from "./support/annotator";
import { kBox, kTable, makeTable } from "./support/clouds";
import { type Desk, expect, keep, test } from "./support/desk";

function openSmall(desk: Desk): Promise<Annotator> {
  const cloud = makeTable(join(desk.folder, "table.pcd"), { spacing_m: 0.01 });
  return desk.start("annotate", cloud.file).then((program) => desk.open(program, cloud));
}

test("keys", async ({ desk }) => {
  const annotator = await openSmall(desk);
  const { page } = annotator;
  const press = (keys: string) => page.keyboard.press(keys);
  const isChosen = (group: string, name: string) => expect(annotator.radio(group, name)).toHaveAttribute("aria-checked", "true");

  await test.step("actions and tools", async () => {
    for (const [key, name] of [["c", "Set"], ["x", "Delete"], ["i", "Pick"], ["n", "Navigate"], ["c", "Set"]] as const) {
      await press(key);
      await isChosen("Action", name);
    }
    for (const [key, name] of [["r", "Rectangle"], ["y", "Polyline"], ["l", "Lasso"], ["b", "Brush"], ["r", "Rectangle"]] as const) {
      await press(key);
      await isChosen("Tool", name);
    }
    for (const name of ["Slightly below rectangle", "Deep rectangle", "Surface rectangle"]) {
      await press("u");
      await isChosen("Depth", name);
    }
    await press("b");
    const radius = page.getByRole("slider", { name: "Radius", exact: true });
    const before = Number(await radius.inputValue());
    await press("]");
    await expect.poll(async () => Number(await radius.inputValue())).toBeGreaterThan(before);
    await press("[");
    await press("[");
    await expect.poll(async () => Number(await radius.inputValue())).toBeLessThan(before);
    await press("p");
    await isChosen("Tool", "Point");
    await press("Escape");
    await isChosen("Action", "Navigate");
  });

  await test.step("labels", async () => {
    const current = page.getByTestId("current-label");
    const keys = [["5", 5], ["0", 10], ["Shift+3", 13], [".", 14], [",", 13], ["PageDown", 33], ["2", 22], ["PageUp", 2], ["Shift+J", 1], ["j", 2]] as const;
    for (const [key, label] of keys) {
      await press(key);
      await expect(current, key).toHaveText(String(label));
    }
    await press("F2");
    await expect(page.getByLabel("Name of the label")).toBeFocused();
    await page.keyboard.type("xcb"); // no shortcuts meanwhile
    await press("Enter");
    await isChosen("Action", "Navigate");
    await annotator.expectLabel(kBox, { name: "xcb", empty: true });
    await press("h");
    await expect(page.getByText("1 label is hidden")).toBeVisible();
    await press("h");
    await expect(page.getByText("1 label is hidden")).toBeHidden();
  });

  await test.step("view", async () => {
    await page.mouse.move(2, 2);
    const hashes = new Set<number>();
    for (const key of ["f", "t", "Shift+F", "Shift+T"]) {
      await press(key);
      hashes.add(await annotator.settled());
    }
    expect(hashes.size).toBe(4);
    for (const [key, name] of [["Shift+C", "Cloud"], ["Shift+L", "Labels"], ["Shift+P", "Control points"]] as const) {
      const toggle = page.getByRole("group", { name: "Show" }).getByRole("button", { name, exact: true });
      await press(key);
      await expect(toggle).toHaveAttribute("aria-pressed", "false");
      await press(key);
      await expect(toggle).toHaveAttribute("aria-pressed", "true");
    }
    await press("o");
    await isChosen("Navigation", "Fly");
    await annotator.view.focus();
    const before = await annotator.settled();
    await page.keyboard.down("w");
    await expect.poll(() => annotator.pictureHash()).not.toBe(before);
    await page.keyboard.up("w");
    await press("o");
    await isChosen("Navigation", "Orbit");
    await press("\\");
    await expect(page.getByRole("complementary")).toBeHidden();
    await press("\\");
    await expect(page.getByRole("complementary")).toBeVisible();
  });

  await test.step("a click with the keyboard alone", async () => {
    await press("1");
    await press("c");
    await press("t");
    await annotator.view.focus();
    for (let i = 0; i < 3; ++i) await press("ArrowDown");
    await press("Shift+ArrowLeft");
    await press("Enter");
    await annotator.expectLabel(kTable, { controls: 1 });
    await press("Control+y");
    await press("Control+z");
    await annotator.expectLabel(kTable, { empty: true });
  });

  await test.step("their sheet", async () => {
    await press("?");
    const sheet = page.getByRole("dialog", { name: "Keyboard and mouse" });
    await expect(sheet).toBeVisible();
    for (const text of ["Undo", "Rectangle", "Next best click", "Save", "Whole cloud", "Next empty label"]) {
      await expect(sheet.getByText(text, { exact: true })).toBeVisible();
    }
    await keep(page, "annotate-keys");
    await press("r"); // is the sheet's
    await press("Escape");
    await expect(sheet).toBeHidden();
    await isChosen("Tool", "Point");
  });
});

test("light, dark, and as the system has it", async ({ desk }) => {
  const annotator = await openSmall(desk);
  const { page } = annotator;
  const { x, y } = await annotator.box();
  const corner: [number, number] = [x + 20, y + 20];
  const brightness = async () => {
    const panel = await page.getByRole("complementary").evaluate((element) => getComputedStyle(element).backgroundColor);
    const of = (color: readonly number[]) => color.reduce((sum, c) => sum + c, 0) / 3;
    return [of((await annotator.pixels([corner]))[0]!), of(panel.match(/\d+/g)!.slice(0, 3).map(Number))];
  };
  const isLight = (light: boolean) =>
    expect.poll(async () => (await brightness()).every((one) => one > 128 === light && (one > 190 || one < 70))).toBe(true);
  await isLight(true);
  await page.emulateMedia({ colorScheme: "dark" });
  await isLight(false);
  const theme = page.getByRole("button", { name: /^Theme/ });
  await theme.click();
  await expect(theme).toHaveAccessibleName("Theme: light");
  await isLight(true);
  await theme.click();
  await expect(theme).toHaveAccessibleName("Theme: dark");
  await page.emulateMedia({ colorScheme: "light" });
  await isLight(false);
  await page.reload();
  await annotator.ready();
  await isLight(false);
});

/** What is cut off or lies over something else. */
function misplaced(page: Page): Promise<string[]> {
  return page.evaluate(() => {
    const wrong: string[] = [];
    const kinds = "button, input, summary, h2, output, .slider-name, .tool-hint, .status, .readout, .hidden-note";
    const name = (element: Element) => `${element.tagName.toLowerCase()} "${(element.getAttribute("aria-label") ?? element.textContent ?? "").slice(0, 40)}"`;
    for (const [place, scrolls] of [[".bar", false], [".panel", true], [".stage", false]] as const) {
      const parent = document.querySelector(place)!;
      const outer = parent.getBoundingClientRect();
      const shown = [...parent.querySelectorAll<HTMLElement>(kinds)].filter((element) => {
        const box = element.getBoundingClientRect();
        return box.width > 0 && box.height > 0 && element.checkVisibility() && !element.closest(".virtual-list");
      });
      if (parent.scrollWidth > parent.clientWidth + 1) wrong.push(`${place} is wider than its place`);
      for (const element of shown) {
        const box = element.getBoundingClientRect();
        const out = box.left < outer.left - 1 || box.right > outer.right + 1 || (!scrolls && (box.top < outer.top - 1 || box.bottom > outer.bottom + 1));
        if (out) wrong.push(`${name(element)} is not wholly in ${place}`);
        const cut = element.scrollWidth > element.clientWidth + 1 && getComputedStyle(element).display !== "inline" && element.tagName !== "INPUT";
        if (cut) wrong.push(`${name(element)} is cut off`);
        for (const other of shown) {
          if (other === element || other.contains(element) || element.contains(other)) continue;
          const its = other.getBoundingClientRect();
          const over = Math.min(box.right, its.right) - Math.max(box.left, its.left) > 1 && Math.min(box.bottom, its.bottom) - Math.max(box.top, its.top) > 1;
          if (over) wrong.push(`${name(element)} lies over ${name(other)}`);
        }
      }
      if (shown.length < 4) wrong.push(`only ${shown.length} things in ${place}`);
    }
    return wrong;
  });
}

test("1024 × 720: nothing is cut off or lies over something else", async ({ desk }) => {
  const annotator = await openSmall(desk);
  const { page } = annotator;
  await page.setViewportSize({ width: 1024, height: 720 });
  await page.keyboard.press("f");
  for (const keys of [["n"], ["c", "p"], ["c", "b"], ["c", "r", "u"], ["x", "p"], ["x", "r"]]) {
    for (const key of keys) await page.keyboard.press(key);
    expect(await misplaced(page), keys.join(" ")).toEqual([]);
  }
  await page.keyboard.press("h");
  await page.keyboard.press("m");
  await annotator.choose("Labels as", "List");
  await page.getByLabel("Name of the label").fill("A name that is rather long for such a small window");
  await page.keyboard.press("Enter");
  await annotator.written();
  const { x, y, width, height } = await annotator.box();
  await page.mouse.move(x + width / 2, y + height / 2);
  await expect(page.locator(".readout")).toContainText("point ");
  expect(await misplaced(page), "with a legend and a hidden label").toEqual([]);
  await keep(page, "annotate-small");
  expect(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth && document.documentElement.scrollHeight <= innerHeight)).toBe(true);
});
