// SPDX-License-Identifier: Apache-2.0
// Other pages in the same browser cannot reach the program, though the browser would send them its cookie.
import { type Server, createServer, request as httpRequest } from "node:http";
import type { AddressInfo } from "node:net";
import { join } from "node:path";
import { makeTable } from "./support/clouds";
import { expect, test } from "./support/desk";

let foreign: Server;
let foreignUrl = "";

test.beforeAll(async () => {
  foreign = createServer((_, answer) => answer.setHeader("Content-Type", "text/html").end("<!doctype html><title>foreign</title>"));
  await new Promise<void>((resolve) => foreign.listen(0, "127.0.0.1", resolve));
  // Of the same site as http://localhost:PORT of the program, so that cookies go along.
  foreignUrl = `http://localhost:${(foreign.address() as AddressInfo).port}/`;
});
test.afterAll(() => void foreign.close());

/** Status of a request without a browser. */
function statusOf(port: number, path: string, headers: Record<string, string>): Promise<number> {
  return new Promise((resolve, reject) => {
    const asked = httpRequest({ host: "127.0.0.1", port, path, headers }, (answer) => {
      answer.resume();
      resolve(answer.statusCode ?? 0);
    });
    asked.on("upgrade", (answer) => {
      answer.socket.destroy();
      resolve(answer.statusCode ?? 0);
    });
    asked.on("error", reject);
    asked.end();
  });
}

test("a foreign page can neither read nor open the socket nor frame the page", async ({ desk, context }) => {
  const cloud = makeTable(join(desk.folder, "table.pcd"), { spacing_m: 0.02 });
  const program = await desk.start("annotate", cloud.file);
  await desk.open(program, cloud); // this browser has the cookie now
  const origin = new URL(program.url).origin;

  /** What any page can try. */
  const attempts = async (at: string) => {
    const page = await context.newPage();
    await page.goto(at);
    const result = await page.evaluate(async (program) => {
      const fetched = async (path: string) => {
        try {
          return (await fetch(program + path, { credentials: "include" })).status;
        } catch {
          return "refused";
        }
      };
      const socket = await new Promise<string>((resolve) => {
        const tried = new WebSocket(`${program.replace("http", "ws")}/socket`);
        tried.onopen = () => resolve("open");
        tried.onerror = () => resolve("refused");
      });
      return { page: await fetched("/"), labels: await fetched("/data/labels?cloud=0&format=npy"), socket };
    }, origin);
    await page.close();
    return result;
  };
  expect(await attempts(foreignUrl)).toEqual({ page: "refused", labels: "refused", socket: "refused" });
  // The same from the program's own origin, so that it is known what was refused.
  expect(await attempts(`${origin}/assets/licenses.txt`)).toEqual({ page: 200, labels: 200, socket: "open" });

  const framing = await context.newPage();
  await framing.goto(foreignUrl);
  const framed = await framing.evaluate((address) => {
    const frame = document.body.appendChild(document.createElement("iframe"));
    return new Promise<boolean>((resolve) => {
      frame.onload = () => resolve(true);
      frame.src = address;
    });
  }, `${origin}/`);
  expect(framed).toBe(true);
  const inner = framing.frames().find((frame) => frame !== framing.mainFrame());
  await expect.poll(() => inner?.url()).toMatch(/^chrome-error:/);
});

test("without the token, or in another's name, everything is forbidden", async ({ desk, browser }) => {
  const cloud = makeTable(join(desk.folder, "table.pcd"), { spacing_m: 0.02 });
  const program = await desk.start("annotate", cloud.file);
  const token = new URL(program.url).searchParams.get("token")!;
  const Host = `localhost:${program.port}`;
  const upgrade = {
    Connection: "Upgrade",
    Upgrade: "websocket",
    "Sec-WebSocket-Version": "13",
    "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==",
  };
  const labels = "/data/labels?cloud=0&format=npy";
  const good = `token=${token}`;
  const wrong = `token=${token.replace(/./g, (c) => (c === "0" ? "1" : "0"))}`;
  const status = (path: string, headers: Record<string, string> = {}) => statusOf(program.port, path, { Host, ...headers });

  for (const path of ["/", labels]) {
    expect(await status(path), path).toBe(403);
    const more = path.includes("?") ? "&" : "?";
    expect(await status(`${path}${more}${wrong}`), path).toBe(403);
    expect(await status(`${path}${more}${good}`), path).toBeLessThan(400);
    expect(await status(`${path}${more}${good}`, { Host: "evil.example" }), path).toBe(403);
    expect(await status(`${path}${more}${good}`, { Origin: "http://evil.example" }), path).toBe(403);
    expect(await status(`${path}${more}${good}`, { Origin: foreignUrl.slice(0, -1) }), path).toBe(403);
  }
  expect(await status("/socket", upgrade)).toBe(403);
  expect(await status(`/socket?${wrong}`, upgrade)).toBe(403);
  expect(await status(`/socket?${good}`, { ...upgrade, Origin: "http://evil.example" })).toBe(403);
  expect(await status(`/socket?${good}`, { ...upgrade, Host: "evil.example" })).toBe(403);
  expect(await status(`/socket?${good}`, upgrade)).toBe(101);
  for (const path of ["/../../etc/passwd", "/assets/../../etc/passwd", "/assets/%2e%2e/%2e%2e/etc/passwd"]) {
    expect([400, 403, 404], path).toContain(await status(`${path}?${good}`));
  }

  const stranger = await browser.newPage();
  const answer = await stranger.goto(`http://localhost:${program.port}/`);
  expect(answer?.status()).toBe(403);
  await stranger.close();
});

test("the token leaves the address, and the cookie is for the program alone", async ({ desk, context }) => {
  const cloud = makeTable(join(desk.folder, "table.pcd"), { spacing_m: 0.02 });
  const program = await desk.start("annotate", cloud.file);
  const { page } = await desk.open(program, cloud);
  expect(page.url()).toBe(`http://localhost:${program.port}/`);
  const cookies = await context.cookies();
  expect(cookies.length).toBe(1);
  expect(cookies[0]).toMatchObject({ httpOnly: true, sameSite: "Strict", domain: "localhost" });
  expect(await page.evaluate(() => document.cookie)).toBe("");
});
