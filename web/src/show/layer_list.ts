// SPDX-License-Identifier: Apache-2.0
// The list of layers: what is shown, its colours and what they mean, opacity and size.
import { slider } from "../ui/controls";
import { type Child, fill, h, on, setAttribute } from "../ui/dom";
import { compact, grouped } from "../ui/figures";
import { icon } from "../ui/icons";
import { rampLegend } from "../ui/ramp_legend";
import { kNoColor, type Layer, layerKey, type SceneDocument } from "./document";
import { type Candidates, gainText } from "./gains";
import type { Look } from "./look_of_layers";
import { choicesOf, titled } from "./paint";
import type { Scale } from "../view/ramp";

const kUnits = { triangles: "triangles", points: "points", voxels: "voxels", lines: "lines", views: "views" } as const;
const kSizes = [0.25, 0.5, 0.75, 1, 1.5, 2, 3, 4, 6];

export class LayerList {
  readonly element = h("div", { class: "layers" });
  private readonly open = new Set<string>(); // keys of the layers with unfolded settings

  /** `changed`: something is to be drawn differently. */
  constructor(
    private readonly look: Look,
    private readonly changed: () => void,
  ) {}

  set(document: SceneDocument, step: number): void {
    const focused = this.element.ownerDocument.activeElement?.getAttribute("data-focus");
    const whole = document.layers.filter((layer) => layer.step === undefined);
    const own = document.layers.filter((layer) => layer.step === step);
    const groups: Child[] = [...whole.map((layer) => this.row(layer))];
    if (document.steps.length > 0 && (own.length > 0 || step > 0)) {
      if (whole.length > 0) groups.push(h("h3", { class: "layers-of" }, "Of this step"));
      groups.push(...own.map((layer) => this.row(layer)));
      if (step > 0) groups.push(this.trailRow());
    }
    if (groups.length === 0) groups.push(h("p", { class: "empty" }, "There is nothing to show."));
    fill(this.element, ...groups);
    if (focused) this.element.querySelector<HTMLElement>(`[data-focus="${CSS.escape(focused)}"]`)?.focus();
  }

  /** Explains the colours of candidates, once their gains are known. */
  setGains(id: string, { best, low, high }: Candidates): void {
    const scale = this.element.querySelector(`[data-layer="${CSS.escape(id)}"] .gain-scale`);
    if (!scale) return;
    const known = best >= 0;
    fill(scale, h("span", {}, known ? gainText(low) : ""), h("i", { class: "ramp" }), h("span", {}, known ? `${gainText(high)} gain` : "gain not known"));
  }

  /** Explains a ramp of colours, once the numbers are known. */
  setScale(layer: Layer, scale: Scale | null): void {
    const legend = this.element.querySelector(`[data-layer="${CSS.escape(layer.id)}"] .value-scale`);
    if (!legend) return;
    const by = this.look.colorBy(layer);
    const unit = by === "height" || /_m$|radius/.test(by) ? " m" : "";
    if (scale === null) fill(legend);
    else fill(legend, ...rampLegend(titled(by), scale, unit));
  }

  private row(layer: Layer): HTMLElement {
    const key = layerKey(layer);
    const row = h("div", { class: "layer", "data-layer": layer.id });
    const eye = this.eye(layer.name, key, () => this.look.visible(layer), (visible) => {
      this.look.setVisible(layer, visible);
      row.classList.toggle("off", !visible);
    });
    row.classList.toggle("off", !this.look.visible(layer));
    const settings = h("div", { class: "layer-settings", hidden: !this.open.has(key) });
    const name = h("button", { type: "button", class: "layer-name", "aria-expanded": this.open.has(key), title: layer.kind === "lines" ? layer.name : `${layer.name}: ${grouped(layer.count)} ${kUnits[layer.kind]}`, "data-focus": `name ${key}` }, swatch(layer), h("span", { class: "name" }, layer.name), h("span", { class: "count" }, count(layer)), icon("down"));
    name.setAttribute("aria-expanded", String(this.open.has(key)));
    on(name, {
      click: () => {
        settings.hidden = !settings.hidden;
        name.setAttribute("aria-expanded", String(!settings.hidden));
        if (settings.hidden) this.open.delete(key);
        else this.open.add(key);
      },
    });
    settings.append(this.opacity(layer), ...this.size(layer));
    row.append(h("div", { class: "layer-head" }, eye, name), ...legend(layer), ...this.coloring(layer), settings);
    return row;
  }

  private coloring(layer: Layer): HTMLElement[] {
    const choices = choicesOf(layer);
    if (choices.length === 0) return [];
    const now = this.look.colorBy(layer);
    const select = h("select", { "aria-label": `Colour of ${layer.name}`, "data-focus": `color ${layerKey(layer)}` }, ...choices.map(([by, text]) => h("option", { value: by, selected: by === now }, text)));
    on(select, {
      change: () => {
        this.look.setColorBy(layer, select.value);
        this.changed();
      },
    });
    return [h("label", { class: "layer-color" }, h("span", {}, "Colour by"), select), h("div", { class: "value-scale" })];
  }

  private trailRow(): HTMLElement {
    const row = h("div", { class: "layer" });
    row.classList.toggle("off", !this.look.trail);
    const eye = this.eye("Earlier views", "trail", () => this.look.trail, (visible) => {
      this.look.trail = visible;
      row.classList.toggle("off", !visible);
    });
    const mark = h("i", { class: "swatch" });
    mark.style.backgroundColor = "#8a94a3";
    row.append(h("div", { class: "layer-head" }, eye, h("div", { class: "layer-name" }, mark, h("span", { class: "name" }, "Earlier views"))));
    return row;
  }

  private eye(name: string, key: string, now: () => boolean, set: (visible: boolean) => void): HTMLElement {
    const button = h("button", { type: "button", class: "button icon-only eye", "data-focus": `eye ${key}`, "aria-label": `Show ${name}` });
    const draw = () => {
      button.setAttribute("aria-pressed", String(now()));
      setAttribute(button, "title", now() ? "Hide" : "Show");
      button.replaceChildren(icon(now() ? "eye" : "hidden"));
    };
    draw();
    return on(button, {
      click: () => {
        set(!now());
        draw();
        this.changed();
      },
    });
  }

  private opacity(layer: Layer): HTMLElement {
    const part = slider("Opacity", { min: 1, max: 20 }, (at) => part.set(at, `${at * 5} %`), (at) => {
      this.look.setOpacity(layer, at / 20);
      this.changed();
    });
    const now = Math.round(this.look.opacity(layer) * 20);
    part.set(now, `${now * 5} %`);
    return part.element;
  }

  private size(layer: Layer): HTMLElement[] {
    if (layer.size_m === undefined || (layer.kind !== "points" && layer.kind !== "voxels")) return [];
    const text = (at: number) => `${((layer.size_m ?? 0) * kSizes[at]! * 1000).toPrecision(2)} mm`;
    const part = slider("Size", { min: 0, max: kSizes.length - 1 }, (at) => part.set(at, text(at)), (at) => {
      this.look.setScale(layer, kSizes[at]!);
      this.changed();
    });
    const now = Math.max(0, kSizes.indexOf(this.look.scale(layer)));
    part.set(now, text(now));
    return [part.element];
  }
}

/** Empty where it says nothing: the edges of a box are twelve. */
function count(layer: Layer): string {
  if (layer.kind === "lines") return "";
  return layer.count < 10_000 ? grouped(layer.count) : compact(layer.count);
}

/** Makes the mark of a layer: one colour, the colours of its legend, or a rainbow where there is no legend. */
function swatch(layer: Layer): HTMLElement {
  const mark = h("i", { class: "swatch" });
  const colors = layer.legend?.map((entry) => entry[1]) ?? [];
  if (layer.kind === "views") mark.classList.add("ramp");
  else if (colors.length > 1) mark.style.backgroundImage = `linear-gradient(90deg, ${colors.join(", ")})`;
  else if (layer.colors && colors.length === 0) mark.classList.add("many");
  else mark.style.backgroundColor = colors[0] ?? layer.color ?? kNoColor;
  return mark;
}

function legend(layer: Layer): HTMLElement[] {
  if (layer.kind === "views") return [h("div", { class: "gain-scale" })];
  if (!layer.legend || layer.legend.length === 0) return [];
  const entries = layer.legend.map(([text, color]) => {
    const mark = h("i", { class: "swatch" });
    mark.style.backgroundColor = color;
    return h("li", {}, mark, text);
  });
  return [h("ul", { class: "legend" }, ...entries)];
}
