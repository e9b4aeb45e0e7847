// SPDX-License-Identifier: Apache-2.0
// The real program, started, killed and started again as a test wants it.
import { type ChildProcess, spawn, spawnSync } from "node:child_process";
import { existsSync } from "node:fs";
import { fileURLToPath } from "node:url";

const kStart_ms = 60_000;
const kEnd_ms = 20_000;

export function programFile(): string {
  const file = process.env["SACCADE_PROGRAM"] ?? fileURLToPath(new URL("../../../build/release/saccade", import.meta.url));
  if (!existsSync(file)) throw new Error(`${file} is not there: make build, or name the program in SACCADE_PROGRAM`);
  return file;
}

/** Runs a command without a page and returns its standard output. */
export function runProgram(args: readonly string[]): string {
  const { status, stdout, stderr, error } = spawnSync(programFile(), ["--quiet", ...args], { encoding: "utf8" });
  if (error) throw error;
  if (status !== 0) throw new Error(`saccade ${args.join(" ")}: status ${status}\n${stderr}`);
  return stdout;
}

export class Program {
  /** With the token, as the program prints it. */
  url = "";
  private child: ChildProcess | null = null;
  private said = "";

  /** @param tokenFile keeps the address of the page over restarts. */
  constructor(
    private readonly args: readonly string[],
    private readonly tokenFile: string,
  ) {}

  get port(): number {
    return Number(new URL(this.url).port);
  }

  /** Until it says where the page is. Again after kill() or stop(), at the same place. */
  async start(): Promise<this> {
    if (this.child) throw new Error("the program runs already");
    const port = this.url ? this.port : 0;
    const args = [...this.args, "--no-browser", "--port", String(port), "--token-file", this.tokenFile];
    const child = spawn(programFile(), args, { stdio: ["ignore", "pipe", "pipe"] });
    this.child = child;
    let out = "";
    this.url = await new Promise<string>((resolve, reject) => {
      const fail = (why: string) => {
        clearTimeout(patience);
        child.kill("SIGKILL");
        this.child = null;
        reject(new Error(`saccade ${args.join(" ")}: ${why}\n${this.said}`));
      };
      const patience = setTimeout(() => fail(`no page after ${kStart_ms} ms`), kStart_ms);
      child.once("error", (error) => fail(error.message));
      child.once("close", (status, signal) => fail(`ended with ${signal ?? status}`));
      child.stderr.on("data", (text) => void (this.said += String(text)));
      child.stdout.on("data", (text) => {
        this.said += String(text);
        out += String(text);
        const url = /^The page is at (http:\/\/\S+)$/m.exec(out)?.[1];
        if (!url || !out.endsWith("\n")) return;
        clearTimeout(patience);
        child.removeAllListeners("close");
        resolve(url);
      });
    });
    return this;
  }

  /** As a loss of power: nothing can be tidied up. */
  kill(): Promise<void> {
    return this.end("SIGKILL", (_, by) => by === "SIGKILL");
  }

  /** As Ctrl-C; what it says then is no error. */
  stop(): Promise<void> {
    return this.end("SIGINT", (status) => status === 0);
  }

  /** Fails also where it has ended by itself before. */
  private async end(signal: NodeJS.Signals, good: (status: number | null, by: NodeJS.Signals | null) => boolean): Promise<void> {
    const child = this.child;
    this.child = null;
    if (!child) return;
    const ended = child.exitCode !== null || child.signalCode !== null;
    if (!ended) {
      await new Promise<void>((resolve) => {
        const patience = setTimeout(() => child.kill("SIGKILL"), kEnd_ms);
        child.once("exit", () => {
          clearTimeout(patience);
          resolve();
        });
        child.kill(signal);
      });
    }
    if (ended || !good(child.exitCode, child.signalCode)) throw new Error(`saccade ended with ${child.signalCode ?? child.exitCode}\n${this.said}`);
  }
}
