// The pictures of the start page's examples, drawn by the editors themselves: written to PICTURES, from which those of
// src/studio/assets/examples are taken.

import { join } from "node:path";
import { browser, open, shown, studio } from "./studio.mjs";

const chrome = await browser();
const server = await studio();
const context = await chrome.newContext({ viewport: { width: 1280, height: 800 }, colorScheme: "light", bypassCSP: true });
context.setDefaultTimeout(60_000);
const { page } = await open(context, server.address);
const token = new URLSearchParams(new URL(server.address).hash.slice(1)).get("token");
const { examples } = await page.evaluate(async (t) => (await fetch("/api/documents", { headers: { "x-edifice-token": t } })).json(), token);
for (const { id, title, kind } of examples) {
  await page.goto(server.address);
  await page.reload();
  // The drawing alone from the first, without a frame, at the size of a card.
  await page.addStyleTag({
    content: `.bar, .work, aside, .tools, figcaption, .notice { display: none !important; }
      main.editor { grid-template-columns: 1fr !important; width: 320px; height: 180px; flex: none !important; }
      .stage, .stage.two { padding: 0 !important; display: block !important; } .stage figure { height: 180px; }
      .stage.two figure:first-child { display: none; }
      body, .drawing, .view { background: transparent !important; }
      .drawing, .view { width: 320px !important; height: 180px !important; border-radius: 0 !important; box-shadow: none !important; }`,
  });
  await page.getByRole("button", { name: title }).first().click();
  await shown(page);
  await page.waitForTimeout(kind === "city" ? 4000 : 1500);
  await page.screenshot({ path: join(process.env.PICTURES, `${id}.png`), omitBackground: true, clip: { x: 0, y: 0, width: 320, height: 180 } });
  console.log(`studio: ${id} drawn`);
}
await chrome.close();
await server.end();
