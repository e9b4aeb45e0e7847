// SPDX-License-Identifier: Apache-2.0
// The page that has the 3-D view alone (dev/view.html), for its tests.
import { type Page, expect } from "@playwright/test";
import type {} from "../dev/view";
import { serveSources } from "./support/dev_server";
import { complete, keep } from "./support/picture";

let address = () => "";

/** Serves the page while the tests of a file run. */
export function serve(): void {
  address = serveSources();
}

export async function open(page: Page, points: number): Promise<void> {
  page.on("pageerror", (error) => expect(error.message).toBe(""));
  page.on("console", (message) => {
    if (message.type() === "error") expect(message.text()).toBe("");
  });
  await page.emulateMedia({ colorScheme: "dark" });
  await page.goto(`${address()}dev/view.html?points=${points}`);
  await settled(page);
}

/** Until the picture is complete. */
export async function settled(page: Page): Promise<void> {
  await page.waitForFunction(() => window.dev !== undefined);
  await complete(page);
}

/** Keeps a picture of the page. */
export async function picture(page: Page, name: string): Promise<void> {
  await settled(page);
  await keep(page, `view-${name}`);
}
