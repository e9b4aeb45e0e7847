// SPDX-License-Identifier: Apache-2.0
// The page's sources, served while the tests of a file run.
import { test } from "@playwright/test";
import { type ViteDevServer, createServer } from "vite";

/** @return its address, once a test runs. */
export function serveSources(): () => string {
  let server: ViteDevServer | undefined;
  test.beforeAll(async () => {
    server = await createServer({
      configFile: false,
      cacheDir: `node_modules/.vite/test-${test.info().parallelIndex}`, // two that fill one are in each other's way
      optimizeDeps: { include: ["three", "three-mesh-bvh"] },
      logLevel: "error",
      server: { host: "127.0.0.1", port: 0, watch: null },
    });
    await server.listen();
  });
  test.afterAll(() => server?.close());
  return () => server!.resolvedUrls!.local[0]!;
}
