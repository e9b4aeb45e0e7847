// SPDX-License-Identifier: Apache-2.0
// The 3-D view alone, on made clouds: what is in its pixels, and what is picked.
import { expect, test } from "@playwright/test";
import type {} from "../dev/view";
import { open, picture, serve, settled } from "./view_page";

serve();

test("a cloud with labels and control points", async ({ page }) => {
  await open(page, 300_000);
  await picture(page, "both");
  await page.evaluate(() => {
    const { cloud } = window.dev.viewer;
    const next = window.dev.random(3);
    for (let i = 0; i < 40; ++i) {
      const point = Math.floor(next() * 300_000);
      cloud.setControlPoint({ point, label: cloud.labelOf(point), position: cloud.positionOf(point)! });
    }
    cloud.mark(cloud.positionOf(17)!);
  });
  await picture(page, "controls");
  await page.evaluate(() => {
    const { cloud } = window.dev.viewer;
    cloud.setMargins(Uint8Array.from({ length: 300_000 }, (_, point) => 127.5 + 127.5 * Math.sin(6 * cloud.positionOf(point)![0])));
    cloud.highlight(Uint32Array.from({ length: 300_000 }, (_, i) => i).filter((point) => cloud.labelOf(point) === 2));
  });
  await picture(page, "margins");
  await page.evaluate(() => {
    const { viewer } = window.dev;
    viewer.cloud.setMargins(null);
    viewer.cloud.highlight(new Uint32Array());
    viewer.cloud.mark(null);
    viewer.cloud.pointSize = 14;
    viewer.setTheme(false);
    viewer.camera.goTo([0.5, -0.5, 0.34]);
  });
  await settled(page); // it has come there
  await page.mouse.move(640, 400);
  for (let i = 0; i < 7; ++i) await page.mouse.wheel(0, -120);
  await picture(page, "near");
  await page.evaluate(() => {
    const { viewer } = window.dev;
    viewer.cloud.pointSize = 4;
    viewer.camera.fit();
  });
  await picture(page, "light");
  await page.evaluate(() => window.dev.viewer.cloud.show({ cloud: false, labels: true, controls: true }));
  await picture(page, "labels");
});

test("what is picked is what is drawn", async ({ page }) => {
  await open(page, 60_000);
  const result = await page.evaluate(async () => {
    const { viewer, makeCloud, load, random } = window.dev;
    const cloud = makeCloud(60_000, [500, -300, 20]); // far from the origin
    load(viewer, cloud);
    const { positions } = cloud.chunks[0]!;
    const next = random(5);
    let compared = 0;
    let hovered = 0;
    let empty = 0;
    let sure = 0;
    const wrong: string[] = [];
    // As the program has it: lib/saccade/annotate/selection.hpp.
    // The GPU has borders to 1/16 px and depths to 24 bits; `maybe` are the points that may be in front then.
    const expected = (px: number, py: number) => {
      const { size, clip_world: m, point_size_px: edge } = viewer.picture();
      const seen: { point: number; w: number; off: number }[] = [];
      for (let i = 0; i < 60_000; ++i) {
        const [x, y, z] = [positions[3 * i]!, positions[3 * i + 1]!, positions[3 * i + 2]!];
        const w = m[12]! * x + m[13]! * y + (m[14]! * z + m[15]!);
        const u = ((m[0]! * x + m[1]! * y + (m[2]! * z + m[3]!)) / w + 1) * 0.5 * size[0];
        const v = (1 - (m[4]! * x + m[5]! * y + (m[6]! * z + m[7]!)) / w) * 0.5 * size[1];
        const off = Math.max(Math.abs(px + 0.5 - u), Math.abs(py + 0.5 - v)) - 0.5 * edge;
        if (w > 0 && off < 1 / 16) seen.push({ point: i, w, off });
      }
      const nearest = (most: number) =>
        seen.reduce((a, b) => (b.off < most && b.w < a.w ? b : a), { point: -1, w: Infinity, off: 0 });
      const sure = nearest(-1 / 16).w;
      const maybe = seen.filter((a) => a.w <= sure * (1 + 1e-6)).map((a) => a.point);
      if (sure === Infinity) maybe.push(-1);
      return { right: nearest(0), maybe, seen };
    };
    // In the middle of a point's square there is this or another one; elsewhere small squares leave gaps.
    const seenAt = (point: number): [number, number] => {
      const { size, clip_world: m } = viewer.picture();
      const row = (i: number) => [0, 1, 2].reduce((sum, axis) => sum + m[4 * i + axis]! * positions[3 * point + axis]!, m[4 * i + 3]!);
      return [(row(0) / row(3) + 1) * 0.5 * size[0], (1 - row(1) / row(3)) * 0.5 * size[1]];
    };
    for (const [turn, size] of [[0, 4], [1, 1], [2, 9]] as const) {
      viewer.cloud.pointSize = size;
      viewer.camera.fit([Math.sin(turn), -Math.cos(turn), 0.4 + 0.3 * turn]);
      for (const ready of [false, true]) {
        for (const began = performance.now(); ready && viewer.hover(...seenAt(0)) === null; ) {
          if (performance.now() - began > 20_000) throw new Error("the hierarchy of the points is not there after 20 s");
          await new Promise((done) => setTimeout(done, 20));
        }
        for (let i = 0; i < 120; ++i) {
          const [px, py] = [Math.floor(300 + 680 * next()), Math.floor(150 + 500 * next())];
          const { right, maybe, seen } = expected(px, py);
          const picked = viewer.pick(px + 0.5, py + 0.5)?.point ?? -1;
          ++compared;
          if (right.point < 0) ++empty;
          if (maybe.length === 1) ++sure;
          if (!maybe.includes(picked)) wrong.push(`pick ${px} ${py}: ${picked}, not ${right.point}`);
          if (!ready) continue;
          ++hovered;
          const hover = viewer.hover(px + 0.5, py + 0.5)?.point ?? -1;
          const same = seen.some((a) => a.point === hover && a.w === right.w && a.off < 0); // two may be as far
          if (hover !== right.point && !same) wrong.push(`hover ${px} ${py}: ${hover}, not ${right.point}`);
        }
      }
    }
    return { compared, hovered, empty, sure, wrong };
  });
  expect(result.compared).toBe(720);
  expect(result.hovered).toBe(360);
  expect(result.empty).toBeLessThan(600);
  expect(result.sure).toBeGreaterThan(650);
  expect(result.wrong).toEqual([]);
});

test("the pixels of a point's square", async ({ page }) => {
  await open(page, 0);
  const result = await page.evaluate(async () => {
    const { viewer } = window.dev;
    const canvas = viewer.element.querySelector("canvas")!;
    const gl = canvas.getContext("webgl2")!;
    viewer.cloud.begin({ points: 3, shown: 3, bounds: [-1, -1, -1, 1, 1, 1], up: [0, 0, 1], spacing_m: 1 });
    viewer.cloud.append({
      positions: Float32Array.from([0, 0, 0, 0.5, 0, 0, -0.5, 0, 0]),
      points: Uint32Array.from([0, 1, 2]),
      colors: Uint8Array.from([200, 100, 50, 255, 200, 100, 50, 255, 200, 100, 50, 255]),
      labels: Uint32Array.from([7, 0, 9]),
    });
    viewer.cloud.setLabelColor(7, [10, 20, 250]);
    viewer.cloud.setLabelColor(9, [90, 220, 30]);
    viewer.cloud.pointSize = 15;
    viewer.camera.fit([0, -1, 0]);
    /** Colours of the pixels around a point, of how many there are. */
    const seen = async (point: number) => {
      const { pictures } = viewer.stats;
      viewer.redraw();
      while (viewer.stats.pictures === pictures) await new Promise((done) => setTimeout(done, 5));
      const [x, y, z] = viewer.cloud.positionOf(point)!;
      const { clip_world: m, size } = viewer.picture();
      const w = m[12]! * x + m[13]! * y + m[14]! * z + m[15]!;
      const u = Math.floor(((m[0]! * x + m[1]! * y + m[2]! * z + m[3]!) / w + 1) * 0.5 * size[0]);
      const v = Math.floor(((m[4]! * x + m[5]! * y + m[6]! * z + m[7]!) / w + 1) * 0.5 * size[1]);
      const pixels = new Uint8Array(4 * 32 * 32);
      gl.readPixels(u - 16, v - 16, 32, 32, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
      const counts: Record<string, number> = {};
      for (let i = 0; i < pixels.length; i += 4) {
        const color = [...pixels.subarray(i, i + 3)].join(" ");
        counts[color] = (counts[color] ?? 0) + 1;
      }
      return counts;
    };
    const { cloud } = viewer;
    const out: Record<string, Record<string, number>> = {};
    out.both = await seen(0);
    out.none = await seen(1);
    cloud.show({ cloud: true, labels: false, controls: true });
    out.cloud = await seen(0);
    cloud.show({ cloud: false, labels: true, controls: true });
    out.labels = await seen(0);
    out.black = await seen(1);
    cloud.setLabel(9, Uint32Array.from([0]));
    out.changed = await seen(0);
    cloud.setLabelVisible(9, false);
    out.hidden = await seen(0);
    cloud.setLabelVisible(9, true);
    cloud.highlight(Uint32Array.from([2]));
    out.highlighted = await seen(2);
    out.other = await seen(0);
    cloud.highlight(new Uint32Array());
    cloud.setControlPoint({ point: 0, label: 7, position: cloud.positionOf(0)! });
    out.control = await seen(0);
    cloud.show({ cloud: true, labels: true, controls: false });
    cloud.setMargins(Uint8Array.from([0, 255, 255]));
    out.doubt = await seen(0);
    out.sure = await seen(1);
    return out;
  });
  const [own, blue, green, dark] = ["200 100 50", "10 20 250", "90 220 30", "36 39 45"] as const;
  const outside = 32 * 32 - 15 * 15;
  expect(result.both).toEqual({ [own]: 15 * 15 - 7 * 7, [blue]: 7 * 7, [dark]: outside });
  expect(result.none).toEqual({ [own]: 15 * 15, [dark]: outside });
  expect(result.cloud).toEqual({ [own]: 15 * 15, [dark]: outside });
  expect(result.labels).toEqual({ [blue]: 15 * 15, [dark]: outside });
  expect(result.black).toEqual({ "0 0 0": 15 * 15, [dark]: outside });
  expect(result.changed).toEqual({ [green]: 15 * 15, [dark]: outside });
  expect(result.hidden).toEqual({ [dark]: 32 * 32 });
  expect(result.highlighted).toEqual({ "255 214 10": 15 * 15, [dark]: outside });
  expect(result.other).toEqual({ [green]: 15 * 15, [dark]: outside });
  expect(Object.keys(result.control!).length).toBeGreaterThan(10); // a ball has shades
  expect(result.doubt!["255 222 56"]).toBe(15 * 15); // no label's colour in the heat map
  expect(Object.keys(result.sure!).length).toBe(2);
});

test("layers of every kind", async ({ page }) => {
  await open(page, 0);
  const picked = await page.evaluate(() => {
    const { viewer, makeCloud } = window.dev;
    viewer.setBounds([-1, -1, 0, 1, 1, 1.2], [0, 0, 1]);
    const join = (...arrays: (Float32Array | Uint8Array | Uint32Array)[]) => {
      const bytes = new Uint8Array(arrays.reduce((sum, array) => sum + array.byteLength, 0));
      let at = 0;
      for (const array of arrays) {
        bytes.set(new Uint8Array(array.buffer, array.byteOffset, array.byteLength), at);
        at += array.byteLength;
      }
      return bytes.buffer;
    };
    // A ball of triangles, coloured.
    const [n, m] = [48, 24];
    const vertices: number[] = [];
    const colors: number[] = [];
    const faces: number[] = [];
    for (let j = 0; j <= m; ++j) {
      for (let i = 0; i <= n; ++i) {
        const [a, b] = [(2 * Math.PI * i) / n, (Math.PI * j) / m];
        vertices.push(0.3 * Math.sin(b) * Math.cos(a), 0.3 * Math.sin(b) * Math.sin(a), 0.3 + 0.3 * Math.cos(b));
        colors.push(120 + 100 * Math.cos(3 * a), 150, 200 - 6 * j, 255);
        const k = j * (n + 1) + i;
        if (i < n && j < m) faces.push(k, k + n + 1, k + 1, k + 1, k + n + 1, k + n + 2);
      }
    }
    const added: boolean[] = [];
    added.push(
      viewer.layers.add(
        { id: "mesh", kind: "triangles", count: faces.length / 3, vertices: vertices.length / 3, colors: true },
        join(Float32Array.from(vertices), Uint8Array.from(colors), Uint32Array.from(faces)),
      ),
    );
    const cubes: number[] = [];
    const shades: number[] = [];
    for (let i = 0; i < 400; ++i) {
      cubes.push(-0.95 + 0.05 * (i % 20), -0.95 + 0.05 * Math.floor(i / 20), 0.03 * Math.sin(i));
      shades.push(90, 110 + (i % 20) * 5, 140, 255);
    }
    added.push(
      viewer.layers.add(
        { id: "map", kind: "voxels", count: 400, colors: true, size_m: 0.05 },
        join(Float32Array.from(cubes), Uint8Array.from(shades)),
      ),
    );
    const cloud = makeCloud(4000).chunks[0]!;
    const placed = cloud.positions.map((value, i) => 0.3 * value + (i % 3 === 2 ? 0 : 0.6));
    added.push(viewer.layers.add({ id: "cloud", kind: "points", count: 4000, colors: true, size_m: 0.012 }, join(placed, cloud.colors)));
    const rays: number[] = [];
    const poses: number[] = [];
    const gains: number[] = [];
    for (let i = 0; i < 9; ++i) {
      const a = (2 * Math.PI * i) / 9;
      const eye = [0.9 * Math.cos(a), 0.9 * Math.sin(a), 0.9] as const;
      rays.push(...eye, 0, 0, 0.55);
      const length = Math.hypot(eye[0], eye[1], eye[2] - 0.3);
      const z = [-eye[0] / length, -eye[1] / length, (0.3 - eye[2]) / length] as const;
      const x = [-Math.sin(a), Math.cos(a), 0] as const;
      const y = [z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0]] as const;
      poses.push(x[0], y[0], z[0], eye[0], x[1], y[1], z[1], eye[1], x[2], y[2], z[2], eye[2], 0, 0, 0, 1);
      gains.push(i === 8 ? NaN : i);
    }
    added.push(viewer.layers.add({ id: "rays", kind: "lines", count: 9, color: "#5a6270" }, Float32Array.from(rays).buffer));
    added.push(
      viewer.layers.add({ id: "views", kind: "views", count: 9, fov_rad: [1.0, 0.75] }, Float32Array.from([...poses, ...gains]).buffer),
    );
    added.push(viewer.layers.add({ id: "unknown", kind: "voxels", count: 1, size_m: 0.4, color: "#8070ff", opacity: 0.35 }, Float32Array.from([0.6, -0.6, 0.2]).buffer));
    added.push(viewer.layers.add({ id: "short", kind: "lines", count: 10 }, Float32Array.from(rays).buffer));
    viewer.camera.fit();
    viewer.layers.select("views", 6);
    viewer.setFrame({ poseRows: [[1, 0, 0, 0.6], [0, 0, 1, -1.3], [0, -1, 0, 0.2], [0, 0, 0, 1]], fov_rad: [0.9, 0.7] });
    // Every tip is found where it is seen.
    const { clip_world: c, size } = viewer.picture();
    const found = gains.map((_, i) => {
      const [x, y, z] = [poses[16 * i + 3]!, poses[16 * i + 7]!, poses[16 * i + 11]!];
      const w = c[12]! * x + c[13]! * y + c[14]! * z + c[15]!;
      const u = ((c[0]! * x + c[1]! * y + c[2]! * z + c[3]!) / w + 1) * 0.5 * size[0];
      const v = (1 - (c[4]! * x + c[5]! * y + c[6]! * z + c[7]!) / w) * 0.5 * size[1];
      return viewer.layers.pickView(u, v)?.item;
    });
    return { added, ids: viewer.layers.ids(), found, nothing: viewer.layers.pickView(5, 5) };
  });
  await picture(page, "layers");
  // The wheel comes to what is under the cursor: the ball.
  const ball = await page.evaluate(() => {
    const { clip_world: m } = window.dev.viewer.picture();
    const row = (i: number) => 0.4 * m[4 * i + 2]! + m[4 * i + 3]!;
    return [640 * (1 + row(0) / row(3)), 400 * (1 - row(1) / row(3))] as const;
  });
  await page.mouse.move(...ball);
  for (let i = 0; i < 30; ++i) await page.mouse.wheel(0, -120);
  await settled(page);
  const eye = await page.evaluate(() => window.dev.viewer.camera.poseRows().map((row) => row[3]!));
  const away = Math.hypot(eye[0]!, eye[1]!, eye[2]! - 0.3);
  expect(away).toBeGreaterThan(0.27); // a slow page looks for the point under the cursor again between two turns
  expect(away).toBeLessThan(0.33);
  expect(picked.added).toEqual([true, true, true, true, true, true, false]);
  expect(picked.ids).toEqual(["mesh", "map", "cloud", "rays", "views", "unknown"]);
  expect(picked.found).toEqual([0, 1, 2, 3, 4, 5, 6, 7, 8]);
  expect(picked.nothing).toBeNull();
});
