// SPDX-License-Identifier: Apache-2.0
// Areas on the screen, on, slightly below and through the surface: what is labelled is what lies in them.
import { join } from "node:path";
import type { Annotator } from "./support/annotator";
import { kBox, kCylinder, kSphere, kTops, type MadeCloud, makeTable, positionOf } from "./support/clouds";
import { expect, keep, test } from "./support/desk";
import { countOf, labelsOfPcd } from "./support/pcd";

type ScreenPlace = readonly [number, number];

/** Points whose labels are not what the area says; those nearer to its border than a pixel may be either. */
function mistakes(annotator: Annotator, labels: Uint32Array, label: number, inside_px: (at: ScreenPlace, point: number) => number): number {
  let wrong = 0;
  for (let point = 0; point < labels.length; ++point) {
    const by_px = inside_px(annotator.exactly(positionOf(annotator.cloud, point)), point);
    if ((by_px > 1 && labels[point] !== label) || (by_px < -1 && labels[point] === label)) ++wrong;
  }
  expect(labels.length, "points compared").toBe(annotator.cloud.truth.length);
  expect(countOf(labels, label), "points with the label").toBeGreaterThan(50);
  return wrong;
}

/** How far inside of a rectangle; negative: outside. */
function insideOf([x0, y0]: ScreenPlace, [x1, y1]: ScreenPlace): (at: ScreenPlace) => number {
  return ([x, y]) => Math.min(x - Math.min(x0, x1), Math.max(x0, x1) - x, y - Math.min(y0, y1), Math.max(y0, y1) - y);
}

function distanceToLine([x, y]: ScreenPlace, [ax, ay]: ScreenPlace, [bx, by]: ScreenPlace): number {
  const [dx, dy] = [bx - ax, by - ay];
  const t = Math.max(0, Math.min(1, ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy)));
  return Math.hypot(x - ax - t * dx, y - ay - t * dy);
}

async function paintedIn(annotator: Annotator, label: number): Promise<Uint32Array> {
  await expect(annotator.label(label)).toHaveAccessibleName(/ points$/);
  await annotator.written();
  return labelsOfPcd(await annotator.export("PCD"));
}

test("rectangles: surface, slightly below, deep", async ({ desk }) => {
  const cloud = makeTable(join(desk.folder, "table.pcd"));
  const annotator = await desk.open(await desk.start("annotate", cloud.file), cloud);
  await annotator.look("front");
  await annotator.setSlider("Point size", 8); // no gaps to look through
  // The face of the box that is turned to the viewer is 0.16 m before its back.
  const corners = [annotator.at([-0.42, -0.18, 0.05]), annotator.at([-0.28, -0.18, 0.15])] as const;
  const onFace = (point: number) => Math.abs(positionOf(cloud, point)[1] + 0.18) < 0.004;
  const inside = insideOf(...corners);
  await annotator.choose("Tool", "Rectangle");
  await expect(annotator.radio("Action", "Set")).toHaveAttribute("aria-checked", "true");

  let label = 0;
  const paint = async (depth: string, below_mm?: number) => {
    await annotator.chooseLabel(++label);
    await annotator.choose("Depth", depth);
    if (below_mm !== undefined) await annotator.setSlider("Down to", below_mm);
    await annotator.dragRectangle(...corners);
    const labels = await paintedIn(annotator, label);
    await annotator.page.keyboard.press("Control+z");
    await annotator.expectLabel(label, { empty: true });
    return labels;
  };
  const deep = await paint("Deep rectangle");
  expect(mistakes(annotator, deep, 1, inside)).toBe(0);
  expect(countOf(deep, 1)).toBe(countInside(annotator, cloud, inside, () => true));

  // On the surface: the whole face, also points whose middle another one's square covers, and nothing of the back.
  const surface = await paint("Surface rectangle");
  expect(mistakes(annotator, surface, 2, (at, point) => (onFace(point) ? inside(at) : -Infinity))).toBe(0);

  const slightly = await paint("Slightly below rectangle", 20);
  expect(mistakes(annotator, slightly, 3, (at, point) => (onFace(point) ? inside(at) : -Infinity))).toBe(0);
  const further = await paint("Slightly below rectangle", 200);
  expect(mistakes(annotator, further, 4, inside)).toBe(0);
});

function countInside(annotator: Annotator, cloud: MadeCloud, inside: (at: ScreenPlace) => number, of: (point: number) => boolean): number {
  let count = 0;
  for (let point = 0; point < cloud.truth.length; ++point) {
    if (of(point) && inside(annotator.exactly(positionOf(cloud, point))) > 0) ++count;
  }
  return count;
}

test("lasso, polyline, brush, and their removal", async ({ desk }) => {
  const cloud = makeTable(join(desk.folder, "table.pcd"));
  const annotator = await desk.open(await desk.start("annotate", cloud.file), cloud);
  const { page } = annotator;
  await annotator.look("above");
  await annotator.choose("Action", "Set");

  await test.step("lasso around the sphere", async () => {
    await annotator.choose("Tool", "Lasso");
    await annotator.choose("Depth", "Deep lasso");
    await annotator.chooseLabel(kSphere);
    const [x, y] = annotator.at([0.35, -0.15, 0.11]);
    const circle = Array.from({ length: 25 }, (_, i): ScreenPlace => {
      const angle = (2 * Math.PI * i) / 24;
      return [x + 80 * Math.cos(angle), y + 80 * Math.sin(angle)];
    });
    await annotator.drag(circle);
    const labels = await paintedIn(annotator, kSphere);
    // A lasso has corners: what is sure is a little inside and outside of the circle.
    expect(mistakes(annotator, labels, kSphere, ([u, v]) => {
      const inside = 80 - Math.hypot(u - x, v - y);
      return Math.abs(inside) < 4 ? 0 : inside;
    })).toBe(0);
  });

  await test.step("polyline around the cylinder, with a corner taken back", async () => {
    await annotator.choose("Tool", "Polyline");
    await annotator.choose("Depth", "Deep polyline");
    await annotator.chooseLabel(kCylinder);
    const [x, y] = annotator.at([0.0, 0.2, 0.12]);
    const [a, b]: [ScreenPlace, ScreenPlace] = [[x - 90, y - 90], [x + 90, y + 90]];
    await page.mouse.click(...a);
    await page.mouse.click(x + 300, y + 300);
    await page.keyboard.press("Backspace");
    await annotator.clickCorners([[b[0], a[1]], b, [a[0], b[1]]]);
    const labels = await paintedIn(annotator, kCylinder);
    expect(mistakes(annotator, labels, kCylinder, insideOf(a, b))).toBe(0);
    await keep(page, "areas");
  });

  await test.step("a stroke of the brush on the table", async () => {
    await annotator.choose("Tool", "Brush");
    await annotator.chooseLabel(7);
    await annotator.choose("Depth", "Deep brush");
    await annotator.setSlider("Radius", 15);
    const line: [ScreenPlace, ScreenPlace] = [annotator.at([-0.5, -0.3, 0]), annotator.at([-0.1, -0.4, 0])];
    await annotator.drag([line[0], line[1]]);
    const labels = await paintedIn(annotator, 7);
    expect(mistakes(annotator, labels, 7, (at) => 15 - distanceToLine(at, ...line))).toBe(0);
  });

  await test.step("a ball drawn over the box, with what is hidden in it", async () => {
    await annotator.choose("Unit of the radius", "mm");
    await annotator.chooseLabel(kBox);
    await annotator.setSlider("Radius", 40);
    await page.mouse.click(...annotator.at(kTops[kBox]!));
    const labels = await paintedIn(annotator, kBox);
    const distance_m = (point: number) => Math.hypot(...positionOf(cloud, point).map((c, i) => c - kTops[kBox]![i]!));
    const wrong = cloud.truth.filter((_, point) => Math.abs(distance_m(point) - 0.04) > 0.004 && (labels[point] === kBox) !== distance_m(point) < 0.04);
    expect(wrong.length).toBe(0);
    expect(countOf(labels, kBox)).toBeGreaterThan(100);
  });

  await test.step("paint comes off in a rectangle", async () => {
    await annotator.choose("Action", "Delete");
    await annotator.choose("Tool", "Rectangle");
    await annotator.choose("What is taken away", "Paint");
    await annotator.choose("Depth", "Deep rectangle");
    const [x, y] = annotator.at([0.35, -0.15, 0.11]);
    await annotator.dragRectangle([x - 100, y - 100], [x + 100, y + 100]);
    await annotator.expectLabel(kSphere, { empty: true });
    await annotator.expectLabel(kCylinder, {});
    await page.keyboard.press("Control+z");
    await annotator.expectLabel(kSphere, {});
    await expect.poll(() => annotator.pointsOf(kSphere)).toBeGreaterThan(1000);
  });
});
