// SPDX-License-Identifier: Apache-2.0
// Counts pixels of the 3-D view.
import { expect, type Page } from "@playwright/test";
import { complete } from "./support/picture";

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
    const inside = (i: number, k: 0 | 1 | 2) => data[i + k]! >= low[k] && data[i + k]! <= high[k];
    for (let i = 0; i < data.length; i += 4) if (inside(i, 0) && inside(i, 1) && inside(i, 2)) ++count;
    return count;
  }, range);
}

/** Until the viewer has what it shows, and has drawn it. */
export async function settled(page: Page): Promise<void> {
  await expect(page.locator("main")).toHaveAttribute("aria-busy", "false", { timeout: 30_000 });
  await complete(page);
}
