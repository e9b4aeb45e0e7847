// SPDX-License-Identifier: Apache-2.0
// The page of reports, opened from disk as the program writes it: all kinds of runs, for eyes, keys, screen readers and paper.
import { mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { expect, type Page, test } from "@playwright/test";
import { armBenchmark, benchmark, cell, comparison, exploration, faults, filtered, manyStrategies, partsOfPage, segments, tables, update, writeReport } from "./support/report";

let folder = "";
test.beforeEach(() => void (folder = mkdtempSync(join(tmpdir(), "saccade-report-"))));
test.afterEach(() => rmSync(folder, { recursive: true, force: true }));

/** @return errors of the page, and what it asked for from elsewhere */
async function open(page: Page, address: string): Promise<string[]> {
  const wrong: string[] = [];
  page.on("pageerror", (error) => wrong.push(error.message));
  page.on("console", (message) => message.type() === "error" && wrong.push(message.text()));
  page.on("request", (request) => /^https?:/.test(request.url()) && wrong.push(request.url()));
  await page.goto(address);
  await expect(page.locator("main section").first()).toBeVisible();
  return wrong;
}

const exploreAddress = (views = 4, scene?: string) => {
  const { record, pictures } = exploration(views, scene);
  return writeReport(folder, record, pictures);
};

const kinds: [name: string, address: () => string, heading: string, parts: string[]][] = [
  ["explore", () => exploreAddress(), "Exploration of tabletop-1", ["Summary", "Views", "Run"]],
  ["update", () => { const { record, pictures, details } = update(); return writeReport(folder, record, pictures, details); }, "Update of jug", ["Summary", "Task", "Looking again", "Run"]],
  ["cell", () => { const { record, pictures } = cell(); return writeReport(folder, record, pictures); }, "Updates of my cell", ["The map now", "Tasks", "Run"]],
  ["compare", () => { const { record, details } = comparison(); return writeReport(folder, record, [], details); }, "Strategies compared", ["All scenes", "clutter:5", "clutter:6", "Slices", "Comparison"]],
  ["benchmark", () => { const { record, details } = benchmark(); return writeReport(folder, record, [], details); }, "Benchmark one-shot", ["one-shot, version 1", "Differences by object", "All scenes", "clutter:5", "clutter:6", "Comparison"]],
  ["reproduce", () => { const { record, pictures } = tables(); return writeReport(folder, record, pictures); }, "Tables of the thesis", ["Table 4.4", "Run"]],
  ["segment", () => { const { record, pictures } = segments(); return writeReport(folder, record, pictures); }, "Segments of table.pcd", ["Summary", "Run"]],
  ["filter", () => { const { record, pictures } = filtered(); return writeReport(folder, record, pictures); }, "Filtered frames of filtered", ["Summary", "Run"]],
];

for (const [name, address, heading, parts] of kinds) {
  test(`${name}: all parts, on a wide and a narrow page, in the light and in the dark`, async ({ page }) => {
    test.slow(); // axe-core goes through the page four times
    const wrong = await open(page, address());
    await expect(page.getByRole("heading", { level: 1 })).toHaveText(heading);
    await expect(page.getByRole("heading", { level: 2 })).toHaveText(parts);
    await page.evaluate(() => document.querySelectorAll<HTMLDetailsElement>("details").forEach((fold) => (fold.open = true)));
    for (const colorScheme of ["light", "dark"] as const) {
      for (const width of [1280, 400, 360]) {
        await page.setViewportSize({ width, height: 800 });
        await page.emulateMedia({ colorScheme });
        await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
        expect(await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth), `${width} px`).toBe(0);
        if (width !== 360) expect(await faults(page), `${width} px, ${colorScheme}`).toEqual([]);
      }
    }
    expect(wrong).toEqual([]);
  });
}

test("a comparison in slices says how far each is and what failed", async ({ page }) => {
  const { record, details } = comparison();
  const wrong = await open(page, writeReport(folder, record, [], details));
  const slices = page.locator("#slices");
  await expect(slices.locator("p").first()).toHaveText("2 slices: 1 done, 1 failed.");
  await expect(slices.locator("li")).toHaveText("Slice 1 of 2: clutter:6: no surface of an object can be seen");
  await expect(slices.locator("tbody tr")).toHaveCount(2);
  await expect(slices.locator("tbody tr").nth(1)).toContainText("4 of 6");
  record.result["runs"] = { planned: 12, done: 5, in_shards: 3 };
  record.result["unreadable"] = ["shards/1-of-2/campaign.sqlite: is damaged"];
  record.result["set_aside"] = ["0-of-2"];
  record.result["slices_at"] = "2024-06-30T12:00:00Z";
  await open(page, writeReport(folder, record, [], details));
  await expect(page.locator("body")).toContainText("5 of 12 runs are merged, 3 more are done in slices, 4 are still to be done. 1 slice failed.");
  await expect(slices.locator("p").first()).toHaveText("2 slices: 1 done, 1 failed, at 2024-06-30 12:00:00 UTC.");
  await expect(page.getByRole("heading", { level: 2 }).first()).toHaveText("Slices");
  await expect(slices.locator("li").nth(2)).toHaveText("Set aside, since it was damaged: 0-of-2");
  await expect(slices.locator("li").nth(1)).toHaveText("Cannot be read: shards/1-of-2/campaign.sqlite: is damaged");
  delete record.result["unreadable"];
  delete record.result["set_aside"];
  delete record.result["slices"];
  await open(page, writeReport(folder, record, [], details));
  await expect(page.locator("#slices")).toHaveCount(0);
  expect(wrong).toEqual([]);
});

test("a benchmark whose slices are at work has no table yet", async ({ page }) => {
  const { record, details } = comparison();
  record.command = "benchmark";
  expect(await open(page, writeReport(folder, record, [], details))).toEqual([]);
  await expect(page.getByRole("heading", { level: 1 })).toHaveText("Benchmark");
  await expect(page.getByRole("heading", { level: 2 }).first()).toHaveText("All scenes");
  await expect(page.locator("main, header").getByText("Figures beside published ones come with the merge.")).toHaveCount(1);
});

test("a benchmark has ours and published figures in one table", async ({ page }) => {
  const { record, details } = benchmark();
  const wrong = await open(page, writeReport(folder, record, [], details));
  const rows = page.locator("#benchmark tbody tr");
  await expect(rows).toHaveCount(3);
  await expect(rows.nth(0).locator("th, td")).toHaveText(["surface", "12", "11.5", "99.0 ± 1.0", "97.2 ± 1.0", "", "this run", ""]);
  await expect(rows.nth(2)).toContainText("12.2");
  await expect(rows.nth(2)).toContainText("93.1");
  await expect(rows.nth(2)).toContainText("year not known, a survey; mean over its objects");
  await expect(page.locator("#benchmark")).toContainText("Stand-ins: these objects are made by rule");
  await expect(page.locator("#benchmark")).not.toContainText("runs so far");
  expect(wrong).toEqual([]);
});

test("a benchmark has differences by object, and says that their intervals are not corrected", async ({ page }) => {
  const { record, details } = benchmark();
  const wrong = await open(page, writeReport(folder, record, [], details));
  const rows = page.locator("#differences tbody tr");
  await expect(rows).toHaveCount(2);
  await expect(rows.nth(0).locator("th, td")).toHaveText(["surface − random", "12", "2", "+7.1 ± 4.2", "yes", "+6.8 ± 9.0", "no"]);
  await expect(rows.nth(1).locator("th, td")).toHaveText(["surface − unobserved-voxel", "12", "2", "−0.2 ± 1.1", "no", "±0.0 ± 0.0", "no"]);
  await expect(page.locator("#differences")).toContainText("not corrected for the number of comparisons");
  expect(wrong).toEqual([]);
});

test("a benchmark with one object has no interval, and one with one strategy no differences", async ({ page }) => {
  const arm = armBenchmark();
  await open(page, writeReport(folder, arm.record, [], arm.details));
  await expect(page.locator("#differences h2")).toHaveText("Differences by scene");
  await expect(page.locator("#differences tbody tr").locator("th, td")).toHaveText(["surface − random", "5", "1", "+3.0", "–"]);
  await expect(page.locator("#differences")).toContainText("One scene has no interval");
  await expect(page.locator("#differences")).not.toContainText("not corrected");
  const { record, details } = benchmark();
  (record.result["benchmark"] as { differences: unknown[] }).differences = [];
  await open(page, writeReport(folder, record, [], details));
  await expect(page.locator("#differences")).toHaveCount(0);
});

test("a benchmark says beside every published figure, first of those that it is short of", async ({ page }) => {
  const { record, details } = benchmark();
  await open(page, writeReport(folder, record, [], details));
  const lines = (await page.locator(".summary-text").innerText()).split("\n");
  expect(lines.map((line) => /short of it|not below it/.exec(line)?.[0])).toEqual(["short of it", "not below it"]);
  expect(lines[0]).toMatch(/\.$/);
});

test("the table of a benchmark shows all its columns on a page of 1200 px", async ({ page }) => {
  await page.setViewportSize({ width: 1200, height: 800 });
  const { record, details } = benchmark();
  await open(page, writeReport(folder, record, [], details));
  const hidden = await page.locator("#benchmark .table-scroll").evaluate((element) => element.scrollWidth - element.clientWidth);
  expect(hidden).toBe(0);
  await expect(page.locator("#benchmark thead th").last()).toHaveText(/what differs/);
});

test("a benchmark that was interrupted says so, and what its table is over", async ({ page }) => {
  const { record, details } = benchmark();
  const result = record.result["benchmark"] as { [key: string]: unknown };
  Object.assign(result, { complete: false, runs: { planned: 16, done: 13, each_strategy: 6 }, beside_published: [] });
  record.result["runs"] = { planned: 16, done: 13 };
  await open(page, writeReport(folder, record, [], details));
  await expect(page.locator("#benchmark")).toContainText("13 of 16 runs so far. The table has 6 runs of each strategy");
  await expect(page.locator(".summary-text")).toContainText("13 of 16 runs");
  await expect(page.locator("body")).not.toContainText("not below it");
});

test("a benchmark on an arm has intervals of path and motion", async ({ page }) => {
  const { record, details } = armBenchmark();
  await open(page, writeReport(folder, record, [], details));
  await expect(page.locator("#benchmark tbody tr").locator("th, td")).toHaveText(["surface", "5", "97.0 ± 1.1", "7.13 ± 0.34", "8.5 ± 0.2", "this run"]);
  await expect(page.locator("#benchmark thead th")).toHaveCount(6); // nothing is published that would differ
});

for (const strategies of [2, 6, 12]) {
  test(`the names below the bars of ${strategies} strategies do not overlap`, async ({ page }) => {
    await page.setViewportSize({ width: 1200, height: 800 });
    const { record, details } = manyStrategies(strategies);
    await open(page, writeReport(folder, record, [], details));
    const bars = page.getByRole("img", { name: /^Time per phase/ }).first();
    await bars.scrollIntoViewIfNeeded();
    const names = bars.locator("[aria-label^='x-axis tick label'] text");
    await expect(names).toHaveCount(strategies);
    // Along the line of the names: how far apart they are, and how high one is.
    const { gaps, outside } = await names.evaluateAll((elements) => {
      const texts = elements as unknown as SVGTextElement[];
      const places = texts.map((text) => text.getScreenCTM()!);
      const own = texts.map((text) => text.getBBox());
      const across = (i: number) => {
        const [a, b] = [places[i]!, places[i + 1]!];
        const turn = Math.atan2(a.b, a.a);
        const [along, beside] = [(b.e - a.e) * Math.cos(turn) + (b.f - a.f) * Math.sin(turn), Math.abs((b.f - a.f) * Math.cos(turn) - (b.e - a.e) * Math.sin(turn))];
        return turn === 0 ? along - (own[i]!.width + own[i + 1]!.width) / 2 : beside - own[i]!.height;
      };
      const card = texts[0]!.closest("figure")!.getBoundingClientRect();
      const boxes = texts.map((text) => text.getBoundingClientRect());
      return { gaps: texts.slice(1).map((_, i) => across(i)), outside: boxes.filter((box) => box.left < card.left || box.bottom > card.bottom || box.right > card.right).length };
    });
    expect(Math.min(...gaps)).toBeGreaterThan(0);
    expect(outside).toBe(0);
  });
}

test("the cells of reproduced tables are shown with their own drawings", async ({ page }) => {
  const { record, pictures } = tables();
  await open(page, writeReport(folder, record, pictures));
  const table = page.getByRole("table", { name: "Parameters & options" });
  await expect(table.locator("tbody tr").first()).toContainText("R_seed");
  await expect(table.locator("tbody tr").last()).toContainText("0.70");
  await expect(page.locator("main img")).toHaveCount(1);
  await expect(page.getByRole("img", { name: "Table 4.4: table-4-4.png" })).toBeVisible();
});

test("segments say how to see their cloud in 3-D", async ({ page }) => {
  const { record, pictures } = segments();
  await open(page, writeReport(folder, record, pictures));
  await expect(page.getByText("saccade show FOLDER/segments.ply")).toBeVisible();
  await expect(page.getByRole("table", { name: /^Segments/ }).locator("tbody tr")).toHaveCount(3);
});

test("names that look like markup are shown as they are", async ({ page }) => {
  const scene = `</script><img src=x onerror="document.title='run'"> & 'quotes'`;
  const wrong = await open(page, exploreAddress(2, scene));
  await expect(page.getByRole("heading", { level: 1 })).toHaveText(`Exploration of ${scene}`);
  await expect(page).toHaveTitle(`Exploration of ${scene} · Saccade`);
  expect(await page.locator("main img[src='x'], h1 img").count()).toBe(0);
  expect(wrong).toEqual([]);
});

test("tables sort by any column and are copied as they are sorted", async ({ page, context }) => {
  await context.grantPermissions(["clipboard-read", "clipboard-write"]).catch(() => {});
  await open(page, exploreAddress(3));
  const table = page.getByRole("table", { name: "Views" });
  const first = () => table.locator("tbody th").first().textContent();
  expect(await first()).toBe("1");
  const promised = table.getByRole("button", { name: /^promised/ });
  await promised.click();
  expect(await first()).toBe("3"); // the view of least gain
  await expect(table.getByRole("columnheader", { name: /^promised/ })).toHaveAttribute("aria-sort", "ascending");
  await promised.press("Enter");
  expect(await first()).toBe("1");
  await promised.press("Enter");
  const copied = async (format: string) => {
    await page.getByRole("button", { name: `Copy ${format}` }).first().click();
    await expect(page.getByText(`${format} copied`)).toBeVisible();
    return page.evaluate(() => navigator.clipboard.readText());
  };
  const csv = (await copied("CSV")).split("\r\n");
  expect(csv[0]).toMatch(/^view,"promised, cm²","delivered, cm²",kept,/);
  expect(csv[1]).toMatch(/^3,/);
  const latex = await copied("LaTeX");
  expect(latex).toContain("\\begin{tabular}{lrrr");
  expect(latex).toMatch(/100 \\%/);
});

test("measures explain themselves on hover and focus, and Escape closes the explanation", async ({ page }) => {
  await open(page, exploreAddress(2));
  const head = page.getByRole("table", { name: "Views" }).getByRole("button", { name: /^coverage/ });
  await head.focus();
  const hint = page.getByRole("tooltip");
  await expect(hint).toContainText("within one voxel");
  await expect(head).toHaveAccessibleDescription(/within one voxel/);
  await page.keyboard.press("Escape");
  await expect(hint).toBeHidden();
  await page.locator(".tiles button", { hasText: "F-score" }).hover();
  await expect(hint).toContainText("Harmonic mean");
});

test("views are stepped through by keys, and their pictures enlarged", async ({ page }) => {
  await open(page, exploreAddress(3));
  await expect(page.locator("#view-1")).not.toHaveAttribute("open");
  expect(await page.locator("#view-1 img").count()).toBe(0); // not even asked for
  await page.keyboard.press("ArrowRight");
  await expect(page.locator("#view-1")).toHaveAttribute("open");
  await page.keyboard.press("ArrowRight");
  await expect(page.locator("#view-2")).toHaveAttribute("open");
  await page.keyboard.press("ArrowLeft");
  await expect(page.locator("#view-1 summary")).toBeFocused();
  await page.getByRole("table", { name: "Views" }).getByRole("link", { name: "3" }).click();
  await expect(page.locator("#view-3")).toHaveAttribute("open");
  await page.getByRole("button", { name: /^Enlarge: The map from outside, unknown in grey, view 1/ }).click();
  const sheet = page.getByRole("dialog", { name: "Picture" });
  await expect(sheet).toContainText("view-01-map.png");
  await page.keyboard.press("ArrowRight");
  await expect(sheet).toContainText("view-02-map.png");
  expect(await faults(page)).toEqual([]);
  await page.keyboard.press("Escape");
  await expect(sheet).toBeHidden();
});

test("curves say what they show to screen readers, and values under the pointer", async ({ page }) => {
  await open(page, exploreAddress(4));
  const coverage = page.getByRole("img", { name: /^Coverage\./ });
  await expect(coverage).toHaveAccessibleName(/from 35 to 86 over 5 points/);
  await coverage.scrollIntoViewIfNeeded();
  const box = (await coverage.boundingBox())!;
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await expect(coverage.locator("[aria-label='tip'] text")).toContainText("coverage, %");
});

test("on paper everything is open, and dark pages are light", async ({ page }) => {
  await page.emulateMedia({ colorScheme: "dark" });
  await open(page, exploreAddress(3));
  await page.evaluate(() => window.dispatchEvent(new Event("beforeprint")));
  await page.emulateMedia({ media: "print", colorScheme: "dark" });
  expect(await page.locator("details.fold:not([open])").count()).toBe(0);
  await expect(page.locator("#view-3 img").first()).toBeVisible();
  await expect(page.getByRole("button", { name: "Copy CSV" }).first()).toBeHidden();
  expect(await page.evaluate(() => getComputedStyle(document.querySelector(".fold")!).backgroundColor)).toBe("rgb(255, 255, 255)");
  expect((await page.pdf({ format: "A4" })).length).toBeGreaterThan(20_000);
  await page.evaluate(() => window.dispatchEvent(new Event("afterprint")));
  expect(await page.locator("details.fold[open]").count()).toBe(0);
});

test("a picture that is gone and a record of another version are said", async ({ page }) => {
  const { record, pictures } = exploration(2);
  const address = writeReport(folder, record, pictures);
  rmSync(join(folder, "view-00-map.png"));
  await page.goto(address);
  await expect(page.getByText("view-00-map.png cannot be read.")).toBeVisible();
  const file = join(folder, "report.html");
  writeFileSync(file, readFileSync(file, "utf8").replace('"schema":"saccade-report/1"', '"schema":"saccade-report/9"'));
  await page.goto(address);
  await expect(page.getByRole("heading", { level: 1 })).toHaveText("This record is of another version");
  await expect(page.getByRole("status").filter({ hasText: "saccade-report/9" })).toContainText('this page reads "saccade-report/1"');
});

test("the page takes at most 400 kB without data", () => {
  const bytes = Object.values(partsOfPage).reduce((sum, file) => sum + statSync(file).size, 0);
  expect(bytes).toBeLessThan(400_000);
  expect(bytes).toBeGreaterThan(50_000);
});
