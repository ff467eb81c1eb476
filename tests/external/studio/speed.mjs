// How long 200 edits of each editor take, in the server and in the page: from the act until the page has drawn the answer. Beside the
// times, which other work on the machine makes longer, the processor time: of the server's process, and of the page's main thread.
//   node speed.mjs [EDITS]
// Run by `tests/external/studio/run.sh EDIFICE PICTURES speed.mjs`.

import { browser, open, shown, studio } from "./studio.mjs";

const EDITS = Number(process.argv[2] ?? 200);

/** Makes an edit inside the page; the milliseconds of the server, and those until the next picture after the answer. */
async function timed(page, commands) {
  return page.evaluate(async (list) => {
    const session = window.studio;
    const before = session.doc.revision;
    const start = performance.now();
    await session.run(() => list);
    // The picture with the answer is shown before the second frame from now.
    await new Promise((r) => requestAnimationFrame(() => setTimeout(r, 0)));
    const time = performance.now() - start;
    return session.doc.revision === before ? null : [session.doc.milliseconds, time];
  }, commands);
}

/** Shows what commands would make of the document, as while something is dragged; the milliseconds until the next picture. */
async function previewed(page, commands) {
  return page.evaluate(async (list) => {
    const start = performance.now();
    await window.studio.preview(list, (view) => window.studio.previewed(view));
    await new Promise((r) => requestAnimationFrame(() => setTimeout(r, 0)));
    return performance.now() - start;
  }, commands);
}

function told(name, times, used, wanted, note) {
  const at = (k, q) => {
    const sorted = times.map((t) => t[k]).sort((a, b) => a - b);
    return sorted[Math.floor((sorted.length - 1) * q)];
  };
  const [server, page, thread] = [0, 1, 2].map((k) => [at(k, 0.5), at(k, 0.95)].map((v) => v.toFixed(1)));
  const row = [name, times.length, ...server, ...page, (used / times.length).toFixed(1), ...thread, wanted];
  console.log(`| ${row.join(" | ")} |`);
  if (note) console.log(`  ${note}`);
  return Number(page[1]) <= wanted;
}

/** A number from 0 to 1, the same in every run. */
function random(seed) {
  let state = seed;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

const measured = {
  async completion(page, next) {
    await timed(page, [{ do: "complete", count: 3, seed: 1 }]);
    return (k) => [{ do: "edit", edits: [`move d1=${(5.5 + 6 * next()).toFixed(2)},0`] }, { do: "complete", count: 3, seed: k }];
  },
  async house(page, next) {
    const { boxes } = (await shown(page)).view;
    return (k) => [{ do: "edit", edits: [`resize 0=${boxes[0].width},${boxes[0].depth},${(2.6 + 0.5 * next()).toFixed(2)}`], seed: k }];
  },
  async grammar(page, next) {
    const { view } = await shown(page);
    await timed(page, [{ do: "edit", edits: [`outline ${4.2 * view.width},${4.2 * view.height}`] }]);
    const now = (await shown(page)).view;
    if (now.terminals.length < 1100) throw new Error(`${now.terminals.length} terminals are too few`);
    console.log(`grammar: ${now.terminals.length} terminals`);
    const rule = now.rules.findIndex((r) => r.operation === "split" && r.parts.length > 1);
    const size = now.rules[rule].parts[0].size;
    return () => [{ do: "edit", edits: [`border ${rule}.0=${(size * (0.1 * next() - 0.05)).toFixed(4)}`] }];
  },
};
/** The commands of an edit as those of a preview. */
const previews = { completion: ([edit, complete]) => [edit, { ...complete, count: 1 }], grammar: (commands) => commands };
const examples = { completion: [/Four elements/, 150], house: [/A house without/, 200], grammar: [/A boulevard/, 100] };

const chrome = await browser();
console.log(`| edit | edits | server median (ms) | server p95 (ms) | page median (ms) | page p95 (ms) | server, processor mean (ms) | page, processor median (ms) | page, processor p95 (ms) | wanted (ms) |\n|${" --- |".repeat(10)}`);
let slow = 0;
for (const [name, prepare] of Object.entries(measured)) {
  const server = await studio();
  const context = await chrome.newContext({ viewport: { width: 1280, height: 800 } });
  const { page } = await open(context, server.address);
  await page.getByRole("button", { name: examples[name][0] }).click();
  await shown(page);
  const command = await prepare(page, random(7));
  for (let k = 0; k < 5; k++) await timed(page, command(k));
  const devtools = await context.newCDPSession(page);
  await devtools.send("Performance.enable", { timeDomain: "threadTicks" });
  const thread = async () => {
    const { metrics } = await devtools.send("Performance.getMetrics");
    return 1000 * metrics.find((m) => m.name === "TaskDuration").value;
  };
  const times = [];
  const before = server.used();
  let refused = 0;
  for (let k = 0; times.length < EDITS && refused < EDITS; k++) {
    const start = await thread();
    const time = await timed(page, command(k));
    if (time) times.push([...time, (await thread()) - start]);
    else refused += 1;
  }
  if (!told(name, times, server.used() - before, examples[name][1], refused > 0 ? `${refused} refused` : "")) slow += 1;
  if (previews[name]) {
    // What the editor draws of a preview is little: the elements or regions anew.
    await page.evaluate(() => (window.studio.previewed = () => {}));
    const waits = [];
    for (let k = 0; k < EDITS; k++) waits.push(await previewed(page, previews[name](command(k))));
    waits.sort((a, b) => a - b);
    const p95 = waits[Math.floor(0.95 * (waits.length - 1))];
    console.log(`| ${name}, preview | ${EDITS} | | | ${waits[EDITS >> 1].toFixed(1)} | ${p95.toFixed(1)} | | | | 33 |`);
    if (p95 > 33) slow += 1;
  }
  await context.close();
  await server.end();
}
await chrome.close();
console.log(slow === 0 ? "all within what is wanted" : `${slow} slower than wanted`);
