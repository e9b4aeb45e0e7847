// SPDX-License-Identifier: Apache-2.0
// The page that has the 3-D view alone (dev/view.html), for its tests.
import { type Page, expect, test } from "@playwright/test";
import { type ViteDevServer, createServer } from "vite";
import type {} from "../dev/view";

let server: ViteDevServer;

/** Serves the page while the tests of a file run. */
export function serve(): void {
  test.beforeAll(async () => {
    server = await createServer({ root: ".", configFile: false, logLevel: "error", server: { port: 0, host: "127.0.0.1" } });
    await server.listen();
  });
  test.afterAll(() => server.close());
}

export async function open(page: Page, points: number): Promise<void> {
  page.on("pageerror", (error) => expect(error.message).toBe(""));
  page.on("console", (message) => {
    if (message.type() === "error") expect(message.text()).toBe("");
  });
  await page.emulateMedia({ colorScheme: "dark" });
  await page.goto(`${server.resolvedUrls!.local[0]}dev/view.html?points=${points}`);
  await settled(page);
}

/** Until the picture is complete. */
export async function settled(page: Page): Promise<void> {
  await page.waitForFunction(() => window.dev !== undefined);
  await page.evaluate(async () => {
    const { stats } = window.dev.viewer;
    for (let frames = -1; frames !== stats.frames || stats.pictures === 0; ) {
      frames = stats.frames;
      await new Promise((done) => setTimeout(done, 150));
    }
  });
}

/** Keeps a picture of the page. */
export async function picture(page: Page, name: string): Promise<void> {
  await settled(page);
  await page.screenshot({ path: `test-results/view/${name}.png` });
}
