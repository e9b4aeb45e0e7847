// SPDX-License-Identifier: Apache-2.0
// A bar that says what the page waits for.
import { h } from "./dom";

export class ProgressCard {
  private readonly name = h("span");
  private readonly share = h("span", { class: "soft number" });
  private readonly bar = h("progress", { max: 1, "aria-label": "Loading" });
  readonly element = h(
    "div",
    { class: "progress", role: "status", hidden: true },
    h("div", { class: "progress-text" }, this.name, this.share),
    this.bar,
  );

  /** total 0: not known. `corner`: something can be seen already. */
  show(stage: string, done: number, total: number, corner = false): void {
    this.element.hidden = false;
    this.element.classList.toggle("corner", corner);
    this.name.textContent = stage;
    this.share.textContent = total > 0 ? `${Math.floor((100 * done) / total)} %` : "";
    if (total > 0) this.bar.value = done / total;
    else this.bar.removeAttribute("value");
  }

  hide(): void {
    this.element.hidden = true;
  }
}
