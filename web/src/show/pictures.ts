// SPDX-License-Identifier: Apache-2.0
// Pictures of a step: small in the panel, large on a sheet.
import { iconButton } from "../ui/controls";
import { openSheet } from "../ui/dialog";
import { fill, h, on } from "../ui/dom";
import { showPicture } from "../token";
import { type Picture, pictureAddress } from "./document";

function image(picture: Picture): HTMLElement {
  const img = h("img", { alt: "", decoding: "async", draggable: "false" });
  on(img, { error: () => img.replaceWith(h("p", { class: "empty" }, "This picture is not there.")) });
  showPicture(img, pictureAddress(picture.name));
  return img;
}

/** The first one, and the others as a strip below it. */
export function thumbnails(pictures: readonly Picture[]): HTMLElement[] {
  const buttons = pictures.map((picture, i) => {
    const label = `Enlarge: ${picture.title}`;
    const button = h("button", { type: "button", class: "thumbnail", title: picture.title, "aria-label": label }, image(picture));
    if (i === 0) button.append(h("span", {}, picture.title));
    return on(button, { click: () => enlarge(pictures, i) });
  });
  const [first, ...others] = buttons;
  if (!first) return [];
  return others.length > 0 ? [first, h("div", { class: "strip" }, ...others)] : [first];
}

export function enlarge(pictures: readonly Picture[], first: number): void {
  let at = first;
  const place = h("figure", { class: "enlarged" });
  const caption = h("figcaption");
  const draw = () => {
    const picture = pictures[at]!;
    caption.textContent = pictures.length > 1 ? `${picture.title} · ${at + 1} of ${pictures.length}` : picture.title;
    fill(place, image(picture));
  };
  const go = (by: number) => {
    at = (at + by + pictures.length) % pictures.length;
    draw();
  };
  draw();
  const foot = h("footer", { class: "enlarged-foot" }, caption);
  if (pictures.length > 1) foot.append(iconButton("previous", "Previous picture", () => go(-1)), iconButton("next", "Next picture", () => go(1)));
  const sheet = openSheet("Picture", { wide: true }, place, foot);
  sheet.element.classList.add("picture-sheet");
  on(sheet.element, {
    keydown: (event) => {
      const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      if (by === undefined || pictures.length < 2) return;
      event.preventDefault();
      go(by);
    },
  });
}
