// SPDX-License-Identifier: Apache-2.0
// What is drawn, and the buttons at the lower edge of the view.
import { checkbox, iconButton, section, segmented, slider, toggleButton } from "../ui/controls";
import { h, on } from "../ui/dom";
import { icon } from "../ui/icons";
import type { Viewer } from "../view/types";
import { toggleFour } from "./four_views";
import { type Side, lookFrom } from "../view/standpoint";
import { type State, type Store, isEmpty } from "./store";

type Shown = keyof State["show"];

export const kPointSizes = { min: 1, max: 16 };

export function toggleShown(store: Store, what: Shown): void {
  store.set({ show: { ...store.state.show, [what]: !store.state.show[what] } });
}

export function showSection(store: Store, coloring: HTMLElement): HTMLElement {
  const toggles: [Shown, string, string][] = [
    [
      "cloud",
      "Cloud",
      "The colours of the cloud; without them points are their label's colour, black without one (Shift+C)",
    ],
    ["labels", "Labels", "Labels as squares in the points (Shift+L)"],
    ["controls", "Control points", "Control points as spheres (Shift+P)"],
  ];
  const row = h("div", { class: "toggle-row", role: "group", "aria-label": "Show" });
  for (const [what, text, title] of toggles) {
    const toggle = toggleButton([h("span", {}, text)], text, title, () => toggleShown(store, what));
    toggle.element.classList.add("outline");
    store.watch(["show"], ({ show }) => toggle.set(show[what]));
    row.append(toggle.element);
  }
  const size = slider(
    "Point size",
    { min: kPointSizes.min, max: kPointSizes.max, title: "Edge of a point's square (+ and −)" },
    (pointSize) => store.set({ pointSize }),
  );
  store.watch(["pointSize"], ({ pointSize }) => size.set(pointSize, `${pointSize} px`));
  const shading = checkbox(
    "Shading",
    "Shades points by their depth, so that shapes are seen without colours (eye-dome lighting)",
    (on) => store.set({ shading: on }),
  );
  store.watch(["shading"], (state) => shading.set(state.shading));
  const boxes = checkbox("Boxes", "An upright box around each label; the line on top points along it (Shift+B)", (on) =>
    store.set({ boxes: on }),
  );
  store.watch(["boxes"], (state) => boxes.set(state.boxes));
  return section("Show", {}, row, coloring, size.element, shading.element, boxes.element);
}

export function viewBar(store: Store, viewer: Viewer): HTMLElement {
  const look = (which: Side) => () => lookFrom(viewer.camera, store.state.cloud?.up ?? [0, 0, 1], which);
  const navigation = segmented<"orbit" | "fly">(
    "Navigation",
    [
      { value: "orbit", text: "Orbit", title: "Turn around what is under the cursor (O)", icon: "orbit" },
      { value: "fly", text: "Fly", title: "Move with W A S D, Q and E, look with the mouse (O)", icon: "fly" },
    ],
    (value) => store.set({ navigation: value }),
  );
  navigation.element.classList.add("plain");
  store.watch(["navigation"], (state) => {
    navigation.set(state.navigation);
    viewer.camera.navigation = state.navigation;
  });
  const four = toggleButton([icon("four")], "Four views", "Top, front, side and free view in one window (Shift+V)", () => toggleFour(store));
  four.element.classList.add("icon-only");
  store.watch(["four"], (state) => four.set(state.four));
  const legend = h(
    "span",
    { class: "heat-legend", hidden: true },
    "in doubt",
    h("span", { class: "heat-scale" }),
    "sure",
  );
  store.watch(["margins"], ({ margins }) => void (legend.hidden = !margins));
  const bar = h(
    "div",
    { class: "floating view-bar", role: "toolbar", "aria-label": "View" },
    legend,
    navigation.element,
    h("span", { class: "divider" }),
    four.element,
    h("span", { class: "divider" }),
    iconButton("fit", "Whole cloud (F)", () => viewer.fit()),
    iconButton("top", "From the top (T)", look("top")),
    iconButton("front", "From the front (Shift+F)", look("front")),
    iconButton("side", "From the side (Shift+T)", look("side")),
  );
  return bar;
}

/** Hint for the first action, shown until something was done. */
export function firstNote(store: Store): HTMLElement {
  const note = h(
    "p",
    { class: "floating first-note", hidden: true },
    "Choose Set and a label, and click an object or a surface; then another label for each of the others.",
  );
  store.watch(["cloud", "ready", "progress", "readOnly", "labels", "canUndo", "canRedo", "pending"], (state) => {
    const untouched = !state.canUndo && !state.canRedo && state.pending === 0;
    const empty = [...state.labels.values()].every(isEmpty);
    const usable = state.cloud !== null && state.ready && state.progress === null && state.readOnly === null;
    note.hidden = !(usable && untouched && empty);
  });
  return note;
}

export function hiddenNote(store: Store): HTMLElement {
  const button = h(
    "button",
    { type: "button", class: "floating hidden-note", hidden: true },
    icon("hidden"),
    h("span"),
  );
  on(button, { click: () => store.set({ hidden: new Set() }) });
  store.watch(["hidden"], ({ hidden }) => {
    button.hidden = hidden.size === 0;
    button.lastElementChild!.textContent = `${hidden.size === 1 ? "1 label is" : `${hidden.size} labels are`} hidden · Show all`;
  });
  return button;
}
