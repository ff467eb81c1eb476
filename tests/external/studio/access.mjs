// What holds in every editor: by keyboard alone, at 420 pixels, in the dark, with a name for everything that can be used.

import assert from "node:assert/strict";
import { changed, open, shown } from "./studio.mjs";

/** Controls of the page without a name for screen readers, and drawings whose parts cannot be reached. */
export function unnamed(page) {
  return page.evaluate(() => {
    const named = (e) => {
      const by = e.getAttribute("aria-labelledby");
      const label = e.labels?.length > 0 ? [...e.labels].map((l) => l.textContent).join(" ") : "";
      return [e.getAttribute("aria-label"), by && document.getElementById(by)?.textContent, label, e.matches("input, select, textarea") ? "" : e.textContent].some((t) => t && t.trim() !== "");
    };
    const all = document.querySelectorAll("button, input, select, textarea, canvas, dialog, section, [role], summary, [tabindex]");
    return [...all].filter((e) => e.checkVisibility() && !named(e) && !e.matches("progress")).map((e) => e.outerHTML.slice(0, 120));
  });
}

/** Everything that Tab reaches after the first button of the page, until it comes round. */
export async function reached(page, most = 400) {
  await page.locator("header button").first().focus();
  const names = [];
  for (let k = 0; k < most; k++) {
    await page.keyboard.press("Tab");
    const name = await page.evaluate(() => {
      const e = document.activeElement;
      if (!e || e === document.body) return null;
      return e.getAttribute("aria-label") ?? e.labels?.[0]?.textContent ?? e.textContent.slice(0, 40);
    });
    if (name === null) break;
    names.push(name);
  }
  return names;
}

/** The least contrast of text to what is behind it (WCAG 2.2, relative luminance), and where. */
export function contrast(page) {
  return page.evaluate(() => {
    const canvas = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
    const rgba = (c) => {
      canvas.clearRect(0, 0, 1, 1);
      canvas.fillStyle = c;
      canvas.fillRect(0, 0, 1, 1);
      return [...canvas.getImageData(0, 0, 1, 1).data];
    };
    const luminance = (c) => {
      const [r, g, b] = c.slice(0, 3).map((v) => (v / 255 <= 0.04045 ? v / 255 / 12.92 : ((v / 255 + 0.055) / 1.055) ** 2.4));
      return 0.2126 * r + 0.7152 * g + 0.0722 * b;
    };
    const behind = (e) => {
      for (let n = e; n; n = n.parentElement) {
        const c = rgba(getComputedStyle(n).backgroundColor);
        if (c[3] > 250) return c;
      }
      return [255, 255, 255, 255];
    };
    let least = [99, ""];
    for (const e of document.querySelectorAll("h1, h2, h3, p, span, button, summary, th, td, li, output, label, figcaption")) {
      const own = [...e.childNodes].some((n) => n.nodeType === 3 && n.textContent.trim() !== "");
      if (!own || !e.checkVisibility() || e.closest(":disabled, .hidden, svg")) continue;
      const [a, b] = [luminance(rgba(getComputedStyle(e).color)), luminance(behind(e))].sort((x, y) => y - x);
      const ratio = (a + 0.05) / (b + 0.05);
      if (ratio < least[0]) least = [ratio, e.outerHTML.slice(0, 100)];
    }
    return least;
  });
}

const EDITORS = [/Four elements/, /A house without/, /Fig\. 9/, /A made town/];

/** Every editor at 420 pixels in the dark. */
export async function narrow(server, chrome, picture) {
  for (const scheme of ["dark", "light"]) {
    const context = await chrome.newContext({ viewport: { width: 420, height: 860 }, colorScheme: scheme, hasTouch: true });
    context.setDefaultTimeout(30_000);
    for (const title of EDITORS) {
      const { page, faults } = await open(context, server.address);
      await page.getByRole("button", { name: title }).first().click();
      const doc = await shown(page);
      if (doc.kind === "completion") await changed(page, () => page.getByRole("button", { name: "Complete", exact: true }).click());
      const wide = await page.evaluate(() => document.documentElement.scrollWidth);
      assert.ok(wide <= 420, `${doc.kind} is ${wide} pixels wide at 420`);
      // A finger finds what it needs: nothing to press is smaller than 24 pixels (WCAG 2.5.8).
      const small = await page.evaluate(() =>
        [...document.querySelectorAll("button, select, input:not([type=checkbox]):not([type=range]):not(.hidden)")]
          .filter((e) => e.checkVisibility() && e.getBoundingClientRect().height < 24)
          .map((e) => `${e.outerHTML.slice(0, 80)} ${e.getBoundingClientRect().height}`),
      );
      assert.deepEqual(small, [], doc.kind);
      assert.deepEqual(await unnamed(page), [], doc.kind);
      const [ratio, where] = await contrast(page);
      assert.ok(ratio >= 4.5, `contrast ${ratio.toFixed(2)} of ${where} (${scheme})`);
      assert.deepEqual(faults, []);
      if (scheme === "dark") await picture(page, `narrow_${doc.kind}`);
      await page.close();
    }
    await context.close();
  }
}

/** An edit of each editor without a mouse. */
export async function keyboard(server, context) {
  const all = [];
  const begin = async (title) => {
    const { page, faults } = await open(context, server.address);
    all.push(faults);
    // From the start page by Tab and Enter.
    await page.getByRole("button", { name: title }).first().waitFor();
    for (let k = 0; k < 40; k++) {
      await page.keyboard.press("Tab");
      if (title.test((await page.evaluate(() => document.activeElement?.textContent)) ?? "")) break;
    }
    await page.keyboard.press("Enter");
    await shown(page);
    return page;
  };
  const tabTo = async (page, selector) => {
    await page.evaluate(() => document.activeElement?.blur());
    for (let k = 0; k < 400; k++) {
      await page.keyboard.press("Tab");
      if (await page.evaluate((s) => document.activeElement?.matches(s) ?? false, selector)) return;
    }
    throw new Error(`Tab does not reach ${selector}`);
  };

  let page = await begin(/Four elements/);
  await tabTo(page, 'g.element[data-id="d1"]');
  let doc = await changed(page, () => page.keyboard.press("ArrowRight"));
  assert.ok(doc.view.elements.find((e) => e.id === "d1").x > 6.8);
  const count = doc.view.elements.length;
  await tabTo(page, 'g.element[data-id="w3"]');
  doc = await changed(page, () => page.keyboard.press("Delete"));
  assert.ok(!doc.view.elements.some((e) => e.id === "w3"), `of ${count}`);

  page = await begin(/A house without/);
  await tabTo(page, '[data-column="bbox.w"] input[type="range"]');
  doc = await changed(page, () => page.keyboard.press("ArrowRight"));
  assert.match(doc.log.at(-1).said, /^wish bbox\.w=/);
  await tabTo(page, ".view canvas");
  await page.keyboard.press("ArrowLeft");

  page = await begin(/Fig\. 9/);
  await tabTo(page, "ol.rules button");
  await page.keyboard.press("Enter");
  await tabTo(page, '.parts input[type="number"]');
  doc = await changed(page, () => page.keyboard.press("ArrowUp"));
  assert.match(doc.log.at(-1).said, /^resize /);
  // Whoever works by keyboard stays where he was, though the panel was drawn anew.
  doc = await changed(page, () => page.keyboard.press("ArrowUp"));

  page = await begin(/A made town/);
  await tabTo(page, 'button[aria-label="Next building"]');
  await page.keyboard.press("Enter");
  await page.getByRole("button", { name: "Scale all of it" }).waitFor();
  await tabTo(page, "section[aria-label=Building] > button");
  doc = await changed(page, () => page.keyboard.press("Enter"));
  assert.match(doc.log.at(-1).said, /^scale /);
  // Undo and save by their keys.
  await changed(page, () => page.keyboard.press("Control+z"));
  await page.keyboard.press("Control+s");
  await page.getByText(/^Saved /).waitFor();
  const names = await reached(page);
  for (const name of ["Redo", "Save", "Seed", "Colours", "Next building", "Synthesize", "Script"]) assert.ok(names.some((n) => n.includes(name)), `${name} in ${names.join(", ")}`);
  return all.flat();
}

/** A part of a plan seen from near: what is dragged follows the pointer, handles keep their size, messages cover nothing. */
export async function zoom(server, context) {
  const { page, faults } = await open(context, server.address);
  await page.getByRole("button", { name: /A house without/ }).first().click();
  await shown(page);
  const plan = page.locator("svg.drawing");
  const seen = async () => (await plan.getAttribute("viewBox")).split(" ").map(Number);
  const whole = await seen();
  const box = page.locator("g.box.selected rect.shape");
  const handle = async () => (await page.locator("rect.handle").first().boundingBox()).width;
  const before = await handle();
  let at = await box.boundingBox();
  await page.mouse.move(at.x + at.width / 2, at.y + at.height / 2);
  for (let k = 0; k < 4; k++) await page.mouse.wheel(0, -60);
  await page.waitForFunction((w) => Number(document.querySelector("svg.drawing").getAttribute("viewBox").split(" ")[2]) < w, 0.7 * whole[2]);
  assert.ok(Math.abs((await handle()) - before) < 1.5, `handles of ${await handle()} and ${before} pixels`);
  // The place under the pointer stayed there.
  const near = await box.boundingBox();
  assert.ok(Math.abs(near.x + near.width / 2 - (at.x + at.width / 2)) < 3, "the wheel zooms at the pointer");
  // A drag by 40 pixels is a drag by 40 pixels of the enlarged plan.
  at = near;
  const { boxes } = (await shown(page)).view;
  const metres = (40 / at.width) * boxes[0].width;
  let doc = await changed(page, async () => {
    await page.mouse.move(at.x + at.width / 2, at.y + at.height / 2);
    await page.mouse.down();
    await page.mouse.move(at.x + at.width / 2 + 40, at.y + at.height / 2, { steps: 5 });
    await page.mouse.up();
  });
  // Another box may stand over the middle of the first.
  const moved = Math.max(...doc.view.boxes.map((b, k) => b.x - boxes[k].x));
  assert.ok(Math.abs(moved - metres) < 0.15, `${moved} m for ${metres}`);
  // The middle button moves what is seen, 0 shows all of it.
  const part = await seen();
  await page.mouse.down({ button: "middle" });
  await page.mouse.move(at.x + at.width / 2, at.y + at.height / 2, { steps: 4 });
  await page.mouse.up({ button: "middle" });
  assert.notDeepEqual(await seen(), part);
  await page.locator("g.box").first().focus();
  await page.keyboard.press("0");
  assert.ok(Math.abs((await seen())[2] - whole[2]) < 0.2 * whole[2]);
  // A message stands below the plan, not on it, and nothing moves when it comes.
  const frame = await plan.boundingBox();
  await page.evaluate(() => window.studio.note("A message"));
  const notice = await page.locator(".notice").boundingBox();
  assert.deepEqual(await plan.boundingBox(), frame);
  assert.ok(notice.y >= frame.y + frame.height, `${notice.y} covers what ends at ${frame.y + frame.height}`);

  // Drawn anew is drawn anew: other answers in place of those, by one command.
  const again = await open(context, server.address);
  const second = again.page;
  await second.getByRole("button", { name: /Four elements/ }).first().click();
  await shown(second);
  const anew = second.getByRole("button", { name: "Draw anew" });
  assert.ok(await anew.isDisabled(), "nothing was drawn yet");
  doc = await changed(second, () => second.getByRole("button", { name: "Complete", exact: true }).click());
  const length = doc.log.length;
  await anew.click();
  await second.waitForFunction(() => window.studio.seed === 2 && !window.studio.busy);
  doc = await shown(second);
  assert.equal(doc.log.length, length);
  assert.match(doc.log.at(-1).said, /2/, doc.log.at(-1).said);
  return [...faults, ...again.faults];
}
