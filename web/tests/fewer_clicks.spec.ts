// SPDX-License-Identifier: Apache-2.0
// Fewer clicks: the offered click by one key, whole segments by one click, a label split by one stroke; and nothing of them is lost when the program is killed.
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import type { Page } from "@playwright/test";
import { type MadeCloud, kBox, kCylinder, kSphere, kTable, kTops, makeTable } from "./support/clouds";
import { expect, keep, test } from "./support/desk";
import { labelsOfPcd } from "./support/pcd";
import { runProgram } from "./support/program";

const kCut_m = 0.17; // x of a stroke across the table, between its objects

interface Kept {
  actions: number;
  control_points: number;
}

/** Counts the actions and control points that the program finds in a session. */
function keptIn(cloud: string, session: string): Kept {
  return (JSON.parse(runProgram(["--json", "-", "annotate", cloud, "--session", session])) as { result: Kept }).result;
}

/** Waits until the ring is at the next place. */
const offered = (page: Page) => expect(page.getByRole("button", { name: "Accept its label" })).toHaveAttribute("aria-disabled", "false");

/** Number of control points, as the panel has it. */
const controls = (page: Page) => page.locator(".list-row", { hasText: /#\d/ }).count();

test("the next best click is accepted by a key", async ({ desk }) => {
  const cloud = makeTable(join(desk.folder, "table.pcd"), { spacing_m: 0.008 });
  const program = await desk.start("annotate", cloud.file);
  const annotator = await desk.open(program, cloud);
  const { page } = annotator;
  await annotator.labelTops([kTable, kBox]); // two actions

  await test.step("with the label of the place, and the next is offered", async () => {
    await page.keyboard.press("g");
    await expect(page.locator(".toast").last()).toContainText("most in doubt");
    await page.keyboard.press("a"); // a third
    await expect.poll(() => controls(page)).toBe(3);
    await offered(page);
    await page.keyboard.press("a"); // a fourth, at the place offered meanwhile
    await expect.poll(() => controls(page)).toBe(4);
    await annotator.expectLabel(kSphere, { empty: true });
    await offered(page);
  });

  await test.step("with the chosen label", async () => {
    await annotator.chooseLabel(kSphere);
    await page.keyboard.press("Shift+A"); // a fifth
    await annotator.expectLabel(kSphere, { controls: 1 });
    await offered(page);
  });

  await test.step("killed in the midst of it, it is done once", async () => {
    await Promise.all([page.getByRole("button", { name: "Accept its label" }).click(), program.kill()]); // a sixth
    await program.start();
    await annotator.written();
    await expect.poll(() => controls(page)).toBe(6);
    await page.close();
    await program.kill();
    expect(keptIn(cloud.file, join(desk.folder, "table.sacann"))).toMatchObject({ actions: 6, control_points: 6 });
  });
});

/** Segments of the objects, the box and the cylinder as one: a file of numbers. */
function writeSegments(cloud: MadeCloud, file: string): string {
  const segments = [...cloud.truth].map((label) => (label === kCylinder ? kBox : label) + 100);
  writeFileSync(file, `${segments.join("\n")}\n`);
  return file;
}

test("whole segments by one click, and one that is two things is split by a stroke", async ({ desk }) => {
  const cloud = makeTable(join(desk.folder, "table.pcd"), { spacing_m: 0.008 });
  const segments = writeSegments(cloud, join(desk.folder, "segments.txt"));
  const program = await desk.start("annotate", cloud.file, "--segments", segments);
  const annotator = await desk.open(program, cloud);
  const { page } = annotator;
  const sizeOf = (...objects: number[]) => cloud.truth.filter((label) => objects.includes(label)).length;
  await annotator.look("above");

  await test.step("the segment under the cursor stands out, and a click takes all of it", async () => {
    await annotator.chooseLabel(7);
    await page.keyboard.press("s");
    await expect(annotator.radio("Tool", "Segment")).toHaveAttribute("aria-checked", "true");
    await expect(annotator.radio("Action", "Set")).toHaveAttribute("aria-checked", "true");
    await expect(page.getByLabel("Colour points by")).toHaveValue("segments");
    await page.mouse.move(...annotator.at(kTops[kBox]!));
    await annotator.expectColor([kTops[kCylinder]!], [255, 214, 10], 3); // it has the cylinder, too
    await keep(page, "segments");
    await annotator.click(kTops[kBox]!); // one action
    await expect.poll(() => annotator.pointsOf(7)).toBe(sizeOf(kBox, kCylinder));
    await annotator.chooseLabel(8);
    await Promise.all([annotator.click(kTops[kSphere]!), program.kill()]); // a second, killed in the midst of it
    await program.start();
    await annotator.written();
    await expect.poll(() => annotator.pointsOf(8)).toBe(sizeOf(kSphere));
  });

  await test.step("split by a stroke across it", async () => {
    await annotator.chooseLabel(6);
    await annotator.click(kTops[kTable]!); // a third
    await expect.poll(() => annotator.pointsOf(6)).toBe(sizeOf(kTable));
    await annotator.chooseLabel(9);
    await page.keyboard.press("k");
    const stroke = [annotator.exactly([kCut_m, -0.5, 0]), annotator.exactly([kCut_m, 0.5, 0])];
    await Promise.all([annotator.drag(stroke), program.kill()]); // a fourth
    await program.start();
    await annotator.written();
    await annotator.expectLabel(9, { controls: 0 });
    await keep(page, "split");
    const labels = labelsOfPcd(await annotator.export("PCD"));
    const table = [...cloud.truth.keys()].filter((point) => cloud.truth[point] === kTable);
    const away_m = (point: number) => cloud.positions[3 * point]! - kCut_m;
    const wrong = table.filter((point) => Math.abs(away_m(point)) > 0.003 && labels[point] !== (away_m(point) > 0 ? 9 : 6));
    expect(wrong.length).toBe(0);
  });

  await test.step("undone and redone as single actions", async () => {
    await page.keyboard.press("Control+z");
    await expect.poll(() => annotator.pointsOf(6)).toBe(sizeOf(kTable));
    await page.keyboard.press("Control+Shift+z");
    await expect.poll(() => annotator.pointsOf(6)).toBeLessThan(sizeOf(kTable));
    await annotator.written();
    await page.close();
    await program.kill();
    expect(keptIn(cloud.file, join(desk.folder, "table.sacann"))).toMatchObject({ actions: 6, control_points: 0 });
  });
});
