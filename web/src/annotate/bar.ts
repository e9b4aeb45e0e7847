// SPDX-License-Identifier: Apache-2.0
// The bar above: which cloud, undo and redo, files, how things stand.
import { iconButton, menuButton, textButton } from "../ui/controls";
import { h, on } from "../ui/dom";
import { foldMenu } from "../ui/fold_menu";
import { icon } from "../ui/icons";
import type { Shortcuts } from "../ui/shortcuts";
import type { ThemeSwitch } from "../ui/theme";
import type { Edits } from "./edits";
import type { Files } from "./files";
import type { State, Store } from "./store";

interface Parts {
  store: Store;
  edits: Edits;
  files: Files;
  shortcuts: Shortcuts;
  theme: ThemeSwitch;
  foldPanel: () => void;
}

const kWriting = "Writing …";
const kShort_ms = 150; // writing that is over sooner is not worth a frame that says so

export function makeBar({ store, edits, files, shortcuts, theme, foldPanel }: Parts): HTMLElement {
  const undo = iconButton("undo", "Undo (Ctrl+Z)", () => edits.undo());
  const redo = iconButton("redo", "Redo (Ctrl+Shift+Z)", () => edits.redo());
  const save = textButton("Save", () => void files.save(), {
    icon: "save",
    title: "Writes the labels beside the cloud (Ctrl+S)",
  });
  const exportButton = textButton("Export", () => undefined, {
    icon: "download",
    title: "The labels as a file of this browser (Ctrl+E)",
  });
  exportButton.dataset["command"] = "export";
  const more = iconButton("more", "More", () => undefined);
  const moreMenu = menuButton(more, "More", () => [
    { text: "New annotation …", icon: "create", choose: () => void files.beginAnew() },
    { text: "Clear all labels", icon: "clear", choose: () => void edits.clear() },
    { text: "Your name …", icon: "people", choose: () => files.askName() },
  ]);
  const writing = [undo, redo, save, exportButton, more];
  store.watch(["canUndo", "canRedo", "cloud", "readOnly", "pending"], (state) => {
    for (const button of writing) button.disabled = state.cloud === null;
    undo.disabled = !state.cloud || state.readOnly !== null || (!state.canUndo && state.pending === 0);
    redo.disabled = !state.cloud || state.readOnly !== null || !state.canRedo;
  });
  undo.setAttribute("aria-label", "Undo");
  redo.setAttribute("aria-label", "Redo");
  return h(
    "header",
    { class: "bar" },
    iconButton("panel", "Panel (\\)", foldPanel),
    cloudPart(store, files),
    h("div", { class: "bar-group" }, undo, redo),
    h("div", { class: "bar-group push" }, people(store), savedAt(store), status(store)),
    foldMenu(
      h(
        "div",
        { class: "bar-group" },
        save,
        menuButton(exportButton, "Export as", () => files.exports()),
        moreMenu,
      ),
      h(
        "div",
        { class: "bar-group bar-end" },
        theme.button,
        iconButton("help", "Keyboard and mouse (?)", () => shortcuts.showHelp()),
      ),
    ),
  );
}

function cloudPart(store: Store, files: Files): HTMLElement {
  const name = h("span", { class: "cloud-name" });
  const open = h(
    "button",
    { type: "button", class: "button cloud-button", title: "Open another cloud (Ctrl+O)", "aria-label": "Open" },
    icon("folder"),
    name,
  );
  on(open, { click: () => files.open() });
  const previous = iconButton("previous", "Previous cloud (Shift+PageUp)", () => files.step(-1));
  const next = iconButton("next", "Next cloud (Shift+PageDown)", () => files.step(1));
  previous.setAttribute("aria-label", "Previous cloud");
  next.setAttribute("aria-label", "Next cloud");
  const place = h("span", { class: "soft number wide-only" });
  const carry = textButton("Carry", () => void files.carry(), {
    icon: "carry",
    title: "Goes to the next cloud, where points without a label take those of this one (Shift+N)",
  });
  carry.setAttribute("aria-label", "Carry the labels to the next cloud");
  const steps = h("div", { class: "bar-group" }, previous, place, next, carry);
  store.watch(["cloud", "clouds", "sequence"], ({ cloud, clouds, sequence }) => {
    name.textContent = cloud?.name ?? "";
    open.setAttribute("aria-label", `Open. ${cloud ? `Now: ${cloud.name}` : "No cloud"}`);
    steps.hidden = clouds.length < 2;
    const index = cloud?.index ?? 0;
    place.textContent = `${index + 1} / ${clouds.length}`;
    previous.disabled = index <= 0;
    next.disabled = index >= clouds.length - 1;
    carry.hidden = !sequence;
    carry.disabled = cloud === null || next.disabled;
    if (cloud) document.title = `${cloud.name} · Saccade`;
  });
  return h("div", { class: "bar-group cloud-part" }, open, steps);
}

function people(store: Store): HTMLElement {
  const count = h("span", { class: "number" });
  const element = h("span", { class: "people", role: "status" }, icon("people"), count);
  store.watch(["people", "others", "lastBy"], (state) => {
    element.hidden = state.people < 2;
    count.textContent = String(state.people) + (state.lastBy ? ` · ${state.lastBy}` : "");
    const names = state.others.length > 0 ? `: you, ${state.others.join(", ")}` : "";
    element.title = `${state.people} pages have this cloud open${names}`;
    element.setAttribute("aria-label", element.title);
  });
  return element;
}

/** When the last action of this page came to the disk. */
function savedAt(store: Store): HTMLElement {
  const element = h("span", { class: "soft number wide-only", "data-testid": "saved-at" });
  store.watch(["savedAt"], (state) => void (element.textContent = state.savedAt ? `saved at ${state.savedAt}` : ""));
  return element;
}

/** data-pending: how many actions are not on the disk yet. */
function status(store: Store): HTMLElement {
  const element = h("span", { class: "status", role: "status", "data-testid": "status" });
  let timer = 0;
  const show = () => {
    timer = 0;
    const [kind, text, title] = statusOf(store.state);
    if (element.textContent === text && element.title === title) return;
    element.dataset["state"] = kind;
    element.textContent = text;
    element.title = title;
  };
  store.watch(["connection", "readOnly", "pending", "cloud", "ready"], (state) => {
    element.dataset["pending"] = String(state.pending);
    if (statusOf(state)[1] === kWriting) {
      timer ||= window.setTimeout(show, kShort_ms);
      return;
    }
    clearTimeout(timer);
    show();
  });
  return element;
}

function statusOf(state: Readonly<State>): [kind: "good" | "busy" | "bad", text: string, title: string] {
  if (state.connection === "closed")
    return ["bad", "Closed", "The program does not let this page in any more. Open the address that it prints."];
  if (state.connection !== "connected") {
    const waiting = state.pending > 0 ? ` · ${state.pending} to write` : "";
    return [
      "busy",
      `Reconnecting …${waiting}`,
      "The program cannot be reached. What is not written yet is sent when it is back.",
    ];
  }
  if (state.readOnly !== null) return ["bad", "Read only", state.readOnly];
  if (state.pending > 0 && state.ready) return ["busy", kWriting, "Actions are on their way to the disk"];
  if (state.cloud && !state.ready)
    return ["busy", "Getting ready …", "Labels can be set when the neighbourhood graph is there"];
  return ["good", "All on disk", "Every action is on the disk; nothing is lost when the page or the program ends"];
}
