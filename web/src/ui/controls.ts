// SPDX-License-Identifier: Apache-2.0
// Buttons, switches, sliders, menus and sections of a panel.
import { type Child, fill, h, on, setAttribute } from "./dom";
import { icon, type IconName } from "./icons";

export function iconButton(name: IconName, label: string, click: (event: MouseEvent) => void): HTMLButtonElement {
  const button = h(
    "button",
    { type: "button", class: "button icon-only", "aria-label": label, title: label },
    icon(name),
  );
  return on(button, { click });
}

export function textButton(
  text: string,
  click: () => void,
  options: { icon?: IconName; title?: string; kind?: string } = {},
) {
  const button = h(
    "button",
    { type: "button", class: `button ${options.kind ?? ""}`, title: options.title },
    options.icon ? icon(options.icon) : null,
    h("span", {}, text),
  );
  return on(button, { click });
}

/** A button that is in or out. */
export function toggleButton(content: Child[], label: string, title: string, changed: (pressed: boolean) => void) {
  const button = h("button", {
    type: "button",
    class: "button toggle",
    "aria-pressed": "false",
    "aria-label": label,
    title,
  });
  fill(button, ...content);
  on(button, { click: () => changed(button.getAttribute("aria-pressed") !== "true") });
  return { element: button, set: (pressed: boolean) => button.setAttribute("aria-pressed", String(pressed)) };
}

export interface Choice<T extends string> {
  value: T;
  text: string;
  label?: string; // for screen readers, where the text is too short
  title: string;
  icon?: IconName;
}

export interface Segmented<T extends string> {
  element: HTMLElement;
  set(value: T): void;
  enable(value: T, enabled: boolean): void;
  name(value: T, label: string, title: string): void;
}

/** One of a few: a group of radio buttons, with one stop for Tab and the arrow keys within. */
export function segmented<T extends string>(
  label: string,
  choices: readonly Choice<T>[],
  changed: (value: T) => void,
): Segmented<T> {
  const buttons = new Map<T, HTMLButtonElement>();
  for (const choice of choices) {
    const button = h(
      "button",
      {
        type: "button",
        role: "radio",
        class: "segment",
        "aria-label": choice.label ?? choice.text,
        title: choice.title,
      },
      choice.icon ? icon(choice.icon) : null,
      choice.text ? h("span", {}, choice.text) : null,
    );
    buttons.set(choice.value, on(button, { click: () => changed(choice.value) }));
  }
  const element = h("div", { class: "segmented", role: "radiogroup", "aria-label": label }, ...buttons.values());
  on(element, {
    keydown: (event) => {
      const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
      if (step === undefined) return;
      event.preventDefault();
      event.stopPropagation();
      const enabled = [...buttons.values()].filter((button) => !button.disabled);
      const at = enabled.findIndex((button) => button.getAttribute("aria-checked") === "true");
      const next = enabled[(at + step + enabled.length) % enabled.length];
      next?.focus();
      next?.click();
    },
  });
  return {
    element,
    set: (value) => {
      for (const [known, button] of buttons) {
        button.setAttribute("aria-checked", String(known === value));
        button.tabIndex = known === value ? 0 : -1;
      }
    },
    enable: (value, enabled) => {
      const button = buttons.get(value);
      if (button) button.disabled = !enabled;
    },
    name: (value, name, title) => {
      const button = buttons.get(value);
      setAttribute(button!, "aria-label", name);
      setAttribute(button!, "title", title);
    },
  };
}

export interface Slider {
  element: HTMLElement;
  input: HTMLInputElement;
  set(position: number, text: string): void;
}

/** `input` while it is dragged, `change` when it is let go. Positions are whole numbers. */
export function slider(
  label: string,
  range: { min: number; max: number; title?: string },
  input: (position: number) => void,
  change: (position: number) => void = () => undefined,
): Slider {
  const field = h("input", {
    type: "range",
    min: range.min,
    max: range.max,
    step: 1,
    "aria-label": label,
    title: range.title,
  });
  const value = h("output", { class: "slider-value" });
  on(field, { input: () => input(field.valueAsNumber), change: () => change(field.valueAsNumber) });
  return {
    element: h("label", { class: "slider" }, h("span", { class: "slider-name" }, label), field, value),
    input: field,
    set: (position, text) => {
      field.value = String(position);
      value.textContent = text;
      field.setAttribute("aria-valuetext", text);
    },
  };
}

export function checkbox(label: string, title: string, changed: (checked: boolean) => void) {
  const field = h("input", { type: "checkbox" });
  on(field, { change: () => changed(field.checked) });
  const element = h("label", { class: "checkbox", title }, field, h("span", {}, label));
  return { element, set: (checked: boolean) => void (field.checked = checked) };
}

/** A part of a panel; with `fold` it can be folded up. */
export function section(
  title: string,
  options: { fold?: boolean; open?: boolean; aside?: Node },
  ...children: Child[]
): HTMLElement {
  if (!options.fold) {
    const head = h("header", { class: "section-head" }, h("h2", {}, title), options.aside ?? null);
    return h("section", { class: "section", "aria-label": title }, head, ...children);
  }
  const summary = h("summary", { class: "section-head" }, h("h2", {}, title), options.aside ?? null, icon("down"));
  return h(
    "details",
    { class: "section", open: options.open ?? false },
    summary,
    h("div", { class: "section-body" }, ...children),
  );
}

export interface MenuItem {
  text: string;
  hint?: string;
  icon?: IconName;
  choose(): void;
}

/** A button that opens a list of commands below it. */
export function menuButton(button: HTMLButtonElement, label: string, items: () => MenuItem[]): HTMLElement {
  const menu = h("div", { class: "menu", role: "menu", "aria-label": label, hidden: true });
  const wrap = h("div", { class: "menu-wrap" }, button, menu);
  setAttribute(button, "aria-haspopup", "menu");
  const close = (focus: boolean) => {
    menu.hidden = true;
    button.setAttribute("aria-expanded", "false");
    if (focus) button.focus();
  };
  const open = () => {
    fill(menu, ...items().map((item) => menuRow(item, close)));
    menu.hidden = false;
    button.setAttribute("aria-expanded", "true");
    menu.querySelector("button")?.focus();
  };
  close(false);
  on(button, { click: () => (menu.hidden ? open() : close(true)) });
  on(wrap, {
    focusout: (event) => {
      if (!wrap.contains(event.relatedTarget as Node | null)) close(false);
    },
    keydown: (event) => {
      const rows = [...menu.querySelectorAll("button")];
      const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
      if (event.key === "Escape" && !menu.hidden) close(true);
      else if (step !== undefined && !menu.hidden) {
        const at = rows.indexOf(document.activeElement as HTMLButtonElement);
        rows[(at + step + rows.length) % rows.length]?.focus();
      } else return;
      event.preventDefault();
      event.stopPropagation();
    },
  });
  return wrap;
}

function menuRow(item: MenuItem, close: (focus: boolean) => void): HTMLElement {
  const row = h(
    "button",
    { type: "button", role: "menuitem", class: "menu-row" },
    item.icon ? icon(item.icon) : null,
    h("span", {}, item.text),
    item.hint ? h("span", { class: "hint" }, item.hint) : null,
  );
  return on(row, {
    click: () => {
      close(true);
      item.choose();
    },
  });
}
