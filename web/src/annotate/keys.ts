// SPDX-License-Identifier: Apache-2.0
// The keys of the annotation tool.
import type { Shortcut } from "../ui/shortcuts";
import type { Viewer } from "../view/types";
import { removeSelected } from "./control_list";
import type { Edits } from "./edits";
import type { Files } from "./files";
import type { Guidance } from "./guidance";
import { emptyLabel, toggleHidden, toggleSolo, turnPage } from "./label_section";
import type { Pointer } from "./pointer";
import { kPointSizes, toggleShown } from "./show_section";
import { type Side, lookFrom } from "../view/standpoint";
import { type Action, type Depth, type Store, type Tool, kMaxLabel, pageOf } from "./store";
import { chooseTool, kMaxBrush } from "./tool_section";

export interface KeyParts {
  store: Store;
  edits: Edits;
  files: Files;
  guidance: Guidance;
  pointer: Pointer;
  viewer: Viewer;
  foldPanel(): void;
  showHelp(): void;
}

const kDepths: readonly Depth[] = ["surface", "below", "deep"];

/** What the camera takes itself while it flies. */
export function isFlightKey(key: string): boolean {
  return /^(Shift\+)?[WASDQE]$/.test(key);
}

export function shortcutsOf(parts: KeyParts): Shortcut[] {
  return [...actionKeys(parts), ...labelKeys(parts), ...viewKeys(parts), ...fileKeys(parts), ...mouse()];
}

function actionKeys({ store, edits, pointer }: KeyParts): Shortcut[] {
  const group = "Actions and tools";
  const action = (key: string, value: Action, text: string, shown?: string): Shortcut => ({
    keys: [key],
    group,
    text,
    run: () => store.set({ action: value }),
    ...(shown ? { shown } : {}),
  });
  const tool = (key: string, value: Tool, text: string): Shortcut => ({
    keys: [key],
    group,
    text,
    run: () => chooseTool(store, value),
  });
  const brush = (by: number) =>
    store.set({ brush: Math.max(2, Math.min(kMaxBrush, Math.round(store.state.brush * by + Math.sign(by - 1)))) });
  const none = (): void => {
    if (!pointer.giveUp()) store.set({ action: "none" });
  };
  return [
    { keys: ["Escape"], group, text: "", run: none },
    action("N", "none", "None: the left button moves the view", "N or Esc"),
    action("C", "set", "Set control points, or paint"),
    action("X", "remove", "Del"),
    action("I", "pick", "Pick a label"),
    tool("P", "point", "Point"),
    tool("R", "rectangle", "Rectangle"),
    tool("Y", "polyline", "Polyline"),
    tool("L", "lasso", "Lasso"),
    tool("B", "brush", "Brush"),
    {
      keys: ["U"],
      group,
      text: "Surface, slightly below, deep",
      run: () => store.set({ depth: kDepths[(kDepths.indexOf(store.state.depth) + 1) % kDepths.length]! }),
    },
    { keys: ["["], group, text: "Brush smaller, larger", shown: "[ ]", run: () => brush(1 / 1.2) },
    { keys: ["]"], group, text: "", run: () => brush(1.2) },
    { keys: ["Enter"], group, text: "Close the polyline", run: () => void pointer.finish() },
    { keys: ["Backspace"], group, text: "Take back its last corner", run: () => void pointer.back() },
    { keys: ["Ctrl+Z"], group, text: "Undo", run: () => edits.undo() },
    { keys: ["Ctrl+Shift+Z", "Ctrl+Y"], group, text: "Redo", shown: "Ctrl+Shift+Z", run: () => edits.redo() },
    { keys: ["Delete"], group, text: "Delete the selected control point", run: () => removeSelected(store, edits) },
  ];
}

function labelKeys({ store }: KeyParts): Shortcut[] {
  const group = "Labels";
  const step = (by: number) => store.set({ label: Math.max(1, Math.min(kMaxLabel, store.state.label + by)) });
  const digits = [1, 2, 3, 4, 5, 6, 7, 8, 9, 0];
  const choose = (place: number) => () => store.set({ label: Math.min(kMaxLabel, pageOf(store.state.label) + place) });
  const jump = (which: "first" | "next" | "last") => () => store.set({ label: emptyLabel(store, which) });
  return [
    ...digits.map((digit, i) => ({
      keys: [String(digit)],
      group,
      text: i === 0 ? "Labels of the first row" : "",
      shown: "1 – 0",
      run: choose(i),
    })),
    ...digits.map((digit, i) => ({
      keys: [`Shift+${digit}`],
      group,
      text: i === 0 ? "Labels of the second row" : "",
      shown: "Shift+1 – 0",
      run: choose(10 + i),
    })),
    { keys: [","], group, text: "Previous, next label", shown: ", .", run: () => step(-1) },
    { keys: ["."], group, text: "", run: () => step(1) },
    {
      keys: ["PageUp"],
      group,
      text: "Previous, next twenty",
      shown: "PageUp PageDown",
      run: () => turnPage(store, -1),
    },
    { keys: ["PageDown"], group, text: "", run: () => turnPage(store, 1) },
    { keys: ["J"], group, text: "Next empty label", run: jump("next") },
    { keys: ["Shift+J"], group, text: "First empty label", run: jump("first") },
    { keys: ["Alt+J"], group, text: "Last empty label", run: jump("last") },
    {
      keys: ["F2"],
      group,
      text: "Name the label",
      run: () => document.querySelector<HTMLInputElement>(".current-label input[type=text]")?.select(),
    },
    { keys: ["H"], group, text: "Hide or show the label", run: () => toggleHidden(store, store.state.label) },
    { keys: ["Shift+H"], group, text: "Show it alone, or all", run: () => toggleSolo(store, store.state.label) },
  ];
}

function viewKeys({ store, viewer, guidance, foldPanel, showHelp }: KeyParts): Shortcut[] {
  const group = "View";
  const look = (which: Side) => () => lookFrom(viewer.camera, store.state.cloud?.up ?? [0, 0, 1], which);
  const size = (by: number) =>
    store.set({ pointSize: Math.max(kPointSizes.min, Math.min(kPointSizes.max, store.state.pointSize + by)) });
  return [
    { keys: ["F"], group, text: "Whole cloud", run: () => viewer.camera.fit() },
    { keys: ["T"], group, text: "From the top", run: look("top") },
    { keys: ["Shift+F"], group, text: "From the front", run: look("front") },
    { keys: ["Shift+T"], group, text: "From the side", run: look("side") },
    {
      keys: ["O"],
      group,
      text: "Orbit or fly",
      run: () => store.set({ navigation: store.state.navigation === "orbit" ? "fly" : "orbit" }),
    },
    { keys: ["+", "="], group, text: "Points larger, smaller", shown: "+ −", run: () => size(1) },
    { keys: ["-", "−"], group, text: "", run: () => size(-1) },
    { keys: ["Shift+C"], group, text: "Cloud on or off", run: () => toggleShown(store, "cloud") },
    { keys: ["Shift+L"], group, text: "Labels on or off", run: () => toggleShown(store, "labels") },
    { keys: ["Shift+P"], group, text: "Control points on or off", run: () => toggleShown(store, "controls") },
    { keys: ["M"], group, text: "Heat map of doubt", run: () => guidance.toggle() },
    { keys: ["G"], group, text: "Next best click", run: () => void guidance.jump() },
    { keys: ["\\"], group, text: "Panel on or off", run: foldPanel },
    { keys: ["?", "F1"], group, text: "This sheet", run: showHelp },
  ];
}

function fileKeys({ store, files }: KeyParts): Shortcut[] {
  const group = "Files";
  const several = () => store.state.clouds.length > 1;
  return [
    { keys: ["Ctrl+S"], group, text: "Save", run: () => void files.save() },
    {
      keys: ["Ctrl+E"],
      group,
      text: "Export",
      run: () => document.querySelector<HTMLButtonElement>("[data-command=export]")?.click(),
    },
    { keys: ["Ctrl+O"], group, text: "Open", run: () => files.open() },
    {
      keys: ["Shift+PageUp"],
      group,
      text: "Previous, next cloud",
      shown: "Shift+PageUp – PageDown",
      run: () => several() && files.step(-1),
    },
    { keys: ["Shift+PageDown"], group, text: "", run: () => several() && files.step(1) },
  ];
}

/** Rows of the sheet without keys of their own. */
function mouse(): Shortcut[] {
  const group = "Mouse and cursor";
  const row = (shown: string, text: string): Shortcut => ({ keys: [], group, text, shown, run: () => undefined });
  return [
    row("Left", "The tool; where there is none, turns the view"),
    row("Right", "Turns the view around what is under the cursor"),
    row("Middle or Shift", "Moves the view"),
    row("Ctrl", "With the button held: rolls the view"),
    row("Wheel", "Nearer or farther, towards the cursor"),
    row("Space", "Held: the left button moves the view, whatever the tool"),
    row("← ↑ → ↓", "In the view: the cursor of the keyboard (Shift: by pixels)"),
    row("Enter", "A click there"),
    row("Alt+Click", "On an eye: this label alone"),
  ];
}
