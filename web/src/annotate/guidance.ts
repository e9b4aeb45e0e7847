// SPDX-License-Identifier: Apache-2.0
// Where labels are in doubt, and where a click would help most.
import { section, textButton, toggleButton } from "../ui/controls";
import { h } from "../ui/dom";
import { grouped } from "../ui/figures";
import { icon } from "../ui/icons";
import { toast } from "../ui/toast";
import type { Viewer } from "../view/types";
import type { Session } from "./session";
import type { Store } from "./store";

const kRest_ms = 400; // after the last change the heat map is asked for anew

export class Guidance {
  private timer = 0;
  private asking = false;

  constructor(
    private readonly store: Store,
    private readonly session: Session,
    private readonly viewer: Viewer,
  ) {
    store.watch(["margins"], ({ margins }) => {
      if (margins) void this.bring();
      else viewer.cloud.setMargins(null);
    });
    session.onChange(() => {
      if (!store.state.margins) return;
      clearTimeout(this.timer);
      this.timer = window.setTimeout(() => void this.bring(), kRest_ms);
    });
  }

  toggle(): void {
    this.store.set({ margins: !this.store.state.margins });
  }

  async jump(): Promise<void> {
    const answer = await this.session.ask({ type: "next_best_click" });
    if (!answer) return;
    const { point, position, label, gain } = answer.head as {
      point?: unknown;
      position?: unknown;
      label?: unknown;
      gain?: unknown;
    };
    if (typeof point !== "number") {
      toast("There is no place where one more click would help.");
      return;
    }
    const place = position as [number, number, number];
    this.viewer.camera.goTo(place);
    this.viewer.cloud.mark(place);
    const settles =
      typeof gain === "number" && gain >= 1
        ? ` A click there settles about ${grouped(gain)} points.`
        : "";
    toast(`The ring is where labels are most in doubt${label ? `; now it is label ${String(label)}` : ""}.${settles}`);
  }

  section(): HTMLElement {
    const heat = toggleButton(
      [icon("heat"), h("span", {}, "Heat map")],
      "Heat map of doubt",
      "Shows where labels are in doubt (M)",
      () => this.toggle(),
    );
    heat.element.classList.add("outline");
    this.store.watch(["margins"], ({ margins }) => heat.set(margins));
    const next = textButton("Next best click", () => void this.jump(), {
      icon: "target",
      kind: "outline",
      title: "Goes to where one more control point helps most (G)",
    });
    return section("Guidance", {}, h("div", { class: "toggle-row" }, heat.element, next));
  }

  private async bring(): Promise<void> {
    if (!this.store.state.cloud) return;
    if (this.asking) {
      clearTimeout(this.timer);
      this.timer = window.setTimeout(() => void this.bring(), kRest_ms);
      return;
    }
    this.asking = true;
    const answer = await this.session.ask({ type: "margins" });
    this.asking = false;
    if (!answer || !this.store.state.margins) {
      if (!answer) this.store.set({ margins: false });
      return;
    }
    this.viewer.cloud.setMargins(new Uint8Array(answer.body, 0, Number(answer.head["count"])));
  }
}
