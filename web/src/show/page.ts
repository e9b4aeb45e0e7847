// SPDX-License-Identifier: Apache-2.0
// The elements of the viewer's page: a bar, the panel, the view with its pictures and steps.
import type { Side } from "../view/standpoint";
import type { ConnectionState } from "../connection";
import { withToken } from "../token";
import { checkbox, iconButton, section, segmented, slider, toggleButton } from "../ui/controls";
import { BusySign } from "../ui/busy";
import { fill, h } from "../ui/dom";
import { drawer, foldMenu } from "../ui/fold_menu";
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
  shading(shaded: boolean): void;
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
  private readonly report = h("a", { class: "button", href: withToken("report.html"), hidden: true, title: "Measures, curves and pictures of the run" }, "Report");
  private readonly status = h("span", { class: "status", role: "status" });
  private readonly facts = h("div");
  private readonly pictures = h("div", { class: "show-pictures", role: "group", "aria-label": "Pictures" });
  private readonly picturesToggle;
  private readonly navigation;
  private readonly pointSize;
  private readonly shading;
  private readonly pointSection: HTMLElement;
  private readonly root: HTMLElement;
  private readonly tail = h("div", { class: "bar-group bar-end" });
  readonly busy = new BusySign();
  private readonly foldPanel: () => void;
  private shownPictures = "";
  private wantsPictures = recall("show.pictures", !matchMedia("(width < 860px)").matches, isBoolean);

  constructor(
    app: Element,
    private readonly player: Player,
    look: Look,
    private readonly actions: PageActions,
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
    this.shading = checkbox("Shading", "Shades points by their depth, so that shapes are seen without colours (eye-dome lighting)", (shaded) => this.setShading(shaded));
    this.pointSection = section("Points", {}, this.pointSize.element, this.shading.element);

    const bar = h(
      "header",
      { class: "bar" },
      iconButton("panel", "Panel (\\)", () => this.fold()),
      h("div", { class: "bar-group" }, this.title, this.kind, this.live, this.report),
      h("div", { class: "bar-group push" }, this.status),
      foldMenu(
        h("div", { class: "bar-group bar-end" }, this.picturesToggle.element, this.navigation.element),
        h(
          "div",
          { class: "bar-group bar-end" },
          iconButton("fit", "Everything in view (F)", () => actions.fit()),
          iconButton("top", "From the top (T)", () => actions.fit("top")),
          iconButton("front", "From the front (Shift+F)", () => actions.fit("front")),
          iconButton("side", "From the side (Shift+T)", () => actions.fit("side")),
        ),
        this.tail,
      ),
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
    this.stage = h("main", { class: "stage" }, this.view, this.pictures, this.bar.element, this.loading.element, this.busy.element);
    this.root = h("div", { class: "page show" }, bar, panel, this.stage);
    this.foldPanel = drawer(this.root, this.stage, false, () => undefined);
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
    this.report.hidden = shown.report !== true;
    fill(this.facts, shown.facts.length > 0 ? factsTable(shown.facts) : h("p", { class: "empty" }, "Nothing is known yet."));
    const points = shown.layers.filter((layer) => layer.kind === "points");
    this.pointSection.hidden = points.length === 0;
    this.pointSize.element.hidden = !points.some((layer) => layer.size_m === undefined);
  }

  /** Draws the parts of the page that depend on the player's step. */
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

  setShading(shaded: boolean): void {
    this.shading.set(shaded);
    this.actions.shading(shaded);
  }

  togglePictures(): void {
    this.showPictures(!this.wantsPictures);
  }

  toggleNavigation(): void {
    this.navigation.element.querySelector<HTMLElement>('[aria-checked="false"]')?.click();
  }

  fold(): void {
    this.foldPanel();
  }

  private showPictures(show: boolean): void {
    this.wantsPictures = show;
    this.pictures.hidden = !show;
    this.picturesToggle.set(show);
    remember("show.pictures", show);
  }
}
