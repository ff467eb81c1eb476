// A studio and a page of it.

import { spawn } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";

const { EDIFICE, BROWSER, PICTURES } = process.env;

/** Starts the program in a folder of its own; its address. */
export async function studio(args = []) {
  const folder = mkdtempSync(join(tmpdir(), "studio-"));
  // Its state in a folder of its own, too: what other studios of this user left is not offered.
  const env = { ...process.env, XDG_STATE_HOME: mkdtempSync(join(tmpdir(), "studio-state-")) };
  const child = spawn(EDIFICE, ["studio", "--no-open", ...args], { cwd: folder, env, stdio: ["ignore", "pipe", "inherit"] });
  const address = await new Promise((found, failed) => {
    let text = "";
    child.stdout.on("data", (bytes) => {
      text += bytes;
      if (text.includes("\n")) found(text.split("\n")[0]);
    });
    child.on("exit", (code) => failed(new Error(`the studio ended with ${code}`)));
  });
  return {
    address,
    folder,
    read: (name) => readFileSync(join(folder, name)),
    /** Processor time that it has used, in milliseconds, in steps of a clock tick of 10 ms; not a number where there is no /proc. */
    used: () => {
      if (!existsSync(`/proc/${child.pid}/stat`)) return NaN;
      const fields = readFileSync(`/proc/${child.pid}/stat`, "utf8").split(") ")[1].split(" ");
      return 10 * (Number(fields[11]) + Number(fields[12]));
    },
    /** Ends it as Ctrl-C does; its exit code. */
    end: () =>
      new Promise((ended) => {
        child.removeAllListeners("exit");
        child.on("exit", (code, signal) => ended(code ?? signal));
        child.kill("SIGINT");
      }),
  };
}

/** A browser; as root it needs the first flag, and without a graphics card the last. */
export function browser() {
  return chromium.launch({
    executablePath: BROWSER,
    args: ["--no-sandbox", "--disable-dev-shm-usage", "--enable-unsafe-swiftshader"],
  });
}

/** A page that fails when it asks another machine for anything, or has an error of its own. */
export async function open(context, address) {
  const page = await context.newPage();
  const faults = [];
  const own = new URL(address).origin;
  page.on("request", (r) => {
    if (!r.url().startsWith(own) && !/^(blob|data):/.test(r.url())) faults.push(`asked ${r.url()}`);
  });
  page.on("pageerror", (e) => faults.push(String(e)));
  page.on("console", (m) => {
    // What the server refuses is told to the user, and the browser notes it too.
    if (m.type() === "error" && !/status of 4\d\d/.test(m.text())) faults.push(m.text());
  });
  await page.goto(address);
  return { page, faults };
}

/** The document that the page shows, once it is not busy. */
export async function shown(page) {
  await page.waitForFunction(() => window.studio && !window.studio.busy);
  return page.evaluate(() => window.studio.doc);
}

/** Waits until the document has another revision, and is not busy. */
export async function changed(page, act) {
  const before = (await shown(page)).revision;
  const start = performance.now();
  await act();
  await page.waitForFunction((r) => window.studio.doc.revision !== r && !window.studio.busy, before, { timeout: 60_000, polling: 20 });
  changed.times.push(performance.now() - start);
  return page.evaluate(() => window.studio.doc);
}
changed.times = [];

/** Clicks the middle of a terminal region of a facade. */
export async function press(page, terminal) {
  const [x, y] = await page.evaluate((k) => {
    const [, left, bottom, width, height] = window.studio.doc.view.terminals[k];
    const matrix = document.querySelector("svg.drawing > g").getScreenCTM();
    const at = new DOMPoint(left + width / 2, bottom + height / 2).matrixTransform(matrix);
    return [at.x, at.y];
  }, terminal);
  await page.mouse.click(x, y);
}

export const picture = (page, name) => page.screenshot({ path: join(PICTURES, `${name}.png`) });
