// SPDX-License-Identifier: Apache-2.0
// saccade show on a real run, map, mesh and cloud: what is in the page and in its pixels.
import { existsSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { expect, type Page, test } from "@playwright/test";
import { countPixels, settled } from "./pixels";
import { keep, keepForDocs } from "./support/picture";
import { Program } from "./support/program";

const gained = { low: [225, 120, 15], high: [255, 160, 60] } as const; // where rays end in the unknown of the region
const table = { low: [130, 100, 60], high: [190, 155, 115] } as const;

interface RunJson {
  views: { gain: number; T_world_camera: number[][] }[];
  final: { coverage: number };
}

let folder = "";
let exploration: Program;
let shown: Program | undefined;

// One run for all of these: the first test follows it, the others wait until it is written.
test.beforeAll(async () => {
  folder = mkdtempSync(join(tmpdir(), "saccade-show-"));
  exploration = new Program(["explore", "tabletop-1", "--saliency", "objectness", "--max-views", "2", "--out", join(folder, "run"), "--show"], join(folder, "live-token"));
  await exploration.start();
});
test.afterEach(async () => {
  await shown?.stop();
  shown = undefined;
});
test.afterAll(async () => {
  await exploration.stop();
  rmSync(folder, { recursive: true, force: true });
});

/** The page of a file or of the run, once it is drawn. */
async function show(page: Page, file = ""): Promise<string[]> {
  await expect.poll(() => existsSync(join(folder, "run", "run.json")), { message: "the run is written", timeout: 100_000 }).toBe(true);
  shown = new Program(["show", join(folder, "run", file)], join(folder, "token"));
  return open(page, await shown.start());
}

async function open(page: Page, program: Program): Promise<string[]> {
  const errors: string[] = [];
  page.on("pageerror", (error) => errors.push(error.message));
  page.on("console", (message) => {
    if (message.type() === "error") errors.push(message.text());
  });
  await page.emulateMedia({ colorScheme: "light" });
  await page.goto(program.url);
  await expect(page.locator(".layer").first()).toBeVisible();
  await expect(page).toHaveURL(/^[^?]*$/); // the token is not in the address any more
  await settled(page);
  return errors;
}

test("an exploration while it runs", async ({ page }) => {
  await open(page, exploration);
  const step = page.getByRole("region", { name: "Step" });
  await expect(step).toContainText("3 of 3", { timeout: 90_000 }); // who follows sees the last one
  await expect(page.getByText("live", { exact: true })).toBeHidden({ timeout: 60_000 });
  await settled(page);
  expect(await countPixels(page, table)).toBeGreaterThan(10_000);
});

test("a run: its steps, layers, pictures and camera", async ({ page }) => {
  await page.setViewportSize({ width: 1440, height: 900 });
  const errors = await show(page);
  const { result } = JSON.parse(readFileSync(join(folder, "run", "run.json"), "utf8")) as { result: RunJson };
  const step = page.getByRole("region", { name: "Step" });
  await expect(step).toContainText(`1 of ${result.views.length + 1}`); // a run that is over begins with its scan
  await page.keyboard.press("End");
  await expect(step).toContainText(`View ${result.views.length}`);
  await settled(page);
  await expect(step).toContainText(`${result.views.length + 1} of ${result.views.length + 1}`);
  await expect(page.getByRole("region", { name: "About" })).toContainText(`${(100 * result.final.coverage).toFixed(1)} %`);
  expect(await countPixels(page, table)).toBeGreaterThan(20_000);
  expect(await countPixels(page, gained)).toBeGreaterThan(300);
  await keepForDocs(page, "viewer");

  await page.getByRole("button", { name: "Show Where rays end" }).click();
  await settled(page);
  const arm = await countPixels(page, gained); // the camera's body has such a colour, too
  await page.getByRole("button", { name: "Show Where rays end" }).click();
  await settled(page);
  expect(await countPixels(page, gained)).toBeGreaterThan(arm + 300);

  await page.getByRole("button", { name: "Show Surface" }).click();
  await page.getByRole("button", { name: "Show Saliency of segments" }).click();
  await settled(page);
  expect(await countPixels(page, table)).toBeLessThan(5_000);
  await keep(page, "show-saliency");
  await page.getByRole("button", { name: "Show Surface" }).click();
  await page.getByRole("button", { name: "Show Saliency of segments" }).click();

  await page.keyboard.press("Home");
  await expect(step).toContainText("Scan");
  await page.getByRole("button", { name: "Show Frontier of the unknown" }).click();
  await settled(page);
  await keep(page, "show-scan");
  await page.getByRole("button", { name: "Show Frontier of the unknown" }).click();
  await page.keyboard.press("ArrowRight");
  await expect(step).toContainText("View 1");

  await page.keyboard.press("c");
  await settled(page);
  await expect(page.locator(".look")).toContainText("View 1");
  expect(await countPixels(page, table)).toBeGreaterThan(20_000); // the camera looks at the table
  await keep(page, "show-camera");
  await page.keyboard.press("Escape");

  const picture = page.getByRole("button", { name: "Enlarge: What the camera saw" });
  await expect.poll(() => picture.locator("img").evaluate((img: HTMLImageElement) => img.naturalWidth)).toBeGreaterThan(200);
  await picture.click();
  await expect(page.getByRole("dialog", { name: "Picture" }).locator("img")).toBeVisible();
  await page.keyboard.press("Escape");
  expect(errors).toEqual([]);
});

test("a run in the dark, on a small screen", async ({ page }) => {
  await page.setViewportSize({ width: 1024, height: 720 });
  await show(page);
  await page.getByRole("button", { name: /^Theme/ }).click();
  await page.getByRole("button", { name: /^Theme/ }).click();
  await expect(page.locator("html")).toHaveAttribute("data-theme", "dark");
  await settled(page);
  await keep(page, "show-dark");
  const widths = await page.evaluate(() => [document.documentElement.scrollWidth, window.innerWidth]);
  expect(widths[0]).toBe(widths[1]); // nothing is beyond the edge
});

test("a map and a mesh", async ({ page }) => {
  for (const file of ["map.sacmap", "mesh.ply"]) {
    const errors = await show(page, file);
    await expect(page.getByRole("heading", { name: file })).toBeVisible();
    await expect(page.getByRole("region", { name: "Step" })).toBeHidden();
    expect(await countPixels(page, table)).toBeGreaterThan(20_000);
    await keep(page, `show-${file.replace(/\..*/, "")}`);
    expect(errors).toEqual([]);
    await page.goto("about:blank");
    await shown?.stop();
  }
});

test("the program ends, and comes back", async ({ page }) => {
  await show(page);
  await page.keyboard.press("Home");
  await expect(page.getByRole("region", { name: "Step" })).toContainText("Scan");
  await shown!.stop();
  await expect(page.getByText("Reconnecting")).toBeVisible();
  await shown!.start();
  await expect(page.getByText("Connected")).toBeVisible({ timeout: 30_000 });
  await expect(page.getByRole("region", { name: "Step" })).toContainText("Scan");
  await page.keyboard.press("End");
  await settled(page);
  expect(await countPixels(page, gained)).toBeGreaterThan(300);
});
