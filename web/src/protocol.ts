// SPDX-License-Identifier: Apache-2.0
// Messages of the WebSocket: a head of JSON and a body of arrays. docs/reference/protocol.md.

export interface Message {
  head: Record<string, unknown> & { type: string; request?: number };
  body: ArrayBuffer;
}

export interface LabelRow {
  number: number;
  name: string;
  class: string;
  instance: number;
  color: string; // "#rrggbb"
  defined: boolean;
  locked?: boolean;
  points: number;
  control_points: number;
}

export interface ControlPoint {
  point: number;
  label: number;
  start_cost: number;
  position: readonly [number, number, number];
}

/** Error of a request that the program refused. */
export class Refusal extends Error {
  constructor(
    readonly code: string,
    message: string,
    readonly context: string,
  ) {
    super(message);
  }
}

export function encode(head: object): ArrayBuffer {
  const text = new TextEncoder().encode(JSON.stringify(head));
  const bytes = new Uint8Array(4 + text.length + ((4 - (text.length % 4)) % 4));
  new DataView(bytes.buffer).setUint32(0, text.length, true);
  bytes.set(text, 4);
  return bytes.buffer;
}

export function decode(message: ArrayBuffer): Message {
  const length = new DataView(message).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(message, 4, length))) as Message["head"];
  const start = 4 + length + ((4 - (length % 4)) % 4);
  return { head, body: start < message.byteLength ? message.slice(start) : new ArrayBuffer(0) };
}
