// SPDX-License-Identifier: Apache-2.0
// Actions on their way to the disk: one at a time, none lost or done twice (docs/reference/protocol.md).
import type { Connection } from "../connection";
import { Disconnected } from "../connection";
import { Refusal } from "../protocol";

export type ActionObject = Record<string, unknown> & { do: string };

/** done: false: there was nothing to undo or redo. */
export interface ActionResult {
  done: boolean;
  carried?: number; // points that took the labels of another cloud
}

interface Waiting {
  question: Record<string, unknown> & { type: string };
  resolve(result: ActionResult): void;
  reject(error: Error): void;
}

const kMostWaiting = 64;

export class ActionQueue {
  private readonly waiting: Waiting[] = []; // the first one may be under way
  private underWay = false;
  private interrupted = false;
  private ready = false; // a cloud is open
  private clientActions = 0;

  constructor(
    private readonly connection: Connection,
    private readonly changed: (pending: number, answer: Record<string, unknown> | null) => void,
  ) {}

  get pending(): number {
    return this.waiting.length;
  }

  /** Rejects with Refusal. Where the connection ends the action waits for the next one. */
  submit(action: ActionObject, options: Record<string, unknown> = {}): Promise<ActionResult> {
    if (this.waiting.length >= kMostWaiting) {
      return Promise.reject(new Refusal("unavailable", "too many actions wait for the connection", ""));
    }
    return new Promise((resolve, reject) => {
      this.waiting.push({ question: { type: "action", action, ...options }, resolve, reject });
      this.changed(this.waiting.length, null);
      this.advance();
    });
  }

  /** The cloud is open with this many actions of this client: what was under way was done, or is sent again. */
  opened(clientActions: number): void {
    const first = this.waiting[0];
    if (this.interrupted && first && clientActions > this.clientActions) {
      this.waiting.shift();
      first.resolve({ done: true });
      this.changed(this.waiting.length, null);
    }
    this.interrupted = false;
    this.clientActions = clientActions;
    this.ready = true;
    this.advance();
  }

  /** Until the next opened() actions wait. */
  pause(): void {
    this.ready = false;
  }

  /** For another cloud: what waits has no meaning there. */
  drop(): void {
    const dropped = this.waiting.splice(0);
    this.underWay = false;
    this.interrupted = false;
    this.ready = false;
    for (const { reject } of dropped) reject(new Refusal("cancelled", "another annotation was opened meanwhile", ""));
    this.changed(0, null);
  }

  private advance(): void {
    const first = this.waiting[0];
    if (!first || this.underWay || !this.ready) return;
    this.underWay = true;
    void this.send(first);
  }

  private async send(first: Waiting): Promise<void> {
    try {
      const { head } = await this.connection.ask(first.question);
      if (this.waiting[0] !== first) return; // dropped
      if (typeof head["client_actions"] === "number") this.clientActions = head["client_actions"];
      this.finish(head);
      const carried = typeof head["carried"] === "number" ? { carried: head["carried"] } : {};
      first.resolve({ done: head["done"] !== false, ...carried });
    } catch (error) {
      if (this.waiting[0] !== first) return;
      if (error instanceof Disconnected) {
        this.underWay = false;
        this.interrupted = true;
        this.ready = false;
        return;
      }
      this.finish(null);
      first.reject(error instanceof Error ? error : new Error(String(error)));
    }
    this.advance();
  }

  private finish(answer: Record<string, unknown> | null): void {
    this.waiting.shift();
    this.underWay = false;
    this.changed(this.waiting.length, answer);
  }
}
