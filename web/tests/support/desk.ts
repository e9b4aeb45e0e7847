// SPDX-License-Identifier: Apache-2.0
// Fixture of every test: a folder of its own, programs that end with it, and a page without errors.
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { type BrowserContext, type Page, test as base, expect } from "@playwright/test";
import { Annotator } from "./annotator";
import type { MadeCloud } from "./clouds";
import { keep } from "./picture";
import { Program } from "./program";

export { expect, keep };

/** Console messages of browsers when the connection ends; tests that end it allow them. */
const kLostConnection = /WebSocket connection to .* failed|ERR_CONNECTION_REFUSED|ERR_CONNECTION_RESET|ERR_EMPTY_RESPONSE|ERR_SOCKET_NOT_CONNECTED/;

export interface Desk {
  folder: string;
  /** `args` as on the command line, without those of the page. */
  start(...args: string[]): Promise<Program>;
  /** Errors of pages that this test is about. */
  expects(error: RegExp): void;
  /** A page with the cloud, once all of it is there. @param of whose browser, where it is another person's. */
  open(program: Program, cloud: MadeCloud, of?: BrowserContext): Promise<Annotator>;
}

export const test = base.extend<{ desk: Desk }>({
  desk: async ({ context }, use) => {
    const folder = mkdtempSync(join(tmpdir(), "saccade-browser-"));
    const programs: Program[] = [];
    const errors: string[] = [];
    const expected = [kLostConnection];
    const watch = (page: Page) => {
      page.on("pageerror", (error) => errors.push(error.message));
      page.on("console", (message) => {
        if (message.type() === "error" && !expected.some((one) => one.test(message.text()))) errors.push(message.text());
      });
    };
    const desk: Desk = {
      folder,
      expects: (error) => void expected.push(error),
      start: async (...args) => {
        const program = new Program(args, join(folder, `token-${programs.length}`));
        programs.push(program);
        return program.start();
      },
      open: async (program, cloud, of = context) => {
        const page = await of.newPage();
        watch(page);
        const annotator = new Annotator(page, cloud);
        await page.goto(program.url);
        await annotator.ready();
        return annotator;
      },
    };
    await use(desk);
    // The pages first: what they say about programs that end is no error.
    await context.close();
    const ends = await Promise.allSettled(programs.map((program) => program.stop()));
    rmSync(folder, { recursive: true, force: true });
    for (const end of ends) if (end.status === "rejected") throw end.reason;
    expect(errors, "errors of the page").toEqual([]);
  },
});
