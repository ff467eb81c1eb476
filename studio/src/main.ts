// The page: a list to begin with, or one document in its editor.

import * as api from "./api";
import { bar, footer, keys, kindName, progress } from "./chrome";
import { city } from "./city";
import { completion } from "./completion";
import { button, h } from "./dom";
import { grammar } from "./grammar";
import { house } from "./house";
import { type Editor, Session } from "./session";

const EDITORS = { house, completion, grammar, city } as unknown as Record<
  api.Summary["kind"],
  (session: Session<unknown>) => Editor<unknown>
>;
const POLL = 2000;

const app = document.getElementById("app")!;
const notice = h("div", { class: "notice", role: "status", "aria-live": "polite", hidden: true });
let close = () => {};
let hide = 0;

function say(text: string, kind: "note" | "error") {
  clearTimeout(hide);
  notice.textContent = text;
  notice.hidden = text === "";
  notice.className = `notice ${kind}`;
  if (kind === "note") hide = setTimeout(() => (notice.hidden = true), 6000);
}

function fail(error: unknown) {
  say(error instanceof Error ? error.message : String(error), "error");
}

/** The document that the address names. */
function wanted(): string | null {
  return new URLSearchParams(location.hash.slice(1)).get("document");
}

function go(id: string | null) {
  const hash = new URLSearchParams(location.hash.slice(1));
  if (id === null) hash.delete("document");
  else hash.set("document", id);
  location.hash = hash.toString();
}

async function start() {
  const all = await api.listing();
  const card = (title: string, about: string, kind: api.Summary["kind"], act: () => void) =>
    h("li", {}, h("button", { type: "button", class: "card", onclick: act }, h("span", { class: "kind" }, kindName(kind)), h("strong", {}, title), h("span", {}, about)));
  const opened = all.documents.map((d) =>
    card(d.name, d.unsaved ? "open, not saved" : "open", d.kind, () => go(d.id)),
  );
  const working = h("div", { class: "work", hidden: true });
  const examples = all.examples.map((e) =>
    card(e.title, e.about, e.kind, async () => {
      try {
        const doc = await api.openExample(e.id, (job) => {
          working.hidden = false;
          working.replaceChildren(h("span", { role: "status" }, `${e.title}: ${job.step || "opening"}`), h("progress", { max: 1, value: job.part, "aria-label": "How much is done" }), button("Stop", () => void api.stop(job.id).catch(fail)));
        });
        go(doc.id);
      } catch (error) {
        working.hidden = true;
        fail(error);
      }
    }),
  );
  document.title = "Edifice studio";
  app.replaceChildren(
    h(
      "main",
      { class: "start" },
      h("h1", {}, "Edifice studio"),
      working,
      h("p", { class: "lead" }, "Draw a part, and see what a method makes of the rest. What you fix stays; every edit is a command that can be run again without this page."),
      ...(opened.length > 0 ? [h("h2", {}, "Open"), h("ul", { class: "cards" }, ...opened)] : []),
      h("h2", {}, "Begin with"),
      h("ul", { class: "cards" }, ...examples),
      h("p", { class: "hint" }, `Edifice ${all.version}${all.readOnly ? " · read only" : ""} · files are opened with edifice studio FILE`),
    ),
    notice,
  );
}

async function edit(id: string) {
  const [all, doc] = await Promise.all([api.listing(), api.get(id)]);
  const session = new Session<unknown>(doc, say);
  const editor = EDITORS[doc.kind](session);
  const pressed = keys(session, all.readOnly);
  const show = () => {
    document.title = `${session.doc.name} · Edifice studio`;
    editor.show(session.doc);
  };
  app.replaceChildren(
    bar(session, all.readOnly, () => go(null)),
    progress(session),
    h("main", { class: `editor ${doc.kind}` }, editor.stage, h("aside", { "aria-label": "Properties" }, editor.panel, footer(session))),
    notice,
  );
  session.onChange(show);
  session.onWork(() => app.classList.toggle("busy", session.busy));
  show();
  addEventListener("keydown", pressed);
  const poll = setInterval(() => {
    if (!document.hidden) session.refresh().catch(fail);
  }, POLL);
  // For tests and for the curious: what the page shows.
  Object.assign(window, { studio: session });
  close = () => {
    clearInterval(poll);
    removeEventListener("keydown", pressed);
    editor.close();
  };
}

async function route() {
  close();
  close = () => {};
  notice.hidden = true;
  try {
    const id = wanted();
    await (id === null ? start() : edit(id));
  } catch (error) {
    app.replaceChildren(h("main", { class: "start" }, h("h1", {}, "Edifice studio"), button("Back to the start", () => go(null))), notice);
    fail(error);
  }
}

addEventListener("hashchange", route);
void route();
