// SPDX-License-Identifier: Apache-2.0
// The WebSocket to the program: questions and their answers, notices, and coming back after the connection ended.
import { type Message, Refusal, decode, encode } from "./protocol";
import { fetchFile, subprotocols, token } from "./token";

export type Hello = Record<string, unknown> & { mode: string; title: string; version: string };

/** closed: the program does not let this page in any more. */
export type ConnectionState = "connecting" | "connected" | "reconnecting" | "closed";

/** Error of a request whose answer was lost with the connection. The program may have carried out the request. */
export class Disconnected extends Error {}

const kProtocol = 1;
const kWaits_ms = [250, 500, 1000, 2000, 4000, 5000];
const kLetsGo_ms = 700;
const kQuietLimit_ms = 20_000; // for the program's hello

interface Waiting {
  resolve(message: Message): void;
  reject(error: Error): void;
}

export class Connection {
  state: ConnectionState = "connecting";
  hello: Hello | null = null;
  name = ""; // as others see the person

  private socket: WebSocket | null = null;
  private request = 0;
  private attempts = 0;
  private timer = 0;
  private readonly waiting = new Map<number, Waiting>();
  private readonly listeners = new Map<string, ((message: Message) => void)[]>();
  private readonly watchers: ((state: ConnectionState) => void)[] = [];

  /** @param client whose undo takes actions back. */
  constructor(readonly client: number) {
    const hurry = () => {
      if (this.state === "reconnecting" && this.socket === null) this.connect();
    };
    window.addEventListener("online", hurry);
    document.addEventListener("visibilitychange", hurry);
  }

  /** Resolves with the first answer to hello. */
  start(): Promise<Hello> {
    return new Promise((resolve) => {
      if (token() === "") return this.become("closed");
      const stop = this.watch((state) => {
        if (state !== "connected" || !this.hello) return;
        stop();
        resolve(this.hello);
      });
      this.connect();
    });
  }

  /** Called with the state at every change of it. @return ends this. */
  watch(watcher: (state: ConnectionState) => void): () => void {
    this.watchers.push(watcher);
    return () => void this.watchers.splice(this.watchers.indexOf(watcher), 1);
  }

  on(notice: string, listener: (message: Message) => void): void {
    this.listeners.set(notice, [...(this.listeners.get(notice) ?? []), listener]);
  }

  /** Rejects with Refusal or Disconnected. */
  ask(question: Record<string, unknown> & { type: string }): Promise<Message> {
    const socket = this.socket;
    if (!socket || socket.readyState !== WebSocket.OPEN) return Promise.reject(new Disconnected("not connected"));
    const request = ++this.request;
    return new Promise((resolve, reject) => {
      this.waiting.set(request, { resolve, reject });
      socket.send(encode({ ...question, request }));
    });
  }

  private connect(): void {
    clearTimeout(this.timer);
    const address = new URL("socket", document.baseURI);
    address.protocol = address.protocol === "https:" ? "wss:" : "ws:";
    const socket = new WebSocket(address, subprotocols());
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    socket.addEventListener("open", () => void this.greet(socket));
    socket.addEventListener("message", (event) => this.receive(event.data));
    socket.addEventListener("close", () => void this.ended());
  }

  private async greet(socket: WebSocket): Promise<void> {
    const patience = window.setTimeout(() => socket.close(), kQuietLimit_ms);
    try {
      const { head } = await this.ask({ type: "hello", protocol: kProtocol, client: this.client, ...(this.name ? { name: this.name } : {}) });
      const before = this.hello;
      this.hello = head as unknown as Hello;
      // Another program, or another folder, answers at this address now.
      if (before && (before.mode !== this.hello.mode || before.version !== this.hello.version)) location.reload();
      this.attempts = 0;
      this.become("connected");
    } catch (error) {
      if (error instanceof Refusal) this.become("closed");
    } finally {
      clearTimeout(patience);
    }
  }

  private receive(data: unknown): void {
    if (!(data instanceof ArrayBuffer)) return;
    const message = decode(data);
    const { type, request } = message.head;
    if (type !== "answer" || request === undefined) {
      for (const listener of this.listeners.get(type) ?? []) listener(message);
      return;
    }
    const waiting = this.waiting.get(request);
    this.waiting.delete(request);
    if (message.head["ok"] === true) waiting?.resolve(message);
    else waiting?.reject(refusalOf(message));
  }

  private async ended(): Promise<void> {
    this.socket = null;
    const unanswered = [...this.waiting.values()];
    this.waiting.clear();
    for (const { reject } of unanswered) reject(new Disconnected("the connection ended"));
    if (this.state === "closed") return;
    if (this.hello) this.become("reconnecting");
    if (await isRefused()) {
      this.become("closed");
      return;
    }
    const wait_ms = kWaits_ms[Math.min(this.attempts++, kWaits_ms.length - 1)]! * (0.8 + 0.4 * Math.random());
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => {
      if (this.socket === null) this.connect();
    }, wait_ms);
  }

  private become(state: ConnectionState): void {
    if (this.state === state && state !== "connected") return;
    this.state = state;
    for (const watcher of [...this.watchers]) watcher(state);
  }
}

/** Whether a program answers at the address and refuses the token: it is another one. */
async function isRefused(): Promise<boolean> {
  try {
    return (await fetchFile(".", { method: "HEAD", cache: "no-store" })).status === 403;
  } catch {
    return false;
  }
}

function refusalOf(message: Message): Refusal {
  const error = message.head["error"] as { code?: string; message?: string; context?: string } | undefined;
  return new Refusal(error?.code ?? "unknown", error?.message ?? "the program refused", error?.context ?? "");
}

/** A number of this tab's own, the same after a reload; another one where a copy of this tab has it. */
export async function ownClient(): Promise<number> {
  const key = "saccade.client";
  let kept = 0;
  try {
    kept = Number(sessionStorage.getItem(key));
  } catch {
    // a new one each time
  }
  if (Number.isSafeInteger(kept) && kept > 0 && (await holdName(`${key}.${kept}`))) return kept;
  const [high, low] = crypto.getRandomValues(new Uint32Array(2));
  const client = (high! >>> 12) * 2 ** 32 + low! + 1;
  await holdName(`${key}.${client}`);
  try {
    sessionStorage.setItem(key, String(client));
  } catch {
    // a new one each time
  }
  return client;
}

/** True where this page is the only one with this name, and from now until it ends. A page that is reloaded lets go soon. */
function holdName(name: string): Promise<boolean> {
  if (!("locks" in navigator)) return Promise.resolve(true);
  return new Promise((resolve) => {
    const held = navigator.locks.request(name, { signal: AbortSignal.timeout(kLetsGo_ms) }, () => {
      resolve(true);
      return new Promise<void>(() => undefined);
    });
    held.catch(() => resolve(false));
  });
}
