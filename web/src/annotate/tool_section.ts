// SPDX-License-Identifier: Apache-2.0
// Section of the sidebar for the tool: action of a click, choice of the tool and its options. Thesis Fig. 4.17.
import { checkbox, section, segmented, slider } from "../ui/controls";
import { h } from "../ui/dom";
import { type Action, type Depth, type Removal, type State, type Store, type Tool } from "./store";

export const kMaxBelow_mm = 200;
export const kMaxBrush = 150;

/** Steps of the sliders of the reach; the cost grows with the cube, as most paths are far below Ω_max. */
const kReachSteps = 100;

export function costOfReach(position: number, maxPath: number): number {
  const share = 1 - position / kReachSteps;
  return Math.min(share ** 3, 0.999) * maxPath;
}

export function reachOfCost(cost: number, maxPath: number): number {
  return Math.round(kReachSteps * (1 - Math.cbrt(Math.min(1, cost / maxPath))));
}

export function reachText(cost: number, maxPath: number): string {
  return cost === 0 ? "full" : `${reachOfCost(cost, maxPath)} %`;
}

export function reachSlider(title: string, input: (position: number) => void, change: (position: number) => void) {
  return slider("Reach", { min: 0, max: kReachSteps, title }, input, change);
}

export function actionSection(store: Store): HTMLElement {
  const actions = segmented<Action>(
    "Action",
    [
      { value: "none", text: "Navigate", title: "The left button moves the view (N, Esc)", icon: "none" },
      {
        value: "set",
        text: "Set",
        title: "Sets control points, or paints areas, with the current label (C)",
        icon: "set",
      },
      { value: "remove", text: "Delete", title: "Takes control points or paint away (X)", icon: "remove" },
      {
        value: "pick",
        text: "Pick",
        title: "Makes the label of the point that is clicked the current one (I)",
        icon: "pick",
      },
    ],
    (action) => store.set({ action }),
  );
  actions.element.classList.add("tall");
  store.watch(["action"], ({ action }) => actions.set(action));
  store.watch(["readOnly"], ({ readOnly }) => {
    actions.enable("set", readOnly === null);
    actions.enable("remove", readOnly === null);
  });
  return section("Action", {}, actions.element);
}

/** An area tool is chosen to paint with, where the action has no areas. */
export function chooseTool(store: Store, tool: Tool): void {
  const { action, readOnly } = store.state;
  const paints = tool !== "point" && (action === "none" || action === "pick") && readOnly === null;
  store.set(paints ? { tool, action: "set" } : { tool });
}

export function toolSection(store: Store): HTMLElement {
  const tools = segmented<Tool>(
    "Tool",
    [
      { value: "point", text: "Point", title: "Single points and control points (P)", icon: "point" },
      { value: "rectangle", text: "Rect", label: "Rectangle", title: "Drag a rectangle (R)", icon: "rectangle" },
      {
        value: "polyline",
        text: "Poly",
        label: "Polyline",
        title: "Click the corners of an area; Enter closes it (Y)",
        icon: "polyline",
      },
      { value: "lasso", text: "Lasso", title: "Draw around an area (L)", icon: "lasso" },
      { value: "brush", text: "Brush", title: "Paint along a line (B)", icon: "brush" },
      { value: "segment", text: "Segm.", label: "Segment", title: "Take the segment that is clicked (S); they come with --segments", icon: "segment" },
      { value: "split", text: "Split", title: "Draw across a label: its smaller part gets the chosen one (K)", icon: "split" },
    ],
    (tool) => chooseTool(store, tool),
  );
  tools.element.classList.add("tall", "soft-choice");
  store.watch(["cloud"], ({ cloud }) => tools.enable("segment", cloud?.has_segments === true));
  store.watch(["tool", "action"], ({ tool, action }) => tools.set(action === "pick" ? "point" : tool));
  return section("Tool", {}, tools.element, optionsPart(store));
}

function optionsPart(store: Store): HTMLElement {
  const hint = h("p", { class: "tool-hint" });
  const parts = [
    part(store, ["action", "tool"], reachPart(store), (s) => s.action === "set" && s.tool === "point"),
    part(store, ["action", "tool"], treePart(store), (s) => s.action === "remove" && s.tool === "point"),
    part(store, ["action", "tool"], removalPart(store), (s) => s.action === "remove" && isArea(s)),
    part(store, ["action", "tool"], brushPart(store), (s) => isArea(s) && s.tool === "brush"),
    part(
      store,
      ["action", "tool", "brushUnit"],
      depthPart(store),
      (s) => isArea(s) && !(s.tool === "brush" && s.brushUnit === "mm"),
    ),
    part(
      store,
      ["action", "tool", "depth", "brushUnit"],
      belowPart(store),
      (s) => isArea(s) && s.depth === "below" && !(s.tool === "brush" && s.brushUnit === "mm"),
    ),
  ];
  store.watch(["action", "tool", "removal", "wholeTree"], (state) => void (hint.textContent = hintOf(state)));
  return h("div", { class: "tool-options" }, hint, ...parts);
}

function part(
  store: Store,
  keys: readonly (keyof State)[],
  element: HTMLElement,
  shown: (state: Readonly<State>) => boolean,
): HTMLElement {
  store.watch(keys, (state) => void (element.hidden = !shown(state)));
  return element;
}

function isArea(state: Readonly<State>): boolean {
  return state.tool !== "point" && state.tool !== "segment" && state.tool !== "split" && (state.action === "set" || state.action === "remove");
}

function hintOf(state: Readonly<State>): string {
  const { action, tool } = state;
  if (action === "none") return "Drag turns the view, Shift and drag moves it.";
  if (action === "pick") return "Click a point to go on with its label.";
  if (action === "set") {
    if (tool === "point") return "Click a point; drag a sphere to move it.";
    if (tool === "segment") return "Click a segment: all of it is painted with the label.";
    if (tool === "split") return "Draw across what one label took: the smaller part gets the chosen label.";
    return "Points in the area are painted with the label.";
  }
  if (tool === "segment") return "Click a segment: its paint goes.";
  if (tool === "split") return "Split goes with Set.";
  if (tool === "point")
    return state.wholeTree ? "Click anywhere in what a sphere has labelled." : "Click the sphere of a control point.";
  return {
    control: "Control points in the area go.",
    trees: "What labels points in the area goes.",
    paint: "Paint in the area goes.",
  }[state.removal];
}

function reachPart(store: Store): HTMLElement {
  const reach = reachSlider(
    "How far new control points reach, compared with others: less reach gives them less of the surroundings",
    (position) => store.set({ startCost: costOfReach(position, store.state.cloud?.maxPath ?? 100) }),
    () => undefined,
  );
  store.watch(["startCost", "cloud"], ({ startCost, cloud }) =>
    reach.set(reachOfCost(startCost, cloud?.maxPath ?? 100), reachText(startCost, cloud?.maxPath ?? 100)),
  );
  return reach.element;
}

function treePart(store: Store): HTMLElement {
  const box = checkbox(
    "Anywhere in its tree",
    "A click on any point takes its control point away; the points that it labels are shown before",
    (wholeTree) => store.set({ wholeTree }),
  );
  store.watch(["wholeTree"], ({ wholeTree }) => box.set(wholeTree));
  return box.element;
}

function removalPart(store: Store): HTMLElement {
  const removal = segmented<Removal>(
    "What is taken away",
    [
      { value: "control", text: "Points", label: "Control points", title: "Control points that are in the area" },
      { value: "trees", text: "Trees", label: "Whole trees", title: "Control points that label any point in the area" },
      { value: "paint", text: "Paint", title: "Paint of areas; what is below it shows again" },
    ],
    (value) => store.set({ removal: value }),
  );
  removal.element.classList.add("plain");
  store.watch(["removal"], (state) => removal.set(state.removal));
  return h("div", { class: "option" }, h("span", { class: "slider-name" }, "Takes away"), removal.element);
}

function depthPart(store: Store): HTMLElement {
  const depth = segmented<Depth>(
    "Depth",
    [
      { value: "surface", text: "Surface", title: "" },
      { value: "below", text: "Below", title: "" },
      { value: "deep", text: "Deep", title: "" },
    ],
    (value) => store.set({ depth: value }),
  );
  depth.element.classList.add("plain");
  store.watch(["depth", "tool"], (state) => {
    depth.set(state.depth);
    const tool = state.tool === "point" ? "area" : state.tool;
    depth.name("surface", `Surface ${tool}`, "Takes only the points that are seen (U changes it)");
    depth.name("below", `Slightly below ${tool}`, "Takes also what lies slightly below the surface that is seen (U)");
    depth.name("deep", `Deep ${tool}`, "Takes everything in the area, however deep (U)");
  });
  return h("div", { class: "option" }, h("span", { class: "slider-name" }, "Depth"), depth.element);
}

function belowPart(store: Store): HTMLElement {
  const below = slider(
    "Down to",
    { min: 1, max: kMaxBelow_mm, title: "How far below the surface that is seen" },
    (mm) => store.set({ below_mm: mm }),
  );
  store.watch(["below_mm"], ({ below_mm: mm }) => below.set(mm, `${mm} mm`));
  return below.element;
}

function brushPart(store: Store): HTMLElement {
  const radius = slider("Radius", { min: 2, max: kMaxBrush, title: "Of the brush ([ and ])" }, (brush) =>
    store.set({ brush }),
  );
  const unit = segmented<"px" | "mm">(
    "Unit of the radius",
    [
      { value: "px", text: "px", title: "On the screen" },
      { value: "mm", text: "mm", title: "In the scene: a ball drawn along the surface, with hidden points in it" },
    ],
    (brushUnit) => store.set({ brushUnit }),
  );
  unit.element.classList.add("plain");
  store.watch(["brush", "brushUnit"], (state) => {
    radius.set(state.brush, String(state.brush));
    radius.input.setAttribute("aria-valuetext", `${state.brush} ${state.brushUnit}`);
    unit.set(state.brushUnit);
  });
  unit.element.classList.add("mini");
  return h("div", { class: "brush-option" }, radius.element, unit.element);
}
