// What designers do beyond the figures of the papers: wishes, floors, joint grammars, photographs, levels, places.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { changed, open, picture, press, shown, studio } from "./studio.mjs";

const { EDIFICE } = process.env;

/** Moves a slider to a value, as an arrow key would in many steps. */
const slide = (slider, value) =>
  slider.evaluate((e, v) => {
    e.value = v;
    e.dispatchEvent(new Event("input", { bubbles: true }));
    e.dispatchEvent(new Event("change", { bubbles: true }));
  }, String(value));

/** A photograph taken from the side, as bytes: a facade with four windows, drawn here in perspective. */
const street = (page) =>
  page.evaluate(async () => {
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [600, 480];
    const context = canvas.getContext("2d");
    context.fillStyle = "#8fb0d0";
    context.fillRect(0, 0, 600, 480);
    const quad = (points, colour) => {
      context.fillStyle = colour;
      context.beginPath();
      points.forEach(([x, y], k) => (k ? context.lineTo(x, y) : context.moveTo(x, y)));
      context.fill();
    };
    quad([[60, 60], [540, 130], [540, 400], [60, 450]], "#c9a27e");
    // Its right end is farther away: 390 pixels high at the left, 270 at the right.
    const at = (u, v) => {
      const s = (390 * u) / (270 + 120 * u);
      const [top, bottom] = [60 + 70 * s, 450 - 50 * s];
      return [60 + 480 * s, top + (bottom - top) * v];
    };
    for (const u of [0.15, 0.6]) for (const v of [0.15, 0.55]) quad([at(u, v), at(u + 0.22, v), at(u + 0.22, v + 0.25), at(u, v + 0.25)], "#33485c");
    const blob = await new Promise((r) => canvas.toBlob(r, "image/png"));
    return [...new Uint8Array(await blob.arrayBuffer())];
  });

/** The corners of its facade. */
const CORNERS = { "upper left": [60, 60], "upper right": [540, 130], "lower right": [540, 400], "lower left": [60, 450] };

/** Puts them in the dialog that asks for them, and straightens. */
async function straighten(page, name) {
  const dialog = page.getByRole("dialog", { name: "Corners of the facade in the photograph" });
  await dialog.waitFor();
  const box = await dialog.locator("canvas").boundingBox();
  for (const [corner, [x, y]] of Object.entries(CORNERS)) {
    const knob = await dialog.getByRole("button", { name: `The facade's ${corner} corner` }).boundingBox();
    await page.mouse.move(knob.x + knob.width / 2, knob.y + knob.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x + (x / 600) * box.width, box.y + (y / 480) * box.height, { steps: 4 });
    await page.mouse.up();
  }
  await picture(page, name);
  await dialog.getByRole("button", { name: "Straighten" }).click();
}

/** Draws an element over a share of the wall. */
async function drawn(page, [u, v, width, height]) {
  const wall = await page.locator("svg.drawing rect.wall").boundingBox();
  await page.mouse.move(wall.x + u * wall.width, wall.y + v * wall.height);
  await page.mouse.down();
  await page.mouse.move(wall.x + (u + width) * wall.width, wall.y + (v + height) * wall.height, { steps: 5 });
  await page.mouse.up();
}

export const designs = (begin, saved) => ({
  /** Sliders with the model's ranges, its styles, wishes that clash, and a walk. */
  async wishes(server, context) {
    const { page, faults } = await begin(server, context, /A house without/);
    const width = page.locator('[data-column="bbox.w"] input[type="range"]');
    const before = (await shown(page)).view.columns.find((c) => c.name === "bbox.w");
    assert.ok(Number(await width.getAttribute("min")) <= before.low && Number(await width.getAttribute("max")) >= before.high);
    let doc = await changed(page, () => slide(width, 14));
    const value = (name) => doc.view.columns.find((c) => c.name === name);
    assert.ok(Math.abs(value("bbox.w").value - 14) < 0.3);
    assert.ok(value("bbox.w").wish !== null);
    doc = await changed(page, () => page.getByLabel("Roofs: hip").selectOption("yes"));
    assert.equal(value("roof.hip").value, 1);
    await picture(page, "wishes");
    // The garage higher than the house: both sliders are marked, and nothing changed.
    await page.locator("summary", { hasText: "Garage" }).click();
    const revision = doc.revision;
    const height = page.locator('[data-column="bbox.h"] input[type="range"]');
    doc = await changed(page, () => slide(height, value("bbox.h").low));
    const now = doc.revision;
    const high = page.locator('[data-column="garage.h"] input[type="range"]');
    await high.evaluate((e) => e.setAttribute("max", "30"));
    await slide(high, 25);
    await page.locator(".notice.error").waitFor();
    const said = await page.locator(".notice.error").textContent();
    assert.match(said, /garage\.h.*bbox\.h/, said);
    const marked = await page.locator(".wish.clash").evaluateAll((all) => all.map((e) => e.dataset.column));
    assert.ok(marked.includes("garage.h") && marked.includes("bbox.h"), marked.join());
    assert.equal((await shown(page)).revision, now);
    assert.ok(now > revision);
    await picture(page, "wishes_clash");
    for (const wish of ["Garage: h", "Size: Height (m)"]) {
      await page.getByRole("button", { name: `Take back the wish ${wish}` }).click();
      await shown(page);
    }
    // A style of the model.
    doc = await changed(page, () => page.getByLabel("Style of the model").selectOption("2"));
    assert.equal(doc.view.style, 2);
    // A walk: forward by keyboard, and back to the view from above.
    const walk = page.getByRole("button", { name: "Walk around" });
    await walk.click();
    assert.equal(await walk.getAttribute("aria-pressed"), "true");
    for (let k = 0; k < 4; k++) await page.keyboard.press("ArrowUp");
    await page.waitForTimeout(600);
    await picture(page, "walk");
    await walk.click();
    await saved(server, page, ".building.json");
    return faults;
  },

  /** Floors and columns, a repeat, a joint grammar of two facades, three dimensions. */
  async floors(server, context) {
    const { page, faults } = await begin(server, context, /Fig\. 9/);
    let doc = await shown(page);
    const before = doc.view;
    const middle = before.terminals.findIndex((t) => t[2] > 0 && /window/i.test(t[0]));
    await press(page, Math.max(middle, 0));
    doc = await changed(page, () => page.getByRole("button", { name: "Insert floor" }).click());
    assert.ok(doc.view.height > before.height && doc.view.width === before.width);
    await press(page, Math.max(middle, 0));
    doc = await changed(page, () => page.getByRole("button", { name: "Insert column" }).click());
    assert.ok(doc.view.width > before.width);
    await picture(page, "floors");
    await press(page, Math.max(middle, 0));
    doc = await changed(page, () => page.getByRole("button", { name: "Remove floor" }).click());
    // Another facade in this studio, and one grammar of both.
    const second = await begin(server, context, /Fig\. 9/);
    await changed(second.page, () => second.page.getByLabel(/^Width/).fill("150").then(() => second.page.keyboard.press("Enter")));
    await page.reload();
    await shown(page);
    doc = await changed(page, () => page.getByRole("button", { name: /^With / }).first().click());
    assert.equal(doc.view.starts.length, 2);
    doc = await changed(page, () => page.getByLabel("Facade of the joint grammar").selectOption({ index: 1 }));
    assert.equal(doc.view.start, 1);
    await picture(page, "joint");
    const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "GLB" }).click()]);
    assert.match(download.suggestedFilename(), /\.glb$/);
    await saved(server, page, ".grammar.json");
    return faults.concat(second.faults);
  },

  /** The columns and rows of a grid, and a repeat A B A: dragged, sized, put in and taken out. */
  async grids(_server, context) {
    const folder = mkdtempSync(join(tmpdir(), "studio-"));
    const file = join(folder, "hall.grammar.json");
    const part = (symbol, size) => ({ symbol, size });
    const rules = [
      { symbol: "Hall", op: "split", axis: "y", successors: [part("Ground", 4), part("Upper", 8)] },
      { symbol: "Ground", op: "split", axis: "x", successors: [part("Bay", 8), part("door", 8), part("Bay", 8)] },
      { symbol: "Bay", op: "grid_split", columns: [2, 4, 2], rows: [1, 3], cells: [["wall", "balcony", "wall"], ["wall", "window", "wall"]] },
      { symbol: "Upper", op: "repeat_aba", axis: "x", successors: [part("wall", 2), part("Opening", 3.5)] },
      { symbol: "Opening", op: "split", axis: "y", successors: [part("wall", 2), part("window", 6)] },
    ];
    writeFileSync(file, JSON.stringify({ format: "edifice/grammar", version: 1, axiom: "Hall", unit: "m", width: 24, height: 12, rules }));
    const server = await studio([file]);
    server.folder = folder;
    server.read = (name) => readFileSync(join(folder, name));
    const { page, faults } = await open(context, server.address);
    await page.getByRole("button", { name: /hall/ }).first().click();
    let doc = await shown(page);
    const windows = (view) => view.terminals.filter((t) => t[0] === "window" && t[2] < 4);
    const drag = async (border, dx, dy) => {
      const box = await page.locator(`svg.drawing rect.border[data-border="${border}"]`).first().boundingBox();
      const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
      await page.mouse.move(x, y);
      await page.mouse.down();
      await page.mouse.move(x + dx, y + dy, { steps: 4 });
      await page.mouse.up();
    };
    // A column and a row of the grid are dragged: both bays follow.
    await page.locator("ol.rules button").nth(2).click();
    assert.equal(await page.locator("svg.drawing rect.border").count(), 3);
    doc = await changed(page, () => drag("c0", 10, 0));
    assert.match(doc.log.at(-1).said, /^border 2\.c0=/);
    doc = await changed(page, () => drag("r0", 0, 8));
    const [one, two] = windows(doc.view);
    assert.ok(one[3] < 4 && one[4] > 3 && Math.abs(one[3] - two[3]) < 1e-6 && Math.abs(one[4] - two[4]) < 1e-6);
    // A copy of a column, another size for it, and a floor by the buttons.
    doc = await changed(page, () => page.getByRole("button", { name: "Insert a copy of column 2" }).click());
    assert.equal(windows(doc.view).length, 4);
    doc = await changed(page, async () => {
      const size = page.getByLabel("Size of column 1");
      await size.fill("1");
      await size.press("Enter");
    });
    assert.match(doc.log.at(-1).said, /^resize 2\.c0=1$/);
    const height = doc.view.height;
    await press(page, doc.view.terminals.findIndex((t) => t[0] === "window"));
    doc = await changed(page, () => page.getByRole("button", { name: "Insert floor" }).click());
    assert.equal(doc.log.at(-1).said, "grow 2.r1");
    assert.ok(doc.view.height > height);
    await picture(page, "grid");
    doc = await changed(page, () => page.getByRole("button", { name: "Remove floor" }).click());
    assert.ok(Math.abs(doc.view.height - height) < 1e-9);
    // The repeat: its border, and a period more; it always has two parts.
    await page.locator("ol.rules button").nth(3).click();
    assert.equal(await page.getByRole("button", { name: /^Remove part/ }).count(), 0);
    doc = await changed(page, () => drag("0", 6, 0));
    assert.match(doc.log.at(-1).said, /^border 3\.0=/);
    const { width } = doc.view;
    await press(page, doc.view.terminals.findIndex((t) => t[0] === "window" && t[2] > 4));
    doc = await changed(page, () => page.getByRole("button", { name: "Insert column" }).click());
    assert.equal(doc.log.at(-1).said, "grow 3.1");
    assert.ok(doc.view.width > width);
    await saved(server, page, ".grammar.json");
    assert.equal(await server.end(), 0);
    return faults;
  },

  /** A facade over a photograph whose corners are put on the facade's. */
  async photograph(server, context) {
    const { page, faults } = await begin(server, context, /An empty facade/);
    const bytes = await street(page);
    await page.getByLabel("Photograph to draw over").setInputFiles({ name: "street.png", mimeType: "image/png", buffer: Buffer.from(bytes) });
    await straighten(page, "photograph_corners");
    await page.locator("svg.drawing image").waitFor();
    // The windows of the photograph are drawn over, and the rest is completed.
    await page.getByRole("button", { name: "Window", exact: true }).click();
    for (const [u, v] of [[0.15, 0.15], [0.6, 0.15], [0.15, 0.55]]) await changed(page, () => drawn(page, [u, v, 0.22, 0.25]));
    let doc = await shown(page);
    const given = doc.view.elements.filter((e) => e.observed);
    assert.equal(given.length, 3);
    assert.ok(Math.abs(given[0].x - 0.15 * doc.view.width) < 0.3);
    // The straightened picture is dark where the windows are and nowhere beside them.
    const dark = await page.evaluate(async () => {
      const image = new Image();
      image.src = document.querySelector("svg.drawing image").getAttribute("href");
      await image.decode();
      const canvas = document.createElement("canvas");
      [canvas.width, canvas.height] = [200, 200];
      const context = canvas.getContext("2d");
      context.drawImage(image, 0, 0, 200, 200);
      const at = (u, v) => context.getImageData(200 * u, 200 * v, 1, 1).data[0] < 120;
      return [[0.17, 0.17], [0.35, 0.38], [0.62, 0.57], [0.8, 0.78], [0.13, 0.2], [0.39, 0.2], [0.58, 0.6], [0.84, 0.6], [0.7, 0.12], [0.7, 0.83]].map(([u, v]) => at(u, v));
    });
    assert.deepEqual(dark, [true, true, true, true, false, false, false, false, false, false]);
    await picture(page, "photograph");
    // A size is dragged, an unknown part is marked, a place is forbidden.
    await page.getByRole("button", { name: "Select", exact: true }).click();
    const id = given[0].id;
    await page.locator(`g.element[data-id="${id}"]`).click();
    const handle = await page.locator("rect.handle").boundingBox();
    doc = await changed(page, async () => {
      await page.mouse.move(handle.x + handle.width / 2, handle.y + handle.height / 2);
      await page.mouse.down();
      await page.mouse.move(handle.x + handle.width / 2 - 25, handle.y + handle.height / 2 + 15, { steps: 4 });
      await page.mouse.up();
    });
    assert.ok(doc.view.elements.find((e) => e.id === id).width < given[0].width);
    // It is part of the document: undone with it, saved with it, and there when the file is opened again.
    const picked = () => page.locator("svg.drawing image").getAttribute("href");
    const address = await picked();
    assert.match(address, /^data:image\/jpeg;base64,/);
    await changed(page, () => page.getByRole("button", { name: "No photograph" }).click());
    await page.locator("svg.drawing image").waitFor({ state: "detached" });
    doc = await changed(page, () => page.keyboard.press("Control+z"));
    await page.locator("svg.drawing image").waitFor();
    assert.equal(await picked(), address);
    const file = JSON.parse(await saved(server, page, ".facade.json"));
    assert.equal(file.photograph, address);
    const again = await studio([join(server.folder, `${doc.name}.facade.json`), "--read-only"]);
    const second = await open(context, again.address);
    await second.page.getByRole("button", { name: new RegExp(doc.name) }).first().click();
    assert.equal((await shown(second.page)).view.elements.length, doc.view.elements.length);
    await second.page.locator("svg.drawing image").waitFor();
    assert.equal(await second.page.locator("svg.drawing image").getAttribute("href"), address);
    await picture(second.page, "photograph_again");
    await second.page.close();
    await again.end();
    return faults.concat(second.faults);
  },

  /** From a photograph to a completion in three actions: the corners, a tool, a window; then dropped on the first page, too. */
  async photograph_first(_server, context) {
    const folder = mkdtempSync(join(tmpdir(), "studio-"));
    const blank = await context.newPage();
    const bytes = Buffer.from(await street(blank));
    await blank.close();
    const file = join(folder, "street.png");
    writeFileSync(file, bytes);
    const server = await studio([file]);
    const { page, faults } = await open(context, server.address);
    await page.getByRole("button", { name: /street/ }).first().click();
    // The corners are asked for unasked.
    await straighten(page, "photograph_first_corners");
    await page.locator("svg.drawing image").waitFor();
    await page.getByRole("button", { name: "Window", exact: true }).click();
    const doc = await changed(page, () => drawn(page, [0.15, 0.15, 0.22, 0.25]));
    assert.ok(doc.view.answers.length > 0 && doc.view.elements.length > 1, "it was completed after the first window");
    assert.equal(doc.view.height, 12);
    await picture(page, "photograph_first");
    await page.close();
    await server.end();
    const other = await studio();
    const second = await open(context, other.address);
    await second.page.locator("main.start").waitFor();
    await picture(second.page, "start");
    const data = await second.page.evaluateHandle((list) => {
      const data = new DataTransfer();
      data.items.add(new File([new Uint8Array(list)], "street.png", { type: "image/png" }));
      return data;
    }, [...bytes]);
    await second.page.dispatchEvent("main.start", "drop", { dataTransfer: data });
    await straighten(second.page, "photograph_dropped");
    await second.page.locator("svg.drawing image").waitFor();
    assert.equal((await shown(second.page)).view.width, doc.view.width);
    await second.page.close();
    await other.end();
    return faults.concat(second.faults);
  },

  /** A city of triangles: levels, the original beside, a building and its rules, a drawn shape, where one is. */
  async levels(_server, context) {
    const made = await studio();
    const grammar = await open(context, made.address);
    await grammar.page.getByRole("button", { name: /A made town/ }).click();
    await shown(grammar.page);
    await changed(grammar.page, async () => {
      await grammar.page.getByLabel("Corners of the shape").fill("0,0 200,0 200,160 0,160");
      await grammar.page.getByRole("button", { name: "Synthesize" }).click();
    });
    await grammar.page.keyboard.press("Control+s");
    await grammar.page.getByText(/^Saved /).waitFor();
    const name = (await shown(grammar.page)).name;
    const obj = join(mkdtempSync(join(tmpdir(), "studio-")), "district.obj");
    execFileSync(EDIFICE, ["city", "derive", join(made.folder, `${name}.city-grammar.json`), "-o", obj]);
    await grammar.page.close();
    await made.end();

    const server = await studio([obj]);
    const { page, faults } = await open(context, server.address);
    await page.getByRole("button", { name: /district/ }).first().click();
    let doc = await shown(page);
    assert.ok(doc.view.original.buildings > 5 && doc.view.templates.length === 0);
    doc = await changed(page, () => slide(page.getByLabel(/^Level of de-instancing/), 0));
    const fine = doc.view.templates.length;
    doc = await changed(page, () => slide(page.getByLabel(/^Level of de-instancing/), 3));
    assert.ok(doc.view.templates.length <= fine && doc.view.level === 3);
    await page.getByLabel("What is shown").selectOption("beside");
    await page.locator(".view canvas").nth(1).waitFor();
    await page.getByLabel("Colours").selectOption("error");
    await page.waitForTimeout(1500);
    await picture(page, "city_beside");
    await page.getByLabel("What is shown").selectOption("blended");
    await page.waitForTimeout(800);
    await page.getByLabel("What is shown").selectOption("made");
    // A building, its rules and its siblings.
    await page.getByRole("button", { name: "Next building" }).click();
    await page.getByRole("row", { name: /^Rules / }).waitFor();
    assert.match(await page.getByRole("row", { name: /^Rules / }).textContent(), /rule \d+, part \d+ of \d+/);
    // Where one is who sees it.
    await page.getByRole("button", { name: "Where do I see these?" }).click();
    await page.getByRole("button", { name: /^1: near / }).waitFor();
    await page.getByRole("button", { name: /^1: near / }).click();
    // A shape drawn with the mouse.
    await page.getByRole("button", { name: "Draw with the mouse" }).click();
    const canvas = await page.locator(".view canvas").first().boundingBox();
    for (const [u, v] of [[0.2, 0.75], [0.8, 0.75], [0.7, 0.35], [0.3, 0.35]]) await page.mouse.click(canvas.x + u * canvas.width, canvas.y + v * canvas.height);
    const corners = (await page.getByLabel("Corners of the shape").inputValue()).split(" ");
    assert.equal(corners.length, 4);
    await page.waitForTimeout(600);
    await picture(page, "city_shape");
    await page.getByLabel("Corners of the shape").fill("0,0 150,0 150,130 0,130");
    doc = await changed(page, () => page.getByRole("button", { name: "Synthesize" }).click());
    assert.ok(doc.view.buildings.length > 0 && doc.view.original === null);
    // Back to the level, and saved: the script begins with the city itself.
    await changed(page, () => page.keyboard.press("Control+z"));
    await page.keyboard.press("Control+s");
    await page.getByText(/^Saved /).waitFor();
    await page.close();
    assert.equal(await server.end(), 0);
    return faults.concat(grammar.faults);
  },

  /** Long work tells how far it is in both tabs, and is stopped from the other one. */
  async work(server, context) {
    const { page, faults } = await begin(server, context, /Fig\. 9/);
    const second = await open(context, page.url());
    const before = await shown(second.page);
    // So many facades, each other than the rest, that the work outlasts the story on any machine.
    const chequered = (k) => {
      const labels = ["wall", "window", "door", "balcony"];
      const regions = [];
      for (let y = 0; y < 14; y++) for (let x = 0; x < 17; x++) regions.push({ label: labels[((y + k) ** 2 + (3 + k) * x * x + x * y) % 4], x, y, width: 1, height: 1 });
      return { format: "edifice/facade", version: 1, name: `chequered ${k}`, unit: before.view.unit, width: 17, height: 14, regions };
    };
    const files = Array.from({ length: 40 }, (_, k) => ({ name: `${k}.facade.json`, mimeType: "application/json", buffer: Buffer.from(JSON.stringify(chequered(k))) }));
    await page.getByLabel("Facade files to merge").setInputFiles(files);
    await page.locator(".work button").waitFor();
    assert.match(await page.locator(".work span").textContent(), /· \d+ s/);
    await second.page.locator(".work button").waitFor();
    await picture(page, "work");
    await second.page.getByRole("button", { name: "Stop" }).click();
    await page.locator(".notice", { hasText: /Stopped/ }).waitFor();
    await page.locator(".work").waitFor({ state: "hidden" });
    assert.equal((await shown(page)).revision, before.revision);
    // It goes on from there, and both tabs see it.
    await changed(second.page, () => page.getByLabel(/^Width/).fill("140").then(() => page.keyboard.press("Enter")));
    assert.equal((await shown(page)).view.width, (await shown(second.page)).view.width);
    return faults.concat(second.faults);
  },

  /** A laptop that was closed for a day, and a studio that has ended. */
  async lid(_server, context) {
    const server = await studio();
    const { page } = await open(context, server.address);
    await page.getByRole("button", { name: /An empty facade/ }).click();
    await shown(page);
    await page.clock.install();
    const add = async (x) => {
      const before = (await shown(page)).revision;
      await page.evaluate((at) => window.studio.run(() => [{ do: "edit", edits: [`add window@${at},2,1,1.5`] }]), x);
      return (await shown(page)).revision - before;
    };
    assert.equal(await add(1), 1);
    await page.clock.fastForward("24:00:00");
    assert.equal(await add(3), 1);
    assert.equal((await shown(page)).view.elements.length, 2);
    await page.clock.resume();
    await server.end();
    await page.evaluate(() => window.studio.run(() => [{ do: "edit", edits: ["add window@6,2,1,1.5"] }]));
    await page.getByText("The studio has ended. Start it again to go on.").waitFor();
    return [];
  },
});
