// SPDX-License-Identifier: Apache-2.0
// The 3-D view alone, on made clouds: what is in its pixels, what is picked, and how long it takes.
import { mkdirSync } from "node:fs";
import { type Page, expect, test } from "@playwright/test";
import { type ViteDevServer, createServer } from "vite";
import type {} from "../dev/view";

const kPictures = "test-results/view";
let server: ViteDevServer;

test.beforeAll(async () => {
  mkdirSync(kPictures, { recursive: true });
  server = await createServer({ root: ".", configFile: false, logLevel: "error", server: { port: 0, host: "127.0.0.1" } });
  await server.listen();
});
test.afterAll(() => server.close());

async function open(page: Page, points: number): Promise<void> {
  page.on("pageerror", (error) => expect(error.message).toBe(""));
  page.on("console", (message) => {
    if (message.type() === "error") expect(message.text()).toBe("");
  });
  await page.emulateMedia({ colorScheme: "dark" });
  await page.goto(`${server.resolvedUrls!.local[0]}dev/view.html?points=${points}`);
  await settled(page);
}

/** Until the picture is complete. */
async function settled(page: Page): Promise<void> {
  await page.waitForFunction(() => window.dev !== undefined);
  await page.evaluate(async () => {
    const { stats } = window.dev.viewer;
    for (let frames = -1; frames !== stats.frames; ) {
      frames = stats.frames;
      await new Promise((done) => setTimeout(done, 150));
    }
  });
}

test("a cloud with labels and control points", async ({ page }) => {
  await open(page, 300_000);
  await page.screenshot({ path: `${kPictures}/both.png` });
  await page.evaluate(() => {
    const { cloud } = window.dev.viewer;
    const next = window.dev.random(3);
    for (let i = 0; i < 40; ++i) {
      const point = Math.floor(next() * 300_000);
      cloud.setControlPoint(point, cloud.labelOf(point));
    }
    cloud.mark(17);
  });
  await settled(page);
  await page.screenshot({ path: `${kPictures}/controls.png` });
  await page.evaluate(() => window.dev.viewer.cloud.show({ cloud: false, labels: true, controls: true }));
  await settled(page);
  await page.screenshot({ path: `${kPictures}/labels.png` });
});
