// SPDX-License-Identifier: Apache-2.0
// The keys of the annotation tool.
import type { Gesture, Shortcut } from "../ui/shortcuts";
import type { Viewer } from "../view/types";
import { slice, toggleClip } from "./clip_section";
import { removeSelected } from "./control_list";
import type { Edits } from "./edits";
import type { Files } from "./files";
import { toggleFour } from "./four_views";
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

/** Keys that the camera takes itself while it flies. */
export function isFlightKey(key: string): boolean {
  return /^(Shift\+)?[WASDQE]$/.test(key);
}

export function shortcutsOf(parts: KeyParts): (Shortcut | Gesture)[] {
  return [...actionKeys(parts), ...labelKeys(parts), ...viewKeys(parts), ...fileKeys(parts), ...mouse()];
}

function actionKeys({ store, edits, pointer }: KeyParts): Shortcut[] {
  const group = "Actions and tools";
  const action = (key: string, value: Action, text: string): Shortcut => ({
    keys: [key],
    group,
    text,
    run: () => store.set({ action: value }),
  });
  const tool = (key: string, value: Tool, text: string): Shortcut => ({
    keys: [key],
    group,
    text,
    run: () => chooseTool(store, value),
  });
  const brush = (by: number) =>
    store.set({ brush: Math.max(2, Math.min(kMaxBrush, Math.round(store.state.brush * by + Math.sign(by - 1)))) });
  const none = (which: number): void => {
    if (which === 0 || !pointer.giveUp()) store.set({ action: "none" });
  };
  return [
    { keys: ["N", "Escape"], group, text: "Navigate: the left button moves the view", run: none },
    action("C", "set", "Set control points, or paint"),
    action("X", "remove", "Delete"),
    action("I", "pick", "Pick a label"),
    tool("P", "point", "Point"),
    tool("R", "rectangle", "Rectangle"),
    tool("Y", "polyline", "Polyline"),
    tool("L", "lasso", "Lasso"),
    tool("B", "brush", "Brush"),
    tool("S", "segment", "Segment (with --segments)"),
    tool("K", "split", "Split with a stroke"),
    {
      keys: ["U"],
      group,
      text: "Surface, slightly below, deep",
      run: () => store.set({ depth: kDepths[(kDepths.indexOf(store.state.depth) + 1) % kDepths.length]! }),
    },
    { keys: ["[", "]"], group, text: "Brush smaller, larger", run: (which) => brush(which === 0 ? 1 / 1.2 : 1.2) },
    { keys: ["Enter"], group, text: "Close the polyline", run: () => void pointer.finish() },
    { keys: ["Backspace"], group, text: "Take back its last corner", run: () => void pointer.back() },
    { keys: ["Ctrl+Z"], group, text: "Undo", run: () => edits.undo() },
    { keys: ["Ctrl+Shift+Z"], or: ["Ctrl+Y"], group, text: "Redo", run: () => edits.redo() },
    { keys: ["Delete"], group, text: "Delete the selected control point", run: () => removeSelected(store, edits) },
  ];
}

function labelKeys({ store, edits }: KeyParts): Shortcut[] {
  const group = "Labels";
  const step = (by: number) => store.set({ label: Math.max(1, Math.min(kMaxLabel, store.state.label + by)) });
  const digits = [..."1234567890"];
  const choose = (place: number) => store.set({ label: Math.min(kMaxLabel, pageOf(store.state.label) + place) });
  const jump = (which: "first" | "next" | "last") => () => store.set({ label: emptyLabel(store, which) });
  return [
    { keys: digits, group, text: "Labels of the first row", run: choose },
    {
      keys: digits.map((digit) => `Shift+${digit}`),
      group,
      text: "Labels of the second row",
      run: (which) => choose(10 + which),
    },
    { keys: [",", "."], group, text: "Previous, next label", run: (which) => step(sign(which)) },
    {
      keys: ["PageUp", "PageDown"],
      group,
      text: "Previous, next twenty",
      run: (which) => turnPage(store, sign(which)),
    },
    { keys: ["J"], group, text: "Next empty label", run: jump("next") },
    { keys: ["Shift+J"], group, text: "First empty label", run: jump("first") },
    { keys: ["Alt+J"], group, text: "Last empty label", run: jump("last") },
    {
      keys: ["F2"],
      group,
      text: "Name the label",
      run: () => document.querySelector<HTMLInputElement>(".current-label input[type=text]")?.select(),
    },
    { keys: ["Shift+K"], group, text: "Lock or unlock the label", run: () => edits.lock(store.state.label) },
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
    { keys: ["F"], group, text: "Whole cloud", run: () => viewer.fit() },
    { keys: ["T"], group, text: "From the top", run: look("top") },
    { keys: ["Shift+F"], group, text: "From the front", run: look("front") },
    { keys: ["Shift+T"], group, text: "From the side", run: look("side") },
    {
      keys: ["O"],
      group,
      text: "Orbit or fly",
      run: () => store.set({ navigation: store.state.navigation === "orbit" ? "fly" : "orbit" }),
    },
    { keys: ["+", "-"], group, text: "Points larger, smaller", run: (which) => size(-sign(which)) },
    { keys: ["Shift+C"], group, text: "Cloud on or off", run: () => toggleShown(store, "cloud") },
    { keys: ["Shift+L"], group, text: "Labels on or off", run: () => toggleShown(store, "labels") },
    { keys: ["Shift+P"], group, text: "Control points on or off", run: () => toggleShown(store, "controls") },
    { keys: ["Shift+B"], group, text: "Boxes around labels on or off", run: () => store.set({ boxes: !store.state.boxes }) },
    { keys: ["Shift+V"], group, text: "Four views or one", run: () => toggleFour(store) },
    { keys: ["V"], group, text: "Clip box on or off", run: () => toggleClip(store) },
    { keys: ["Alt+PageUp", "Alt+PageDown"], group, text: "Slice above, below", run: (which) => slice(store, which === 0 ? 1 : -1) },
    { keys: ["M"], group, text: "Heat map of doubt", run: () => guidance.toggle() },
    { keys: ["G"], group, text: "Next best click", run: () => void guidance.jump() },
    { keys: ["A"], group, text: "Accept it with the label of the place, and go on", run: () => void guidance.accept(true) },
    { keys: ["Shift+A"], group, text: "Accept it with the chosen label, and go on", run: () => void guidance.accept(false) },
    { keys: ["\\"], group, text: "Panel on or off", run: foldPanel },
    { keys: ["?"], or: ["F1"], group, text: "This sheet", run: showHelp },
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
      keys: ["Shift+PageUp", "Shift+PageDown"],
      group,
      text: "Previous, next cloud",
      run: (which) => several() && files.step(sign(which)),
    },
    { keys: ["Shift+N"], group, text: "Next cloud of a sequence, with the labels of this one", run: () => void files.carry() },
  ];
}

/** Returns the direction of a pair of keys: the first goes back, the second forward. */
function sign(which: number): 1 | -1 {
  return which === 0 ? -1 : 1;
}

/** Keys of the view itself. */
function mouse(): Gesture[] {
  const group = "Mouse and cursor";
  const row = (shown: string, text: string): Gesture => ({ group, text, shown });
  return [
    row("Left", "The tool; where there is none, turns the view"),
    row("Right", "Turns the view around what is under the cursor"),
    row("Middle or Shift", "Moves the view"),
    row("Ctrl", "With the button held: rolls the view"),
    row("Wheel", "Nearer or farther, towards the cursor"),
    row("Space", "Held: the left button moves the view, whatever the tool"),
    row("← ↑ → ↓", "In the view: the cursor of the keyboard (Shift: by pixels)"),
    row("Enter", "A click there"),
    row("W A S D", "In flight: forward, left, back, right"),
    row("Q E", "In flight: down, up (Shift: faster)"),
    row("Alt+Click", "On an eye: this label alone"),
  ];
}
