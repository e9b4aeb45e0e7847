// SPDX-License-Identifier: Apache-2.0
// Reports on disk: the built page with a record in it, as the program writes it, beside pictures; and records to fill it with.
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { crc32, deflateSync } from "node:zlib";

const dist = fileURLToPath(new URL("../../dist/", import.meta.url));
const axe = readFileSync(fileURLToPath(new URL("../../node_modules/axe-core/axe.min.js", import.meta.url)), "utf8");

export const partsOfPage = { html: `${dist}report.html`, css: `${dist}assets/report.css`, js: `${dist}assets/report.js` };

export interface Record {
  command: string;
  result: { [key: string]: unknown };
}

/** A PNG of one colour. */
export function png(width: number, height: number, color: readonly [number, number, number]): Buffer {
  const row = Buffer.concat([Buffer.from([0]), Buffer.from(Array.from({ length: width }, () => color).flat())]);
  const chunk = (type: string, data: Buffer) => {
    const body = Buffer.concat([Buffer.from(type, "latin1"), data]);
    const ends = Buffer.alloc(8);
    ends.writeUInt32BE(data.length, 0);
    ends.writeUInt32BE(crc32(body), 4);
    return Buffer.concat([ends.subarray(0, 4), body, ends.subarray(4)]);
  };
  const head = Buffer.alloc(13);
  head.writeUInt32BE(width, 0);
  head.writeUInt32BE(height, 4);
  head.set([8, 2, 0, 0, 0], 8);
  const pixels = deflateSync(Buffer.concat(Array.from({ length: height }, () => row)));
  return Buffer.concat([Buffer.from([137, 80, 78, 71, 13, 10, 26, 10]), chunk("IHDR", head), chunk("IDAT", pixels), chunk("IEND", Buffer.alloc(0))]);
}

/** Writes the page and its pictures into a folder. @return the page's address */
export function writeReport(folder: string, record: Record, pictures: readonly string[] = [], details: unknown = null): string {
  for (const [i, name] of pictures.entries()) {
    mkdirSync(dirname(join(folder, name)), { recursive: true });
    if (/\.(png)$/.test(name)) writeFileSync(join(folder, name), png(480, 360, [60 + ((i * 37) % 180), 120, 160]));
    else writeFileSync(join(folder, name), "x");
  }
  const document = { schema: "saccade-report/1", record: { schema: "saccade-result/1", version: "0.1.0", seed: 1, threads: 2, ...record }, files: [...pictures].sort(), details };
  const data = JSON.stringify(document).replaceAll("<", "\\u003c");
  const page = readFileSync(partsOfPage.html, "utf8")
    .replace(/<link rel="stylesheet"[^>]*>/, () => `<style>${readFileSync(partsOfPage.css, "utf8")}</style>`)
    .replace('id="record">', () => `id="record">${data}`)
    .replace('<script src="assets/report.js"></script>', () => `<script>${readFileSync(partsOfPage.js, "utf8")}</script>`);
  mkdirSync(folder, { recursive: true });
  writeFileSync(join(folder, "report.html"), page);
  return pathToFileURL(join(folder, "report.html")).href;
}

/** Returns the faults that axe-core finds, one line each. */
export async function faults(page: import("@playwright/test").Page): Promise<string[]> {
  if (!(await page.evaluate(() => "axe" in globalThis))) await page.evaluate(axe);
  return page.evaluate(async () => {
    type Found = { violations: { id: string; nodes: { html: string }[] }[] };
    const { violations } = await (globalThis as unknown as { axe: { run(): Promise<Found> } }).axe.run();
    return violations.flatMap(({ id, nodes }) => nodes.map(({ html }) => `${id}: ${html.slice(0, 160)}`));
  });
}

const phases = ["planner_map", "candidates", "segmentation", "saliency", "reachability", "evaluation", "planning", "motion", "fusion"];

function view(i: number, of: number): { [key: string]: unknown } {
  const left = 1 - (i + 1) / (of + 1);
  return {
    index: i,
    region: i % 2,
    gain: 900 * left + 40.5,
    gain_observed: (900 * left + 40.5) * (0.4 + (0.6 * (i + 1)) / of),
    candidates: 3840,
    evaluated: 2000 + i,
    refused: { no_ik: 700, goal_in_collision: 12 },
    frames: 5,
    frames_on_way: 0,
    tracking: null,
    tilt_rad: [-0.0872, 0.0872],
    T_world_camera: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]],
    unknown_left: Math.round(90_000 + 500_000 * left),
    unknown_near_objects: Math.round(1000 + 9000 * left),
    points_at_object: i % 3 !== 0,
    looks_at_object: true,
    coverage: 0.98 - 0.6 * left,
    q: [0, 0.1, 0.2, 0.3, 0.4, 0.5],
    motion_s: 1.8,
    retreat_s: i === 1 ? 0.4 : 0,
    path_m: 2.1,
    attention: { segments: 40, contours: 600, segment: 11, rank: 0, saliency: 0.52, why: "round and apart", contours_of_segment: 24 },
    ms: Object.fromEntries(phases.map((phase, k) => [phase, 3 * (k + 1) * (1 + left)])),
  };
}

const camera = { width: 640, height: 480, fx: 525, fy: 525, cx: 319.5, cy: 239.5, min_range_m: 0.5, max_range_m: 2 };

export function exploration(views: number, scene = "tabletop-1"): { record: Record; pictures: string[] } {
  const all = Array.from({ length: views }, (_, i) => view(i, views));
  const pictures = ["view-00-map.png", "mesh.ply", "map.sacmap", "run.json"];
  for (let i = 1; i <= views; ++i) for (const kind of ["choice", "seen", "map"]) pictures.push(`view-${String(i).padStart(2, "0")}-${kind}.png`);
  const final = { coverage: 0.98, unknown_left: 93_954, unknown_near_objects: 1260, accuracy_m: 0.00088, chamfer_m: 0.00106, f_score: 0.985 };
  const result = {
    scene,
    robot: "comau",
    strategy: "surface",
    gain_unit: "cm²",
    min_gain: 14,
    noise: true,
    sensor: "kinect-v1",
    camera,
    voxel_size_m: 0.0058,
    dry_run: false,
    interrupted: false,
    initial: { coverage: 0.35, unknown_left: 619_603, views: 1, attempted: 2, refused: { outside_limits: 1 } },
    views: all,
    final,
    refused_at_end: {},
    gain_left: 9.5,
    gain_needed: 14,
    stopped_because: "regions_done",
  };
  return { record: { command: "explore", result }, pictures };
}

const regions = [
  { center_m: [-0.35, 0.09, 0.22], radius_m: 0.2, saliency: 3.48, why: "the hand slowed from 1.09 to 0.03 m/s and left with 1.65 m/s", end: "done", views: 2, gain_left: 3, refused: {}, unknown: [171_770, 801, 605, 603], coverage: { objects: 1, surfaces: 1 } },
  { center_m: [0.35, -0.03, 0.2], radius_m: 0.2, saliency: 3.73, why: "the hand <stopped>", end: "out_of_reach", views: 1, gain_left: 72, refused: { no_path: 2 }, unknown: [171_697, 28_615, 28_615, 7646], coverage: { objects: 0.99, surfaces: 0.97 } },
];
const task = { regions, views: [0, 1, 2].map((i) => view(i, 3)), unknown_after_task: 521_809, stopped_because: "views_used_up" };
const speed = { speed: { time_s: [0, 0.1, 0.2, 0.3], speed_m_s: [0.1, 1.2, 0.05, 0.9] } };

export function update(): { record: Record; pictures: string[]; details: unknown } {
  const objects = [{ name: "jug", true: { height_m: 0.19, major_m: 0.17, minor_m: 0.128 }, measured: { height_m: 0.189, major_m: 0.168, minor_m: 0.127 }, error: {} }];
  const about = { trajectory: "simulated", method: "ours", samples: { total: 409 }, actions: [{}, {}] };
  const result = { scene: "jug", before: "jug-before", robot: "comau", fuse_when: "viewpoints", camera, voxel_size_m: 0.0058, task: about, objects, back: { at_stand_by: true }, contacts: { instants: 795, touching: 0 }, phases_s: { forgetting: 0.0004 }, ...task };
  return { record: { command: "update", result }, pictures: ["before.png", "after.png", "hand.png", "regions.png", "view-01-map.png", "view-02-map.png", "update.json"], details: speed };
}

export function cell(): { record: Record; pictures: string[] } {
  const about = { samples: { total: 100 }, duration_s: 12.5, method: "ours", actions: [{}, {}], back: { at_stand_by: true } };
  const tasks = [{ ...about, ...task }, { ...about, ...task, problem: "the camera's program ended", views: [] }];
  return { record: { command: "update", result: { cell: "my cell", robot: "comau", fuse_when: "motion", tasks } }, pictures: ["map.png", "task-1/hand.png", "task-1/view-01-map.png", "update.json"] };
}

const estimate = (mean: number, half: number, n = 3) => ({ n, mean, low: mean - half, high: mean + half });
const difference = (mean: number, half: number, n = 3) => ({ ...estimate(mean, half, n), excludes_0: Math.abs(mean) > half });

export function comparison(): { record: Record; details: unknown } {
  const scenes = ["clutter:5", "clutter:6"];
  const measures = [
    { name: "coverage", text: "coverage at the end", unit: "%", scale: 100, decimals: 1 },
    { name: "coverage_area", text: "area under coverage over views", unit: "%", scale: 100, decimals: 1 },
    { name: "views", text: "views taken", unit: "", scale: 1, decimals: 1 },
  ];
  const group = (scene: string | null, strategy: string, area: number) => ({
    scene, strategy, noise: "kinect-v1", runs: 3, stopped_because: { views_used_up: 3 }, promises: { views: 12, median_kept: 0.97, rank_correlation: 0.94, broken: 1 },
    coverage: estimate(0.97, 0.01), coverage_area: estimate(area, 0.02), views: estimate(4, 0), evaluation_ms: estimate(5000, 100), fusion_ms: estimate(3000, 50), points_at_object: [estimate(1, 0), estimate(0.67, 0.3)],
  });
  const gap = (scene: string | null, half: number) => ({ scene, noise: "kinect-v1", a: "surface", b: "random", coverage: estimate(0.05, half), coverage_area: estimate(0.06, 0.05), views: estimate(0, 0) });
  const curve = (scene: string | null) => {
    const of = (name: string, scale: number) => ({ name, x: [0, 1, 2, 3], y: [35, 70, 85, 97].map((y) => y * scale), low: [34, 66, 80, 95].map((y) => y * scale), high: [36, 74, 90, 99].map((y) => y * scale) });
    return { scene, coverage: [of("surface", 1), of("random", 0.9)], unknown: [of("surface", 20), of("random", 25)] };
  };
  const slice = (index: number, state: string, done: number) => ({ slice: index, of: 2, state, planned: 6, done, tries: 1 + index, machine: "node1", job: `12_${index}`, began: "2024-06-30T12:00:00Z", ended: "2024-06-30T12:10:00Z", error: "" });
  const all = [null, ...scenes];
  const result = { summaries: all.flatMap((scene) => [group(scene, "surface", 0.8), group(scene, "random", 0.74)]), gaps: [], robot: "free", max_views: 4, seeds: [1, 2, 3], runs: { planned: 12, done: 12 }, slices: [slice(0, "done", 6), { ...slice(1, "failed", 4), error: "clutter:6: no surface of an object can be seen" }] };
  const marks = scenes.flatMap((scene) => [1, 2].map((seed) => ({ scene, label: "surface", seed, marks: [true, false, true] })));
  return { record: { command: "compare", result }, details: { measures, gaps: all.map((scene, i) => gap(scene, i === 0 ? 0.09 : 0.03)), curves: all.map(curve), marks, facts: [{ name: "voxel size", value: "5.80 mm" }] } };
}

export function tables(): { record: Record; pictures: string[] } {
  const result = { tables: [{ table: "4.4", caption: "Table 4.4: parameters & options", columns: ["parameter", "thesis", "ours"], cells: [["R_seed", "0.08", "0.08"], ["T_ff", "1.40", "0.70"]], rows: [{ name: "R_seed" }], notes: ["Figures are medians."], drawings: ["table-4-4.png"], complete: true }] };
  return { record: { command: "reproduce", result }, pictures: ["table-4-4.png", "of-another-run.png"] };
}

export function segments(): { record: Record; pictures: string[] } {
  const list = [1, 2, 3].map((id) => ({ id, points: 1000 * id, saliency: 0.3 * id, why: "round", roundness: 0.7, isolation: 0.2, sizes_m: [0.1, 0.1, 0.2] }));
  const points = [0.5, 1, 1.5].map((threshold) => ({ threshold, segments: 9, boundary_precision: 0.8, boundary_recall: threshold / 2, boundary_f: 0.7, bce: 0.3 }));
  return { record: { command: "segment", result: { input: "/data/table.pcd", method: "lccp", rows: 6000, points: 5990, supervoxels: 210, found: 3, segments: list, curve: { points } } }, pictures: ["segments.ply", "segments.png"] };
}

export function filtered(): { record: Record; pictures: string[] } {
  const details = [1, 2].map((i) => ({ frame: `frame-${i}.png`, points: 200_000, shadow: 900 * i, veil: 400, out_of_range: 3, ms: 7.5 }));
  return { record: { command: "filter", result: { out: "filtered", method: "full", frames: 2, points: 400_000, shadow: 2700, veil: 800, ms_per_frame: { median: 7.5 }, details } }, pictures: ["frame-1.png", "pictures/frame-1.png", "pictures/frame-2.png"] };
}

/** A benchmark: a comparison with a table of ours and published figures. */
export function benchmark(): { record: Record; details: unknown } {
  const { record, details } = comparison();
  record.command = "benchmark";
  delete record.result["slices"];
  record.result["benchmark"] = {
    name: "one-shot",
    version: 1,
    text: "an object on a table, 32 views over it",
    measure: "coverage: share of the voxels of 6.25 mm with surface in which a point was measured",
    objects: ["figure", "hare"],
    scenes: ["figure@4", "figure@12", "hare@4", "hare@12"],
    objects_from: "stand-ins",
    runs: { planned: 8, done: 8, each_strategy: 4 },
    complete: true,
    table: [
      { method: "surface", views: 12, published: false, views_taken: estimate(11.5, 0.5, 2), of_visible: estimate(0.99, 0.01, 2), of_all: estimate(0.972, 0.01, 2) },
      { method: "volumetric information gain", views: 20, published: true, coverage: 0.921, year: null, source: "survey that compares six planners in ROS and Gazebo (ProQuest 3214124105); its abstract alone could be read", object: "mean over the survey's objects; 1 % less than MA-SCVP, read as a point", differs: "objects, sensor, view space and threshold of the survey are unknown to us; planners choose their number of views there, and it is fixed here" },
      { method: "MA-SCVP", views: 12.2, published: true, coverage: 0.931, year: null, source: "a survey", object: "mean over its objects", differs: "other objects" },
    ],
    differences: [
      { method: "surface", beside: "random", views: 12, objects: 2, of_visible: difference(0.071, 0.042, 2), of_all: difference(0.068, 0.09, 2) },
      { method: "surface", beside: "unobserved-voxel", views: 12, objects: 2, of_visible: difference(-0.002, 0.011, 2), of_all: difference(0, 0, 2) },
    ],
    beside_published: [
      "surface after 10 views: 80.1 % of all; SCVP 80.8 % after 10: short of it by 0.7 points of all (other objects)",
      "surface after 12 views (11.5 taken): 97.2 % of all; MA-SCVP 93.1 % after 12.2: not below it (other objects)",
    ],
    not_published: "",
  };
  return { record, details };
}

/** A benchmark on an arm, whose figures are not shares alone. */
export function armBenchmark(): { record: Record; details: unknown } {
  const { record, details } = benchmark();
  const table = [{ method: "surface", views: 5, published: false, of_visible: estimate(0.97, 0.011), path_m: estimate(7.13, 0.34), motion_s: estimate(8.5, 0.2) }];
  const differences = [{ method: "surface", beside: "random", views: 5, objects: 1, of_visible: { n: 1, mean: 0.03, low: null, high: null, excludes_0: null } }];
  record.result["benchmark"] = { ...(record.result["benchmark"] as object), name: "tabletop-arm", objects_from: "published", table, differences, beside_published: [], not_published: "none is known" };
  return { record, details };
}

/** A comparison with the given number of strategies, whose names are long. */
export function manyStrategies(strategies: number): { record: Record; details: unknown } {
  const { record, details } = comparison();
  const one = (record.result["summaries"] as { scene: string | null }[])[0]!;
  record.result["summaries"] = [null, "clutter:5", "clutter:6"].flatMap((scene) => Array.from({ length: strategies }, (_, i) => ({ ...one, scene, strategy: `rear-side-entropy-${i}` })));
  return { record, details };
}
