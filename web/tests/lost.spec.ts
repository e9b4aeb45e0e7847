// SPDX-License-Identifier: Apache-2.0
// Nothing is lost, and nothing is done twice: the page is loaded again, the program is killed and comes back.
import { unlinkSync } from "node:fs";
import { join } from "node:path";
import { kBox, kCylinder, kFlatBox, kSphere, kTable, kTops, makeTable } from "./support/clouds";
import { expect, keep, test } from "./support/desk";
import { iou, labelsOfPcd } from "./support/pcd";
import { runProgram } from "./support/program";

test("the page loaded again, the program killed and back", async ({ desk }) => {
  const cloud = makeTable(join(desk.folder, "table.pcd"));
  const program = await desk.start("annotate", cloud.file);
  const annotator = await desk.open(program, cloud);
  const { page } = annotator;
  await annotator.labelTops([kTable, kBox]); // two actions
  await annotator.page.getByLabel("Name of the label").fill("Tea box");
  await page.keyboard.press("Enter"); // a third
  await annotator.expectLabel(kBox, { name: "Tea box" });
  await annotator.written();
  const before = labelsOfPcd(await annotator.export("PCD"));

  await test.step("loaded again, all is as it was, and undo is still one's own", async () => {
    await page.reload();
    await annotator.ready();
    await annotator.expectLabel(kTable, { controls: 1 });
    await annotator.expectLabel(kBox, { name: "Tea box", controls: 1 });
    expect(labelsOfPcd(await annotator.export("PCD"))).toEqual(before);
    await page.keyboard.press("Control+z"); // the name; a fourth action
    await expect(annotator.label(kBox)).toHaveAccessibleName(/^Label 2: 1 control point/);
    await page.keyboard.press("Control+Shift+z"); // a fifth
    await annotator.expectLabel(kBox, { name: "Tea box" });
    await annotator.written();
  });

  await annotator.look("above");
  await annotator.choose("Action", "Set");

  await test.step("what is clicked while the program is down is done once, when it is back", async () => {
    await annotator.chooseLabel(kCylinder);
    await program.kill();
    await expect(annotator.status).toHaveText(/^Reconnecting/);
    await annotator.click(kTops[kCylinder]!); // a sixth
    await expect(annotator.status).toHaveText("Reconnecting … · 1 to write");
    await page.getByLabel("Colour of the label").fill("#2fae74"); // a seventh
    await page.getByLabel("Name of the label").fill("Tin");
    await page.keyboard.press("Enter"); // an eighth, which is not to take the colour back
    await expect(annotator.status).toHaveText("Reconnecting … · 3 to write");
    await keep(page, "annotate-reconnecting");
    await program.start();
    await annotator.written();
    await annotator.expectLabel(kCylinder, { name: "Tin", controls: 1 });
    expect(await annotator.colorOf(kCylinder)).toEqual([0x2f, 0xae, 0x74]);
    await annotator.expectLabel(kBox, { name: "Tea box", controls: 1 });
  });

  await test.step("what is under way when the program is killed is done once", async () => {
    for (const object of [kSphere, kFlatBox]) {
      await annotator.chooseLabel(object);
      await Promise.all([annotator.click(kTops[object]!), program.kill()]); // a ninth and a tenth
      await program.start();
      await annotator.written();
      await annotator.expectLabel(object, { controls: 1 });
    }
  });

  await test.step("undo takes back one action at a time", async () => {
    await page.keyboard.press("Control+z");
    await annotator.expectLabel(kFlatBox, { empty: true });
    await annotator.expectLabel(kSphere, { controls: 1 });
    await page.keyboard.press("Control+Shift+z");
    await annotator.expectLabel(kFlatBox, { controls: 1 });
    await annotator.written();
  });

  await test.step("on the disk is what the page showed", async () => {
    const labels = labelsOfPcd(await annotator.export("PCD"));
    for (const object of [kTable, kBox, kCylinder, kSphere, kFlatBox]) {
      expect(iou(labels, object, cloud.truth, object), `label ${object}`).toBeGreaterThan(0.9);
    }
    await program.kill();
    // Ten, an undo and a redo.
    expect(actionsIn(cloud.file, join(desk.folder, "table.sacann"))).toMatchObject({ actions: 12, control_points: 5 });
  });
});

for (const lost of ["question", "answer"] as const) {
  test(`an action whose ${lost} is lost is done once`, async ({ desk, context }) => {
    const cloud = makeTable(join(desk.folder, "table.pcd"), { spacing_m: 0.01 });
    const program = await desk.start("annotate", cloud.file);
    let losing = false;
    let losses = 0;
    await context.routeWebSocket(/\/socket$/, (page) => {
      const program = page.connectToServer();
      const pass = (message: string | Buffer, on: (message: string | Buffer) => void, isTheOne: (head: Record<string, unknown>) => boolean) => {
        if (!losing || !isTheOne(headOf(message))) return on(message);
        losing = false;
        ++losses;
        void page.close();
        void program.close();
      };
      page.onMessage((message) => pass(message, (one) => program.send(one), (head) => lost === "question" && head["type"] === "action"));
      program.onMessage((message) => pass(message, (one) => page.send(one), (head) => lost === "answer" && "done" in head && "request" in head));
    });
    const annotator = await desk.open(program, cloud);
    await annotator.labelTops([kTable]);
    for (const object of [kBox, kCylinder]) {
      losing = true;
      await annotator.chooseLabel(object);
      await annotator.click(kTops[object]!);
      await expect.poll(() => losing).toBe(false);
      await annotator.written();
      await annotator.expectLabel(object, { controls: 1 });
    }
    expect(losses).toBe(2);
    await annotator.page.close();
    await program.kill();
    expect(actionsIn(cloud.file, join(desk.folder, "table.sacann"))).toMatchObject({ actions: 3, control_points: 3 });
  });
}

/** Returns the head of a message of the WebSocket (docs/reference/protocol.md). */
function headOf(message: string | Buffer): Record<string, unknown> {
  const bytes = Buffer.from(message);
  return JSON.parse(bytes.toString("utf8", 4, 4 + bytes.readUInt32LE(0))) as Record<string, unknown>;
}

/** Counts the actions and control points that the program finds in a session. */
function actionsIn(cloud: string, session: string): { actions: number; control_points: number } {
  const text = runProgram(["--json", "-", "annotate", cloud, "--session", session]);
  return (JSON.parse(text) as { result: { actions: number; control_points: number } }).result;
}

test("a page that the program does not know any more says so", async ({ desk }) => {
  const cloud = makeTable(join(desk.folder, "table.pcd"), { spacing_m: 0.02 });
  const program = await desk.start("annotate", cloud.file);
  const annotator = await desk.open(program, cloud);
  await program.stop();
  desk.expects(/status of 403/);
  unlinkSync(join(desk.folder, "token-0"));
  await program.start(); // the same place, another token
  await expect(annotator.status).toHaveText("Closed", { timeout: 30_000 });
});
