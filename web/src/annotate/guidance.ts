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

interface Offer {
  point: number;
  label: number; // that the place has now
}

const kRest_ms = 400; // after the last change the heat map is asked for anew

export class Guidance {
  private timer = 0;
  private asking = false;
  private offer: Offer | null = null; // where the ring is
  private accepting = false;
  private acceptButton: HTMLButtonElement | null = null;

  constructor(
    private readonly store: Store,
    private readonly session: Session,
    private readonly viewer: Viewer,
  ) {
    store.watch(["margins"], ({ margins }) => {
      if (margins) void this.bring();
      else viewer.cloud.setMargins(null);
    });
    store.watch(["cloud"], () => void (this.offer = null));
    const renew = (): void => {
      if (!store.state.margins) return;
      clearTimeout(this.timer);
      this.timer = window.setTimeout(() => void this.bring(), kRest_ms);
    };
    session.onChange(renew);
    session.tiles.onTiles(renew);
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
    this.offer = typeof point === "number" ? { point, label: Number(label) || 0 } : null;
    if (typeof point !== "number") {
      this.viewer.cloud.mark(null);
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

  /**
   * A control point where the ring is, and on to the next place. `own`: with the label that the place has now. Until the
   * ring is at the next place nothing is accepted: that place has not been seen.
   */
  async accept(own: boolean): Promise<void> {
    if (this.accepting) return;
    this.setAccepting(true);
    try {
      if (!this.offer || (await this.setControl(this.offer, own))) await this.jump();
    } finally {
      this.setAccepting(false);
    }
  }

  private async setControl({ point, label }: Offer, own: boolean): Promise<boolean> {
    const { cloud } = this.viewer;
    const now = cloud.positionOf(point) === undefined ? label : cloud.labelOf(point);
    const given = own && now !== 0 ? now : this.store.state.label;
    return (await this.session.act({ do: "set", label: given, points: [point] })) !== null;
  }

  private setAccepting(accepting: boolean): void {
    this.accepting = accepting;
    this.acceptButton?.setAttribute("aria-disabled", String(accepting)); // it keeps the focus
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
    const accept = textButton("Accept its label", () => void this.accept(true), {
      icon: "set",
      kind: "outline",
      title: "A control point there with the label that the place has, and on to the next (A); with the chosen label: Shift+A",
    });
    this.acceptButton = accept;
    this.store.watch(["readOnly"], ({ readOnly }) => void (accept.disabled = readOnly !== null));
    return section("Guidance", {}, h("div", { class: "toggle-row" }, heat.element, next), h("div", { class: "toggle-row" }, accept));
  }

  private async bringTiles(): Promise<void> {
    try {
      await this.session.tiles.margins();
    } catch {
      this.store.set({ margins: false });
    }
    this.asking = false;
  }

  private async bring(): Promise<void> {
    if (!this.store.state.cloud) return;
    if (this.asking) {
      clearTimeout(this.timer);
      this.timer = window.setTimeout(() => void this.bring(), kRest_ms);
      return;
    }
    this.asking = true;
    if (this.store.state.cloud.tiles !== undefined) return this.bringTiles();
    const answer = await this.session.ask({ type: "margins" });
    this.asking = false;
    if (!answer || !this.store.state.margins) {
      if (!answer) this.store.set({ margins: false });
      return;
    }
    this.viewer.cloud.setMargins(new Uint8Array(answer.body, 0, Number(answer.head["count"])));
  }
}
