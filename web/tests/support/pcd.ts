// SPDX-License-Identifier: Apache-2.0
// Reads the files that the program writes, and compares labels with the truth.

export interface Table {
  count: number;
  columns: ReadonlyMap<string, Float64Array>;
}

const kReaders: Record<string, (view: DataView, at: number) => number> = {
  F4: (view, at) => view.getFloat32(at, true),
  F8: (view, at) => view.getFloat64(at, true),
  U1: (view, at) => view.getUint8(at),
  U2: (view, at) => view.getUint16(at, true),
  U4: (view, at) => view.getUint32(at, true),
  I1: (view, at) => view.getInt8(at),
  I2: (view, at) => view.getInt16(at, true),
  I4: (view, at) => view.getInt32(at, true),
};

/** A PCD in text or binary, with one number per field. */
export function readPcd(file: Buffer): Table {
  const head = new Map<string, string[]>();
  let at = 0;
  while (!head.has("DATA")) {
    const end = file.indexOf(10, at);
    if (end < 0) throw new Error("a PCD without DATA");
    const [key, ...words] = file.toString("latin1", at, end).trim().split(/\s+/);
    head.set(key ?? "", words);
    at = end + 1;
  }
  const words = (key: string) => head.get(key) ?? [];
  const count = Number(words("POINTS")[0]);
  const fields = words("FIELDS");
  if (!(count > 0) || fields.length === 0 || words("COUNT").some((one) => one !== "1")) throw new Error("a PCD that this does not read");
  const columns = new Map(fields.map((name) => [name, new Float64Array(count)]));
  const kind = words("DATA")[0];
  if (kind === "ascii") {
    const numbers = file.toString("latin1", at).trim().split(/\s+/).map(Number);
    if (numbers.length !== count * fields.length) throw new Error(`${numbers.length} numbers, not ${count} × ${fields.length}`);
    fields.forEach((name, f) => columns.get(name)!.forEach((_, i, column) => void (column[i] = numbers[i * fields.length + f]!)));
  } else if (kind === "binary") {
    const sizes = words("SIZE").map(Number);
    const stride = sizes.reduce((sum, size) => sum + size, 0);
    if (file.length !== at + stride * count) throw new Error(`${file.length} bytes, not ${at + stride * count}`);
    const view = new DataView(file.buffer, file.byteOffset + at);
    let offset = 0;
    fields.forEach((name, f) => {
      const read = kReaders[`${words("TYPE")[f]}${sizes[f]}`];
      if (!read) throw new Error(`field ${name}`);
      const column = columns.get(name)!;
      for (let i = 0; i < count; ++i) column[i] = read(view, i * stride + offset);
      offset += sizes[f]!;
    });
  } else {
    throw new Error(`DATA ${kind}`);
  }
  return { count, columns };
}

export function labelsOfPcd(file: Buffer): Uint32Array {
  const labels = readPcd(file).columns.get("label");
  if (!labels) throw new Error("a PCD without labels");
  return Uint32Array.from(labels);
}

/** SemanticKITTI: a u32 per point, the class below, the instance above. */
export function labelsOfKitti(file: Buffer): Uint32Array {
  return Uint32Array.from({ length: file.length / 4 }, (_, i) => file.readUInt32LE(4 * i));
}

export function labelsOfText(file: Buffer): Uint32Array {
  const lines = file.toString("latin1").trim().split("\n");
  return Uint32Array.from(lines.filter((line) => /^[-+.\d]/.test(line)).map((line) => Number(line.split(/[\s,]+/).at(-1))));
}

/** Intersection over union of a label with what it ought to be. */
export function iou(labels: Uint32Array, label: number, truth: Uint32Array, object: number): number {
  if (labels.length !== truth.length) throw new Error(`${labels.length} labels for ${truth.length} points`);
  let both = 0;
  let either = 0;
  for (let i = 0; i < labels.length; ++i) {
    const [here, there] = [labels[i] === label, truth[i] === object];
    if (here && there) ++both;
    if (here || there) ++either;
  }
  return either === 0 ? 0 : both / either;
}

export function countOf(labels: Uint32Array, label: number): number {
  return labels.reduce((sum, one) => sum + (one === label ? 1 : 0), 0);
}
