// SPDX-License-Identifier: Apache-2.0
// Section of the sidebar for the clip box: what is outside is neither drawn nor picked nor selected. Slices.
import { checkbox, section, slider } from "../ui/controls";
import { h } from "../ui/dom";
import type { Clip, State, Store } from "./store";

const kSteps = 200; // between the cloud's bounds
const kAxes = ["x", "y", "z"] as const;
const kSlice = 0.1; // thickness of a first slice, as a share of the height

type Three = [number, number, number];

/** The whole cloud, and a little more, so that nothing is lost to rounding. */
function whole(state: Readonly<State>): Clip | null {
  const bounds = state.cloud?.bounds;
  if (!bounds) return null;
  const room = [0, 1, 2].map((i) => 1e-4 * (bounds[3 + i]! - bounds[i]!) + 1e-4);
  return {
    low: [0, 1, 2].map((i) => bounds[i]! - room[i]!) as Three,
    high: [0, 1, 2].map((i) => bounds[3 + i]! + room[i]!) as Three,
  };
}

export function toggleClip(store: Store): void {
  store.set({ clip: store.state.clip ? null : whole(store.state) });
}

/** Moves the box by its own thickness along the vertical; where it is as high as the cloud, it becomes the lowest or highest slice. */
export function slice(store: Store, sign: 1 | -1): void {
  const all = whole(store.state);
  if (!all) return;
  const up = store.state.cloud!.up;
  const axis = [0, 1, 2].reduce((best, i) => (Math.abs(up[i]!) > Math.abs(up[best]!) ? i : best), 0);
  const { low, high } = store.state.clip ?? all;
  const height = all.high[axis]! - all.low[axis]!;
  const isFull = high[axis]! - low[axis]! > 0.999 * height;
  const thick = isFull ? kSlice * height : high[axis]! - low[axis]!;
  const by = sign * Math.sign(up[axis]!) * thick;
  const first = by > 0 ? all.low[axis]! : all.high[axis]! - thick;
  const from = isFull ? first : Math.min(Math.max(low[axis]! + by, all.low[axis]!), all.high[axis]! - thick);
  const replaced = (sides: readonly number[], value: number) => sides.map((side, i) => (i === axis ? value : side)) as Three;
  store.set({ clip: { low: replaced(low, from), high: replaced(high, from + thick) } });
}

export function clipSection(store: Store): HTMLElement {
  const box = checkbox("Clip box", "Only what is inside is drawn, picked and selected (V; slices: Alt+PageUp, Alt+PageDown)", () =>
    toggleClip(store),
  );
  const sides = kAxes.flatMap((name, axis) => [side(store, name, axis, "low"), side(store, name, axis, "high")]);
  const sliders = h("div", {}, ...sides);
  store.watch(["clip"], ({ clip }) => {
    box.set(clip !== null);
    sliders.hidden = clip === null;
  });
  return section("Clip", {}, box.element, sliders);
}

function side(store: Store, name: string, axis: number, which: "low" | "high"): HTMLElement {
  const made = slider(
    `${name} ${which === "low" ? "from" : "to"}`,
    { min: 0, max: kSteps, title: "A side of the clip box" },
    (position) => {
      const { clip } = store.state;
      const all = whole(store.state);
      if (!clip || !all) return;
      const value = all.low[axis]! + (position / kSteps) * (all.high[axis]! - all.low[axis]!);
      store.set({ clip: { ...clip, [which]: clip[which].map((one, i) => (i === axis ? value : one)) as Three } });
    },
  );
  store.watch(["clip"], (state) => {
    const all = whole(state);
    if (!state.clip || !all) return;
    const value = state.clip[which][axis]!;
    const share = (value - all.low[axis]!) / (all.high[axis]! - all.low[axis]!);
    made.set(Math.round(kSteps * share), `${value.toFixed(2)} m`);
  });
  return made.element;
}
