// SPDX-License-Identifier: Apache-2.0
// The annotation tool: puts its parts together.
import type { Connection, Hello } from "../connection";
import { BusySign } from "../ui/busy";
import { fill, h } from "../ui/dom";
import { drawer } from "../ui/fold_menu";
import { ProgressCard } from "../ui/progress";
import { isBoolean, isNumber, isText, oneOf, recall, remember } from "../ui/settings";
import { Shortcuts } from "../ui/shortcuts";
import { ThemeSwitch } from "../ui/theme";
import type { Viewer } from "../view/types";
import { createViewer } from "../view/viewer";
import "./annotate.css";
import { makeBar } from "./bar";
import { BoxShow } from "./box_show";
import { Coloring } from "./coloring";
import { controlSection } from "./control_list";
import { Edits } from "./edits";
import { Files } from "./files";
import { fourViews } from "./four_views";
import { Guidance } from "./guidance";
import { isFlightKey, shortcutsOf } from "./keys";
import { labelSection } from "./label_section";
import { Pointer } from "./pointer";
import { Segments } from "./segments";
import { Session } from "./session";
import { firstNote, hiddenNote, showSection, viewBar } from "./show_section";
import "./stage.css";
import { type CloudEntry, type State, Store } from "./store";
import { clipSection } from "./clip_section";
import { actionSection, kMaxBelow_mm, kMaxBrush, toolSection } from "./tool_section";

export function startAnnotate(connection: Connection, hello: Hello, app: HTMLElement): void {
  const store = new Store(firstState(hello));
  const view = h("div", { class: "stage-view" });
  const panel = h("aside", { class: "panel", "aria-label": "Tools and labels" });
  const stage = h("main", { class: "stage" }, view);
  const page = h("div", { class: "page" });

  const viewer = createViewer(view);
  viewer.element.tabIndex = 0;
  viewer.element.setAttribute("role", "application");
  viewer.element.setAttribute("aria-label", "Cloud");
  const busy = new BusySign();
  connection.name = store.state.name;
  store.watch(["name"], ({ name }) => remember("name", name));
  const session = new Session(connection, store, viewer, busy);
  const edits = new Edits(store, session, viewer);
  const segments = new Segments(store, session, viewer);
  const pointer = new Pointer(viewer, store, edits, segments);
  const files = new Files(store, session);
  const coloring = new Coloring(store, session, viewer, segments);
  new BoxShow(store, session, viewer);
  const guidance = new Guidance(store, session, viewer);
  const shortcuts = new Shortcuts();
  const theme = new ThemeSwitch((dark) => viewer.setTheme(dark));
  const foldPanel = drawer(page, stage, recall("folded", false, isBoolean), (folded) => remember("folded", folded));
  shortcuts.taken = (key) => store.state.navigation === "fly" && isFlightKey(key);
  shortcuts.add(
    ...shortcutsOf({ store, edits, files, guidance, pointer, viewer, foldPanel, showHelp: () => shortcuts.showHelp() }),
  );

  fill(
    panel,
    actionSection(store),
    toolSection(store),
    labelSection(store, edits),
    showSection(store, coloring.element),
    clipSection(store),
    controlSection(store, edits, viewer),
    guidance.section(),
  );
  viewer.element.append(fourViews(store, viewer));
  stage.append(
    pointer.overlay.element,
    pointer.overlay.hint,
    viewBar(store, viewer),
    firstNote(store),
    hiddenNote(store),
    pointer.readout,
  );
  stage.append(progressOf(store), busy.element, failureOf(store));
  fill(page, makeBar({ store, edits, files, shortcuts, theme, foldPanel }), panel, stage);
  fill(app, page);

  followView(store, viewer);
  session.onChange(() => pointer.renew());
  viewer.cloud.onHoverReady(() => pointer.renew());
  keepSettings(store);
  window.addEventListener("beforeunload", (event) => {
    if (store.state.pending > 0) event.preventDefault();
  });
  void session.open(Number(hello["current"]) || 0);
}

function firstState(hello: Hello): State {
  return {
    connection: "connected",
    readOnly: null,
    clouds: (hello["clouds"] as CloudEntry[] | undefined) ?? [],
    sequence: hello["sequence"] === true,
    cloud: null,
    failure: null,
    progress: null,
    ready: false,
    pending: 0,
    people: 1,
    others: [],
    name: recall("name", "", isText),
    lastBy: "",
    savedAt: "",
    clip: null,
    boxes: false,
    four: false,
    canUndo: false,
    canRedo: false,
    labels: new Map(),
    colors: (hello["colors"] as string[] | undefined) ?? [],
    controls: new Map(),
    action: "none",
    tool: "point",
    depth: recall("depth", "surface", oneOf("surface", "below", "deep")),
    below_mm: Math.min(kMaxBelow_mm, recall("below_mm", 20, isNumber)),
    brush: Math.min(kMaxBrush, recall("brush", 20, isNumber)),
    brushUnit: recall("brushUnit", "px", oneOf("px", "mm")),
    wholeTree: recall("wholeTree", true, isBoolean),
    removal: recall("removal", "control", oneOf("control", "trees", "paint")),
    label: 1,
    startCost: 0,
    selected: null,
    show: { cloud: true, labels: true, controls: true },
    hidden: new Set(),
    margins: false,
    colorBy: "own",
    shading: false,
    navigation: recall("navigation", "orbit", oneOf("orbit", "fly")),
    pointSize: recall("pointSize", 4, isNumber),
    labelList: recall("labelList", false, isBoolean),
  };
}

function keepSettings(store: Store): void {
  const kept = [
    "depth",
    "below_mm",
    "brush",
    "brushUnit",
    "wholeTree",
    "removal",
    "navigation",
    "pointSize",
    "labelList",
  ] as const;
  for (const key of kept) store.watch([key], (state) => remember(key, state[key]));
}

/** The view shows what the state says. */
function followView(store: Store, viewer: Viewer): void {
  store.watch(["show"], ({ show }) => viewer.cloud.show(show));
  store.watch(["clip"], ({ clip }) => viewer.cloud.setClip(clip));
  store.watch(["pointSize"], ({ pointSize }) => void (viewer.cloud.pointSize = pointSize));
  let hidden: ReadonlySet<number> = new Set();
  store.watch(["hidden"], (state) => {
    for (const label of hidden) if (!state.hidden.has(label)) viewer.cloud.setLabelVisible(label, true);
    for (const label of state.hidden) if (!hidden.has(label)) viewer.cloud.setLabelVisible(label, false);
    hidden = state.hidden;
  });
}

const kStages: Record<string, string> = {
  reading: "Reading the cloud",
  points: "Loading points",
  graph: "Joining neighbouring points",
  seeds: "Placing control points",
};

function progressOf(store: Store): HTMLElement {
  const card = new ProgressCard();
  store.watch(["progress"], ({ progress }) => {
    if (!progress) return card.hide();
    card.show(kStages[progress.stage] ?? progress.stage, progress.done, progress.total, progress.seen);
  });
  return card.element;
}

function failureOf(store: Store): HTMLElement {
  const text = h("p");
  const element = h(
    "div",
    { class: "notice failure", role: "alert" },
    h("h1", {}, "This cloud cannot be opened"),
    text,
  );
  store.watch(["failure"], ({ failure }) => {
    element.hidden = failure === null;
    text.textContent = failure;
  });
  return element;
}
