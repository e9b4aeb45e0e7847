// SPDX-License-Identifier: Apache-2.0
// Twenty labels as buttons in their colours, page by page. Thesis Fig. 4.17.
import { h, on } from "../ui/dom";
import { compact, grouped } from "../ui/figures";
import type { LabelRow } from "../protocol";
import { textOn } from "../ui/colors";
import { type Store, isEmpty, kMaxLabel, kPage, pageOf, rowOf } from "./store";

export class LabelGrid {
  private readonly buttons: HTMLButtonElement[] = [];
  readonly element: HTMLElement;

  constructor(private readonly store: Store) {
    for (let i = 0; i < kPage; i++) {
      const button = h("button", { type: "button", role: "radio", class: "label-button" }, h("b"), h("small"));
      on(button, { click: () => this.choose(pageOf(this.store.state.label) + i) });
      this.buttons.push(button);
    }
    this.element = h("div", { class: "label-grid", role: "radiogroup", "aria-label": "Labels" }, ...this.buttons);
    on(this.element, {
      keydown: (event) => {
        const step = { ArrowRight: 1, ArrowLeft: -1, ArrowDown: 10, ArrowUp: -10 }[event.key];
        if (step === undefined) return;
        event.preventDefault();
        event.stopPropagation();
        this.choose(this.store.state.label + step);
        this.buttons[this.store.state.label - pageOf(this.store.state.label)]?.focus();
      },
    });
    store.watch(["label", "labels", "hidden"], () => this.draw());
  }

  private choose(label: number): void {
    if (label >= 1 && label <= kMaxLabel) this.store.set({ label });
  }

  private draw(): void {
    const state = this.store.state;
    const first = pageOf(state.label);
    this.buttons.forEach((button, i) => {
      const row = rowOf(state, first + i);
      const empty = isEmpty(row);
      const chosen = row.number === state.label;
      button.hidden = row.number > kMaxLabel;
      button.style.setProperty("--label", row.color);
      button.style.setProperty("--on-label", textOn(row.color));
      button.classList.toggle("empty", empty);
      button.classList.toggle("off", state.hidden.has(row.number));
      button.setAttribute("aria-checked", String(chosen));
      button.tabIndex = chosen ? 0 : -1;
      button.children[0]!.textContent = String(row.control_points);
      button.children[1]!.textContent = empty ? "" : compact(row.points);
      const text = describeLabel(row);
      button.title = text + (state.hidden.has(row.number) ? "\nHidden" : "");
      button.setAttribute("aria-label", text);
    });
  }
}

export function describeLabel(row: LabelRow): string {
  const name = row.name ? ` ${row.name}` : "";
  if (isEmpty(row)) return `Label ${row.number}${name}: empty`;
  const control = row.control_points === 1 ? "1 control point" : `${row.control_points} control points`;
  return `Label ${row.number}${name}: ${control}, ${grouped(row.points)} points`;
}
