// SPDX-License-Identifier: Apache-2.0
// The page of a report: head, navigation, sections; drawn anew when a run that goes on has another view.
import { fill, h } from "../ui/dom";
import { ThemeSwitch } from "../ui/theme";
import { benchmarkReport } from "./benchmark";
import { compareReport } from "./compare";
import { forgetCurves } from "./curves";
import { Files, kSchema, type ReportDocument } from "./document";
import { exploreReport } from "./explore";
import { otherReport } from "./other";
import type { Report } from "./parts";
import { Pictures } from "./pictures";
import { tablesReport } from "./tables";
import { updateReport } from "./update";

const kReports: Record<string, (document: ReportDocument, pictures: Pictures) => Report> = {
  explore: exploreReport,
  update: updateReport,
  benchmark: benchmarkReport,
  compare: compareReport,
  reproduce: tablesReport,
};

export function reportOf(document: ReportDocument, served: boolean): Report {
  const pictures = new Pictures(new Files(document.files, served));
  return (kReports[document.record.command] ?? otherReport)(document, pictures);
}

export class ReportPage {
  private readonly main = h("main", { id: "report", tabindex: -1 });
  private readonly navigation = h("nav", { "aria-label": "Parts of the report", class: "report-nav no-print" });
  private readonly head = h("div", { class: "report-title" });
  private readonly live = h("span", { class: "badge live", role: "status", hidden: true }, "live");
  private readonly foot = h("footer", { class: "report-foot" });
  private theme = new ThemeSwitch(() => {});

  /** @param scene address of the page that shows the run in 3-D; undefined: there is no program to show it. */
  constructor(
    app: Element,
    private readonly scene?: string,
  ) {
    const skip = h("a", { class: "skip", href: "#report" }, "To the report");
    const tools = h("div", { class: "report-tools no-print" }, this.live, scene ? h("a", { class: "button", href: scene }, "3-D view") : null, this.theme.button);
    fill(app, skip, h("header", { class: "report-head" }, this.head, tools), this.navigation, this.main, this.foot);
    printWhole();
    stepThroughViews();
  }

  say(title: string, text: string): void {
    fill(this.head, h("h1", {}, title));
    fill(this.main, h("p", { class: "soft", role: "status" }, text));
    fill(this.navigation);
  }

  show(record: ReportDocument): void {
    if (record.schema !== kSchema) {
      return this.say("This record is of another version", `It is "${record.schema}", and this page reads "${kSchema}". Write the report anew with the program that the record is from.`);
    }
    const served = this.scene !== undefined;
    const open = [...document.querySelectorAll<HTMLDetailsElement>("details[id][open]")].map((fold) => fold.id);
    const at = window.scrollY;
    forgetCurves();
    const report = reportOf(record, served);
    document.title = `${report.title} · Saccade`;
    const settings = report.settings.filter(([, value]) => value !== "").map(([name, value]) => h("div", {}, h("dt", {}, name), h("dd", {}, value)));
    fill(this.head, h("h1", {}, report.title), settings.length > 0 ? h("dl", { class: "settings" }, ...settings) : null, h("p", { class: "summary-text" }, report.summary), this.hint(record));
    fill(this.navigation, ...report.sections.map(({ id, title }) => h("a", { href: `#${id}` }, title)));
    fill(this.main, ...report.sections.map(({ element }) => element));
    this.live.hidden = record.live !== true;
    fill(this.foot, `Written by Saccade ${record.record.version ?? ""}. `, h("span", { class: "no-print" }, "The keys ← and → step from view to view."));
    for (const id of open) {
      const fold = document.getElementById(id);
      if (fold instanceof HTMLDetailsElement) fold.open = true;
    }
    if (at > 0) window.scrollTo({ top: at });
  }

  /** Tells the reader of a file how to see the run in 3-D. */
  private hint(record: ReportDocument): HTMLElement | null {
    const shown = record.files.find((name) => name.endsWith(".sacmap") || name.endsWith(".ply"));
    if (this.scene !== undefined || shown === undefined) return null;
    const subject = record.record.command === "segment" ? `FOLDER/${shown}` : "FOLDER";
    return h("p", { class: "soft no-print" }, "To turn the result in 3-D: ", h("code", {}, `saccade show ${subject}`), ", with the folder of this page.");
  }
}

/** Folds are opened for print, and closed again. */
function printWhole(): void {
  let closed: HTMLDetailsElement[] = [];
  window.addEventListener("beforeprint", () => {
    const folded = [...document.querySelectorAll<HTMLDetailsElement>("details:not([open])")];
    closed.push(...folded); // browsers may announce one print twice
    for (const fold of folded) {
      fold.dispatchEvent(new Event("saccade-print"));
      fold.open = true;
    }
    document.querySelectorAll("img").forEach((img) => (img.loading = "eager"));
  });
  window.addEventListener("afterprint", () => {
    closed.forEach((fold) => (fold.open = false));
    closed = [];
  });
}

/** Opens what a link leads to, and steps from view to view by keys. */
function stepThroughViews(): void {
  const reveal = (id: string, smooth: boolean) => {
    const target = document.getElementById(id);
    if (!target) return;
    for (let fold = target.closest("details"); fold; fold = fold.parentElement?.closest("details") ?? null) fold.open = true;
    target.scrollIntoView({ block: "start", behavior: smooth ? "smooth" : "auto" });
    (target.querySelector("summary") ?? target).focus({ preventScroll: true });
  };
  document.addEventListener("click", (event) => {
    const link = event.target instanceof Element ? event.target.closest<HTMLAnchorElement>("a[href^='#']") : null;
    if (!link) return;
    event.preventDefault();
    const id = decodeURIComponent(link.hash.slice(1));
    history.replaceState(null, "", link.hash);
    reveal(id, false);
  });
  window.addEventListener("load", () => location.hash && reveal(decodeURIComponent(location.hash.slice(1)), false));
  window.addEventListener("keydown", (event) => {
    const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (by === undefined || event.altKey || event.ctrlKey || event.metaKey || event.defaultPrevented) return;
    if (event.target instanceof Element && event.target.closest(".table-scroll, input, textarea, dialog")) return;
    const folds = [...document.querySelectorAll<HTMLDetailsElement>("details[id*='view-']")].filter((fold) => fold.offsetParent !== null);
    if (folds.length === 0) return;
    const current = folds.findIndex((fold) => fold.contains(document.activeElement));
    const next = folds[current < 0 ? (by > 0 ? 0 : folds.length - 1) : Math.min(folds.length - 1, Math.max(0, current + by))]!;
    event.preventDefault();
    reveal(next.id, false);
    next.open = true;
  });
}
