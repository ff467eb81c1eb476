// Each editor's story, from opening to the saved file, asserted on state and files.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { keyboard, narrow, unnamed, zoom } from "./access.mjs";
import { designs } from "./designs.mjs";
import { browser, changed, open, picture, press, shown, studio, violations } from "./studio.mjs";

/** Saves, runs the script elsewhere, and compares the bytes. */
async function saved(server, page, ending) {
  const doc = await shown(page);
  await page.keyboard.press("Control+s");
  await page.getByText(/^Saved /).waitFor();
  const own = server.read(doc.name + ending);
  const made = join(server.folder, "again");
  execFileSync("sh", [join(server.folder, `${doc.name}.sh`), made], { env: { ...process.env } });
  assert.deepEqual(server.read("again"), own, "the script gives the same bytes");
  return own;
}

async function begin(server, context, title) {
  const { page, faults } = await open(context, server.address);
  await page.getByRole("button", { name: title }).click();
  await shown(page);
  return { page, faults };
}

const stories = {
  /** What was not saved when the studio was killed is offered, opened again, closed; the page asks before it is left. */
  async recovery(server, context) {
    const { page, faults } = await begin(server, context, /An empty facade/);
    const asked = [];
    page.on("dialog", (dialog) => {
      asked.push(dialog.type());
      void dialog.accept();
    });
    await changed(page, () => page.evaluate(() => void window.studio.run(() => [{ do: "edit", edits: ["add window@2,2,1,1"] }])));
    await page.mouse.click(300, 400);
    await page.goto("about:blank");
    assert.deepEqual(asked, ["beforeunload"]);
    const next = await server.killed();
    await page.goto(next);
    await page.getByRole("button", { name: /sketch.*1 edit not saved/ }).click();
    const doc = await shown(page);
    assert.equal(doc.view.elements.length, 1);
    await page.keyboard.press("Control+z");
    await page.getByRole("button", { name: "all documents" }).click();
    await page.getByRole("button", { name: "Close sketch" }).click();
    await page.getByRole("heading", { name: "Open", exact: true }).waitFor({ state: "detached" });
    assert.deepEqual(asked, ["beforeunload", "confirm"]);
    // The next studio is another place.
    return faults.filter((fault) => !fault.startsWith(`asked ${new URL(next).origin}`));
  },

  async start(server, context) {
    const { page, faults } = await open(context, server.address);
    await page.getByRole("heading", { name: "Edifice studio" }).waitFor();
    await picture(page, "start");
    return faults;
  },

  /** Fan et al. 2014, Fig. 15. */
  async completion(server, context) {
    const { page, faults } = await begin(server, context, /Four elements/);
    // (a) four elements, (c) a completion.
    let doc = await changed(page, () => page.getByRole("button", { name: "Complete", exact: true }).click());
    assert.ok(doc.view.elements.length > 4);
    const count = doc.view.elements.length;
    await picture(page, "completion");
    // (d) the door is dragged to another place.
    const door = page.locator('g.element[data-id="d1"]');
    const box = await door.boundingBox();
    doc = await changed(page, async () => {
      await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
      await page.mouse.down();
      await page.mouse.move(box.x + box.width * 2, box.y + box.height / 2, { steps: 5 });
      await page.mouse.up();
    });
    assert.ok(doc.view.elements.find((e) => e.id === "d1").x > 7);
    // (e) the type of an element, by keyboard alone.
    const own = doc.view.elements.find((e) => !e.observed && e.class === "window");
    await page.locator(`g.element[data-id="${own.id}"]`).focus();
    doc = await changed(page, () => page.getByLabel("Label", { exact: true }).first().selectOption("balcony"));
    assert.equal(doc.view.elements.find((e) => e.id === own.id).label, "balcony");
    // (f) a column of windows, by the arrow keys.
    await page.locator('g.element[data-id="w1"]').focus();
    await page.locator('g.element[data-id="w3"]').click({ modifiers: ["Shift"] });
    const x = doc.view.elements.find((e) => e.id === "w1").x;
    doc = await changed(page, () => page.keyboard.press("ArrowLeft"));
    for (const id of ["w1", "w3"]) assert.ok(doc.view.elements.find((e) => e.id === id).x < x);
    // Another answer, undone and done again.
    doc = await changed(page, () => page.getByRole("button", { name: /^2 · / }).click());
    assert.equal(doc.view.chosen, 2);
    doc = await changed(page, () => page.keyboard.press("Control+z"));
    assert.equal(doc.view.chosen, 1);
    await changed(page, () => page.keyboard.press("Control+Shift+z"));
    await picture(page, "completion_edited");
    const file = JSON.parse(await saved(server, page, ".facade.json"));
    assert.ok(file.regions.length >= count / 2);
    // A second tab sees the same, and what it does.
    const second = await open(context, page.url());
    assert.equal((await shown(second.page)).revision, (await shown(page)).revision);
    await changed(page, () => second.page.getByRole("button", { name: "Undo" }).click());
    return faults.concat(second.faults);
  },

  /** Fan and Wonka 2016, Fig. 19. */
  async house(server, context) {
    const { page, faults } = await begin(server, context, /A house with/);
    await page.waitForTimeout(1500);
    await picture(page, "house");
    const before = (await shown(page)).view.boxes.length;
    await page.getByLabel("The model suggests the rest").check();
    // (a) a garage; (b) the house that is suggested around it.
    let doc = await changed(page, () => page.getByRole("button", { name: "Garage", exact: true }).click());
    let garage = doc.view.boxes.findIndex((b) => b.style === "garage");
    assert.ok(garage >= 0 && doc.view.locked[garage], `of ${before} boxes`);
    // (c) the garage to the back, by keyboard.
    await page.locator("g.box.garage").focus();
    const y = doc.view.boxes[garage].y;
    doc = await changed(page, async () => {
      for (let k = 0; k < 5; k++) await page.keyboard.press("ArrowUp");
    });
    garage = doc.view.boxes.findIndex((b) => b.style === "garage");
    assert.ok(Math.abs(doc.view.boxes[garage].y - y - 0.5) < 1e-9);
    // (d) the size of a box; the others stay.
    await page.getByLabel("The model suggests the rest").uncheck();
    await page.locator("g.box.main").first().focus();
    doc = await changed(page, async () => {
      const height = page.getByRole("spinbutton", { name: "Height" });
      await height.fill("3.1");
      await height.press("Enter");
    });
    assert.ok(doc.view.boxes.some((b) => b.height === 3.1));
    await page.waitForTimeout(1500);
    await picture(page, "house_edited");
    const house = JSON.parse(await saved(server, page, ".building.json"));
    assert.ok(house.boxes.some((b) => b.style === "garage"));
    return faults;
  },

  /** Wu et al. 2014, Sec. 5. */
  async grammar(server, context) {
    const { page, faults } = await begin(server, context, /Fig\. 9/);
    let doc = await shown(page);
    // A region is clicked, then the region around it.
    await press(page, 4);
    await page.locator("svg.drawing rect.lit").first().waitFor();
    const lit = await page.locator("svg.drawing rect.lit:not(.weak)").count();
    assert.ok(lit >= 1);
    await picture(page, "grammar");
    // A border of a rule with several regions is moved: all follow.
    const count = (r) => doc.view.nonTerminals.filter((n) => n[0] === r).length;
    const splits = doc.view.rules.map((r, k) => [k, r]).filter(([, r]) => r.operation === "split" && r.parts.length > 1);
    const [rule] = splits.sort((a, b) => count(b[0]) - count(a[0]))[0];
    await page.locator("ol.rules button").nth(rule).click();
    const border = await page.locator("svg.drawing rect.border").first().boundingBox();
    const cost = doc.view.cost;
    doc = await changed(page, async () => {
      const [x, y] = [border.x + border.width / 2, border.y + border.height / 2];
      await page.mouse.move(x, y);
      await page.mouse.down();
      await page.mouse.move(x + 5, y - 5, { steps: 4 });
      await page.mouse.up();
    });
    assert.equal(doc.view.cost, cost);
    assert.match(doc.log.at(-1).said, /^border /);
    // Another symbol for a part.
    doc = await changed(page, async () => {
      const symbol = page.getByLabel("Symbol of part 1");
      await symbol.fill("Door");
      await symbol.press("Enter");
    });
    assert.ok(doc.view.terminals.filter((t) => t[0] === "Door").length >= count(rule));
    // A larger facade.
    doc = await changed(page, async () => {
      const width = page.getByLabel(/^Width/);
      await width.fill(String(doc.view.width * 1.5));
      await width.press("Enter");
    });
    await picture(page, "grammar_edited");
    await saved(server, page, ".grammar.json");
    return faults;
  },

  async city(server, context) {
    const { page, faults } = await begin(server, context, /A made town/);
    await page.waitForTimeout(2500);
    await picture(page, "city");
    let doc = await shown(page);
    const before = doc.view.buildings.length;
    const canvas = await page.locator(".view canvas").boundingBox();
    // Somewhere in the middle there is a building.
    for (const [dx, dy] of [[0.5, 0.5], [0.5, 0.45], [0.52, 0.55], [0.48, 0.42]]) {
      await page.mouse.click(canvas.x + dx * canvas.width, canvas.y + dy * canvas.height);
      if ((await page.getByRole("button", { name: "Scale all of it" }).count()) > 0) break;
    }
    await page.waitForTimeout(1000);
    await picture(page, "city_picked");
    doc = await changed(page, () => page.getByRole("button", { name: "Scale all of it" }).click());
    assert.equal(doc.view.buildings.length, before);
    doc = await changed(page, () => page.getByRole("button", { name: "Synthesize" }).click());
    assert.ok(doc.view.buildings.length > 3);
    await page.waitForTimeout(1500);
    await picture(page, "city_grown");
    await saved(server, page, ".city-grammar.json");
    return faults;
  },

  /** The document of a picture of the report, edited: its cost changes, and it is saved in the present folder. */
  async pictured(_server, context) {
    const server = await studio(["--report", "facade_grammar/figure_15/townhouse_1"]);
    const { page, faults } = await open(context, server.address);
    await page.getByRole("button", { name: /townhouse_1/ }).first().click();
    const before = (await shown(page)).view;
    await press(page, before.terminals.findIndex((t) => /window/i.test(t[0])));
    const cost = page.getByText(/^\d+ rules, cost/);
    const said = await cost.textContent();
    const doc = await changed(page, () => page.getByRole("button", { name: /^Insert a copy of/ }).first().click());
    assert.notEqual(doc.view.cost, before.cost);
    assert.notEqual(await cost.textContent(), said);
    // Back and forward by the list of commands.
    await changed(page, () => page.getByRole("button", { name: "As it was opened" }).click());
    assert.equal((await shown(page)).view.cost, before.cost);
    await changed(page, () => page.getByRole("button", { name: doc.log[0].said }).click());
    await picture(page, "pictured");
    await saved(server, page, ".grammar.json");
    assert.equal(await server.end(), 0);
    return faults;
  },

  /** Names stay text. */
  async names(_server, context) {
    const folder = mkdtempSync(join(tmpdir(), "studio-"));
    const file = join(folder, "a<img src=x onerror=alert(1)>.facade.json");
    const region = { label: "<b onmouseover=alert(2)>window</b>", x: 1, y: 1, width: 1, height: 1 };
    writeFileSync(file, JSON.stringify({ format: "edifice/facade", version: 1, name: "<script>alert(3)</script>", unit: "m", width: 4, height: 4, regions: [region] }));
    const server = await studio([file, "--read-only"]);
    const { page, faults } = await open(context, server.address);
    await page.getByRole("button", { name: /onerror/ }).first().click();
    await shown(page);
    assert.equal(await page.locator("img, b[onmouseover], script:not([src])").count(), 0);
    assert.ok(await page.getByRole("button", { name: "Save" }).isDisabled());
    assert.equal(await server.end(), 0);
    return faults;
  },
};

Object.assign(stories, designs(begin, saved), { keyboard, zoom });

const chrome = await browser();
const only = process.argv[2];
let failed = 0;
for (const [name, story] of Object.entries(stories)) {
  if (only && only !== name) continue;
  const server = await studio();
  const context = await chrome.newContext({ viewport: { width: 1280, height: 800 }, colorScheme: "light" });
  context.setDefaultTimeout(30_000);
  changed.times = [];
  try {
    const faults = await story(server, context);
    assert.deepEqual(faults, [], "the page had faults");
    for (const page of context.pages()) assert.deepEqual(await unnamed(page), [], "controls without a name");
    for (const page of context.pages()) assert.deepEqual(await violations(page), [], "what axe finds");
    const times = changed.times.map((t) => t.toFixed(0)).join(", ");
    console.log(`studio: ${name} passed${times ? `; page time of its edits ${times} ms` : ""}`);
  } catch (error) {
    failed += 1;
    console.error(`studio: ${name} failed:`, error);
    for (const page of context.pages()) await picture(page, `failed_${name}`);
  }
  await context.close();
  await server.end();
}
// The first page of the report, in the light, in the dark and on a phone.
if (!only || only === "report") {
  for (const [colorScheme, width] of [["light", 1280], ["dark", 1280], ["light", 390]]) {
    const context = await chrome.newContext({ colorScheme, viewport: { width, height: 900 } });
    const page = await context.newPage();
    try {
      await page.goto(`file://${process.env.REPORT}`);
      assert.deepEqual(await violations(page), [], "what axe finds");
      assert.equal(await page.evaluate(() => document.documentElement.scrollWidth > innerWidth), false, "wider than the window");
      console.log(`studio: report passed, ${colorScheme}, ${width} wide`);
    } catch (error) {
      failed += 1;
      console.error("studio: report failed:", error);
    }
    await picture(page, `report_${colorScheme}_${width}`);
    await context.close();
  }
}
// Narrow, in the dark and in the light.
if (!only || only === "narrow") {
  const server = await studio();
  try {
    await narrow(server, chrome, picture);
    console.log("studio: narrow passed");
  } catch (error) {
    failed += 1;
    console.error("studio: narrow failed:", error);
  }
  await server.end();
}
await chrome.close();
console.log(failed === 0 ? "studio: all stories passed" : `studio: ${failed} failed`);
process.exit(failed === 0 ? 0 : 1);
