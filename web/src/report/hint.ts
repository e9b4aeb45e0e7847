// SPDX-License-Identifier: Apache-2.0
// Definitions on hover and focus: one hint for the page, next to what it explains.
import { h, on } from "../ui/dom";

let hint: HTMLElement | null = null;
let owner: HTMLElement | null = null;
let numbered = 0;

function place(target: HTMLElement, text: string): void {
  hint ??= document.body.appendChild(h("div", { class: "hint", role: "tooltip", hidden: true }));
  hint.textContent = text;
  hint.hidden = false;
  owner = target;
  const at = target.getBoundingClientRect();
  const box = hint.getBoundingClientRect();
  const left = Math.min(Math.max(8, at.left), document.documentElement.clientWidth - box.width - 8);
  const above = at.bottom + box.height + 8 > window.innerHeight;
  hint.style.left = `${left + window.scrollX}px`;
  hint.style.top = `${(above ? at.top - box.height - 6 : at.bottom + 6) + window.scrollY}px`;
}

function hide(target?: HTMLElement): void {
  if (!hint || (target && owner !== target)) return;
  hint.hidden = true;
  owner = null;
}

window.addEventListener("keydown", (event) => {
  if (event.key === "Escape") hide();
});

/** Shows the definition while the element is pointed at or has the focus; screen readers read it with the element. */
export function withDefinition<T extends HTMLElement>(element: T, definition: string | undefined): T {
  if (!definition) return element;
  const id = `definition-${++numbered}`;
  element.classList.add("defined");
  element.setAttribute("aria-describedby", id);
  element.append(h("span", { id, hidden: true }, definition));
  return on(element, {
    mouseenter: () => place(element, definition),
    mouseleave: () => hide(element),
    focus: () => place(element, definition),
    blur: () => hide(element),
    click: () => place(element, definition),
  });
}
