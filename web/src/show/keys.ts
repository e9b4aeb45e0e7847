// SPDX-License-Identifier: Apache-2.0
// Keys of the viewer.
import type { Side } from "../view/standpoint";
import type { Gesture, Shortcut, Shortcuts } from "../ui/shortcuts";
import type { ShowPage } from "./page";
import type { Player } from "./player";

interface KeyActions {
  fit(from?: Side): void;
  toggleLooking(): void;
  stopLooking(): void;
}

export function addShortcuts(shortcuts: Shortcuts, player: Player, page: ShowPage, actions: KeyActions): void {
  const go = (step: () => number) => () => {
    player.stop();
    player.go(step());
  };
  const key = (group: string, keys: readonly string[], text: string, run: () => void): Shortcut => ({ keys, group, text, run });
  const mouse = (shown: string, text: string): Gesture => ({ group: "Mouse and cursor", text, shown });
  shortcuts.add(
    key("Steps", ["ArrowRight"], "Next step", go(() => player.step + 1)),
    key("Steps", ["ArrowLeft"], "Previous step", go(() => player.step - 1)),
    key("Steps", ["Home"], "First step", go(() => 0)),
    key("Steps", ["End"], "Last step", go(() => player.steps - 1)),
    key("Steps", ["Space"], "Play, pause", () => (player.playing ? player.stop() : player.play())),
    key("Steps", ["C"], "Look through the camera, and back", actions.toggleLooking),
    key("Steps", ["Escape"], "Back from the camera", actions.stopLooking),
    key("Steps", ["P"], "Pictures", () => page.togglePictures()),
    key("View", ["F"], "Everything in view", () => actions.fit()),
    key("View", ["T"], "From the top", () => actions.fit("top")),
    key("View", ["Shift+F"], "From the front", () => actions.fit("front")),
    key("View", ["Shift+T"], "From the side", () => actions.fit("side")),
    key("View", ["O"], "Orbit or fly", () => page.toggleNavigation()),
    key("View", ["\\"], "Panel on or off", () => page.fold()),
    { ...key("View", ["?"], "This sheet", () => shortcuts.showHelp()), or: ["F1"] },
    mouse("Click", "On a candidate: its gain, the view from there"),
    mouse("Click", "On an earlier view: to its step"),
    mouse("Drag", "Turn around what is under the cursor"),
    mouse("Shift+Drag", "Move; also with the middle button"),
    mouse("Ctrl+Drag", "Roll"),
    mouse("Wheel", "Nearer, farther"),
    mouse("W A S D", "In Fly: go; Q E down and up, Shift faster"),
  );
  // The focused element keeps the keys that it needs itself.
  shortcuts.taken = (pressed) => {
    const focused = document.activeElement;
    if (pressed === "Space") return !!focused?.closest("button, summary, input");
    return focused instanceof HTMLInputElement && focused.type === "range" && /^(Arrow|Home|End)/.test(pressed);
  };
}
