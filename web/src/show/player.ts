// SPDX-License-Identifier: Apache-2.0
// Which step is shown, and the clock that goes on to the next one.

export class Player {
  private count = 0;
  private at = 0;
  private timer: number | undefined;
  /** Shows a step; the next one waits for its end. */
  show: (step: number) => Promise<void> = () => Promise.resolve();
  changed: () => void = () => undefined;

  constructor(private readonly pause_ms = 1200) {}

  get step(): number {
    return this.at;
  }
  get steps(): number {
    return this.count;
  }
  get playing(): boolean {
    return this.timer !== undefined;
  }
  get atEnd(): boolean {
    return this.at >= this.count - 1;
  }

  /** Sets the number of steps. A player at the last step of a live run follows it to the new one. */
  resize(count: number, live: boolean): void {
    const follows = this.atEnd && (live || this.count > 0);
    this.count = count;
    this.at = follows ? Math.max(0, count - 1) : Math.min(this.at, Math.max(0, count - 1));
    this.changed();
  }

  go(step: number): void {
    const next = Math.max(0, Math.min(this.count - 1, step));
    if (next === this.at || this.count === 0) return;
    this.at = next;
    this.changed();
    void this.show(next);
  }

  play(): void {
    if (this.playing || this.count < 2) return;
    if (this.atEnd) this.go(0);
    this.arm();
    this.changed();
  }

  stop(): void {
    if (!this.playing) return;
    window.clearTimeout(this.timer);
    this.timer = undefined;
    this.changed();
  }

  private arm(): void {
    this.timer = window.setTimeout(() => void this.tick(), this.pause_ms);
  }

  private async tick(): Promise<void> {
    if (this.atEnd) return this.stop();
    this.at += 1;
    this.changed();
    await this.show(this.at);
    if (!this.playing) return;
    if (this.atEnd) this.stop();
    else this.arm();
  }
}
