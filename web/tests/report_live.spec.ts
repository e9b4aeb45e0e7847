// SPDX-License-Identifier: Apache-2.0
// The report of a run that goes on, served by the real program, and of one that is over.
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { expect, test } from "@playwright/test";
import { Program } from "./support/program";
import { faults } from "./support/report";

test("a run's report grows with its views, and is beside its 3-D view", async ({ page }) => {
  const folder = mkdtempSync(join(tmpdir(), "saccade-report-"));
  const run = join(folder, "run");
  const settings = ["--robot", "free", "--strategy", "sphere", "--voxel-size", "0.012", "--max-views", "2"];
  const program = await new Program(["explore", "tabletop-1", ...settings, "--out", run, "--show"], join(folder, "token")).start();
  const wrong: string[] = [];
  page.on("pageerror", (error) => wrong.push(error.message));
  page.on("console", (message) => /Content Security Policy/.test(message.text()) && wrong.push(message.text()));
  try {
    await page.goto(program.url);
    await page.getByRole("link", { name: "Report" }).click();
    await expect(page.getByRole("heading", { level: 1 })).toHaveText("Exploration of tabletop-1", { timeout: 60_000 });
    await page.locator("#view-1 > summary").click({ timeout: 60_000 });
    await expect(page.locator("#view-2")).toBeVisible({ timeout: 60_000 });
    await expect(page.locator("#view-1")).toHaveAttribute("open"); // still, though the page was drawn anew
    const picture = page.locator("#view-1 img").first();
    await picture.scrollIntoViewIfNeeded();
    await expect.poll(() => picture.evaluate((img: HTMLImageElement) => img.naturalWidth)).toBeGreaterThan(100);
    await expect(page.getByText("It stopped at the number of views it was given.")).toBeVisible({ timeout: 60_000 });
    await expect(page.locator(".badge.live")).toBeHidden();
    expect(await faults(page)).toEqual([]);
    await page.getByRole("link", { name: "3-D view" }).click();
    await expect(page.getByRole("region", { name: "Step" })).toContainText("1 of 3");
    expect(wrong).toEqual([]);
  } finally {
    await program.stop();
  }

  // What is left on disk opens without the program.
  await page.goto(pathToFileURL(join(run, "report.html")).href);
  await expect(page.getByRole("heading", { level: 1 })).toHaveText("Exploration of tabletop-1");
  await expect(page.locator("#summary img").first()).toHaveJSProperty("complete", true);
  await expect(page.locator("details[id^='view-']")).toHaveCount(2);
  expect(wrong).toEqual([]);
  rmSync(folder, { recursive: true, force: true });
});
