// SPDX-License-Identifier: Apache-2.0
// A folder of clouds: opening, next and previous, and which are begun.
import { existsSync, mkdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { kBox, kCylinder, kTable, makeTable } from "./support/clouds";
import { expect, keep, test } from "./support/desk";
import { iou, labelsOfPcd } from "./support/pcd";

test("a folder of three clouds", async ({ desk }) => {
  const folder = join(desk.folder, "clouds");
  mkdirSync(folder);
  const clouds = ["a", "b", "c"].map((name, i) => makeTable(join(folder, `${name}.pcd`), { spacing_m: 0.008, seed: i + 1, turn_rad: 0.0 }));
  const program = await desk.start("annotate", folder);
  const annotator = await desk.open(program, clouds[0]!);
  const { page } = annotator;
  const shows = async (index: number) => {
    await expect(page.getByRole("button", { name: `Open. Now: ${"abc"[index]}.pcd` })).toBeVisible();
    annotator.cloud = clouds[index]!;
    await annotator.ready();
  };
  const sheet = page.getByRole("dialog", { name: "Open" });

  await shows(0);
  await expect(page.getByRole("button", { name: "Previous cloud" })).toBeDisabled();
  await expect(page.getByText("1 / 3")).toBeVisible();
  await annotator.labelTops([kTable, kBox]);

  await page.keyboard.press("Shift+PageDown");
  await shows(1);
  await annotator.expectLabel(kBox, { empty: true });
  await expect(page.getByRole("button", { name: "Undo" })).toBeDisabled();
  await annotator.labelTops([kTable, kCylinder]);

  await test.step("the dialog says which are begun", async () => {
    await page.keyboard.press("Control+o");
    await expect(sheet.getByText("3 clouds, 2 begun")).toBeVisible();
    const rows = sheet.locator(".cloud-row");
    await expect(rows).toHaveCount(3);
    await expect(rows.nth(1)).toHaveAttribute("aria-current", "true");
    await expect(rows.nth(0)).toContainText(/begun/);
    await expect(rows.nth(0)).not.toContainText("not begun");
    await expect(rows.nth(2)).toContainText("not begun");
    await keep(page, "annotate-open");
    await rows.nth(0).click();
    await expect(sheet).toBeHidden();
  });

  await shows(0);
  await annotator.expectLabel(kBox, { controls: 1 });
  await annotator.expectLabel(kCylinder, { empty: true });
  await page.keyboard.press("Control+z"); // undoes in this cloud
  await annotator.expectLabel(kBox, { empty: true });
  await page.keyboard.press("Control+Shift+z");
  await annotator.expectLabel(kBox, { controls: 1 });

  await test.step("next and previous", async () => {
    const next = page.getByRole("button", { name: "Next cloud" });
    await next.click();
    await shows(1);
    await annotator.expectLabel(kCylinder, { controls: 1 });
    await next.click();
    await shows(2);
    await expect(next).toBeDisabled();
    await page.keyboard.press("Shift+PageUp");
    await shows(1);
  });

  await test.step("labels are saved beside each other", async () => {
    await page.keyboard.press("Control+s");
    await expect(page.locator(".toast").filter({ hasText: "Saved" })).toContainText("b.pcd");
    const labels = labelsOfPcd(readFileSync(join(folder, "labels", "b.pcd")));
    expect(iou(labels, kCylinder, clouds[1]!.truth, kCylinder)).toBeGreaterThan(0.9);
    expect(existsSync(join(folder, "labels", "a.pcd"))).toBe(false);
    expect(labelsOfPcd(await annotator.export("PCD"))).toEqual(labels);
  });

  await test.step("begun is what there is a session of, also for a program that is started again", async () => {
    const address = page.url();
    await page.goto("about:blank"); // else the page finds the program again, before or after it is reloaded, with its own cloud
    await program.stop();
    await program.start();
    await page.goto(address);
    await shows(0);
    await page.keyboard.press("Control+o");
    await expect(sheet.getByText("3 clouds, 3 begun")).toBeVisible(); // the third one was opened
    await page.keyboard.press("Escape");
    await expect(sheet).toBeHidden();
  });
});
