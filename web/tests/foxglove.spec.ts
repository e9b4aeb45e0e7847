// SPDX-License-Identifier: Apache-2.0
// A run as Foxglove sees it: live over its WebSocket, and recorded in an MCAP file. No browser is started.
import { type ChildProcess, spawn } from "node:child_process";
import { createReadStream, existsSync, mkdtempSync, rmSync } from "node:fs";
import { open } from "node:fs/promises";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import type * as protocol from "@foxglove/ws-protocol";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { expect, test } from "@playwright/test";
import { decompress } from "fzstd";
import { WebSocket } from "ws";
import { programFile } from "./support/program";
import { expectMessage, kTypes, type Place, readerOf } from "./support/ros_messages";

// As a module for require: Node finds not all its names as those of an ES module.
const { FoxgloveClient } = createRequire(import.meta.url)("@foxglove/ws-protocol") as typeof protocol;

const kPlace: Place = { low: [-0.7, -0.5, -0.03], high: [0.7, 0.5, 0.45], voxel_m: 0.02 };
const kViews = 2;
const kTopics = Object.keys(kTypes).sort();
const kOnlyOfViews = kTopics.filter((topic) => !/occupied|frontier|map_2d/.test(topic));

/** An exploration of a table that ends by itself. */
class Run {
  said = "";
  private readonly child: ChildProcess;
  private readonly ended: Promise<number | null>;

  constructor(folder: string, more: readonly string[]) {
    const args = ["explore", "tabletop-1", "--robot", "free", "--max-views", String(kViews), "--voxel-size", String(kPlace.voxel_m)];
    this.child = spawn(programFile(), [...args, "--no-pictures", "--quiet", "--out", folder, ...more], { stdio: ["ignore", "pipe", "pipe"] });
    for (const stream of [this.child.stdout, this.child.stderr]) stream?.on("data", (text) => void (this.said += String(text)));
    this.ended = new Promise((resolve) => this.child.once("close", resolve));
  }
  async says(pattern: RegExp): Promise<string> {
    await expect.poll(() => pattern.test(this.said), { intervals: [20], timeout: 60_000 }).toBe(true);
    return pattern.exec(this.said)?.[1] ?? "";
  }
  async end(): Promise<void> {
    const status = await this.ended;
    if (status !== 0) throw new Error(`saccade ended with ${status}\n${this.said}`);
  }
  kill(): void {
    this.child.kill("SIGKILL");
  }
}

interface Seen {
  topic: string;
  time: bigint;
}

/** A client of Foxglove's own protocol library that subscribes to everything and checks each message. */
class Viewer {
  readonly seen: Seen[] = [];
  readonly types: Record<string, string> = {};
  readonly errors: unknown[] = [];
  readonly closed: Promise<number>;
  readonly socket: WebSocket;

  constructor(url: string, subprotocol: string, origin: string) {
    this.socket = new WebSocket(url, [subprotocol], { origin });
    const client = new FoxgloveClient({ ws: this.socket as unknown as protocol.IWebSocket });
    const subscribed = new Map<number, { topic: string; read: (data: ArrayBufferView) => unknown }>();
    client.on("serverInfo", (info) => {
      if (info.name !== "saccade" || info.capabilities.length > 0 || !info.sessionId) this.errors.push(info);
    });
    client.on("status", (status) => this.errors.push(status));
    client.on("error", (error) => this.errors.push(error));
    client.on("advertise", (channels) => {
      for (const channel of channels) {
        if (channel.encoding !== "cdr" || channel.schemaEncoding !== "ros2msg") this.errors.push(channel);
        this.types[channel.topic] = channel.schemaName;
        subscribed.set(client.subscribe(channel.id), { topic: channel.topic, read: readerOf(channel.schema) });
      }
    });
    client.on("message", ({ subscriptionId, timestamp, data }) => {
      try {
        const channel = subscribed.get(subscriptionId);
        if (!channel) throw new Error(`subscription ${subscriptionId} was not asked for`);
        expectMessage(channel.topic, channel.read(data), kPlace);
        this.seen.push({ topic: channel.topic, time: timestamp });
      } catch (error) {
        this.errors.push(error);
      }
    });
    this.closed = new Promise((resolve) => client.on("close", (event) => resolve(event.code)));
  }

  of(topic: string): bigint[] {
    return this.seen.filter((message) => message.topic === topic).map((message) => message.time);
  }
}

// The first run is recorded while it is looked at; the last test reads the file.
test.describe.configure({ mode: "serial" });
let folder = "";
test.beforeAll(() => {
  folder = mkdtempSync(join(tmpdir(), "saccade-foxglove-"));
});
test.afterAll(() => rmSync(folder, { recursive: true, force: true }));

test("two viewers see a run live, each by its subprotocol", async () => {
  const run = new Run(join(folder, "live"), ["--foxglove", "0", "--record", join(folder, "run.mcap")]);
  try {
    const url = await run.says(/^Foxglove connects to (ws:\S+)$/m);
    const viewers = [new Viewer(url, "foxglove.websocket.v1", "https://app.foxglove.dev"), new Viewer(url, "foxglove.sdk.v1", "file://")];
    for (const viewer of viewers) {
      expect(await viewer.closed).toBe(1001); // after the last message
      expect(viewer.errors).toEqual([]);
      expect(viewer.types).toEqual(kTypes);
      for (const topic of kTopics) {
        const times = viewer.of(topic);
        const views = kOnlyOfViews.includes(topic) ? kViews : kViews + 1; // the map is there after the scan, too
        expect(times.length, topic).toBe(views);
        expect([...times].sort(), topic).toEqual(times);
      }
      const now = BigInt(Date.now()) * 1_000_000n;
      for (const { time } of viewer.seen) expect(now - time).toBeLessThan(120_000_000_000n);
    }
    expect(viewers.map((viewer) => viewer.socket.protocol)).toEqual(["foxglove.websocket.v1", "foxglove.sdk.v1"]);
    await run.end();
  } finally {
    run.kill();
  }
});

test("a viewer that comes late sees the newest of all; others are refused", async () => {
  const run = new Run(join(folder, "shown"), ["--show", "--no-browser"]);
  try {
    const url = await run.says(/^Foxglove connects to (ws:\S+token=\S+)$/m);
    await expect.poll(() => existsSync(join(folder, "shown", "run.json")), { intervals: [20], timeout: 60_000 }).toBe(true);
    const refused = async (address: string, subprotocols: string[], origin: string) =>
      new Promise<number>((resolve, reject) => {
        const socket = new WebSocket(address, subprotocols, { origin });
        socket.on("unexpected-response", (request, answer) => {
          resolve(answer.statusCode ?? 0);
          request.destroy();
        });
        socket.on("open", () => reject(new Error("it was let in")));
        socket.on("error", () => {});
      });
    expect(await refused(url, ["foxglove.websocket.v2"], "https://app.foxglove.dev")).toBe(400);
    expect(await refused(url, [], "https://app.foxglove.dev")).toBe(400);
    expect(await refused(url.replace(/token=.*/, "token=wrong"), ["foxglove.sdk.v1"], "https://app.foxglove.dev")).toBe(403);
    const viewer = new Viewer(url, "foxglove.sdk.v1", "https://lichtblick.example");
    await expect.poll(() => viewer.seen.length, { intervals: [20] }).toBe(kTopics.length);
    expect(viewer.seen.map((message) => message.topic).sort()).toEqual(kTopics);
    expect(new Set(viewer.seen.map((message) => message.time)).size).toBe(1); // all of the last view
    expect(viewer.errors).toEqual([]);
    viewer.socket.send("rubbish");
    await expect.poll(() => viewer.errors.length, { intervals: [20] }).toBe(1);
    expect(viewer.errors[0]).toMatchObject({ op: "status", level: 2 });
    viewer.socket.close();
    await viewer.closed;
  } finally {
    run.kill();
  }
});

test("the recording of the first run is a whole MCAP file", async () => {
  const file = join(folder, "run.mcap");
  const handle = await open(file);
  try {
    const size = BigInt((await handle.stat()).size);
    const reader = await McapIndexedReader.Initialize({
      readable: {
        size: async () => size,
        read: async (offset, length) => {
          const bytes = new Uint8Array(Number(length));
          await handle.read(bytes, 0, bytes.length, Number(offset));
          return bytes;
        },
      },
      decompressHandlers: { zstd: (bytes, length) => decompress(bytes, new Uint8Array(Number(length))) },
    });
    expect(reader.header).toMatchObject({ profile: "ros2", library: "saccade" });
    expect(reader.chunkIndexes.every((chunk) => chunk.compression === "zstd")).toBe(true);
    const readers = new Map<number, { topic: string; read: (data: ArrayBufferView) => unknown }>();
    const types: Record<string, string> = {};
    for (const channel of reader.channelsById.values()) {
      const schema = reader.schemasById.get(channel.schemaId);
      expect([channel.messageEncoding, schema?.encoding]).toEqual(["cdr", "ros2msg"]);
      types[channel.topic] = schema?.name ?? "";
      readers.set(channel.id, { topic: channel.topic, read: readerOf(new TextDecoder().decode(schema?.data)) });
    }
    expect(types).toEqual(kTypes);
    const counts = new Map<number, bigint>();
    const sequences = new Map<number, number>();
    let last = 0n;
    let first: bigint | undefined;
    for await (const message of reader.readMessages()) {
      const channel = readers.get(message.channelId);
      if (!channel) throw new Error(`channel ${message.channelId} is not described`);
      expectMessage(channel.topic, channel.read(message.data), kPlace);
      expect(message.logTime).toBeGreaterThanOrEqual(last);
      last = message.logTime;
      first ??= message.logTime;
      expect(message.sequence).toBe(sequences.get(message.channelId) ?? message.sequence);
      sequences.set(message.channelId, message.sequence + 1);
      counts.set(message.channelId, (counts.get(message.channelId) ?? 0n) + 1n);
    }
    const total = BigInt(kOnlyOfViews.length * kViews + (kTopics.length - kOnlyOfViews.length) * (kViews + 1));
    expect(reader.statistics).toMatchObject({
      messageCount: total,
      channelCount: kTopics.length,
      schemaCount: new Set(Object.values(kTypes)).size,
      chunkCount: reader.chunkIndexes.length,
      messageStartTime: first,
      messageEndTime: last,
      channelMessageCounts: counts,
    });
  } finally {
    await handle.close();
  }
  expect(await messagesOfAStream(file)).toBe(kOnlyOfViews.length * kViews + 3 * (kViews + 1));
});

/** Reads a file from its beginning to its end, without its index, and checks every checksum. */
async function messagesOfAStream(file: string): Promise<number> {
  const reader = new McapStreamReader({ validateCrcs: true, decompressHandlers: { zstd: (bytes, length) => decompress(bytes, new Uint8Array(Number(length))) } });
  let messages = 0;
  for await (const bytes of createReadStream(file)) {
    reader.append(bytes as Uint8Array);
    for (let record = reader.nextRecord(); record; record = reader.nextRecord()) if (record.type === "Message") ++messages;
  }
  expect(reader.done()).toBe(true);
  return messages;
}
