// SPDX-License-Identifier: Apache-2.0
// The page of reports: one script, one style sheet and report.html, of which the program makes one file with a record
// in it. It goes beside the bundle of the other pages (docs/decisions/0015-web-bundle.md).
import { existsSync, readFileSync } from "node:fs";
import { defineConfig, type Plugin } from "vite";

/** The page as it is served, and the licences of all packages in the script. */
function pageAndLicenses(): Plugin {
  return {
    name: "page-and-licenses",
    generateBundle(_options, bundle) {
      this.emitFile({ type: "asset", fileName: "report.html", source: readFileSync("report.html", "utf8") });
      const packages = new Set<string>();
      for (const file of Object.values(bundle)) {
        if (file.type !== "chunk") continue;
        for (const [id, { renderedLength }] of Object.entries(file.modules)) {
          const name = /node_modules\/((?:@[^/]+\/)?[^/]+)\//.exec(id)?.[1];
          if (name && renderedLength > 0) packages.add(name);
        }
      }
      const texts = [...packages].sort().map((name) => `${name}\n\n${licenseOf(name)}\n`);
      this.emitFile({ type: "asset", fileName: "assets/report-licenses.txt", source: texts.join("\n\n") });
    },
  };
}

function licenseOf(name: string): string {
  const file = ["LICENSE", "LICENSE.md", "LICENSE.txt"].map((of) => `node_modules/${name}/${of}`).find(existsSync);
  if (!file) throw new Error(`The package ${name} has no file with its licence.`);
  return readFileSync(file, "utf8").trim();
}

export default defineConfig({
  base: "./",
  plugins: [pageAndLicenses()],
  build: {
    target: "es2022",
    outDir: "dist",
    emptyOutDir: false,
    assetsInlineLimit: 0,
    sourcemap: false,
    modulePreload: false,
    cssCodeSplit: false,
    rollupOptions: {
      input: "src/report/main.ts",
      output: { format: "iife", entryFileNames: "assets/report.js", assetFileNames: "assets/report[extname]" },
    },
  },
});
