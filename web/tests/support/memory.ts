// SPDX-License-Identifier: Apache-2.0
// Memory of the programs that a test has started.
import { readFileSync, readdirSync } from "node:fs";

/** Memory of a process's descendants by their names, in MiB. What processes share is left out. */
export function memoryOf(root: number): Map<string, number> {
  const parents = new Map<number, number>();
  const all = new Map<number, { name: string; mb: number }>();
  for (const number of readdirSync("/proc").filter((one) => /^\d+$/.test(one)).map(Number)) {
    try {
      const status = readFileSync(`/proc/${number}/status`, "utf8");
      parents.set(number, Number(/^PPid:\s+(\d+)/m.exec(status)?.[1]));
      all.set(number, { name: /^Name:\s+(\S+)/m.exec(status)?.[1] ?? "", mb: Number(/^RssAnon:\s+(\d+)/m.exec(status)?.[1] ?? 0) / 1024 });
    } catch {
      // has ended meanwhile
    }
  }
  const belongs = (process: number | undefined): boolean => process !== undefined && (process === root || belongs(parents.get(process)));
  const sums = new Map<string, number>();
  for (const [process, { name, mb }] of all) if (process !== root && belongs(process)) sums.set(name, (sums.get(name) ?? 0) + mb);
  return sums;
}
