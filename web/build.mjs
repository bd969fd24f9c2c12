// Bundles a page into one self-contained HTML file: node build.mjs report OUT.html
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import * as esbuild from "esbuild";

const [page, out] = process.argv.slice(2);
if (!out) {
  console.error("usage: node build.mjs PAGE OUT.html");
  process.exit(2);
}

const web = dirname(fileURLToPath(import.meta.url));

async function bundle(entry) {
  const result = await esbuild.build({
    entryPoints: [join(web, page, entry)],
    bundle: true,
    minify: true,
    format: "iife",
    target: ["es2022"],
    charset: "utf8",
    legalComments: "none", // the licence is in the page's head instead
    write: false,
  });
  return result.outputFiles[0].text.trim();
}

const licence = readFileSync(join(web, "node_modules/uplot/LICENSE"), "utf8").trim();
const parts = {
  licence: `<!-- Charts by uPlot:\n${licence}\n-->`,
  style: `<style>${await bundle("style.css")}</style>`,
  script: `<script>${await bundle("main.js")}</script>`,
};
const html = readFileSync(join(web, page, "page.html"), "utf8").replace(
  /<!-- (licence|style|script) -->/g,
  (_, name) => parts[name],
);
mkdirSync(dirname(resolve(out)), { recursive: true });
writeFileSync(out, html);
