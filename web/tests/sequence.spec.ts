// SPDX-License-Identifier: Apache-2.0
// A sequence of clouds with poses: labels are carried to the next cloud, and mean the same in all.
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { kBox, kCylinder, kFlatBox, kSphere, kTable, makeTable } from "./support/clouds";
import { expect, keep, test } from "./support/desk";
import { iou, labelsOfPcd } from "./support/pcd";

const kObjects = [kTable, kBox, kCylinder, kSphere, kFlatBox];
const kTurns_rad = [0, 0.6, 1.2];

test("labels go on to the next clouds of a sequence", async ({ desk }) => {
  const clouds = kTurns_rad.map((turn_rad, i) => makeTable(join(desk.folder, `scan_${i}.pcd`), { spacing_m: 0.008, seed: i + 1, turn_rad }));
  const poses = join(desk.folder, "poses.txt");
  const line = (turn_rad: number) => {
    const [cos, sin] = [Math.cos(-turn_rad), Math.sin(-turn_rad)];
    return [cos, -sin, 0, 0, sin, cos, 0, 0, 0, 0, 1, 0].join(" ");
  };
  writeFileSync(poses, `${kTurns_rad.map(line).join("\n")}\n`);
  const program = await desk.start("annotate", ...clouds.map(({ file }) => file), "--poses", poses);
  const annotator = await desk.open(program, clouds[0]!);
  const { page } = annotator;
  const carry = page.getByRole("button", { name: "Carry the labels to the next cloud" });
  const shows = async (index: number) => {
    await expect(page.getByText(`${index + 1} / 3`)).toBeVisible();
    annotator.cloud = clouds[index]!;
    await annotator.ready();
  };
  const expectRight = async (index: number) => {
    const labels = labelsOfPcd(await annotator.export("PCD"));
    for (const object of kObjects) expect(iou(labels, object, clouds[index]!.truth, object), `label ${object} in cloud ${index}`).toBeGreaterThan(0.9);
  };

  await shows(0);
  await annotator.labelTops(kObjects);
  await annotator.chooseLabel(kBox);
  await page.getByLabel("Name of the label").fill("crate");
  await page.keyboard.press("Enter");
  await annotator.expectLabel(kBox, { controls: 1, name: "crate" });
  await expectRight(0);

  await carry.click();
  await shows(1);
  const toast = page.locator(".toast").filter({ hasText: "took the labels of scan_0.pcd" });
  await expect(toast).toBeVisible();
  await annotator.written();
  await annotator.expectLabel(kBox, { controls: 0, name: "crate" });
  await keep(page, "sequence");
  await expectRight(1);

  await test.step("it is one action", async () => {
    await page.keyboard.press("Control+z");
    await annotator.expectLabel(kBox, { empty: true, name: "crate" });
    await page.keyboard.press("Control+Shift+z");
    await annotator.expectLabel(kBox, { controls: 0, name: "crate" });
    await annotator.written();
  });

  await test.step("a name that is changed later holds in all clouds", async () => {
    await annotator.chooseLabel(kSphere);
    await page.getByLabel("Name of the label").fill("ball");
    await page.keyboard.press("Enter");
    await annotator.written();
    await page.keyboard.press("Shift+PageUp");
    await shows(0);
    await annotator.expectLabel(kSphere, { controls: 1, name: "ball" });
    await page.keyboard.press("Shift+PageDown");
    await shows(1);
  });

  await test.step("nothing of it is lost by a kill", async () => {
    await page.keyboard.press("Shift+N");
    await shows(2);
    await expect(page.locator(".toast").filter({ hasText: "took the labels of scan_1.pcd" })).toBeVisible();
    await program.kill();
    await program.start();
    await annotator.written();
    await expect(carry).toBeDisabled();
    await expectRight(2);
    await page.keyboard.press("Control+s");
    await expect(page.locator(".toast").filter({ hasText: "Saved" })).toContainText("scan_2_labels.pcd");
    for (let i = 0; i < 3; ++i) expect(existsSync(join(desk.folder, `scan_${i}.sacann`))).toBe(true);
    expect(readFileSync(join(desk.folder, "scan_2_labels.names.json"), "utf8")).toContain("crate");
  });
});
