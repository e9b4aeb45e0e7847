// SPDX-License-Identifier: Apache-2.0
// The control points, to jump to, change and take away.
import { checkbox, section, textButton } from "../ui/controls";
import { h } from "../ui/dom";
import { VirtualList } from "../ui/virtual_list";
import type { ControlPoint } from "../protocol";
import type { Viewer } from "../view/types";
import type { Edits } from "./edits";
import { type Store, rowOf } from "./store";
import { costOfReach, reachOfCost, reachSlider, reachText } from "./tool_section";

const kRow_px = 28;
const kMostRows = 8;

export function controlSection(store: Store, edits: Edits, viewer: Viewer): HTMLElement {
  let onlyCurrent = false;
  const count = h("span", { class: "soft number" });
  const only = checkbox("Of the current label only", "", (checked) => {
    onlyCurrent = checked;
    draw();
  });
  const list = new VirtualList<ControlPoint>(
    "Control points",
    kRow_px,
    (control) => controlRow(store, control),
    (control) => {
      store.set({ selected: control.point });
      viewer.camera.goTo(control.position);
      viewer.cloud.mark(control.position);
    },
  );
  const empty = h("p", { class: "soft" }, "None yet. Choose Set and click a point.");
  const draw = () => {
    const state = store.state;
    const shown = [...state.controls.values()]
      .filter((control) => !onlyCurrent || control.label === state.label)
      .sort((a, b) => a.label - b.label || a.point - b.point);
    count.textContent = String(state.controls.size);
    empty.hidden = shown.length > 0;
    list.element.hidden = shown.length === 0;
    list.element.style.height = `${Math.min(kMostRows, shown.length) * kRow_px + 2}px`;
    list.set(shown);
  };
  store.watch(["controls", "label", "labels", "selected"], draw);
  return section(
    "Control points",
    { fold: true, open: true, aside: count },
    only.element,
    empty,
    list.element,
    selectedPart(store, edits),
  );
}

function controlRow(store: Store, control: ControlPoint): HTMLElement {
  const row = rowOf(store.state, control.label);
  const swatch = h("span", { class: "swatch round" });
  swatch.style.background = row.color;
  return h(
    "div",
    { class: "list-row", "aria-selected": String(store.state.selected === control.point) },
    swatch,
    h("span", { class: "number row-number" }, String(control.label)),
    h("span", { class: "row-name" }, row.name),
    control.start_cost > 0
      ? h(
          "span",
          { class: "number soft", title: `Start cost ${control.start_cost.toPrecision(3)}` },
          reachText(control.start_cost, mostOf(store)),
        )
      : null,
    h("span", { class: "number soft" }, `#${control.point}`),
  );
}

function mostOf(store: Store): number {
  return store.state.cloud?.maxPath ?? 100;
}

/** Reach and removal of the one that is selected. */
function selectedPart(store: Store, edits: Edits): HTMLElement {
  const most = () => mostOf(store);
  const reach = reachSlider(
    "How far the selected control point reaches, compared with others",
    (position) => reach.set(position, reachText(costOfReach(position, most()), most())),
    (position) => {
      if (store.state.selected !== null) edits.changeReach(store.state.selected, costOfReach(position, most()));
    },
  );
  reach.input.setAttribute("aria-label", "Reach of the selected control point");
  const remove = textButton("Delete", () => removeSelected(store, edits), {
    icon: "clear",
    title: "Takes it away (Delete)",
    kind: "outline",
  });
  const element = h("div", { class: "selected-control" }, reach.element, remove);
  store.watch(["selected", "controls", "cloud"], ({ selected, controls }) => {
    const control = selected === null ? undefined : controls.get(selected);
    element.hidden = !control;
    if (control) reach.set(reachOfCost(control.start_cost, most()), reachText(control.start_cost, most()));
  });
  return element;
}

export function removeSelected(store: Store, edits: Edits): void {
  if (store.state.selected !== null) edits.removeControl(store.state.selected);
}
