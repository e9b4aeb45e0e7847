// SPDX-License-Identifier: Apache-2.0
// A person at the annotation page: mouse, keyboard, and what can be seen.
import { readFile } from "node:fs/promises";
import { type Locator, type Page, expect } from "@playwright/test";
import { type Box, type From, ScreenCamera } from "./camera";
import { type Color, type MadeCloud, type Place, kTops } from "./clouds";
import { complete } from "./picture";

type ScreenPlace = readonly [number, number];

const kKeys: Record<Exclude<From, "first">, string> = { above: "t", aside: "f", front: "Shift+F" };

export class Annotator {
  readonly view: Locator;
  readonly status: Locator;
  private camera: ScreenCamera | null = null;

  constructor(
    readonly page: Page,
    public cloud: MadeCloud,
  ) {
    this.view = page.getByRole("application", { name: "Cloud" });
    this.status = page.getByTestId("status");
  }

  /** Until all points are there and nothing waits for the disk. */
  async ready(): Promise<void> {
    await expect(this.view).toBeVisible({ timeout: 60_000 });
    await expect(this.page.locator(".progress")).toBeHidden({ timeout: 60_000 });
    await this.written();
    this.camera = new ScreenCamera(this.cloud.positions, "first", await this.box());
  }

  async written(): Promise<void> {
    await expect(this.status).toHaveAttribute("data-pending", "0", { timeout: 30_000 });
    await expect(this.status).toHaveText("All on disk", { timeout: 30_000 });
  }

  async box(): Promise<Box> {
    const box = await this.view.boundingBox();
    if (!box) throw new Error("there is no view");
    return box;
  }

  /** Presses the key for the whole cloud from there. */
  async look(from: Exclude<From, "first">): Promise<void> {
    await this.page.keyboard.press(kKeys[from]);
    this.camera = new ScreenCamera(this.cloud.positions, from, await this.box());
  }

  /** Where a place is on the page, as seen from where look() went last. */
  exactly(place: Place): [number, number] {
    if (!this.camera) throw new Error("the page is not open");
    return this.camera.project(place);
  }

  /** The pixel there. */
  at(place: Place): [number, number] {
    const [x, y] = this.exactly(place);
    return [Math.floor(x), Math.floor(y)];
  }

  // The panel.

  radio(group: string, name: string): Locator {
    return this.page.getByRole("radiogroup", { name: group, exact: true }).getByRole("radio", { name, exact: true });
  }

  async choose(group: "Action" | "Tool" | "Depth" | "What is taken away" | "Labels as" | "Unit of the radius", name: string): Promise<void> {
    const radio = this.radio(group, name);
    await radio.click();
    await expect(radio).toHaveAttribute("aria-checked", "true");
  }

  /** Its button among the twenty, whose name says how many points it has. */
  label(number: number): Locator {
    return this.page.getByRole("radiogroup", { name: "Labels", exact: true }).getByRole("radio", { name: new RegExp(`^Label ${number}\\b`) });
  }

  async chooseLabel(number: number): Promise<void> {
    await this.label(number).click();
    await expect(this.page.getByTestId("current-label")).toHaveText(String(number));
  }

  /** Waits until the label has `controls` control points; undefined: at least one. */
  async expectLabel(number: number, what: { controls?: number; name?: string; empty?: boolean }): Promise<void> {
    const { controls, name, empty } = what;
    const start = `Label ${number}${name ? ` ${name}` : ""}: `;
    const counted = controls === undefined ? "" : `${controls} control points?, `;
    await expect(this.label(number)).toHaveAccessibleName(new RegExp(`^${start}${empty ? "empty" : counted}`));
  }

  /** Points of a label, as its button says. */
  async pointsOf(number: number): Promise<number> {
    const name = (await this.label(number).getAttribute("aria-label")) ?? "";
    return name.endsWith("empty") ? 0 : Number(/([\d\u202f]+) points?$/.exec(name)?.[1]?.replaceAll("\u202f", "") ?? NaN);
  }

  async colorOf(number: number): Promise<Color> {
    await this.chooseLabel(number);
    const hex = await this.page.getByLabel("Colour of the label").inputValue();
    const value = Number.parseInt(hex.slice(1), 16);
    return [value >> 16, (value >> 8) & 255, value & 255];
  }

  async setSlider(name: string, position: number): Promise<void> {
    const slider = this.page.getByRole("slider", { name, exact: true });
    await slider.focus();
    const now = Number(await slider.inputValue());
    for (let i = 0; i < Math.abs(position - now); ++i) await this.page.keyboard.press(position > now ? "ArrowRight" : "ArrowLeft");
    await expect(slider).toHaveValue(String(position));
  }

  /** Labels objects with the labels of the truth, as seen from above, by a click each. */
  async labelTops(objects: readonly number[]): Promise<void> {
    await this.look("above");
    await this.choose("Action", "Set");
    await this.choose("Tool", "Point");
    for (const object of objects) {
      await this.chooseLabel(object);
      await this.click(kTops[object]!);
      await this.expectLabel(object, { controls: 1 });
    }
    await this.written();
  }

  // The mouse.

  async click(place: Place): Promise<void> {
    await this.page.mouse.click(...this.at(place));
  }

  async drag(line: readonly ScreenPlace[], button: "left" | "right" | "middle" = "left"): Promise<void> {
    const { mouse } = this.page;
    await mouse.move(...line[0]!);
    await mouse.down({ button });
    for (const place of line.slice(1)) await mouse.move(...place, { steps: 3 });
    await mouse.up({ button });
  }

  /** Drags a rectangle from corner a to the opposite corner b. */
  async dragRectangle(a: ScreenPlace, b: ScreenPlace): Promise<void> {
    await this.drag([a, b]);
  }

  async clickCorners(corners: readonly ScreenPlace[]): Promise<void> {
    for (const corner of corners) await this.page.mouse.click(...corner);
    await this.page.keyboard.press("Enter");
  }

  // Looking at the page.

  /** Colours of the view's picture there. */
  pixels(places: readonly ScreenPlace[]): Promise<Color[]> {
    return this.view.locator("canvas").evaluate((canvas: HTMLCanvasElement, wanted) => {
      const copy = document.createElement("canvas");
      copy.width = canvas.width;
      copy.height = canvas.height;
      const context = copy.getContext("2d", { willReadFrequently: true })!;
      context.drawImage(canvas, 0, 0);
      const { data } = context.getImageData(0, 0, copy.width, copy.height);
      const box = canvas.getBoundingClientRect();
      return wanted.map(([x, y]) => {
        const column = Math.floor(((x - box.x) * copy.width) / box.width);
        const row = Math.floor(((y - box.y) * copy.height) / box.height);
        const i = 4 * (row * copy.width + column);
        return [data[i] ?? -1, data[i + 1] ?? -1, data[i + 2] ?? -1] as const;
      });
    }, places);
  }

  /** A number that is another one for another picture. */
  pictureHash(): Promise<number> {
    return this.view.locator("canvas").evaluate((canvas: HTMLCanvasElement) => {
      const copy = document.createElement("canvas");
      copy.width = canvas.width;
      copy.height = canvas.height;
      const context = copy.getContext("2d", { willReadFrequently: true })!;
      context.drawImage(canvas, 0, 0);
      const words = new Uint32Array(context.getImageData(0, 0, copy.width, copy.height).data.buffer);
      return words.reduce((hash, word) => (Math.imul(hash ^ word, 16777619) >>> 0), 2166136261);
    });
  }

  /** The number of the complete picture. */
  async settled(): Promise<number> {
    await complete(this.page);
    return this.pictureHash();
  }

  /** Waits until these places have that colour. */
  async expectColor(places: readonly Place[], color: Color, within = 2): Promise<void> {
    const screen = places.map((place) => this.at(place));
    await expect(async () => {
      const seen = await this.pixels(screen);
      const wrong = seen.filter((one) => one.some((c, i) => Math.abs(c - color[i]!) > within));
      expect(wrong, `not ${color.join(" ")}`).toEqual([]);
    }).toPass({ timeout: 60_000 });  // the first picture of a cold browser takes its time
  }

  // Files.

  /** Returns the file that Export downloads. */
  async export(format: string): Promise<Buffer> {
    await this.page.getByRole("button", { name: "Export", exact: true }).click();
    const downloading = this.page.waitForEvent("download");
    await this.page.getByRole("menuitem", { name: new RegExp(`^${format}`) }).click();
    return readFile(await (await downloading).path());
  }
}

/** Nine places around one on the same level. */
export function around([x, y, z]: Place, radius_m: number): Place[] {
  const steps = [-radius_m, 0, radius_m];
  return steps.flatMap((dx) => steps.map((dy): Place => [x + dx, y + dy, z]));
}
