// SPDX-License-Identifier: Apache-2.0
// The step in the panel: its facts, and the way to look through its camera.
import { toggleButton } from "../ui/controls";
import { fill, h } from "../ui/dom";
import { icon } from "../ui/icons";
import type { Fact, SceneDocument } from "./document";

const kLong = 26; // characters: a line of its own

export function factsTable(facts: readonly Fact[]): HTMLElement {
  const rows = facts.flatMap(([name, text]) => {
    const kind = text.length > kLong ? "long" : undefined;
    return [h("dt", { class: kind }, name), h("dd", { class: kind }, text)];
  });
  return h("dl", { class: "facts" }, ...rows);
}

export class StepPanel {
  readonly element = h("section", { class: "section step-panel", "aria-label": "Step" });
  private readonly title = h("h2");
  private readonly place = h("span", { class: "aside" });
  private readonly facts = h("div");
  private readonly lookThrough: ReturnType<typeof toggleButton>;

  constructor(look: (through: boolean) => void) {
    this.lookThrough = toggleButton([icon("camera"), h("span", {}, "Look through the camera")], "Look through the camera", "The view of this step, from where the camera was (C)", look);
    this.lookThrough.element.classList.add("wide");
    this.element.append(h("header", { class: "section-head" }, this.title, this.place), this.lookThrough.element, this.facts);
  }

  set(document: SceneDocument, index: number): void {
    const step = document.steps[index];
    this.element.hidden = step === undefined;
    if (!step) return;
    this.title.textContent = step.name;
    this.place.textContent = document.steps.length > 1 ? `${index + 1} of ${document.steps.length}` : "";
    fill(this.facts, step.facts.length > 0 ? factsTable(step.facts) : null);
    this.lookThrough.element.hidden = step.T_world_camera === null;
  }

  setLooking(through: boolean): void {
    this.lookThrough.set(through);
  }
}
