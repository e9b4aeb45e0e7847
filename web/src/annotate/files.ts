// SPDX-License-Identifier: Apache-2.0
// Clouds and files: opening, saving, exporting, beginning anew.
import { fetchFile } from "../token";
import { type MenuItem } from "../ui/controls";
import { confirm, openSheet } from "../ui/dialog";
import { h, on } from "../ui/dom";
import { icon } from "../ui/icons";
import { toast } from "../ui/toast";
import type { Session } from "./session";
import type { CloudEntry, Store } from "./store";

const kFormats: readonly [format: string, text: string, hint: string][] = [
  ["pcd", "PCD, all fields and label", ".pcd"],
  ["ply", "PLY, all fields and label", ".ply"],
  ["txt", "Text, label in the last column", ".txt"],
  ["csv", "CSV, label in the last column", ".csv"],
  ["label", "SemanticKITTI", ".label"],
  ["npy", "NumPy array", ".npy"],
  ["names.txt", "Names of labels, text", ".txt"],
  ["names.json", "Names of labels, JSON", ".json"],
  ["boxes.json", "Boxes around labels, JSON", ".json"],
  ["boxes.txt", "Boxes around labels, KITTI", ".txt"],
];

export class Files {
  constructor(
    private readonly store: Store,
    private readonly session: Session,
  ) {}

  async save(): Promise<void> {
    const answer = await this.session.ask({ type: "save" });
    if (!answer) return;
    const files = Array.isArray(answer.head["files"]) ? answer.head["files"].map(String) : [];
    toast(files.length > 0 ? `Saved ${files.join(", ")}` : "Saved.");
  }

  /** Asks for the name that others see. */
  askName(): void {
    const input = h("input", { type: "text", "aria-label": "Your name", maxlength: 20, autocomplete: "off" });
    input.value = this.store.state.name;
    const form = h("form", { class: "fields" }, input, h("button", { type: "submit", class: "button outline" }, "Say it"));
    const sheet = openSheet("Your name", {}, h("p", { class: "soft" }, "Others who have this cloud open see who did what last."), form);
    on(form, {
      submit: (event) => {
        event.preventDefault();
        sheet.close();
        void this.session.rename(input.value.trim());
      },
    });
    input.focus();
  }

  exports(): MenuItem[] {
    return kFormats.map(([format, text, hint]) => ({ text, hint, choose: () => void this.download(format) }));
  }

  async download(format: string): Promise<void> {
    const cloud = this.store.state.cloud;
    if (!cloud) return;
    toast("The file is being made …", { stays_ms: 2000 });
    try {
      const answer = await fetchFile(`data/labels?cloud=${cloud.index}&format=${encodeURIComponent(format)}`);
      if (!answer.ok) throw new Error((await answer.text()).slice(0, 400) || `the program answered ${answer.status}`);
      const name = /filename="([^"]+)"/.exec(answer.headers.get("Content-Disposition") ?? "")?.[1];
      const address = URL.createObjectURL(await answer.blob());
      const link = h("a", {
        href: address,
        download: name ?? `${cloud.name.replace(/\.[^.]*$/, "")}_labels.${format}`,
      });
      link.click();
      window.setTimeout(() => URL.revokeObjectURL(address), 60_000);
    } catch (error) {
      toast(`Cannot export: ${error instanceof Error ? error.message : String(error)}`, { kind: "error" });
    }
  }

  async beginAnew(): Promise<void> {
    const text = "The cloud begins again without labels. What there is now stays on the disk, in a file of its own.";
    if (await confirm("Begin a new annotation?", text, "Begin anew")) await this.session.beginAnew();
  }

  step(by: 1 | -1): void {
    const { cloud, clouds } = this.store.state;
    const index = (cloud?.index ?? 0) + by;
    if (index >= 0 && index < clouds.length) void this.session.change(index);
  }

  /** Goes to the next cloud, where points without a label take those of this one. */
  async carry(): Promise<void> {
    const { cloud, clouds, sequence } = this.store.state;
    if (!sequence || !cloud) return;
    if (cloud.index + 1 >= clouds.length) return toast("This is the last cloud of the sequence.");
    await this.session.change(cloud.index + 1);
    if (this.store.state.cloud?.index !== cloud.index + 1) return;
    const result = await this.session.act({ do: "carry" }, { from: cloud.index });
    if (!result) return;
    const points = result.carried === undefined ? "Points" : `${result.carried.toLocaleString("en")} points`;
    toast(`${points} took the labels of ${cloud.name}.`, { button: { text: "Undo", click: () => void this.session.act({ do: "undo" }) } });
  }

  open(): void {
    const { clouds, cloud } = this.store.state;
    const search = h("input", { type: "text", placeholder: "Find", "aria-label": "Find a cloud", autocomplete: "off" });
    const rows = clouds.map((entry, index) => cloudRow(entry, index === cloud?.index, () => choose(index)));
    const list = h("div", { class: "cloud-list", role: "list" }, ...rows);
    const begun = clouds.filter((entry) => entry.begun).length;
    const sheet = openSheet(
      "Open",
      {},
      clouds.length > 8 ? search : null,
      h(
        "p",
        { class: "soft cloud-count" },
        `${clouds.length === 1 ? "1 cloud" : `${clouds.length} clouds`}, ${begun} begun`,
      ),
      list,
    );
    const choose = (index: number) => {
      sheet.close();
      void this.session.change(index);
    };
    on(search, {
      input: () => {
        const wanted = search.value.toLowerCase();
        rows.forEach((row, i) => void (row.hidden = !clouds[i]!.name.toLowerCase().includes(wanted)));
      },
    });
    on(list, {
      keydown: (event) => {
        const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
        if (step === undefined) return;
        event.preventDefault();
        const shown = rows.filter((row) => !row.hidden);
        shown[shown.indexOf(document.activeElement as HTMLButtonElement) + step]?.focus();
      },
    });
    (rows[cloud?.index ?? 0] ?? rows[0])?.focus();
  }
}

function cloudRow(entry: CloudEntry, current: boolean, choose: () => void): HTMLButtonElement {
  const row = h(
    "button",
    { type: "button", class: "cloud-row", "aria-current": current ? "true" : undefined },
    icon(entry.begun ? "set" : "point"),
    h("span", { class: "row-name" }, entry.name),
    h("span", { class: `badge${entry.begun ? " begun" : ""}` }, entry.begun ? "begun" : "not begun"),
    h("span", { class: "soft number cloud-bytes" }, bytesText(entry.bytes)),
  );
  return on(row, { click: choose });
}

export function bytesText(bytes: number): string {
  if (bytes < 1e6) return `${Math.max(1, Math.round(bytes / 1e3))} kB`;
  return bytes < 1e9 ? `${(bytes / 1e6).toFixed(1)} MB` : `${(bytes / 1e9).toFixed(2)} GB`;
}
