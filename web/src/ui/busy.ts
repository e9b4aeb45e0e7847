// SPDX-License-Identifier: Apache-2.0
// A sign that says what the page waits for, once that takes long enough to be noticed.
import { h } from "./dom";

const kPatience_ms = 300;

export class BusySign {
  private readonly text = h("span");
  readonly element = h("div", { class: "busy", role: "status", hidden: true }, h("i", { class: "busy-wheel", "aria-hidden": "true" }), this.text);
  private readonly works = new Set<string>();

  /** Shows `what` while the work goes on. */
  async during<T>(what: string, work: Promise<T>): Promise<T> {
    const timer = window.setTimeout(() => this.begin(what), kPatience_ms);
    try {
      return await work;
    } finally {
      clearTimeout(timer);
      this.end(what);
    }
  }

  /** Shows `what` at once, before work that stops the page; it begins when the sign is seen. */
  async before<T>(what: string, work: () => T): Promise<T> {
    this.begin(what);
    await new Promise((seen) => requestAnimationFrame(() => setTimeout(seen)));
    try {
      return work();
    } finally {
      this.end(what);
    }
  }

  private begin(what: string): void {
    this.works.add(what);
    this.draw();
  }

  private end(what: string): void {
    if (this.works.delete(what)) this.draw();
  }

  private draw(): void {
    const last = [...this.works].at(-1);
    this.element.hidden = last === undefined;
    if (last !== undefined) this.text.textContent = `${last} …`;
  }
}
