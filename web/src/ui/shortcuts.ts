// SPDX-License-Identifier: Apache-2.0
// Keys of the page, and the sheet that lists them.
import { h, takesText } from "./dom";
import { openSheet } from "./dialog";

/** A row of the sheet. `run` is told which of the keys it was. */
export interface Shortcut {
  keys: readonly string[]; // as in "Ctrl+Shift+Z", "?", "F2"
  or?: readonly string[]; // that do the same as the first of them
  group: string;
  text: string;
  run(which: number): void;
}

/** A row of the sheet about the mouse, or about keys that the view has. */
export interface Gesture {
  shown: string;
  group: string;
  text: string;
}

/** Keys with two signs, and one without any. */
const kSame: Record<string, string> = { "=": "+", "−": "-", " ": "Space" };

/** "Ctrl+Shift+Z" of an event; Cmd counts as Ctrl. Shift is named with letters and keys with a name, not with signs. */
export function keyOf(event: KeyboardEvent): string {
  const letter = event.code.startsWith("Key") ? event.code.slice(3) : null;
  const digit = event.code.startsWith("Digit") ? event.code.slice(5) : null;
  const named = letter !== null || digit !== null || event.key.length > 1 || event.key === " ";
  let key = kSame[event.key] ?? event.key;
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
  private readonly known: (Shortcut | Gesture)[] = [];
  /** Keys that the view has at the moment. */
  taken: (key: string) => boolean = () => false;

  constructor() {
    window.addEventListener("keydown", (event) => this.handle(event));
  }

  add(...shortcuts: readonly (Shortcut | Gesture)[]): void {
    this.known.push(...shortcuts);
  }

  showHelp(): void {
    const groups = [...new Set(this.known.map((shortcut) => shortcut.group))];
    const tables = groups.map((group) =>
      h(
        "section",
        { class: "help-group" },
        h("h2", {}, group),
        h("dl", {}, ...this.known.filter((row) => row.group === group).flatMap(helpRow)),
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
    const sign = event.ctrlKey || event.metaKey || event.altKey ? key : (kSame[event.key] ?? event.key);
    const found = this.find(key) ?? this.find(sign);
    if (!found) return;
    event.preventDefault();
    found();
  }

  private find(key: string): (() => void) | undefined {
    for (const row of this.known) {
      if (!("keys" in row)) continue;
      const which = row.or?.includes(key) ? 0 : row.keys.indexOf(key);
      if (which >= 0) return () => row.run(which);
    }
    return undefined;
  }
}

const kNames: Record<string, string> = {
  ArrowLeft: "←",
  ArrowRight: "→",
  Escape: "Esc",
  PageUp: "PgUp",
  PageDown: "PgDn",
  "-": "−",
};

function named(key: string): string {
  const parts = /^((?:\w+\+)*)(.+)$/.exec(key);
  return parts ? `${parts[1]}${kNames[parts[2]!] ?? parts[2]}` : key;
}

/** "[ ]", "1 – 0", "N or Esc" */
function keysShown({ keys, or }: Shortcut): string {
  const many = keys.length > 3;
  const shown = many ? [keys[0]!, "–", keys.at(-1)!] : [...keys];
  for (const key of or ?? []) shown.push("or", key);
  return shown.map(named).join(" ");
}

function helpRow(row: Shortcut | Gesture): HTMLElement[] {
  const shown = "keys" in row ? keysShown(row) : row.shown;
  const keys = shown.split(" ").map((word) => (word === "or" || word === "–" ? word : h("kbd", {}, word)));
  return [h("dt", {}, ...keys), h("dd", {}, row.text)];
}
