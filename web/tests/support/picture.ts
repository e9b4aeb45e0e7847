// SPDX-License-Identifier: Apache-2.0
// Pictures of the 3-D view: when they are complete, and where they are kept.
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { expect, type Page } from "@playwright/test";

export const kRepository = fileURLToPath(new URL("../../../", import.meta.url));

/** Until all that was asked for is drawn, and nothing moves: the view says the number of its complete picture. */
export async function complete(page: Page): Promise<void> {
  await page.evaluate(async (most_ms) => {
    const frame = () => new Promise((done) => requestAnimationFrame(done));
    const number = () => document.querySelector<HTMLElement>("[data-picture]")?.dataset["picture"];
    const began = performance.now();
    for (;;) {
      const before = number();
      await frame();
      await frame();
      const marks = document.querySelector("[data-flash]") !== null; // what an action changed, for a moment
      if (before !== undefined && number() === before && !marks) return;
      if (performance.now() - began > most_ms) throw new Error(`the picture does not become complete in ${most_ms} ms`);
    }
  }, 30_000);
}

/** A picture that is kept. */
export async function keep(page: Page, name: string): Promise<void> {
  const folder = join(kRepository, "out/test/screenshots");
  mkdirSync(folder, { recursive: true });
  await page.screenshot({ path: join(folder, `${name}.png`) });
}

/** A picture for README and docs, made where SACCADE_UPDATE_IMAGES=1. */
export async function keepForDocs(page: Page, name: string): Promise<void> {
  await keep(page, name);
  if (process.env["SACCADE_UPDATE_IMAGES"] !== "1") return;
  const picture = await page.screenshot({ path: join(kRepository, "docs/images", `${name}.png`) });
  expect(picture.length, `bytes of ${name}.png`).toBeLessThanOrEqual(400_000);
}
