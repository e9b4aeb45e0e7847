// SPDX-License-Identifier: Apache-2.0
// Other pages and other servers of this machine, in the same browser: they cannot reach the program, and learn nothing of it.
import { type IncomingMessage, type Server, createServer, request as httpRequest } from "node:http";
import type { AddressInfo } from "node:net";
import { join } from "node:path";
import { makeTable } from "./support/clouds";
import { expect, test } from "./support/desk";

let foreign: Server;
let foreignUrl = "";
const heard: IncomingMessage[] = []; // requests to the foreign server

test.beforeAll(async () => {
  foreign = createServer((asked, answer) => {
    heard.push(asked);
    answer.setHeader("Content-Type", "text/html").end("<!doctype html><title>foreign</title>");
  });
  await new Promise<void>((resolve) => foreign.listen(0, "127.0.0.1", resolve));
  // localhost makes this the same site as the program's, so that the browser sends the cookies along.
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
  await desk.open(program, cloud); // this browser knows the token now
  const origin = new URL(program.url).origin;
  const token = new URL(program.url).searchParams.get("token")!;

  /** Tries everything that a page of any origin can try. */
  const attempts = async (at: string, token: string) => {
    const page = await context.newPage();
    await page.goto(at);
    const result = await page.evaluate(async ([program, token]) => {
      const fetched = async (path: string) => {
        try {
          return (await fetch(program + path, { credentials: "include", headers: token === "" ? {} : { "Saccade-Token": token } })).status;
        } catch {
          return "refused";
        }
      };
      const socket = await new Promise<string>((resolve) => {
        const tried = new WebSocket(`${program.replace("http", "ws")}/socket`, token === "" ? [] : ["saccade.v1", `saccade.token.${token}`]);
        tried.onopen = () => resolve("open");
        tried.onerror = () => resolve("refused");
      });
      return { page: await fetched("/"), labels: await fetched("/data/labels?cloud=0&format=npy"), socket };
    }, [origin, token] as const);
    await page.close();
    return result;
  };
  const nothing = { page: "refused", labels: "refused", socket: "refused" };
  expect(await attempts(foreignUrl, "")).toEqual(nothing);
  expect(await attempts(foreignUrl, token)).toEqual(nothing);
  // The attempts succeed from the program's own origin, so the refusals above are due to the origin.
  const own = `${origin}/assets/licenses.txt`;
  expect(await attempts(own, token)).toEqual({ page: 200, labels: 200, socket: "open" });
  expect(await attempts(own, "")).toEqual({ page: 200, labels: 403, socket: "refused" });

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

  expect(await status("/")).toBe(200); // the page holds no secret, and knows nothing without the token
  expect(await status(labels)).toBe(403);
  expect(await status(labels, { Cookie: `token=${token}; saccade_${program.port}=${token}` })).toBe(403);
  expect(await status(labels, { "Saccade-Token": token })).toBe(200);
  for (const path of ["/", labels]) {
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
  await stranger.goto(`http://localhost:${program.port}/`);
  await expect(stranger.getByRole("status")).toContainText("does not let this page in");
  await stranger.close();
});

test("no other server of this machine learns the token", async ({ desk, context }) => {
  desk.expects(/Content Security Policy/);
  const cloud = makeTable(join(desk.folder, "table.pcd"), { spacing_m: 0.02 });
  const program = await desk.start("annotate", cloud.file);
  const token = new URL(program.url).searchParams.get("token")!;
  const { page } = await desk.open(program, cloud);
  expect(page.url()).toBe(`http://localhost:${program.port}/`); // the token has left the address
  expect(await context.cookies()).toEqual([]);
  expect(await page.evaluate(() => document.cookie + JSON.stringify({ ...localStorage }))).not.toContain(token);

  heard.length = 0;
  await page.evaluate(async (address) => {
    await fetch(`${address}fetched`, { mode: "no-cors", credentials: "include" }).catch(() => undefined);
    window.open(`${address}opened`);
  }, foreignUrl);
  await page.goto(foreignUrl); // in the tab of the program's page
  await expect.poll(() => heard.map((asked) => asked.url)).toEqual(expect.arrayContaining(["/", "/opened"]));
  for (const asked of heard) expect(`${asked.url} ${JSON.stringify(asked.headers)}`).not.toContain(token);
  expect(await page.evaluate(() => JSON.stringify({ ...sessionStorage, ...localStorage }) + document.cookie + document.referrer)).not.toContain(token);
});

test("the page is loaded again, and opens in a second tab from the address that was printed", async ({ desk, context }) => {
  const cloud = makeTable(join(desk.folder, "table.pcd"), { spacing_m: 0.02 });
  const program = await desk.start("annotate", cloud.file);
  const annotator = await desk.open(program, cloud);
  await annotator.page.reload();
  await annotator.ready();
  const second = await desk.open(program, cloud);
  expect(second.page.url()).toBe(annotator.page.url());
  const stranger = await context.newPage(); // without the token, beside tabs that have it
  await stranger.goto(annotator.page.url());
  await expect(stranger.getByRole("status")).toContainText("does not let this page in");
});
