// SPDX-License-Identifier: Apache-2.0
// Short messages at the lower edge, read out by screen readers.
import { h, on } from "./dom";
import { iconButton, textButton } from "./controls";

export interface ToastOptions {
  kind?: "info" | "error";
  button?: { text: string; click(): void };
  stays_ms?: number;
}

const kMost = 4;
const kStays_ms = 5000;
const kErrorStays_ms = 9000;

let shelf: HTMLElement | null = null;

export function toast(text: string, options: ToastOptions = {}): void {
  shelf ??= document.body.appendChild(h("div", { class: "toasts", role: "status", "aria-live": "polite" }));
  const kind = options.kind ?? "info";
  const same = [...shelf.children].find((other) => other.querySelector("span")?.textContent === text);
  same?.remove();
  const close = () => row.remove();
  const row = h("div", { class: `toast ${kind}` }, h("span", {}, text));
  const button = options.button;
  if (button) {
    const act = () => {
      close();
      button.click();
    };
    row.append(textButton(button.text, act, { kind: "quiet" }));
  }
  row.append(iconButton("close", "Dismiss", close));
  shelf.append(row);
  while (shelf.children.length > kMost) shelf.firstElementChild?.remove();

  const stays = options.stays_ms ?? (kind === "error" ? kErrorStays_ms : kStays_ms);
  let timer = window.setTimeout(close, stays);
  on(row, {
    pointerenter: () => clearTimeout(timer),
    pointerleave: () => void (timer = window.setTimeout(close, stays)),
  });
}
