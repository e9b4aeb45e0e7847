// SPDX-License-Identifier: Apache-2.0
// The viewer's page alone: a document with every kind of layer, served by the test itself.
import { expect, type Page, test } from "@playwright/test";
import { countPixels } from "./pixels";
import { type Mock, mockRun, serveMock } from "./show_mock";
import { serveSources } from "./support/dev_server";

const address = serveSources();

const blue = { low: [40, 90, 180], high: [90, 160, 255] } as const; // the frontier's voxels
const orange = { low: [150, 90, 20], high: [240, 175, 80] } as const; // the arm

async function open(page: Page, mock: Mock = mockRun()) {
  const errors: string[] = [];
  page.on("pageerror", (error) => errors.push(error.message));
  const program = await serveMock(page, mock);
  await page.goto(address());
  await expect(page.getByRole("heading", { name: mock.document.title })).toBeVisible();
  await expect(page.locator(".progress")).toBeHidden();
  await expect.poll(() => countPixels(page, blue)).toBeGreaterThan(500);
  if (mock.document.steps.length > 1 && !mock.document.live) {
    await expect(page.getByRole("region", { name: "Step" })).toContainText(`1 of ${mock.document.steps.length}`); // begins with the first one
    await page.keyboard.press("End");
    await expect(page.getByRole("region", { name: "Step" })).toContainText(`${mock.document.steps.length} of`);
  }
  return { program, errors };
}

test("layers are drawn, and hidden by their switch", async ({ page }) => {
  const { program, errors } = await open(page);
  expect(await countPixels(page, orange)).toBeGreaterThan(500);
  expect(program.asked).not.toContain("b3"); // hidden: not even fetched
  const eye = page.getByRole("button", { name: "Show Frontier of the unknown" });
  await eye.click();
  await expect(eye).toHaveAttribute("aria-pressed", "false");
  await expect.poll(() => countPixels(page, blue)).toBeLessThan(50);
  await eye.click();
  await expect.poll(() => countPixels(page, blue)).toBeGreaterThan(500);
  await page.getByRole("button", { name: "Show Unknown" }).click();
  await expect.poll(() => program.asked).toContain("b3");
  expect(errors).toEqual([]);
});

test("steps by keys, slider and play", async ({ page }) => {
  const { program } = await open(page);
  const panel = page.getByRole("region", { name: "Step" });
  await expect(panel).toContainText("4 of 4");
  await page.keyboard.press("ArrowLeft");
  await expect(panel).toContainText("View 2");
  await expect(panel).toContainText("2600 voxels");
  await page.keyboard.press("Home");
  await expect(panel).toContainText("Initial scan");
  await expect(page.getByRole("button", { name: "Enlarge: Choice" }).locator("img")).toHaveAttribute("src", /^blob:/);
  await expect.poll(() => program.pictures).toContain("view-0-choice");
  await page.getByRole("slider", { name: "Step" }).fill("1");
  await expect(panel).toContainText("2 of 4");
  await page.getByRole("button", { name: /^Next step/ }).click();
  await expect(panel).toContainText("3 of 4");
  await page.keyboard.press("Home");
  await page.locator(".stage-view").click({ position: { x: 20, y: 20 } });
  await page.keyboard.press("Space");
  await expect(page.getByRole("button", { name: /^Pause/ })).toBeVisible();
  await expect(panel).toContainText("4 of 4", { timeout: 15_000 });
  await expect(page.getByRole("button", { name: /^Play/ })).toBeVisible();
});

test("looking through the camera, and back", async ({ page }) => {
  await open(page);
  const before = await page.locator("canvas").screenshot();
  await page.keyboard.press("c");
  await expect(page.locator(".look")).toBeVisible();
  await expect(page.locator(".look")).toContainText("View 3");
  const edges = await page.locator(".look-edges").boundingBox();
  expect(edges!.width / edges!.height).toBeCloseTo(Math.tan(1.09 / 2) / Math.tan(0.86 / 2), 1);
  await page.keyboard.press("Escape");
  await expect(page.locator(".look")).toBeHidden();
  await expect.poll(async () => (await page.locator("canvas").screenshot()).equals(before)).toBe(true);
});

test("candidates say their gain", async ({ page }) => {
  await open(page);
  await page.keyboard.press("t"); // from above
  const box = (await page.locator(".stage-view").boundingBox())!;
  const tip = page.getByRole("tooltip");
  const seen = new Set<string>();
  for (let i = 0; i < 90 && seen.size <= 5; ++i) {
    const [angle, radius] = [(i / 30) * 2 * Math.PI, 150 + 30 * Math.floor(i / 30)];
    await page.mouse.move(box.x + box.width / 2 + Math.cos(angle) * radius, box.y + box.height / 2 + Math.sin(angle) * radius);
    await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
    if (await tip.isVisible()) seen.add((await tip.textContent()) ?? "");
  }
  expect(seen.size).toBeGreaterThan(5);
  for (const text of seen) expect(text).toMatch(/^(Gain [\d\u202f]+ · (the best|number \d+) of 24|Gain not known|Initial scan|View \d)$/);
});

test("pictures are enlarged", async ({ page }) => {
  await open(page);
  await page.getByRole("button", { name: "Enlarge: What the camera saw" }).click();
  const sheet = page.getByRole("dialog", { name: "Picture" });
  await expect(sheet).toContainText("1 of 2");
  await page.keyboard.press("ArrowRight");
  await expect(sheet).toContainText("Choice · 2 of 2");
  await page.keyboard.press("Escape");
  await expect(sheet).toBeHidden();
});

test("a run that goes on is followed by who is at its end", async ({ page }) => {
  const { program } = await open(page, mockRun(2, true));
  const panel = page.getByRole("region", { name: "Step" });
  await expect(page.getByText("live", { exact: true })).toBeVisible();
  await expect(panel).toContainText("2 of 2");
  program.update(mockRun(3, true));
  await expect(panel).toContainText("3 of 3");
  await page.keyboard.press("Home");
  program.update(mockRun(4, false));
  await expect(panel).toContainText("1 of 4");
  await expect(page.getByText("live", { exact: true })).toBeHidden();
  await program.drop();
  await expect(page.getByText("Reconnecting")).toBeVisible();
  await expect(page.getByText("Connected")).toBeVisible({ timeout: 15_000 });
  await expect(panel).toContainText("1 of 4");
});

test("a buffer that is not there is said", async ({ page }) => {
  const mock = mockRun();
  mock.buffers.delete("b2");
  await open(page, mock);
  await expect(page.locator(".toast.error")).toContainText("Regions by saliency");
});

test("keys are listed", async ({ page }) => {
  await open(page);
  await page.keyboard.press("?");
  await expect(page.getByRole("dialog", { name: "Keyboard and mouse" })).toContainText("Look through the camera");
});
