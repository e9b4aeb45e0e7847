// SPDX-License-Identifier: Apache-2.0
// The labels: choosing one, naming it, finding an empty one, hiding some.
import { fill, h, on } from "../ui/dom";
import { iconButton, section, segmented } from "../ui/controls";
import { compact } from "../ui/figures";
import { icon } from "../ui/icons";
import { VirtualList } from "../ui/virtual_list";
import type { LabelRow } from "../protocol";
import type { Edits } from "./edits";
import { LabelGrid, describeLabel } from "./label_grid";
import { type Store, isEmpty, kMaxLabel, kPage, pageOf, rowOf } from "./store";

const kRow_px = 28;
const kMostRows = 9;

/** first: the least number without points; next: the least above the current; last: above all that are used. */
export function emptyLabel(store: Store, which: "first" | "next" | "last"): number {
  const used = (label: number) => !isEmpty(rowOf(store.state, label));
  if (which === "last") {
    const most = Math.max(
      0,
      ...[...store.state.labels.values()].filter((row) => !isEmpty(row)).map((row) => row.number),
    );
    return Math.min(most + 1, kMaxLabel);
  }
  let label = which === "first" ? 1 : store.state.label + 1;
  while (used(label)) label++;
  return Math.min(label, kMaxLabel);
}

export function turnPage(store: Store, step: number): void {
  const label = store.state.label + step * kPage;
  if (label >= 1 && label <= kMaxLabel) store.set({ label });
  else if (step < 0) store.set({ label: 1 });
}

export function toggleHidden(store: Store, label: number): void {
  const hidden = new Set(store.state.hidden);
  if (!hidden.delete(label)) hidden.add(label);
  store.set({ hidden });
}

/** Shows this one alone, or all again. */
export function toggleSolo(store: Store, label: number): void {
  const others = [0, ...store.state.labels.keys()].filter((other) => other !== label);
  const alone = others.every((other) => store.state.hidden.has(other)) && !store.state.hidden.has(label);
  store.set({ hidden: new Set(alone ? [] : others) });
}

export function labelSection(store: Store, edits: Edits): HTMLElement {
  const views = segmented(
    "Labels as",
    [
      { value: "grid", text: "", label: "Grid", title: "Twenty labels at a time", icon: "grid" },
      { value: "list", text: "", label: "List", title: "All labels in use, to hide and show them", icon: "list" },
    ],
    (value) => store.set({ labelList: value === "list" }),
  );
  views.element.classList.add("plain", "mini");
  const grid = gridPart(store);
  const list = listPart(store);
  store.watch(["labelList"], ({ labelList }) => {
    views.set(labelList ? "list" : "grid");
    grid.hidden = labelList;
    list.hidden = !labelList;
  });
  return section("Labels", { aside: views.element }, grid, list, currentPart(store, edits), detailsPart(store, edits));
}

function gridPart(store: Store): HTMLElement {
  const range = h("span", { class: "number label-range" });
  const jump = (which: "first" | "next" | "last") => () => store.set({ label: emptyLabel(store, which) });
  const previous = iconButton("previous", "Previous twenty labels (PageUp)", () => turnPage(store, -1));
  const next = iconButton("next", "Next twenty labels (PageDown)", () => turnPage(store, 1));
  const jumps = [
    jumpButton("First", "First empty label (Shift+J)", jump("first")),
    jumpButton("Next", "Next empty label (J)", jump("next")),
    jumpButton("Last", "Last empty label, after all that are used (Alt+J)", jump("last")),
  ];
  for (const button of [previous, next]) button.classList.add("small");
  store.watch(["label"], ({ label }) => {
    const first = pageOf(label);
    range.textContent = `${first}–${Math.min(first + kPage - 1, kMaxLabel)}`;
    previous.disabled = first === 1;
  });
  return h(
    "div",
    { class: "label-part" },
    new LabelGrid(store).element,
    h("div", { class: "label-pages" }, previous, range, next, h("span", { class: "soft push" }, "Empty label:"), ...jumps),
  );
}

function jumpButton(text: string, title: string, click: () => void): HTMLButtonElement {
  const label = title.replace(/[,(].*/, "").trim();
  return on(h("button", { type: "button", class: "button small", title, "aria-label": label }, text), { click });
}

function listPart(store: Store): HTMLElement {
  const list = new VirtualList<LabelRow>(
    "Labels in use",
    kRow_px,
    (row) => labelRow(store, row),
    (row) => {
      if (row.number > 0) store.set({ label: row.number });
    },
  );
  list.element.classList.add("label-list");
  store.watch(["labels", "hidden", "label", "cloud", "labelList"], (state) => {
    const labelled = [...state.labels.values()].reduce((sum, row) => sum + row.points, 0);
    const rest = { ...rowOf(state, 0), points: Math.max(0, (state.cloud?.finite ?? 0) - labelled) };
    const rows = [...state.labels.values()].filter((row) => row.number !== 0).sort((a, b) => a.number - b.number);
    list.element.style.height = `${Math.min(kMostRows, rows.length + 1) * kRow_px + 2}px`;
    list.set([rest, ...rows]);
  });
  return list.element;
}

function labelRow(store: Store, row: LabelRow): HTMLElement {
  const hidden = store.state.hidden.has(row.number);
  const name = row.number === 0 ? "No label" : row.name || `Label ${row.number}`;
  const what = hidden ? "Show" : "Hide";
  const eye = iconButton(hidden ? "hidden" : "eye", `${what} ${name}`, (event) => {
    event.stopPropagation();
    if (event.altKey) toggleSolo(store, row.number);
    else toggleHidden(store, row.number);
  });
  eye.title = `${what} (Alt: this one alone)`;
  eye.classList.add("small");
  eye.tabIndex = -1;
  const swatch = h("span", { class: "swatch" });
  swatch.style.background = row.color;
  const element = h(
    "div",
    {
      class: `list-row${hidden ? " off" : ""}`,
      "aria-selected": String(row.number === store.state.label),
      title: row.number > 0 ? describeLabel(row) : undefined,
    },
    swatch,
    h("span", { class: "number row-number" }, row.number > 0 ? String(row.number) : ""),
    h("span", { class: "row-name" }, row.number === 0 ? "No label" : row.name),
    h("span", { class: "number soft" }, compact(row.points)),
    row.locked ? icon("locked") : null,
    eye,
  );
  return element;
}

function currentPart(store: Store, edits: Edits): HTMLElement {
  const number = h("span", { class: "current-number number", "data-testid": "current-label" });
  const name = h("input", {
    type: "text",
    "aria-label": "Name of the label",
    placeholder: "Name",
    maxlength: 256,
    autocomplete: "off",
    spellcheck: "false",
  });
  const eye = iconButton("eye", "Hide this label (H)", (event) => {
    if (event.altKey) toggleSolo(store, store.state.label);
    else toggleHidden(store, store.state.label);
  });
  const lock = iconButton("unlocked", "Lock this label (Shift+K)", () => edits.lock(store.state.label));
  const color = h("input", { type: "color", "aria-label": "Colour of the label", title: "Colour" });
  let named = store.state.label; // what is typed belongs to the label that was current when it was begun
  on(name, {
    focus: () => void (named = store.state.label),
    change: () => void edits.define(named, { name: name.value.trim() }),
    keydown: (event) => {
      if (event.key === "Escape") name.value = rowOf(store.state, store.state.label).name;
      if (event.key === "Enter" || event.key === "Escape") name.blur();
    },
  });
  on(color, { change: () => void edits.define(store.state.label, { color: color.value }) });
  store.watch(["label", "labels", "hidden"], (state) => {
    const row = rowOf(state, state.label);
    number.textContent = String(row.number);
    if (document.activeElement !== name) name.value = row.name;
    color.value = row.color;
    fill(lock, icon(row.locked ? "locked" : "unlocked"));
    lock.setAttribute("aria-pressed", String(row.locked === true));
    lock.setAttribute("aria-label", row.locked ? "Unlock this label" : "Lock this label");
    lock.title = row.locked ? "Unlock this label (Shift+K)" : "Lock this label: nothing takes its points (Shift+K)";
    const hidden = state.hidden.has(row.number);
    fill(eye, icon(hidden ? "hidden" : "eye"));
    eye.setAttribute("aria-label", hidden ? "Show this label" : "Hide this label");
    eye.title = `${hidden ? "Show" : "Hide"} this label (H; with Alt or Shift+H: this one alone)`;
  });
  store.watch(["label"], () => {
    if (document.activeElement === name) name.blur();
  });
  return h("div", { class: "current-label" }, color, number, name, lock, eye);
}

function detailsPart(store: Store, edits: Edits): HTMLElement {
  const kind = h("input", {
    type: "text",
    "aria-label": "Class",
    maxlength: 256,
    autocomplete: "off",
    placeholder: "as cup, 40",
  });
  const instance = h("input", { type: "number", "aria-label": "Instance", min: 0, max: 4294967295, step: 1 });
  on(kind, { change: () => void edits.define(store.state.label, { class: kind.value.trim() }) });
  on(instance, {
    change: () => {
      if (instance.checkValidity() && instance.value !== "")
        void edits.define(store.state.label, { instance: instance.valueAsNumber });
    },
  });
  store.watch(["label", "labels"], (state) => {
    const row = rowOf(state, state.label);
    if (document.activeElement !== kind) kind.value = row.class;
    if (document.activeElement !== instance) instance.value = String(row.instance);
  });
  return h(
    "details",
    { class: "fold" },
    h("summary", {}, "Class and instance"),
    h("div", { class: "fields" }, h("label", {}, "Class", kind), h("label", {}, "Instance", instance)),
  );
}
