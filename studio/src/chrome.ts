// What stands around every editor: the bar above, the log, the exports.

import * as api from "./api";
import { button, h, section, swap, tidy } from "./dom";
import type { Session } from "./session";

const KINDS = { house: "House", completion: "Completion", grammar: "Facade by its grammar", city: "City" };

/** The name of a kind of document. */
export function kindName(kind: api.Summary["kind"]): string {
  return KINDS[kind];
}

/** The beginning of what a command is called. */
const short = (said: string) => (said.length > 60 ? `${said.slice(0, 59)}…` : said);

/** The bar above an editor. */
export function bar(session: Session<unknown>, readOnly: boolean, leave: () => void): HTMLElement {
  const name = h("h1", {});
  const kind = h("span", { class: "kind" });
  const undo = button("Undo", () => session.undo(), { "aria-keyshortcuts": "Control+Z", title: "Undo (Ctrl+Z)" });
  const redo = button("Redo", () => session.redo(), { "aria-keyshortcuts": "Control+Shift+Z", title: "Redo (Ctrl+Shift+Z or Ctrl+Y)" });
  const save = button("Save", () => session.save(), {
    class: "primary",
    "aria-keyshortcuts": "Control+S",
    title: readOnly ? "The studio was started with --read-only" : "Write the file, and its commands as a script (Ctrl+S)",
    disabled: readOnly,
  });
  const seed = h("input", { type: "number", min: 0, step: 1, value: session.seed, "aria-label": "Seed" });
  seed.addEventListener("change", () => {
    session.seed = Math.max(0, Math.floor(Number(seed.value) || 0));
    seed.value = String(session.seed);
  });
  const anew = button("Draw anew", () => session.anew(), { class: "quiet" });
  const show = () => {
    name.textContent = session.doc.name + (session.doc.unsaved ? " •" : "");
    name.title = session.doc.unsaved ? "not saved" : "";
    kind.textContent = kindName(session.doc.kind);
    undo.disabled = session.busy || !session.doc.undo;
    if (document.activeElement !== seed) seed.value = String(session.seed);
    anew.disabled = !session.canDrawAnew;
    anew.title = session.canDrawAnew ? "The last thing once more, with the next seed" : "The last thing done was not drawn";
    redo.disabled = session.busy || !session.doc.redo;
    const { log } = session.doc;
    const at = log.filter((l) => l.done).length;
    undo.title = at > 0 ? `Undo ${short(log[at - 1].said)} (Ctrl+Z)` : "Nothing to undo (Ctrl+Z)";
    redo.title = at < log.length ? `Redo ${short(log[at].said)} (Ctrl+Shift+Z or Ctrl+Y)` : "Nothing to redo (Ctrl+Shift+Z or Ctrl+Y)";
  };
  session.onWork(show);
  show();
  return h(
    "header",
    { class: "bar" },
    button("Studio", leave, { class: "home", "aria-label": "Studio: all documents" }),
    h("div", { class: "title" }, name, kind),
    h("div", { class: "group" }, undo, redo),
    h("div", { class: "group seed" }, h("label", {}, h("span", {}, "Seed"), seed), anew),
    save,
  );
}

/** What is worked on, how far it is, and a button that stops it. */
export function progress(session: Session<unknown>): HTMLElement {
  const text = h("span", { role: "status", "aria-live": "polite" });
  const meter = h("progress", { max: 1, "aria-label": "How much of the work is done" });
  const strip = h("div", { class: "work", hidden: true }, text, meter, button("Stop", () => session.stop()));
  const show = () => {
    const { job } = session;
    strip.hidden = job === null;
    if (!job) return;
    const said = `${job.step || "working"} · ${tidy(job.seconds, 0)} s`;
    if (text.textContent !== said) text.textContent = said;
    if (job.part === null) meter.removeAttribute("value");
    else meter.value = job.part;
  };
  session.onWork(show);
  show();
  return strip;
}

/** The list of commands, and what the document can be written as. */
export function footer(session: Session<unknown>): HTMLElement {
  const log = h("ol", { class: "log" });
  const empty = h("p", { class: "hint" }, "Nothing was changed yet. Each edit is a command that is listed here; a click goes back to it.");
  const time = h("p", { class: "hint" });
  const exports = h("div", { class: "row" });
  const keep = async (blob: Promise<Blob>, name: string) => {
    await session.calmly(async () => {
      const url = URL.createObjectURL(await blob);
      h("a", { href: url, download: name }).click();
      setTimeout(() => URL.revokeObjectURL(url), 10_000);
    });
  };
  const show = () => {
    const { doc } = session;
    const at = doc.log.filter((l) => l.done).length;
    const moment = (said: string, count: number, done: boolean) =>
      h("li", { class: done ? "" : "undone" }, button(said, () => session.to(count), {
        class: "quiet",
        "aria-current": count === at ? "step" : null,
        disabled: session.busy,
        title: count < at ? "Undo all that came after" : count > at ? "Redo up to here" : "As it is shown",
      }));
    swap(log, ...(doc.log.length > 0 ? [moment("As it was opened", 0, true)] : []), ...doc.log.map((l, k) => moment(l.said, k + 1, l.done)));
    empty.hidden = doc.log.length > 0;
    time.textContent = doc.milliseconds > 0 ? `Last edit: ${tidy(doc.milliseconds, 0)} ms` : "";
    exports.replaceChildren(
      button("Script", () => keep(api.script(doc.id), `${doc.name}.sh`), { class: "quiet" }),
      ...doc.formats.map((f) =>
        button(f.toUpperCase(), () => keep(api.exported(doc.id, f), `${doc.name}.${f}`), { class: "quiet" }),
      ),
    );
  };
  session.onChange(show);
  session.onWork(() => {
    for (const step of log.querySelectorAll("button")) step.disabled = session.busy;
  });
  show();
  return h("div", {}, section("Commands", empty, log, time), section("Download", exports));
}

/** Undo, redo and save by the usual keys, and Escape, which lets go of what is selected. */
export function keys(session: Session<unknown>, readOnly: boolean, clear: () => void): (event: KeyboardEvent) => void {
  return (event) => {
    if (event.key === "Escape" && !event.defaultPrevented && !document.querySelector("dialog[open]")) {
      // First out of the field, then out of the selection.
      const field = document.activeElement;
      if (field instanceof HTMLInputElement || field instanceof HTMLTextAreaElement || field instanceof HTMLSelectElement) field.blur();
      else clear();
      return;
    }
    if (!(event.ctrlKey || event.metaKey)) return;
    const key = event.key.toLowerCase();
    const typing = event.target instanceof HTMLInputElement;
    if (key === "s") {
      event.preventDefault();
      if (!readOnly) void session.save();
    } else if (key === "z" && !typing) {
      event.preventDefault();
      void (event.shiftKey ? session.redo() : session.undo());
    } else if (key === "y" && !typing) {
      event.preventDefault();
      void session.redo();
    }
  };
}
