// SPDX-License-Identifier: Apache-2.0
// Keys of the page, and the sheet that lists them.
import { h, takesText } from "./dom";
import { openSheet } from "./dialog";

export interface Shortcut {
  keys: readonly string[]; // as in "Ctrl+Shift+Z", "?", "F2"; the first one is shown
  group: string;
  text: string;
  run(event: KeyboardEvent): void;
  /** Also shown, without being a key by itself. */
  shown?: string;
}

/** "Ctrl+Shift+Z" of an event; Cmd counts as Ctrl. Shift is named with letters and keys with a name, not with signs. */
export function keyOf(event: KeyboardEvent): string {
  const letter = event.code.startsWith("Key") ? event.code.slice(3) : null;
  const digit = event.code.startsWith("Digit") ? event.code.slice(5) : null;
  const named = letter !== null || digit !== null || event.key.length > 1 || event.key === " ";
  let key = event.key === " " ? "Space" : event.key;
  // Letters are taken as they are printed on the key, whatever Alt makes of them; digits by their place.
  if (letter !== null) key = /^[a-z]$/i.test(event.key) ? event.key.toUpperCase() : letter;
  else if (digit !== null) key = digit;
  const modifiers = [
    event.ctrlKey || event.metaKey ? "Ctrl" : "",
    event.altKey ? "Alt" : "",
    event.shiftKey && named ? "Shift" : "",
  ].filter((name) => name !== "");
  return [...modifiers, key].join("+");
}

export class Shortcuts {
  private readonly known: Shortcut[] = [];
  /** Keys that the view has at the moment. */
  taken: (key: string) => boolean = () => false;

  constructor() {
    window.addEventListener("keydown", (event) => this.handle(event));
  }

  add(...shortcuts: readonly Shortcut[]): void {
    this.known.push(...shortcuts);
  }

  showHelp(): void {
    const groups = [...new Set(this.known.map((shortcut) => shortcut.group))];
    const tables = groups.map((group) =>
      h(
        "section",
        { class: "help-group" },
        h("h2", {}, group),
        h("dl", {}, ...this.known.filter((shortcut) => shortcut.group === group && shortcut.text).flatMap(helpRow)),
      ),
    );
    openSheet("Keyboard and mouse", { wide: true }, h("div", { class: "help" }, ...tables));
  }

  private handle(event: KeyboardEvent): void {
    const key = keyOf(event);
    const plain = !key.startsWith("Ctrl+");
    if (event.defaultPrevented || (plain && takesText(event.target)) || this.taken(key)) return;
    if (document.querySelector("dialog[open]")) return;
    // Signs such as ? may stand on digit keys.
    const sign = event.ctrlKey || event.metaKey || event.altKey ? key : event.key;
    const found =
      this.known.find((shortcut) => shortcut.keys.includes(key)) ??
      this.known.find((shortcut) => shortcut.keys.includes(sign));
    if (!found) return;
    event.preventDefault();
    found.run(event);
  }
}

function helpRow(shortcut: Shortcut): HTMLElement[] {
  const shown = shortcut.shown ?? shortcut.keys[0] ?? "";
  const keys = shown.split(" ").map((word) => (word === "or" || word === "–" ? word : h("kbd", {}, word)));
  return [h("dt", {}, ...keys), h("dd", {}, shortcut.text)];
}
