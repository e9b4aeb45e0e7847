// SPDX-License-Identifier: Apache-2.0
// A list of any length of which only the rows in view are elements.
import { h, on } from "./dom";

const kMargin = 4; // rows beyond the edges

export class VirtualList<T> {
  private readonly spacer = h("div", { class: "virtual-spacer" });
  readonly element: HTMLElement;
  private items: readonly T[] = [];
  private focused = 0;

  constructor(
    label: string,
    private readonly rowHeight_px: number,
    private readonly makeRow: (item: T) => HTMLElement,
    private readonly chosen: (item: T) => void,
  ) {
    this.element = h("div", { class: "virtual-list", role: "listbox", tabindex: 0, "aria-label": label }, this.spacer);
    on(this.element, { scroll: () => this.draw(), keydown: (event) => this.key(event) });
    new ResizeObserver(() => this.draw()).observe(this.element);
  }

  set(items: readonly T[]): void {
    this.items = items;
    this.focused = Math.min(this.focused, Math.max(0, items.length - 1));
    this.spacer.style.height = `${items.length * this.rowHeight_px}px`;
    this.draw();
  }

  show(index: number): void {
    if (index < 0) return;
    this.focused = index;
    const top = index * this.rowHeight_px;
    const room = this.element.clientHeight - this.rowHeight_px;
    if (top < this.element.scrollTop) this.element.scrollTop = top;
    else if (top > this.element.scrollTop + room) this.element.scrollTop = top - room;
    this.draw();
  }

  private key(event: KeyboardEvent): void {
    const page = Math.max(1, Math.floor(this.element.clientHeight / this.rowHeight_px) - 1);
    const steps: Record<string, number> = {
      ArrowDown: 1,
      ArrowUp: -1,
      PageDown: page,
      PageUp: -page,
      Home: -Infinity,
      End: Infinity,
    };
    const step = steps[event.key];
    if (step === undefined || this.items.length === 0) return;
    event.preventDefault();
    event.stopPropagation();
    this.show(Math.max(0, Math.min(this.items.length - 1, this.focused + step)));
    const item = this.items[this.focused];
    if (item !== undefined) this.chosen(item);
  }

  private draw(): void {
    const first = Math.max(0, Math.floor(this.element.scrollTop / this.rowHeight_px) - kMargin);
    const count = Math.ceil(this.element.clientHeight / this.rowHeight_px) + 2 * kMargin;
    const rows = this.items.slice(first, first + count).map((item, i) => {
      const row = this.makeRow(item);
      row.style.transform = `translateY(${(first + i) * this.rowHeight_px}px)`;
      row.setAttribute("role", "option");
      on(row, {
        click: () => {
          this.focused = first + i;
          this.chosen(item);
        },
      });
      return row;
    });
    this.spacer.replaceChildren(...rows);
  }
}
