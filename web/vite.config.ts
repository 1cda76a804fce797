import { readFileSync } from "node:fs";
import { defineConfig } from "vite";
import { viteSingleFile } from "vite-plugin-singlefile";

/** Where the Python package looks for the built page. */
const folder = "../python/bioscope/live/page";

/** The one version number of the whole house: page and world must agree on it. */
const version = /^version = "(.+)"$/m.exec(readFileSync("../Cargo.toml", "utf8"))?.[1] ?? "0";
const define = { __VERSION__: JSON.stringify(version) };

/** Server of `npm run dev`: a world that runs beside it lends its stream. */
const server = { proxy: { "/stream": { target: "ws://127.0.0.1:8765", ws: true } } };

/** `vite build` writes the page as one file, `vite build --mode widget` the notebook module beside it. */
export default defineConfig(({ mode }) =>
  mode === "widget"
    ? {
        define,
        build: {
          outDir: folder,
          emptyOutDir: false,
          lib: { entry: "src/widget.ts", formats: ["es"], fileName: () => "widget.js" },
        },
      }
    : { define, server, plugins: [viteSingleFile()], build: { outDir: folder, emptyOutDir: true } },
);
