// SPDX-License-Identifier: Apache-2.0
// Commands of a bar that fold into a menu where the page is narrow, and a panel that is a drawer there.
import { iconButton } from "./controls";
import { h, on } from "./dom";

const kNarrow = "(width < 860px)"; // the style sheets have it, too

/** In a bar: as they are on a wide page; behind a button "…" on a narrow one. */
export function foldMenu(...groups: Node[]): HTMLElement {
  const content = h("div", { class: "fold-content" }, ...groups);
  const button = iconButton("more", "More commands", () => set(button.getAttribute("aria-expanded") !== "true"));
  button.classList.add("fold-button");
  const wrap = h("div", { class: "fold-menu" }, button, content);
  const set = (open: boolean) => {
    button.setAttribute("aria-expanded", String(open));
    wrap.classList.toggle("open", open);
  };
  set(false);
  on(content, {
    click: (event) => {
      const command = (event.target as Element).closest("button");
      if (command && !command.hasAttribute("aria-haspopup") && !command.closest(".segmented")) set(false);
    },
  });
  on(wrap, {
    keydown: (event) => {
      if (event.key !== "Escape" || !wrap.classList.contains("open")) return;
      event.stopPropagation();
      set(false);
      button.focus();
    },
  });
  document.addEventListener("pointerdown", (event) => {
    if (!wrap.contains(event.target as Node)) set(false);
  });
  return wrap;
}

/**
 * The panel of a page: beside the stage, or on a narrow page a drawer over it, closed at first.
 * @param wanted whether it is folded on a wide page.
 * @return folds it, or shows it.
 */
export function drawer(page: HTMLElement, stage: HTMLElement, wanted: boolean, changed: (folded: boolean) => void): () => void {
  const narrow = matchMedia(kNarrow);
  let folded = wanted;
  const show = (closed: boolean) => void page.classList.toggle("folded", closed);
  const fit = () => show(narrow.matches || folded);
  narrow.addEventListener("change", fit);
  fit();
  stage.addEventListener("pointerdown", () => {
    if (narrow.matches) show(true);
  });
  page.addEventListener("keydown", (event) => {
    if (event.key === "Escape" && narrow.matches && !page.classList.contains("folded")) {
      event.stopPropagation();
      show(true);
    }
  });
  return () => {
    const closed = !page.classList.contains("folded");
    show(closed);
    if (narrow.matches) return;
    folded = closed;
    changed(folded);
  };
}
