// The page: a list to begin with, or one document in its editor.

import * as api from "./api";
import { bar, footer, keys, kindName, progress } from "./chrome";
import { city } from "./city";
import { completion } from "./completion";
import { button, h } from "./dom";
import { grammar } from "./grammar";
import { house } from "./house";
import { address, corners } from "./photograph";
import { type Editor, Session } from "./session";

const EDITORS = { house, completion, grammar, city } as unknown as Record<
  api.Summary["kind"],
  (session: Session<unknown>) => Editor<unknown>
>;
const POLL = 2000;

const app = document.getElementById("app")!;
const notice = h("div", { class: "notice", role: "status", "aria-label": "Messages", "aria-live": "polite" });
let close = () => {};
let hide = 0;

function say(text: string, kind: "note" | "error") {
  clearTimeout(hide);
  notice.textContent = text;
  notice.className = text === "" ? "notice" : `notice ${kind}`;
  if (kind === "note") hide = setTimeout(() => say("", "note"), 6000);
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

/** A time that has passed, in words. */
function ago(seconds: number): string {
  const units: [number, string][] = [[86_400, "day"], [3600, "hour"], [60, "minute"]];
  for (const [length, name] of units) {
    const count = Math.floor(seconds / length);
    if (count > 0) return `${count} ${name}${count === 1 ? "" : "s"} ago`;
  }
  return "just now";
}

async function start(): Promise<void> {
  const all = await api.listing();
  const card = (title: string, about: string, kind: api.Summary["kind"], act: () => void, picture?: string) =>
    h("li", {}, h("button", { type: "button", class: "card", onclick: act }, picture ? h("img", { src: picture, alt: "", width: 320, height: 180 }) : null, h("span", { class: "kind" }, kindName(kind)), h("strong", {}, title), h("span", {}, about)));
  /** A card with a button in its corner. */
  const removable = (item: HTMLElement, text: string, label: string, act: () => Promise<unknown>) => {
    item.append(button(text, () => act().then(start).catch(fail), { class: "quiet remove", "aria-label": label }));
    return item;
  };
  const opened = all.documents.map((d) =>
    removable(
      card(d.name, d.unsaved ? "open, not saved" : "open", d.kind, () => go(d.id)),
      "Close",
      `Close ${d.name}`,
      async () => {
        if (!d.unsaved || confirm(`${d.name} has unsaved work. Close it without saving?`)) await api.close(d.id, d.unsaved);
      },
    ),
  );
  const working = h("div", { class: "work", hidden: true });
  /** Opens a document, telling of the work. */
  const openBy = (title: string, work: (tell: (job: api.Job) => void) => Promise<api.Doc>) => async () => {
    try {
      const doc = await work((job) => {
        working.hidden = false;
        working.replaceChildren(h("span", { role: "status" }, `${title}: ${job.step || "opening"}`), h("progress", { max: 1, value: job.part, "aria-label": "How much is done" }), button("Stop", () => void api.stop(job.id).catch(fail)));
      });
      go(doc.id);
    } catch (error) {
      working.hidden = true;
      fail(error);
    }
  };
  const examples = all.examples.map((e) => card(e.title, e.about, e.kind, openBy(e.title, (tell) => api.openExample(e.id, tell)), `/examples/${e.id}.png`));
  /** Begins a drawing over a photograph. */
  const photograph = async (file: File) => {
    try {
      const sent = await address(file);
      const placed = await corners(file, [sent.width, sent.height], "new");
      if (placed === null) return;
      const doc = await api.openExample("sketch", () => {});
      await api.edit(doc, [{ do: "straighten", picture: sent.text, ...placed }], () => {});
      go(doc.id);
    } catch (error) {
      fail(error);
    }
  };
  const file = h("input", { type: "file", accept: "image/*", class: "hidden", "aria-label": "A photograph of a facade" });
  file.addEventListener("change", () => file.files?.[0] && void photograph(file.files[0]));
  const drop = h(
    "li",
    {},
    h(
      "label",
      { class: "card drop" },
      h("span", { class: "kind" }, kindName("completion")),
      h("strong", {}, "A photograph"),
      h("span", {}, "Drop the picture of a facade here, or choose it: put its corners, draw a few windows, and have it completed."),
      file,
    ),
  );
  const unsaved = all.unsaved.map((u) =>
    removable(
      card(u.name, `${u.edits} ${u.edits === 1 ? "edit" : "edits"} not saved${u.seconds === null ? "" : `, ${ago(u.seconds)}`}: open it again`, u.kind, openBy(u.name, (tell) => api.recover(u.id, tell))),
      "Discard",
      `Discard the unsaved work on ${u.name}`,
      async () => {
        if (confirm(`Discard the unsaved work on ${u.name} for good?`)) await api.discard(u.id);
      },
    ),
  );
  document.title = "Edifice studio";
  const page = h("main", { class: "start" });
  page.addEventListener("dragover", (event) => {
    event.preventDefault();
    page.classList.add("dropping");
  });
  page.addEventListener("dragleave", () => page.classList.remove("dropping"));
  page.addEventListener("drop", (event) => {
    event.preventDefault();
    page.classList.remove("dropping");
    const picture = [...(event.dataTransfer?.files ?? [])].find((f) => f.type.startsWith("image/"));
    if (picture) void photograph(picture);
    else say("Drop a picture here; other files are opened with edifice studio FILE", "note");
  });
  page.append(
      h("h1", {}, "Edifice studio"),
      working,
      h("p", { class: "lead" }, "Draw a part, and see what a method makes of the rest. What you fix stays; every edit is a command that can be run again without this page."),
      ...(unsaved.length > 0 ? [h("h2", {}, "Not saved when the studio ended"), h("ul", { class: "cards unsaved" }, ...unsaved)] : []),
      ...(opened.length > 0 ? [h("h2", {}, "Open"), h("ul", { class: "cards" }, ...opened)] : []),
      h("h2", {}, "Begin with"),
      h("ul", { class: "cards" }, drop, ...examples),
      h("p", { class: "hint" }, `Edifice ${all.version}${all.readOnly ? " · read only" : ""} · files are opened with edifice studio FILE`),
  );
  app.replaceChildren(page, notice);
}

async function edit(id: string) {
  const [all, doc] = await Promise.all([api.listing(), api.get(id)]);
  const session = new Session<unknown>(doc, say);
  const editor = EDITORS[doc.kind](session);
  const pressed = keys(session, all.readOnly, () => editor.clear?.());
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
  // The studio keeps what is not saved, but the page is where it is seen.
  const leaving = (event: BeforeUnloadEvent) => {
    if (session.doc.unsaved || session.busy) event.preventDefault();
  };
  addEventListener("beforeunload", leaving);
  const poll = setInterval(() => {
    if (!document.hidden) session.refresh().catch(fail);
  }, POLL);
  // For tests and for the curious: what the page shows.
  Object.assign(window, { studio: session });
  close = () => {
    clearInterval(poll);
    removeEventListener("keydown", pressed);
    removeEventListener("beforeunload", leaving);
    editor.close();
  };
}

async function route() {
  close();
  close = () => {};
  say("", "note");
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
