// SPDX-License-Identifier: Apache-2.0
// The bar below the view: steps forth and back, a slider through them, and play.
import { iconButton } from "../ui/controls";
import { h, on, setAttribute } from "../ui/dom";
import { icon } from "../ui/icons";
import type { SceneDocument } from "./document";
import type { Player } from "./player";

export class StepBar {
  readonly element: HTMLElement;
  private readonly buttons: { back: HTMLButtonElement[]; forth: HTMLButtonElement[]; play: HTMLButtonElement };
  private readonly slider = h("input", { type: "range", min: 0, step: 1, "aria-label": "Step" });
  private readonly name = h("output", { class: "step-name" });

  constructor(private readonly player: Player) {
    const move = (step: () => number) => () => {
      player.stop();
      player.go(step());
    };
    const first = iconButton("first", "First step (Home)", move(() => 0));
    const previous = iconButton("previous", "Previous step (←)", move(() => player.step - 1));
    const next = iconButton("next", "Next step (→)", move(() => player.step + 1));
    const last = iconButton("last", "Last step (End)", move(() => player.steps - 1));
    const play = iconButton("play", "Play (Space)", () => (player.playing ? player.stop() : player.play()));
    this.buttons = { back: [first, previous], forth: [next, last], play };
    on(this.slider, { input: move(() => this.slider.valueAsNumber) });
    this.element = h("div", { class: "step-bar", role: "group", "aria-label": "Steps" }, first, previous, play, next, last, this.slider, this.name);
  }

  set(document: SceneDocument): void {
    const { player } = this;
    this.element.hidden = document.steps.length < 2;
    const name = document.steps[player.step]?.name ?? "";
    this.slider.max = String(Math.max(0, document.steps.length - 1));
    this.slider.value = String(player.step);
    this.slider.setAttribute("aria-valuetext", name);
    const part = document.steps.length > 1 ? player.step / (document.steps.length - 1) : 0;
    this.slider.style.setProperty("--done", `${100 * part}%`);
    this.name.textContent = name;
    for (const button of this.buttons.back) button.disabled = player.step === 0;
    for (const button of this.buttons.forth) button.disabled = player.atEnd;
    this.buttons.play.replaceChildren(icon(player.playing ? "pause" : "play"));
    const label = player.playing ? "Pause (Space)" : "Play (Space)";
    setAttribute(this.buttons.play, "title", label);
    setAttribute(this.buttons.play, "aria-label", label);
  }
}
