// SPDX-License-Identifier: Apache-2.0
// Light, dark, or as the system has it.
import { iconButton } from "./controls";
import { icon } from "./icons";
import { oneOf, recall, remember } from "./settings";

export type Theme = "auto" | "light" | "dark";

const kOrder: readonly Theme[] = ["auto", "light", "dark"];
const kNames: Record<Theme, string> = { auto: "as the system", light: "light", dark: "dark" };

export class ThemeSwitch {
  private theme: Theme = recall("theme", "auto", oneOf("auto", "light", "dark"));
  private readonly system = matchMedia("(prefers-color-scheme: dark)");
  readonly button = iconButton("auto", "Theme", () => this.next());

  constructor(private readonly changed: (dark: boolean) => void) {
    this.system.addEventListener("change", () => this.apply());
    this.apply();
  }

  next(): void {
    this.theme = kOrder[(kOrder.indexOf(this.theme) + 1) % kOrder.length]!;
    remember("theme", this.theme);
    this.apply();
  }

  private apply(): void {
    const dark = this.theme === "dark" || (this.theme === "auto" && this.system.matches);
    document.documentElement.dataset["theme"] = dark ? "dark" : "light";
    this.button.replaceChildren(icon(this.theme));
    const title = `Theme: ${kNames[this.theme]}`;
    this.button.title = title;
    this.button.setAttribute("aria-label", title);
    this.changed(dark);
  }
}
