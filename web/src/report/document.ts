// SPDX-License-Identifier: Apache-2.0
// ReportDocument: the record of a run and the files beside it, as the program writes them. docs/guides/report.md.
import { showPicture } from "../token";

/** Result of a command as it stands in its --json file, run.json and update.json. */
export interface Envelope {
  schema: string;
  command: string;
  version?: string;
  backend?: string;
  threads?: number;
  seed?: number;
  timings_ms?: Record<string, number>;
  result: Json;
}

/** An object of a record. Which keys it has depends on the command; older programs wrote fewer. */
export type Json = { readonly [key: string]: unknown };

export interface ReportDocument {
  schema: string;
  record: Envelope;
  /** Names of the files beside the page, relative to it. */
  files: string[];
  /** Content of the page beyond the record, such as curves of a comparison. */
  details?: Json;
  /** The run goes on, and the page follows it. */
  live?: boolean;
}

export const kSchema = "saccade-report/1";

/** Reads the record that the program put into the page; null where there is none, as in the page that is served. */
export function embeddedDocument(): ReportDocument | null {
  const text = document.getElementById("record")?.textContent?.trim();
  return text ? (JSON.parse(text) as ReportDocument) : null;
}

export const object = (value: unknown): Json => (typeof value === "object" && value !== null && !Array.isArray(value) ? (value as Json) : {});
export const objects = (value: unknown): Json[] => (Array.isArray(value) ? value.map(object) : []);
export const list = (value: unknown): unknown[] => (Array.isArray(value) ? value : []);
export const text = (value: unknown): string => (typeof value === "string" ? value : "");
/** undefined for anything but a finite number. */
export const number = (value: unknown): number | undefined => (typeof value === "number" && Number.isFinite(value) ? value : undefined);
export const numbers = (value: unknown): number[] => list(value).map((entry) => number(entry) ?? Number.NaN);

/** The files beside the page. A page that is served asks the program for them. */
export class Files {
  private readonly names: Set<string>;

  constructor(
    names: readonly string[],
    private readonly served: boolean,
  ) {
    this.names = new Set(names);
  }

  has(name: string): boolean {
    return this.names.has(name);
  }

  all(): string[] {
    return [...this.names];
  }

  /** Address of a file beside a page that is not served. */
  address(name: string): string {
    return name.split("/").map(encodeURIComponent).join("/");
  }

  show(img: HTMLImageElement, name: string): void {
    if (this.served) showPicture(img, `data/file?name=${encodeURIComponent(name)}`);
    else img.src = this.address(name);
  }
}
