// Opens each tileset folder in both viewers and compares what they draw with what the files say, with the bounding volumes, and
// with each other.

import assert from "node:assert/strict";
import { readFile, writeFile } from "node:fs/promises";
import { createServer } from "node:http";
import { basename, dirname, extname, join, resolve, sep } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

const HERE = dirname(fileURLToPath(import.meta.url));
const BACKGROUND = "#30a0ff";
/** Milliseconds for the loading of a tileset, without a graphics card. */
const DEADLINE = 120_000;
/** Radius in metres of what the second picture shows, about the building nearest to the middle. */
const NEAR = 100;
/** Least share of the pictures that is drawn on, and least deviation of grey there, from near: a city without light has nearly none. */
const [LEAST_DRAWN, LEAST_DEVIATION] = [0.02, 5];
/** Greatest share of the drawn pixels, from near, at which the nearest surface turns its back and is left out. */
const BACKS = 0.01;
/** Metres, and share of the extent, by which what is drawn may be beyond a bounding volume. */
const [BEYOND, BEYOND_SHARE] = [1, 1e-6];
/** Share of a root's volume that is filled along each axis; a region is a box on the ellipsoid, which a city on a grid fills less. */
const [FILLED, FILLED_REGION] = [0.95, 0.8];
/** Share of the picture in which the two viewers may differ in what is drawn on: they smooth edges differently. */
const DIFFERENT = 0.01;

/** Warnings that say nothing about the tiles: 3DTilesRendererJS warns of all 3D Tiles 1.1, and chromium of slow reading. */
const HARMLESS = /tiles versions at 1\.1 or higher have limited support|GPU stall due to ReadPixels/;

const TYPES = { ".html": "text/html", ".js": "text/javascript", ".mjs": "text/javascript", ".json": "application/json", ".glb": "model/gltf-binary", ".wasm": "application/wasm", ".css": "text/css" };

const page = (scripts) => `<!doctype html><title>viewer</title>
<style>body { margin: 0 } div, canvas { width: 100vw; height: 100vh; display: block }</style>
<script>globalThis.BACKGROUND = "${BACKGROUND}"; globalThis.CESIUM_BASE_URL = "/cesium/";</script>
${scripts}`;
const PAGES = {
  "/three.html": page('<script type="module" src="/page/three.bundle.mjs"></script>'),
  "/cesium.html": page('<script src="/cesium/Cesium.js"></script><script type="module" src="/page/cesium.mjs"></script>'),
};

/** Serves the pages, CesiumJS and the folders: `/tiles/0/` is the first. */
async function serve(folders) {
  const roots = { page: HERE, cesium: join(HERE, "node_modules/cesium/Build/Cesium") };
  folders.forEach((folder, k) => (roots[`tiles/${k}`] = resolve(folder)));
  const server = createServer(async (request, response) => {
    const path = decodeURIComponent(new URL(request.url, "http://localhost").pathname);
    if (path in PAGES) return response.writeHead(200, { "content-type": "text/html" }).end(PAGES[path]);
    if (path === "/favicon.ico") return response.writeHead(204).end();
    for (const [prefix, root] of Object.entries(roots)) {
      const file = resolve(root, `.${path.slice(prefix.length + 1)}`);
      if (!path.startsWith(`/${prefix}/`) || !file.startsWith(root + sep)) continue;
      const bytes = await readFile(file).catch(() => undefined);
      if (bytes) return response.writeHead(200, { "content-type": TYPES[extname(file)] ?? "application/octet-stream" }).end(bytes);
    }
    response.writeHead(404).end();
  });
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  return { server, address: `http://127.0.0.1:${server.address().port}` };
}

/** What the files of a tileset hold: tiles with content, instances, triangles of all instances, and triangles of meshes, each counted once. */
async function said(file) {
  const sum = { tiles: 0, instances: 0, triangles: 0, meshTriangles: 0 };
  const add = (other) => Object.keys(sum).forEach((k) => (sum[k] += other[k]));
  const walk = async (tile, above) => {
    const refine = tile.refine ?? above;
    const uri = tile.content?.uri;
    if (tile.contents || tile.implicitTiling || (uri && !/\.(json|glb)$/.test(uri))) throw new Error("a tile has content that this check does not count");
    if (uri?.endsWith(".json")) add(await said(join(dirname(file), uri)));
    else if (uri && (refine !== "REPLACE" || !tile.children?.length)) {
      const bytes = await readFile(join(dirname(file), uri));
      const gltf = JSON.parse(bytes.subarray(20, 20 + bytes.readUInt32LE(12)));
      sum.tiles += 1;
      for (const node of gltf.nodes) {
        if (node.mesh === undefined) continue;
        const attributes = node.extensions?.EXT_mesh_gpu_instancing?.attributes;
        const count = attributes ? gltf.accessors[Object.values(attributes)[0]].count : 1;
        for (const primitive of gltf.meshes[node.mesh].primitives) {
          const corners = gltf.accessors[primitive.indices ?? primitive.attributes.POSITION].count;
          sum.instances += count;
          sum.triangles += (count * corners) / 3;
          sum.meshTriangles += corners / 3;
        }
      }
    }
    for (const child of tile.children ?? []) await walk(child, refine);
  };
  await walk(JSON.parse(await readFile(file)).root, "REPLACE");
  return sum;
}

/**
 * The pixels of a picture that are not background: a mask, their share, and the deviation of their grey, away from the background,
 * which shines through at the smoothed edges.
 */
function drawnOn(tab, png) {
  return tab.evaluate(
    async ([data, background]) => {
      const picture = new Image();
      picture.src = `data:image/png;base64,${data}`;
      await picture.decode();
      const canvas = new OffscreenCanvas(picture.width, picture.height);
      const context = canvas.getContext("2d", { willReadFrequently: true });
      context.fillStyle = background;
      context.fillRect(0, 0, 1, 1);
      const plain = context.getImageData(0, 0, 1, 1).data;
      context.drawImage(picture, 0, 0);
      const pixels = context.getImageData(0, 0, picture.width, picture.height).data;
      const drawn = new Uint8Array(pixels.length / 4).map((_, i) => [0, 1, 2].some((k) => Math.abs(pixels[4 * i + k] - plain[k]) > 12));
      const steps = [-2, -1, 0, 1, 2].flatMap((y) => [-2, -1, 0, 1, 2].map((x) => y * picture.width + x));
      let [count, sum, squares] = [0, 0, 0];
      for (let i = 0; i < drawn.length; i++) {
        if (!steps.every((step) => drawn[i + step])) continue;
        const grey = 0.299 * pixels[4 * i] + 0.587 * pixels[4 * i + 1] + 0.114 * pixels[4 * i + 2];
        count += 1;
        sum += grey;
        squares += grey * grey;
      }
      const deviation = count === 0 ? 0 : Math.sqrt(Math.max(squares / count - (sum / count) ** 2, 0));
      return { mask: drawn.join(""), share: drawn.reduce((s, d) => s + d, 0) / drawn.length, deviation };
    },
    [png.toString("base64"), BACKGROUND],
  );
}

const firstLine = (text) => text.split("\n")[0];

/** Opens a viewer with a tileset: its numbers, its picture, and everything that it complained of. */
async function view(chrome, address, viewer, k, name, above) {
  const context = await chrome.newContext({ viewport: { width: 900, height: 900 } });
  const faults = [];
  await context.route("**/*", (route) => {
    if (route.request().url().startsWith(`${address}/`)) return route.continue();
    faults.push(`the viewer asked for ${route.request().url()}`);
    return route.abort();
  });
  const tab = await context.newPage();
  tab.on("console", (m) => ["error", "warning"].includes(m.type()) && !HARMLESS.test(m.text()) && faults.push(`console: ${firstLine(m.text())}`));
  tab.on("pageerror", (e) => faults.push(`error in the page: ${firstLine(e.message)}`));
  tab.on("response", (r) => r.status() >= 400 && faults.push(`${r.status()} for ${r.url()}`));
  const begin = Date.now();
  try {
    await tab.goto(`${address}/${viewer}.html`);
    await tab.waitForFunction(() => globalThis.check !== undefined);
    const numbers = await tab.evaluate((given) => globalThis.check(...given), [`/tiles/${k}/tileset.json`, DEADLINE, above?.sphere]);
    faults.push(...numbers.failed.map((f) => `a tile failed: ${firstLine(f)}`));
    const picture = async (what) => {
      const png = await tab.screenshot({ timeout: DEADLINE });
      await writeFile(join(process.env.PICTURES, `${name}-${viewer}-${what}.png`), png);
      return drawnOn(tab, png);
    };
    const whole = await picture("whole");
    const { sphere, middle } = above ?? numbers;
    const backs = await tab.evaluate((given) => globalThis.approach(...given), [[...middle, Math.min(NEAR, sphere[3] / 2)], DEADLINE]);
    const near = await picture("near");
    return { ...numbers, backs, pictures: { whole, near }, faults, seconds: (Date.now() - begin) / 1000 };
  } catch (e) {
    return { faults: [...faults, firstLine(e.message)] };
  } finally {
    await context.close();
  }
}

const metres = (values) => values.map((v) => v.toFixed(1)).join(" x ");

/** What is wrong with what both viewers drew of a tileset. */
async function compare(chrome, address, k, folder) {
  const name = basename(resolve(folder));
  const file = await said(join(folder, "tileset.json")).catch((e) => e);
  if (file instanceof Error) return [`${name}: the files cannot be read: ${file.message}`];
  console.log(`${name}: ${file.tiles} tiles, ${file.instances} instances, ${file.triangles} triangles (${file.meshTriangles} of meshes, each counted once)`);
  const wrong = [];
  const expect = (holds, sentence) => holds || wrong.push(`${name}: ${sentence}`);
  const report = (viewer, seen, numbers) => {
    seen.faults.forEach((f) => expect(false, `${viewer}: ${f}`));
    const pictures = Object.entries(seen.pictures ?? {});
    const said = pictures.map(([what, p]) => `${what}: ${(100 * p.share).toFixed(1)} % drawn on, deviation ${p.deviation.toFixed(1)}`);
    console.log(`${name}: ${viewer}: ${numbers}; ${said.join("; ")}; ${seen.seconds?.toFixed(1)} s`);
    for (const [what, { share }] of pictures) expect(share >= LEAST_DRAWN, `${viewer} draws on ${(100 * share).toFixed(2)} % of its picture (${what}), less than ${100 * LEAST_DRAWN} %`);
    const lit = seen.pictures?.near.deviation;
    expect(!(lit < LEAST_DEVIATION), `${viewer}'s grey has a deviation of ${lit?.toFixed(1)} from near, less than ${LEAST_DEVIATION}: the sides of buildings are not lit differently`);
  };

  const three = await view(chrome, address, "three", k, name);
  // Where nothing could be loaded there is nothing to compare.
  if (!three.pictures) return three.faults.map((f) => `${name}: three.js: ${f}`);
  const size = ([low, high]) => high.map((h, i) => h - low[i]);
  const [drawn, whole] = [size(three.drawn), size(three.volume)];
  report("three.js", three, `${three.tiles} tiles, ${three.instances} instances, ${three.triangles} triangles, ${metres(drawn)} m drawn in ${metres(whole)} m, ${(100 * three.backs).toFixed(1)} % backs`);
  expect(three.backs <= BACKS, `at ${(100 * three.backs).toFixed(1)} % of what is seen from near the surface turns its back and is not drawn, more than ${100 * BACKS} %`);
  for (const of of ["tiles", "instances", "triangles"]) expect(three[of] === file[of], `three.js draws ${three[of]} ${of}, and the files have ${file[of]}`);
  const least = three.region ? FILLED_REGION : FILLED;
  for (let i = 0; i < 3; i++) {
    const beyond = Math.max(three.volume[0][i] - three.drawn[0][i], three.drawn[1][i] - three.volume[1][i]);
    expect(beyond <= BEYOND + BEYOND_SHARE * whole[i], `along axis ${i}, what is drawn is ${beyond.toFixed(1)} m beyond the root's bounding volume`);
    expect(drawn[i] >= least * whole[i], `along axis ${i}, ${drawn[i].toFixed(1)} m are drawn of ${whole[i].toFixed(1)} m of the root's bounding volume`);
  }
  const outside = three.outside.filter(([, beyond]) => beyond > BEYOND + BEYOND_SHARE * Math.max(...whole));
  expect(outside.length === 0, `${outside.length} of ${three.tiles} tiles draw outside their own bounding volume, the first, ${outside[0]?.[0]}, by ${outside[0]?.[1].toFixed(1)} m`);

  const cesium = await view(chrome, address, "cesium", k, name, three);
  if (!cesium.pictures) return [...wrong, ...cesium.faults.map((f) => `${name}: CesiumJS: ${f}`)];
  report("CesiumJS", cesium, `${cesium.tiles} tiles, ${cesium.triangles} triangles of meshes, each counted once`);
  expect(cesium.tiles === file.tiles, `CesiumJS draws ${cesium.tiles} tiles, and the files have ${file.tiles}`);
  // Cesium counts a mesh once, however many instances it has.
  expect(cesium.triangles === file.meshTriangles, `CesiumJS draws ${cesium.triangles} triangles of meshes, and the files have ${file.meshTriangles}`);
  // That Cesium's instances are there, and stand where they should, is seen in the pictures, taken from the same places.
  for (const what of ["whole", "near"]) {
    const [a, b] = [three.pictures[what].mask, cesium.pictures[what].mask];
    let different = 0;
    for (let i = 0; i < a.length; i++) different += a[i] === b[i] ? 0 : 1;
    const share = different / a.length;
    console.log(`${name}: the viewers differ in ${(100 * share).toFixed(2)} % of the picture (${what})`);
    expect(share <= DIFFERENT, `the viewers differ in ${(100 * share).toFixed(2)} % of the picture (${what}), more than ${100 * DIFFERENT} %`);
  }
  return wrong;
}

const folders = process.argv.slice(2);
assert.ok(folders.length > 0, "name a folder with a tileset.json");
const { server, address } = await serve(folders);
// The processor draws, so that no graphics card is needed, and no name of another machine is looked up.
const chrome = await chromium.launch({
  executablePath: process.env.BROWSER,
  args: ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-sandbox", "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1"],
});
const wrong = [];
try {
  for (const [k, folder] of folders.entries()) wrong.push(...(await compare(chrome, address, k, folder)));
} finally {
  await chrome.close();
  server.close();
}
wrong.forEach((sentence) => console.error(`viewers: ${sentence}`));
process.exitCode = wrong.length > 0 ? 1 : 0;
