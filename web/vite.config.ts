// SPDX-License-Identifier: Apache-2.0
// The bundle in dist/ is part of the repository: the same source gives the same bytes (docs/decisions/0015-web-bundle.md).
import { readFileSync } from "node:fs";
import { defineConfig, type Plugin } from "vite";

/** The licences of what the bundle contains go with it. */
function licenses(packages: string[]): Plugin {
  return {
    name: "licenses",
    generateBundle() {
      const texts = packages.map((name) => `${name}\n\n${readFileSync(`node_modules/${name}/LICENSE`, "utf8").trim()}\n`);
      this.emitFile({ type: "asset", fileName: "assets/licenses.txt", source: texts.join("\n\n") });
    },
  };
}

export default defineConfig({
  base: "./",
  plugins: [licenses(["three", "three-mesh-bvh"])],
  build: {
    target: "es2022",
    outDir: "dist",
    emptyOutDir: true,
    assetsInlineLimit: 0,
    sourcemap: false,
    modulePreload: { polyfill: false },
    chunkSizeWarningLimit: 2000,
    rollupOptions: {
      output: {
        entryFileNames: "assets/[name].js",
        chunkFileNames: "assets/[name].js",
        manualChunks: (id) => (/\/(node_modules\/three|src\/view)/.test(id) ? "view" : undefined),
        assetFileNames: "assets/[name][extname]",
      },
    },
  },
  worker: { format: "es", rollupOptions: { output: { entryFileNames: "assets/[name].js" } } },
});
