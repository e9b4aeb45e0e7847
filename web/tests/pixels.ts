// SPDX-License-Identifier: Apache-2.0
// What the 3-D view shows, as numbers of pixels.
import { expect, type Page } from "@playwright/test";

export interface ColorRange {
  low: readonly [number, number, number];
  high: readonly [number, number, number];
}

/** Pixels of the view's canvas whose colour is in the range, ends included. */
export function countPixels(page: Page, range: ColorRange): Promise<number> {
  return page.evaluate(({ low, high }) => {
    const source = document.querySelector("canvas");
    if (!source || source.width === 0) return 0;
    const copy = document.createElement("canvas");
    copy.width = source.width;
    copy.height = source.height;
    const context = copy.getContext("2d")!;
    context.drawImage(source, 0, 0);
    const { data } = context.getImageData(0, 0, copy.width, copy.height);
    let count = 0;
    for (let i = 0; i < data.length; i += 4) if ([0, 1, 2].every((k) => data[i + k]! >= low[k]! && data[i + k]! <= high[k]!)) ++count;
    return count;
  }, range);
}

/** Until the viewer has what it shows, and its canvas stays as it is. */
export async function settled(page: Page): Promise<void> {
  await expect(page.locator("main")).toHaveAttribute("aria-busy", "false", { timeout: 30_000 });
  let before = "";
  const same = async (): Promise<boolean> => {
    const now = await page.evaluate(() => {
      const copy = document.createElement("canvas");
      [copy.width, copy.height] = [320, 200];
      const context = copy.getContext("2d")!;
      context.drawImage(document.querySelector("canvas")!, 0, 0, 320, 200);
      return context.getImageData(0, 0, 320, 200).data.join();
    });
    const same = now === before;
    before = now;
    return same;
  };
  await expect.poll(same, { intervals: [250], timeout: 30_000 }).toBe(true);
}
