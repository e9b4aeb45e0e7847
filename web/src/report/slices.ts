// SPDX-License-Identifier: Apache-2.0
// How far the slices of a campaign are that several machines share, and what failed.
import { h } from "../ui/dom";
import { type Json, list, number, objects, type ReportDocument, text } from "./document";
import { section, type Section } from "./parts";
import { type Column, dataTable } from "./table";
import { count, plural } from "./words";

const runsOf = (slice: Json): string => (slice["planned"] === undefined ? "" : `${count(number(slice["done"]))} of ${count(number(slice["planned"]))}`);
const shareOf = (slice: Json): number => (number(slice["done"]) ?? 0) / Math.max(1, number(slice["planned"]) ?? 0);
const timeOf = (value: unknown): string => text(value).replace("T", " ").replace("Z", "");

const kColumns: Column<Json>[] = [
  { name: "slice", text: (slice) => `${String(number(slice["slice"]))} of ${String(number(slice["of"]))}`, value: (slice) => number(slice["slice"]) },
  { name: "state", text: (slice) => text(slice["state"]) },
  { name: "runs", text: runsOf, value: shareOf },
  { name: "tries", text: (slice) => count(number(slice["tries"])), value: (slice) => number(slice["tries"]) },
  { name: "machine", text: (slice) => text(slice["machine"]), left: true },
  { name: "job", text: (slice) => text(slice["job"]), left: true },
  { name: "began, UTC", text: (slice) => timeOf(slice["began"]), left: true },
  { name: "ended, UTC", text: (slice) => timeOf(slice["ended"]), left: true },
];

/** "7 done, 1 failed". */
function statesText(slices: readonly Json[]): string {
  const states = new Map<string, number>();
  for (const slice of slices) states.set(text(slice["state"]), (states.get(text(slice["state"])) ?? 0) + 1);
  return [...states].map(([state, n]) => `${count(n)} ${state}`).join(", ");
}

/** null for a campaign without slices. */
export function slicesSection(document: ReportDocument): Section | null {
  const slices = objects(document.record.result["slices"]);
  const { result } = document.record;
  const others = [
    ...list(result["unreadable"]).map((error) => h("li", {}, `Cannot be read: ${text(error)}`)),
    ...list(result["set_aside"]).map((name) => h("li", {}, `Set aside, since it was damaged: ${text(name)}`)),
  ];
  if (slices.length + others.length === 0) return null;
  const at = timeOf(result["slices_at"]);
  const failed = slices.filter((slice) => text(slice["error"]) !== "");
  const errors = failed.map((slice) => h("li", {}, `Slice ${String(number(slice["slice"]))} of ${String(number(slice["of"]))}: ${text(slice["error"])}`));
  return section(
    "slices",
    "Slices",
    h("p", { class: "soft" }, `${plural(slices.length, "slice")}: ${statesText(slices)}${at === "" ? "" : `, at ${at} UTC`}.`),
    errors.length + others.length > 0 ? h("ul", {}, ...errors, ...others) : null,
    dataTable("Slices of the campaign", kColumns, slices),
  );
}
