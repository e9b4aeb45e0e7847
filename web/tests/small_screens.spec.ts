// SPDX-License-Identifier: Apache-2.0
// Both pages on small screens: nothing lies over anything else, and a checker of accessibility finds nothing.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import type { Page } from "@playwright/test";
import { mockRun, serveMock } from "./show_mock";
import { makeTable } from "./support/clouds";
import { expect, keep, test } from "./support/desk";
import { serveSources } from "./support/dev_server";
import { complete } from "./support/picture";

const address = serveSources();
const kAxe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

declare global {
  interface Window {
    axe: { run(): Promise<{ violations: { id: string; nodes: { html: string }[] }[] }> };
  }
}

/** Returns the violations that axe-core finds. */
async function violations(page: Page): Promise<string[]> {
  await page.evaluate(kAxe);
  const { violations: found } = await page.evaluate(() => window.axe.run());
  return found.map(({ id, nodes }) => `${id}: ${nodes.map((node) => node.html.slice(0, 120)).join(" ")}`);
}

/** Pairs of the controls that can be seen and lie over each other, and those that are not whole in the window. */
async function overlaps(page: Page, within: string): Promise<string[]> {
  return page.locator(within).evaluate((part) => {
    const shown = [...part.querySelectorAll<HTMLElement>("button, input, select, h1, output, .status, .badge")].filter((one) => one.checkVisibility());
    const boxes = shown.map((one) => ({ name: one.ariaLabel || one.textContent || one.className, one, box: one.getBoundingClientRect() })).filter(({ box }) => box.width > 0);
    const wrong = boxes.filter(({ box }) => box.left < 0 || box.right > innerWidth + 0.5 || box.bottom > innerHeight + 0.5).map(({ name }) => `${name} is cut off`);
    boxes.forEach((a, i) => {
      for (const b of boxes.slice(i + 1)) {
        if (a.one.contains(b.one) || b.one.contains(a.one)) continue;
        const wide = Math.min(a.box.right, b.box.right) - Math.max(a.box.left, b.box.left);
        const tall = Math.min(a.box.bottom, b.box.bottom) - Math.max(a.box.top, b.box.top);
        if (wide > 0.5 && tall > 0.5) wrong.push(`${a.name} and ${b.name}`);
      }
    });
    return wrong;
  });
}

async function check(page: Page, name: string, bars: readonly string[]): Promise<void> {
  const more = page.getByRole("button", { name: "More commands" });
  for (const width of [1280, 860, 859, 400, 360]) {
    await page.setViewportSize({ width, height: 720 });
    for (const bar of bars) expect(await overlaps(page, bar), `${bar} at ${width} px`).toEqual([]);
    expect(await more.isVisible(), `the menu at ${width} px`).toBe(width < 860);
  }
  const panel = page.locator(".panel");
  await expect(panel).toBeHidden(); // a drawer, closed at first
  expect(await violations(page)).toEqual([]);
  await complete(page);
  await keep(page, `${name}-360`);
  await more.click();
  await keep(page, `${name}-360-menu`);
  expect(await overlaps(page, ".bar")).toEqual([]);
  expect(await violations(page)).toEqual([]);
  await page.keyboard.press("Escape");
  await page.getByRole("button", { name: "Panel (\\)" }).click();
  await expect(panel).toBeVisible();
  expect(await violations(page)).toEqual([]);
  await keep(page, `${name}-360-panel`);
  await page.locator(".stage-view").click({ position: { x: 350, y: 400 } });
  await expect(panel).toBeHidden();
}

test("the viewer", async ({ page }) => {
  const run = mockRun();
  await serveMock(page, run);
  for (const colorScheme of ["light", "dark"] as const) {
    await page.emulateMedia({ colorScheme });
    await page.setViewportSize({ width: 1280, height: 720 });
    await page.goto(address());
    await expect(page.getByRole("heading", { name: run.document.title })).toBeVisible();
    await expect(page.locator(".progress")).toBeHidden();
    await check(page, `viewer-${colorScheme}`, [".bar", ".step-bar"]);
  }
});

test("the annotation page", async ({ desk }) => {
  const cloud = makeTable(join(desk.folder, "a table with a name that is long.pcd"), { spacing_m: 0.01 });
  const program = await desk.start("annotate", cloud.file);
  const { page } = await desk.open(program, cloud);
  for (const colorScheme of ["light", "dark"] as const) {
    await page.emulateMedia({ colorScheme });
    await check(page, `annotate-${colorScheme}`, [".bar", ".view-bar"]);
  }
});
