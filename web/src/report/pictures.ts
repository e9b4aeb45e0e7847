// SPDX-License-Identifier: Apache-2.0
// Pictures of a run: small in the page, large in a dialog that steps through pictures of a kind.
import { iconButton } from "../ui/controls";
import { openSheet } from "../ui/dialog";
import { fill, h, on } from "../ui/dom";
import { icon } from "../ui/icons";
import type { Files } from "./document";

export interface Picture {
  name: string; // file name
  title: string;
  alt: string;
  kind: string; // large pictures are stepped through by kind
}

const kKinds: Record<string, [title: string, alt: string]> = {
  saliency: ["What drew the attention: the surface by its saliency, with the contours of the chosen segment", "The surface from outside, brighter where it is more salient"],
  choice: ["The chosen view among its candidates", "The candidates around the region and the chosen view"],
  seen: ["What the camera saw: colour and depth", "Colour picture beside the depth picture"],
  map: ["The map after the view", "The map from outside"],
};

export class Pictures {
  private all: Picture[] = [];

  /** @param unknown how pictures of the map show what is unknown */
  constructor(readonly files: Files, public unknown = "unknown in grey") {}

  /** The pictures of a view that are there. 0 is the initial scan. */
  ofView(view: number, folder = ""): Picture[] {
    const place = view === 0 ? "the initial scan" : `view ${view}`;
    return Object.entries(kKinds).flatMap(([kind, [title, alt]]) => {
      const name = `${folder}view-${String(view).padStart(2, "0")}-${kind}.png`;
      if (!this.files.has(name)) return [];
      const shown = kind === "map" && view === 0 ? "The map after the scan" : title;
      const unknown = kind === "map" ? `, ${this.unknown}` : "";
      return [{ name, title: shown + unknown, alt: `${alt}${unknown}, ${place}`, kind }];
    });
  }

  /** A picture with a name of its own; none where it is not there. */
  named(name: string, title: string, alt: string, kind = "map"): Picture[] {
    return this.files.has(name) ? [{ name, title, alt, kind }] : [];
  }

  figures(pictures: readonly Picture[], options: { eager?: boolean } = {}): HTMLElement | null {
    if (pictures.length === 0) return null;
    this.all.push(...pictures);
    return h("div", { class: pictures.length === 1 ? "pictures single" : "pictures" }, ...pictures.map((picture) => this.figure(picture, options.eager ?? false)));
  }

  private image(picture: Picture, eager: boolean): HTMLElement {
    const img = h("img", { alt: picture.alt, decoding: "async", loading: eager ? "eager" : "lazy", draggable: "false" });
    on(img, { error: () => img.replaceWith(h("p", { class: "empty" }, `${picture.name} cannot be read.`)) });
    this.files.show(img, picture.name);
    return img;
  }

  private figure(picture: Picture, eager: boolean): HTMLElement {
    const button = h("button", { type: "button", class: "picture", "aria-label": `Enlarge: ${picture.alt}` }, this.image(picture, eager));
    button.append(h("span", { class: "enlarge", "aria-hidden": "true" }, icon("fit")));
    on(button, { click: () => this.enlarge(picture) });
    return h("figure", { "data-kind": picture.kind }, button, h("figcaption", {}, picture.title));
  }

  private enlarge(first: Picture): void {
    const row = this.all.filter((picture) => picture.kind === first.kind);
    let at = row.indexOf(first);
    const place = h("div", { class: "enlarged" });
    const caption = h("p", { role: "status" });
    const go = (by: number) => {
      at = Math.min(row.length - 1, Math.max(0, at + by));
      const picture = row[at]!;
      caption.textContent = `${picture.title} · ${picture.name} · ${at + 1} of ${row.length}`;
      fill(place, this.image(picture, true));
    };
    go(0);
    const foot = h("div", { class: "enlarged-foot" }, caption);
    if (row.length > 1) foot.append(iconButton("previous", "Previous picture (←)", () => go(-1)), iconButton("next", "Next picture (→)", () => go(1)));
    const sheet = openSheet("Picture", { wide: true }, place, foot);
    sheet.element.classList.add("picture-sheet");
    on(sheet.element, {
      keydown: (event) => {
        const by = { ArrowLeft: -1, ArrowRight: 1, Home: -row.length, End: row.length }[event.key];
        if (by === undefined) return;
        event.preventDefault();
        go(by);
      },
    });
  }
}
