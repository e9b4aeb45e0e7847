// SPDX-License-Identifier: Apache-2.0
// The elements of the viewer's page: a bar, the panel, the view with its pictures and steps.
import type { Side } from "../view/standpoint";
import type { ConnectionState } from "../connection";
import { iconButton, section, segmented, slider, toggleButton } from "../ui/controls";
import { fill, h } from "../ui/dom";
import { icon } from "../ui/icons";
import { ProgressCard } from "../ui/progress";
import { isBoolean, recall, remember } from "../ui/settings";
import "../ui/style";
import type { Navigation } from "../view/types";
import type { SceneDocument } from "./document";
import { LayerList } from "./layer_list";
import type { Look } from "./look_of_layers";
import { thumbnails } from "./pictures";
import "./pictures.css";
import type { Player } from "./player";
import "./show.css";
import { StepBar } from "./step_bar";
import { factsTable, StepPanel } from "./step_panel";

export interface PageActions {
  layersChanged(): void;
  lookThrough(through: boolean): void;
  fit(from?: Side): void;
  navigation(navigation: Navigation): void;
  pointSize(size_px: number): void;
  help(): void;
}

const kStates: Record<ConnectionState, [string, string]> = {
  connecting: ["busy", "Connecting"],
  connected: ["good", "Connected"],
  reconnecting: ["busy", "Reconnecting"],
  closed: ["bad", "The program has ended or does not let this page in"],
};
const kKinds = { run: "Run", mesh: "Mesh", map: "Map", cloud: "Point cloud" } as const;

export class ShowPage {
  readonly view = h("div", { class: "stage-view" });
  readonly stage: HTMLElement;
  readonly layers: LayerList;
  readonly step: StepPanel;
  readonly loading = new ProgressCard();
  private readonly bar: StepBar;
  private readonly title = h("h1", { class: "show-title" });
  private readonly kind = h("span", { class: "badge" });
  private readonly live = h("span", { class: "badge live", hidden: true, role: "status" }, "live");
  private readonly status = h("span", { class: "status", role: "status" });
  private readonly facts = h("div");
  private readonly pictures = h("div", { class: "show-pictures", role: "group", "aria-label": "Pictures" });
  private readonly picturesToggle;
  private readonly navigation;
  private readonly pointSize;
  private readonly pointSection: HTMLElement;
  private readonly root: HTMLElement;
  private readonly tail = h("div", { class: "bar-group" });
  private shownPictures = "";
  private wantsPictures = recall("show.pictures", true, isBoolean);

  constructor(
    app: Element,
    private readonly player: Player,
    look: Look,
    actions: PageActions,
  ) {
    this.layers = new LayerList(look, actions.layersChanged);
    this.step = new StepPanel(actions.lookThrough);
    this.bar = new StepBar(player);
    this.navigation = segmented<Navigation>(
      "Navigation",
      [
        { value: "orbit", text: "", label: "Orbit", title: "Orbit: drag turns around what is under the cursor (O)", icon: "orbit" },
        { value: "fly", text: "", label: "Fly", title: "Fly: drag looks around, W A S D move (O)", icon: "fly" },
      ],
      (value) => {
        this.navigation.set(value);
        actions.navigation(value);
      },
    );
    this.navigation.set("orbit");
    this.navigation.element.classList.add("plain");
    this.picturesToggle = toggleButton([icon("picture")], "Pictures", "Pictures of the step (P)", (on) => this.showPictures(on));
    this.picturesToggle.element.classList.add("icon-only");
    this.pointSize = slider("Point size", { min: 1, max: 16 }, (at) => {
      this.pointSize.set(at, `${at} px`);
      actions.pointSize(at);
    });
    this.pointSize.set(3, "3 px");
    this.pointSection = section("Points", {}, this.pointSize.element);

    const bar = h(
      "header",
      { class: "bar" },
      iconButton("panel", "Panel (\\)", () => this.fold()),
      h("div", { class: "bar-group" }, this.title, this.kind, this.live),
      h("div", { class: "bar-group push" }, this.status),
      h("div", { class: "bar-group" }, this.picturesToggle.element, this.navigation.element),
      h(
        "div",
        { class: "bar-group" },
        iconButton("fit", "Everything in view (F)", () => actions.fit()),
        iconButton("top", "From the top (T)", () => actions.fit("top")),
        iconButton("front", "From the front (Shift+F)", () => actions.fit("front")),
        iconButton("side", "From the side (Shift+T)", () => actions.fit("side")),
      ),
      this.tail,
    );
    this.tail.append(iconButton("help", "Keyboard and mouse (?)", actions.help));
    const panel = h(
      "aside",
      { class: "panel", "aria-label": "What is shown" },
      this.step.element,
      section("Layers", {}, this.layers.element),
      this.pointSection,
      section("About", {}, this.facts),
    );
    this.stage = h("main", { class: "stage" }, this.view, this.pictures, this.bar.element, this.loading.element);
    this.root = h("div", { class: "page show" }, bar, panel, this.stage);
    fill(app, this.root);
    this.step.element.hidden = this.bar.element.hidden = this.pointSection.hidden = true;
    this.showPictures(this.wantsPictures);
  }

  addThemeButton(button: HTMLElement): void {
    this.tail.prepend(button);
  }

  setTitle(title: string): void {
    this.title.textContent = this.title.title = title;
    document.title = `${title} · Saccade`;
  }

  setConnection(state: ConnectionState): void {
    const [look, text] = kStates[state];
    this.status.dataset["state"] = look;
    this.status.textContent = text;
  }

  setDocument(shown: SceneDocument): void {
    this.setTitle(shown.title);
    this.kind.textContent = kKinds[shown.kind];
    this.live.hidden = !shown.live;
    fill(this.facts, shown.facts.length > 0 ? factsTable(shown.facts) : h("p", { class: "empty" }, "Nothing is known yet."));
    this.pointSection.hidden = !shown.layers.some((layer) => layer.kind === "points" && layer.size_m === undefined);
  }

  /** What the step that the player is at changes. */
  draw(shown: SceneDocument): void {
    const step = this.player.step;
    this.bar.set(shown);
    this.stage.classList.toggle("with-steps", shown.steps.length > 1);
    this.step.set(shown, step);
    this.layers.set(shown, step);
    const pictures = shown.steps[step]?.pictures ?? [];
    this.picturesToggle.element.hidden = shown.steps.every((each) => each.pictures.length === 0);
    if (JSON.stringify(pictures) === this.shownPictures) return; // no flicker when a run goes on
    this.shownPictures = JSON.stringify(pictures);
    fill(this.pictures, ...thumbnails(pictures));
  }

  togglePictures(): void {
    this.showPictures(!this.wantsPictures);
  }

  toggleNavigation(): void {
    this.navigation.element.querySelector<HTMLElement>('[aria-checked="false"]')?.click();
  }

  fold(): void {
    this.root.classList.toggle("folded");
  }

  private showPictures(show: boolean): void {
    this.wantsPictures = show;
    this.pictures.hidden = !show;
    this.picturesToggle.set(show);
    remember("show.pictures", show);
  }
}
