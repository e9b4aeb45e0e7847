// SPDX-License-Identifier: Apache-2.0
// Dialogs: a sheet over the page that Escape closes.
import { type Child, h, on } from "./dom";
import { iconButton, textButton } from "./controls";

export interface Sheet {
  element: HTMLDialogElement;
  close(): void;
}

export function openSheet(title: string, options: { wide?: boolean }, ...children: Child[]): Sheet {
  const before = document.activeElement;
  const element = h("dialog", { class: options.wide ? "sheet wide" : "sheet", "aria-label": title });
  const close = () => element.close();
  element.append(h("header", { class: "sheet-head" }, h("h1", {}, title), iconButton("close", "Close", close)));
  element.append(
    h(
      "div",
      { class: "sheet-body", tabindex: -1, autofocus: true },
      ...children.filter((child): child is Node | string => !!child),
    ),
  );
  on(element, {
    close: () => {
      element.remove();
      if (before instanceof HTMLElement) before.focus();
    },
    click: (event) => {
      if (event.target === element) close();
    },
    keydown: (event) => event.stopPropagation(),
  });
  document.body.append(element);
  element.showModal();
  return { element, close };
}

/** Whether the person wants it. */
export function confirm(title: string, text: string, yes: string): Promise<boolean> {
  return new Promise((resolve) => {
    let answer = false;
    const accept = textButton(
      yes,
      () => {
        answer = true;
        sheet.close();
      },
      { kind: "primary" },
    );
    const refuse = textButton("Cancel", () => sheet.close());
    const sheet = openSheet(title, {}, h("p", {}, text), h("footer", { class: "sheet-foot" }, refuse, accept));
    sheet.element.addEventListener("close", () => resolve(answer));
    accept.focus();
  });
}
