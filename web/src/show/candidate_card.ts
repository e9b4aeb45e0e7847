// SPDX-License-Identifier: Apache-2.0
// Candidates under the cursor: their gain on a tip; of the one that was clicked, a card.
import { iconButton, textButton } from "../ui/controls";
import { fill, h, on } from "../ui/dom";
import { grouped } from "../ui/figures";
import type { LayerPick, Viewer } from "../view/types";
import { kUsualFov_rad } from "./document";
import { gainText, rankOf } from "./gains";
import type { Scene } from "./scene";
import { kTrail } from "./trail";

const kStill_px = 4; // a click moves no farther

export interface CandidateActions {
  lookFrom(rows: number[][], fov_rad: readonly [number, number], name: string): void;
  goTo(item: number): void; // index in the trail
  trailName(item: number): string;
}

export class CandidateCard {
  readonly tip = h("div", { class: "tip", hidden: true, role: "tooltip" });
  readonly card = h("div", { class: "floating candidate", hidden: true, role: "group", "aria-label": "Candidate" });
  private pinned: LayerPick | null = null;
  private hovered: LayerPick | null = null;
  private asked = false;

  constructor(
    private readonly viewer: Viewer,
    private readonly scene: Scene,
    private readonly actions: CandidateActions,
  ) {
    let down: [number, number] = [0, 0];
    on(viewer.element, {
      pointerdown: (event) => void (down = [event.clientX, event.clientY]),
      pointermove: (event) => this.move(event),
      pointerleave: () => this.hover(null, 0, 0),
      click: (event) => {
        if (Math.hypot(event.clientX - down[0], event.clientY - down[1]) < kStill_px) this.click(...this.at(event));
      },
    });
  }

  /** The step is another one: what was pinned is gone. */
  clear(): void {
    this.pinned = this.hovered = null;
    this.tip.hidden = this.card.hidden = true;
  }

  private at(event: MouseEvent): [number, number] {
    const box = this.viewer.element.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  private move(event: PointerEvent): void {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      const [x, y] = this.at(event);
      this.hover(event.buttons === 0 ? this.viewer.layers.pickView(x, y) : null, x, y);
    });
  }

  private hover(pick: LayerPick | null, x: number, y: number): void {
    const text = pick ? this.text(pick) : undefined;
    this.tip.hidden = text === undefined;
    if (text !== undefined) {
      this.tip.textContent = text;
      this.tip.style.transform = `translate(${x + 14}px, ${y + 14}px)`;
    }
    if (pick?.layer === this.hovered?.layer && pick?.item === this.hovered?.item) return;
    const before = this.hovered;
    this.hovered = pick;
    if (before) this.mark(before.layer);
    if (pick) this.mark(pick.layer);
  }

  private click(x: number, y: number): void {
    const pick = this.viewer.layers.pickView(x, y);
    if (pick?.layer === kTrail) return this.actions.goTo(pick.item);
    const before = this.pinned;
    this.pinned = pick;
    if (before) this.mark(before.layer);
    this.drawCard();
  }

  private drawCard(): void {
    const pick = this.pinned;
    const found = pick && this.scene.candidatesIn(pick.layer);
    this.card.hidden = !found;
    if (!pick || !found) return;
    this.mark(pick.layer);
    const name = `Candidate ${pick.item + 1}`;
    const look = () => {
      const rows = this.scene.poseOf(pick.layer, pick.item);
      if (rows) this.actions.lookFrom(rows, found.layer.fov_rad ?? kUsualFov_rad, name);
    };
    const close = () => {
      this.pinned = null;
      this.mark(pick.layer);
      this.card.hidden = true;
    };
    fill(this.card, h("div", { class: "candidate-text" }, h("strong", {}, name), h("span", {}, this.text(pick))), textButton("Look from here", look, { icon: "camera" }), iconButton("close", "Close", close));
  }

  /** The hovered one stands out, else the pinned one, else the best. */
  private mark(layer: string): void {
    const found = this.scene.candidatesIn(layer);
    if (!found) return;
    const one = [this.hovered, this.pinned].find((pick) => pick?.layer === layer);
    this.viewer.layers.select(layer, one?.item ?? (found.gains.best >= 0 ? found.gains.best : null));
  }

  private text(pick: LayerPick): string | undefined {
    if (pick.layer === kTrail) return this.actions.trailName(pick.item);
    const found = this.scene.candidatesIn(pick.layer);
    if (!found) return undefined;
    const gain = found.gains.gains[pick.item] ?? Number.NaN;
    if (Number.isNaN(gain)) return "Gain not known";
    const rank = rankOf(found.gains, pick.item);
    return `Gain ${gainText(gain)} · ${rank === 1 ? "the best" : `number ${rank}`} of ${grouped(found.layer.count)}`;
  }
}
