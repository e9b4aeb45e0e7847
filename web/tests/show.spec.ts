// SPDX-License-Identifier: Apache-2.0
// saccade show on a real run, map, mesh and cloud: what is in the page and in its pixels. Pictures in test-results/show.
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { expect, type Page, test } from "@playwright/test";
import { countPixels, settled } from "./pixels";
import { kProgram, run, type Served, serve } from "./program";

const kPictures = "test-results/show";
const gained = { low: [225, 120, 15], high: [255, 160, 60] } as const; // where rays end in the unknown of the region
const table = { low: [130, 100, 60], high: [190, 155, 115] } as const;

interface RunJson {
  views: { gain: number; T_world_camera: number[][] }[];
  final: { coverage: number };
}

let folder = "";
let served: Served | undefined;

test.beforeAll(() => {
  test.setTimeout(300_000);
  expect(existsSync(kProgram), `${kProgram}: SACCADE_PROGRAM says where the program is`).toBe(true);
  mkdirSync(kPictures, { recursive: true });
  folder = mkdtempSync(join(tmpdir(), "saccade-show-"));
  run("explore", "tabletop-1", "--max-views", "2", "--out", join(folder, "run"));
});
test.afterEach(async () => {
  await served?.stop();
  served = undefined;
});
test.afterAll(() => rmSync(folder, { recursive: true, force: true }));

/** The page of what the program shows, once it is drawn. */
async function open(page: Page, ...words: string[]): Promise<string[]> {
  const errors: string[] = [];
  page.on("pageerror", (error) => errors.push(error.message));
  page.on("console", (message) => {
    if (message.type() === "error") errors.push(message.text());
  });
  await page.emulateMedia({ colorScheme: "light" });
  served = await serve(...words);
  await page.goto(served.address);
  await expect(page.locator(".layer").first()).toBeVisible();
  await expect(page).toHaveURL(/^[^?]*$/); // the token is not in the address any more
  await settled(page);
  return errors;
}

test("a run: its steps, layers, pictures and camera", async ({ page }) => {
  await page.setViewportSize({ width: 1440, height: 900 });
  const { result } = JSON.parse(readFileSync(join(folder, "run", "run.json"), "utf8")) as { result: RunJson };
  const errors = await open(page, "show", join(folder, "run"));
  const step = page.getByRole("region", { name: "Step" });
  await expect(step).toContainText(`View ${result.views.length}`);
  await expect(step).toContainText(`${result.views.length + 1} of ${result.views.length + 1}`);
  await expect(page.getByRole("region", { name: "About" })).toContainText(`${(100 * result.final.coverage).toFixed(1)} %`);
  expect(await countPixels(page, table)).toBeGreaterThan(20_000);
  expect(await countPixels(page, gained)).toBeGreaterThan(300);
  await page.screenshot({ path: `${kPictures}/run.png` });

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
  await page.screenshot({ path: `${kPictures}/saliency.png` });
  await page.getByRole("button", { name: "Show Surface" }).click();
  await page.getByRole("button", { name: "Show Saliency of segments" }).click();

  await page.keyboard.press("Home");
  await expect(step).toContainText("Scan");
  await page.getByRole("button", { name: "Show Frontier of the unknown" }).click();
  await settled(page);
  await page.screenshot({ path: `${kPictures}/scan.png` });
  await page.getByRole("button", { name: "Show Frontier of the unknown" }).click();
  await page.keyboard.press("ArrowRight");
  await expect(step).toContainText("View 1");

  await page.keyboard.press("c");
  await settled(page);
  await expect(page.locator(".look")).toContainText("View 1");
  expect(await countPixels(page, table)).toBeGreaterThan(20_000); // the camera looks at the table
  await page.screenshot({ path: `${kPictures}/camera.png` });
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
  await open(page, "show", join(folder, "run"));
  await page.getByRole("button", { name: /^Theme/ }).click();
  await page.getByRole("button", { name: /^Theme/ }).click();
  await expect(page.locator("html")).toHaveAttribute("data-theme", "dark");
  await settled(page);
  await page.screenshot({ path: `${kPictures}/dark.png` });
  const widths = await page.evaluate(() => [document.documentElement.scrollWidth, window.innerWidth]);
  expect(widths[0]).toBe(widths[1]); // nothing is beyond the edge
});

test("a map and a mesh", async ({ page }) => {
  for (const file of ["map.sacmap", "mesh.ply"]) {
    const errors = await open(page, "show", join(folder, "run", file));
    await expect(page.getByRole("heading", { name: file })).toBeVisible();
    await expect(page.getByRole("region", { name: "Step" })).toBeHidden();
    expect(await countPixels(page, table)).toBeGreaterThan(20_000);
    await page.screenshot({ path: `${kPictures}/${file.replace(/\..*/, "")}.png` });
    expect(errors).toEqual([]);
    await served?.stop();
    await page.goto("about:blank");
  }
});

test("an exploration while it runs", async ({ page }) => {
  test.setTimeout(300_000);
  await open(page, "explore", "tabletop-1", "--max-views", "2", "--out", join(folder, "live"), "--show");
  const step = page.getByRole("region", { name: "Step" });
  await expect(step).toContainText("3 of 3", { timeout: 120_000 }); // who follows sees the last one
  await expect(page.getByText("live", { exact: true })).toBeHidden({ timeout: 60_000 });
  await settled(page);
  expect(await countPixels(page, table)).toBeGreaterThan(10_000);
});

test("the program ends, and comes back", async ({ page }) => {
  const words = ["show", join(folder, "run"), "--token-file", join(folder, "token"), "--port"];
  await open(page, ...words, "0");
  const port = new URL(served!.address).port;
  await page.keyboard.press("Home");
  await expect(page.getByRole("region", { name: "Step" })).toContainText("Scan");
  await served!.stop();
  await expect(page.getByText("Reconnecting")).toBeVisible();
  served = await serve(...words, port);
  await expect(page.getByText("Connected")).toBeVisible({ timeout: 30_000 });
  await expect(page.getByRole("region", { name: "Step" })).toContainText("Scan");
  await page.keyboard.press("End");
  await settled(page);
  expect(await countPixels(page, gained)).toBeGreaterThan(300);
});
