// SPDX-License-Identifier: Apache-2.0
// 300,000 points, drawn in software: a click is seen no later than twice the time of a full redraw.
import { join } from "node:path";
import type { Page } from "@playwright/test";
import { kBox, kTable, kTops, makeTable } from "./support/clouds";
import { expect, test } from "./support/desk";

const kTimes = 5;
const kMostAnswer_ms = 10; // on a machine that needs at most 25 times as long for a redraw; slower or busier ones in proportion
const kAnswersPerRedraw = 25;
const kRounds = 3; // while something else has the processor, a round may be slow; of a page that is slow, all are

function quantile(times: readonly number[], share: number): number {
  return [...times].sort((a, b) => a - b)[Math.floor(share * (times.length - 1))]!;
}

/** Until the next input has changed a pixel of the view, in milliseconds from when the browser had the input. */
async function untilChanged(page: Page, type: "pointerup" | "keydown", at: readonly [number, number], input: () => Promise<void>): Promise<number> {
  const measured = page.evaluate(
    ([type, x, y]) =>
      new Promise<number>((resolve, reject) => {
        const canvas = document.querySelector("canvas")!;
        const gl = canvas.getContext("webgl2")!;
        const box = canvas.getBoundingClientRect();
        const column = Math.floor(((x - box.x) * canvas.width) / box.width);
        const row = canvas.height - 1 - Math.floor(((y - box.y) * canvas.height) / box.height);
        const look = () => {
          const bound = gl.getParameter(gl.READ_FRAMEBUFFER_BINDING) as WebGLFramebuffer | null;
          gl.bindFramebuffer(gl.READ_FRAMEBUFFER, null);
          const bytes = new Uint8Array(4);
          gl.readPixels(column, row, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
          gl.bindFramebuffer(gl.READ_FRAMEBUFFER, bound);
          return bytes.join();
        };
        const before = look();
        document.documentElement.dataset["armed"] = "true";
        const begin = (event: Event) => {
          const poll = () => {
            const now = performance.now();
            if (look() !== before) resolve(performance.now() - event.timeStamp);
            else if (now - event.timeStamp > 20_000) reject(new Error("the pixel does not change"));
            // After what the page draws in a frame.
            else requestAnimationFrame(() => setTimeout(poll));
          };
          requestAnimationFrame(() => setTimeout(poll));
        };
        window.addEventListener(type, begin, { once: true, capture: true });
      }),
    [type, ...at] as const,
  );
  await page.waitForFunction(() => document.documentElement.dataset["armed"] === "true");
  await input();
  const time = await measured;
  await page.evaluate(() => delete document.documentElement.dataset["armed"]);
  return time;
}

test("300,000 points: from a click to the labels that it gives", async ({ desk }) => {
  const cloud = makeTable(join(desk.folder, "table.pcd"), { spacing_m: 0.0023 });
  expect(cloud.truth.length).toBeGreaterThan(290_000);
  const program = await desk.start("annotate", cloud.file);
  const annotator = await desk.open(program, cloud);
  const { page } = annotator;
  await annotator.labelTops([kTable, kBox]);
  await annotator.settled();
  const [x, y] = annotator.at(kTops[kBox]!);
  await page.mouse.move(x, y);
  await expect(page.locator(".readout")).toContainText("control point"); // what is under the mouse is known quickly from now

  let [click, redraw] = [Infinity, 0];
  for (let round = 0; round < kRounds && click > 2 * redraw; ++round) {
    const clicks: number[] = [];
    const redraws: number[] = [];
    for (let i = 0; i < kTimes; ++i) {
      // The box and its control point have another label, one after the other.
      await page.keyboard.press((round + i) % 2 === 0 ? "3" : "2");
      clicks.push(await untilChanged(page, "pointerup", [x + 24, y], () => page.mouse.click(x, y)));
      await annotator.written();
      redraws.push(await untilChanged(page, "keydown", [x, y], () => page.keyboard.press("Shift+P")));
      await untilChanged(page, "keydown", [x, y], () => page.keyboard.press("Shift+P"));
    }
    [click, redraw] = [quantile(clicks, 0.5), quantile(redraws, 0.5)];
  }
  await page.close();

  // The program alone: a page of its own that only asks.
  const asking = await page.context().newPage();
  const origin = new URL(program.url).origin;
  const token = new URL(program.url).searchParams.get("token")!;
  await asking.goto(`${origin}/assets/licenses.txt`);
  const askOften = () => asking.evaluate(
    async ({ origin, token, times, point }) => {
      const socket = new WebSocket(`${origin.replace("http", "ws")}/socket`, ["saccade.v1", `saccade.token.${token}`]);
      socket.binaryType = "arraybuffer";
      await new Promise((resolve, reject) => {
        socket.onopen = resolve;
        socket.onerror = reject;
      });
      let request = 0;
      const ask = (question: object) =>
        new Promise<number>((resolve, reject) => {
          const mine = ++request;
          const began = performance.now();
          socket.onmessage = (event: MessageEvent<ArrayBuffer>) => {
            const length = new DataView(event.data).getUint32(0, true);
            const head = JSON.parse(new TextDecoder().decode(new Uint8Array(event.data, 4, length))) as { request?: number; ok?: boolean };
            if (head.request !== mine) return;
            if (head.ok) resolve(performance.now() - began);
            else reject(new Error(JSON.stringify(head)));
          };
          const text = new TextEncoder().encode(JSON.stringify({ ...question, request: mine }));
          const bytes = new Uint8Array(4 + Math.ceil(text.length / 4) * 4);
          new DataView(bytes.buffer).setUint32(0, text.length, true);
          bytes.set(text, 4);
          socket.send(bytes);
        });
      await ask({ type: "hello", protocol: 1, client: 77 });
      await ask({ type: "open", cloud: 0, budget: 1_000_000 });
      const answers: number[] = [];
      for (let i = 0; i < times; ++i) answers.push(await ask({ type: "action", action: { do: "set", label: 4 + (i % 2), points: [point] } }));
      return answers;
    },
    { origin, token, times: 2 * kTimes, point: cloud.truth.indexOf(kBox) + 100 },
  );
  const mostAnswer_ms = Math.max(kMostAnswer_ms, redraw / kAnswersPerRedraw);
  let answers = await askOften();
  for (let round = 1; round < kRounds && quantile(answers, 0.25) > mostAnswer_ms; ++round) answers = await askOften();

  const figures = `${cloud.truth.length} points: click to labels ${click.toFixed(0)} ms, full redraw ${redraw.toFixed(0)} ms (medians of ${kTimes}); an action asked and answered ${quantile(answers, 0.5).toFixed(1)} ms (median of ${answers.length}), a quarter within ${quantile(answers, 0.25).toFixed(1)} ms`;
  console.log(figures);
  test.info().annotations.push({ type: "figures", description: figures });
  expect(click).toBeLessThanOrEqual(2 * redraw);
  expect(quantile(answers, 0.25)).toBeLessThanOrEqual(mostAnswer_ms);
});
