// SPDX-License-Identifier: Apache-2.0
// Browser tests, in Debian's Chromium with software rendering, on two slow cores. What measures times runs when the
// others are through, alone; with --no-deps without them.
import { defineConfig } from "@playwright/test";

const large = process.env["SACCADE_LARGE"] === "1" ? [] : ["**/large*.spec.ts"];
const measuring = "**/*performance.spec.ts";

export default defineConfig({
  testDir: "tests",
  projects: [
    { name: "pages", testIgnore: [measuring, ...large] },
    { name: "times", testMatch: measuring, dependencies: ["pages"], workers: 1 },
  ],
  workers: 2,
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
