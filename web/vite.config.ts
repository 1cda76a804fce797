import { readFileSync } from "node:fs";
import { type BuildOptions, defineConfig } from "vite";
import { viteSingleFile } from "vite-plugin-singlefile";

/** Where the Python package looks for the built page. */
const folder = "../python/bioscope/live/page";

/** The one version number of the whole house: page and world must agree on it. */
const version = /^version = "(.+)"$/m.exec(readFileSync("../Cargo.toml", "utf8"))?.[1] ?? "0";
const define = { __VERSION__: JSON.stringify(version) };

/** Server of `npm run dev`: a world that runs beside it lends its stream. */
const server = { proxy: { "/stream": { target: "ws://127.0.0.1:8765", ws: true } } };

/** What `vite build` writes: the page of the live view as one file; beside it the editor's, and the notebook module. */
const builds: Record<string, BuildOptions> = {
  production: { emptyOutDir: true },
  editor: { emptyOutDir: false, rolldownOptions: { input: "editor.html" } },
  contour: { emptyOutDir: false, rolldownOptions: { input: "contour.html" } },
  widget: {
    emptyOutDir: false,
    lib: { entry: "src/widget.ts", formats: ["es"], fileName: () => "widget.js" },
  },
};

export default defineConfig(({ mode }) => ({
  define,
  server,
  plugins: mode === "widget" ? [] : [viteSingleFile()],
  build: { outDir: folder, ...builds[mode] },
}));
