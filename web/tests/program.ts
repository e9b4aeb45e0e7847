// SPDX-License-Identifier: Apache-2.0
// The program itself, started for a test. SACCADE_PROGRAM says where it is.
import { type ChildProcess, execFileSync, spawn } from "node:child_process";

export const kProgram = process.env["SACCADE_PROGRAM"] ?? "../build/release/saccade";

export interface Served {
  address: string; // with its token
  process: ChildProcess;
  /** What it printed so far, of both outputs. */
  said(): string;
  stop(): Promise<void>;
}

export function run(...words: string[]): string {
  return execFileSync(kProgram, words, { encoding: "utf8", stdio: ["ignore", "pipe", "pipe"] });
}

/** Starts the program and waits until it says where its page is. */
export function serve(...words: string[]): Promise<Served> {
  const child = spawn(kProgram, [...words, "--no-browser"], { stdio: ["ignore", "pipe", "pipe"] });
  let text = "";
  const ended = new Promise<void>((resolve) => child.once("exit", () => resolve()));
  return new Promise((resolve, reject) => {
    const hear = (chunk: Buffer): void => {
      text += chunk.toString();
      const address = /http:\/\/\S+token=\S+/.exec(text)?.[0];
      if (!address) return;
      const stop = async (): Promise<void> => {
        if (child.exitCode === null && child.signalCode === null) child.kill("SIGINT");
        await ended;
      };
      resolve({ address, process: child, said: () => text, stop });
    };
    child.stdout.on("data", hear);
    child.stderr.on("data", hear);
    child.once("error", reject);
    child.once("exit", (code) => reject(new Error(`${kProgram} ended with ${code}: ${text}`)));
  });
}
