// SPDX-License-Identifier: Apache-2.0
// Buffers of layers: fetched in pieces, kept as long as the document names them.
import type { Message } from "../protocol";

const kPieceBytes = 4 * 1024 * 1024;

export type Ask = (question: { type: string; [key: string]: unknown }) => Promise<Message>;

interface Entry {
  promise: Promise<ArrayBuffer>;
  done: number;
  total: number;
  ready: boolean;
}

export class BufferCache {
  private readonly entries = new Map<string, Entry>();

  /** `progress` hears the bytes that are here and those that are asked for, of all that are under way. */
  constructor(
    private readonly ask: Ask,
    private readonly progress: (done: number, total: number) => void,
  ) {}

  /** `bytes` is what the layer says it ought to be. */
  get(name: string, bytes: number): Promise<ArrayBuffer> {
    const known = this.entries.get(name);
    if (known) return known.promise;
    const entry: Entry = { promise: Promise.resolve(new ArrayBuffer(0)), done: 0, total: bytes, ready: false };
    this.entries.set(name, entry);
    entry.promise = this.fetch(name, entry).catch((error: unknown) => {
      if (this.entries.get(name) === entry) this.entries.delete(name); // asked again next time
      this.report();
      throw error;
    });
    return entry.promise;
  }

  /** Drops what is not among these. */
  keep(names: ReadonlySet<string>): void {
    for (const name of this.entries.keys()) if (!names.has(name)) this.entries.delete(name);
    this.report();
  }

  get bytes(): number {
    let sum = 0;
    for (const entry of this.entries.values()) sum += entry.done;
    return sum;
  }

  private async fetch(name: string, entry: Entry): Promise<ArrayBuffer> {
    let whole: Uint8Array | undefined;
    do {
      const { head, body } = await this.ask({ type: "buffer", name, from: entry.done, bytes: kPieceBytes });
      const total = Number(head["total"]);
      whole ??= new Uint8Array(total);
      entry.total = total;
      if (whole.length !== total || entry.done + body.byteLength > total || (body.byteLength === 0 && entry.done < total))
        throw new Error(`The buffer ${name} came in pieces that do not fit together.`);
      whole.set(new Uint8Array(body), entry.done);
      entry.done += body.byteLength;
      this.report();
    } while (entry.done < entry.total);
    entry.ready = true;
    this.report();
    return whole.buffer as ArrayBuffer;
  }

  private report(): void {
    let done = 0;
    let total = 0;
    for (const entry of this.entries.values()) {
      if (entry.ready) continue;
      done += entry.done;
      total += entry.total;
    }
    this.progress(done, total);
  }
}
