// SPDX-License-Identifier: Apache-2.0
// Browser tests, in Debian's Chromium with software rendering, one after the other: two slow cores are enough.
import { defineConfig } from "@playwright/test";

export default defineConfig({
  testDir: "tests",
  testIgnore: process.env["SACCADE_LARGE"] === "1" ? [] : ["**/large.spec.ts"],
  workers: 1,
  retries: 0,
  timeout: 120_000,
  expect: { timeout: 20_000 },
  outputDir: "../out/test/browser",
  reporter: [["list"], ["junit", { outputFile: "../out/test/web.xml" }]],
  forbidOnly: !!process.env["CI"],
  use: {
    headless: true,
    viewport: { width: 1280, height: 800 },
    acceptDownloads: true,
    actionTimeout: 30_000,
    navigationTimeout: 60_000,
    colorScheme: "light",
    launchOptions: {
      executablePath: process.env["CHROMIUM"] ?? "/usr/bin/chromium",
      args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"],
    },
  },
});
