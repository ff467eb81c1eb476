// Builds the page into src/studio/assets, from which it becomes part of the program, or into the folder that is named.
import { build } from "esbuild";
import { copyFileSync, readFileSync, writeFileSync } from "node:fs";
import { resolve } from "node:path";

const out = (process.argv[2] ? resolve(process.argv[2]) : new URL("../src/studio/assets", import.meta.url).pathname) + "/";
const here = new URL("./src/", import.meta.url).pathname;

await build({
  entryPoints: { app: here + "main.ts" },
  outdir: out,
  bundle: true,
  minify: true,
  format: "esm",
  target: "es2022",
  legalComments: "none",
  charset: "utf8",
});
await build({ entryPoints: { app: here + "style.css" }, outdir: out, minify: true });
copyFileSync(here + "index.html", out + "index.html");
copyFileSync(here + "icon.svg", out + "icon.svg");

const lock = JSON.parse(readFileSync(new URL("package-lock.json", import.meta.url)));
const three = lock.packages["node_modules/three"].version;
const licence = readFileSync(new URL("node_modules/three/LICENSE", import.meta.url), "utf8").trim();
writeFileSync(out + "licences.txt", `This page contains three.js ${three}:\n\n${licence}\n`);
