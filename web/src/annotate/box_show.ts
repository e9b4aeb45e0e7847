// SPDX-License-Identifier: Apache-2.0
// Boxes around labels in the view, anew after changes.
import { toRgb } from "../ui/colors";
import type { LabelBox, Viewer } from "../view/types";
import type { Session } from "./session";
import { type Store, rowOf } from "./store";

const kRest_ms = 300; // after the last change

interface SentBox {
  label: number;
  center: number[];
  size: number[];
  axes: number[][];
}

export class BoxShow {
  private timer = 0;

  constructor(
    private readonly store: Store,
    private readonly session: Session,
    private readonly viewer: Viewer,
  ) {
    store.watch(["boxes", "hidden"], () => void this.bring());
    session.onChange(() => {
      if (!store.state.boxes) return;
      clearTimeout(this.timer);
      this.timer = window.setTimeout(() => void this.bring(), kRest_ms);
    });
  }

  private async bring(): Promise<void> {
    const { boxes, cloud, ready } = this.store.state;
    if (!boxes || !cloud || !ready) return this.viewer.cloud.setBoxes([]);
    const answer = await this.session.ask({ type: "boxes" });
    const state = this.store.state;
    if (!answer || !state.boxes) return;
    const sent = (answer.head["boxes"] as SentBox[]).filter(({ label }) => !state.hidden.has(label));
    const shown: LabelBox[] = sent.map((box) => ({ ...box, color: toRgb(rowOf(state, box.label).color) }));
    this.viewer.cloud.setBoxes(shown);
    this.viewer.element.dataset["boxes"] = String(shown.length);
  }
}
