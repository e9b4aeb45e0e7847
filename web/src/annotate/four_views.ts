// SPDX-License-Identifier: Apache-2.0
// Four views in one window: their names, the lines between them, and which of them is in use.
import { h } from "../ui/dom";
import type { PaneName, Viewer } from "../view/types";
import "./four_views.css";
import type { Store } from "./store";

const kPanes: readonly [PaneName, string][] = [
  ["top", "Top"],
  ["free", "Free"],
  ["front", "Front"],
  ["side", "Side"],
];

export function toggleFour(store: Store): void {
  store.set({ four: !store.state.four });
}

/** Lies over the view; what is pressed goes through it. */
export function fourViews(store: Store, viewer: Viewer): HTMLElement {
  const panes = kPanes.map(([name, text]) => h("div", { class: `pane pane-${name}` }, h("span", { class: "pane-name" }, text)));
  const element = h("div", { class: "panes", hidden: true, "aria-hidden": "true" }, ...panes);
  store.watch(["four"], ({ four }) => {
    element.hidden = !four;
    viewer.element.dataset["views"] = four ? "4" : "1";
    viewer.setFour(four);
  });
  return element;
}
