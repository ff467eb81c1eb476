// The editor of completions: elements on an outline, and what the model makes of the rest (Fan et al. 2014, Fig. 15).

import type { Doc } from "./api";
import { button, field, h, s, section, swap, tidy } from "./dom";
import { arrow, Drawing, place, type Rect, snap } from "./drawing";
import { address, corners, held } from "./photograph";
import type { Editor, Session } from "./session";

interface Element_ extends Rect {
  id: string;
  label: string;
  class: string;
  observed: boolean;
  probability: number | null;
  reason: string | null;
  pinned: boolean;
}

type Corners = [number, number, number, number];

interface View {
  /** Which photograph is under the drawing. */
  photograph: string | null;
  /** The photograph that the drawing was opened from, until its corners are known. */
  original: { file: string; width: number; height: number } | null;
  unit: string;
  width: number;
  height: number;
  elements: Element_[];
  unknown: Corners[] | null;
  forbid: Corners[];
  answers: { mass: number; score: number; added: number; elements: Element_[] }[];
  chosen: number | null;
  labels: string[];
}

const four = (v: number) => tidy(v, 4);
const area = (e: Rect) => Math.round(e.width * e.height * 1e6);

/** Larger elements lie below smaller ones, and completed ones below given ones of the same size, so that what is given can be clicked. */
const below = (a: Element_, b: Element_) => area(b) - area(a) || Number(a.observed) - Number(b.observed);

/** A facade element as people draw one. */
function picture(e: Rect & { class: string }): SVGGElement {
  const g = s("g", { class: `element ${/^[a-z]+$/.test(e.class) ? e.class : "other"}` }, s("rect", place(e)));
  if (e.class === "window" && e.width > 0 && e.height > 0) {
    const x = e.x + e.width / 2;
    const y = e.y + e.height * 0.62;
    g.append(s("line", { x1: x, x2: x, y1: e.y, y2: e.y + e.height }), s("line", { x1: e.x, x2: e.x + e.width, y1: y, y2: y }));
  }
  return g;
}

function thumbnail(view: View, elements: Element_[]): SVGSVGElement {
  return s(
    "svg",
    { viewBox: `0 ${-view.height} ${view.width} ${view.height}`, "aria-hidden": "true" },
    s("g", { transform: "scale(1,-1)" }, s("rect", { class: "wall", ...place({ x: 0, y: 0, width: view.width, height: view.height }) }), ...elements.map(picture)),
  );
}

/** The editor. */
export function completion(session: Session<View>): Editor<View> {
  const drawing = new Drawing("Facade. Tab to an element, arrow keys move it, Delete removes it.", () => session.redraw());
  const tools = h("div", { class: "tools", role: "toolbar", "aria-label": "Tools" });
  const stage = h("div", { class: "stage" }, tools, drawing.svg as unknown as HTMLElement);
  const panel = h("div", {});
  let tool = "select";
  let selected = new Set<string>();
  let live = true;
  let count = 3;
  let nudge = 0;
  /** The photograph that was asked for last: which, and its address once it has come. */
  let photograph: { id: string; address: string } | null = null;

  const grid = () => {
    // A fiftieth of the facade, as a round number: 0.1 m, or 10 px.
    const power = 10 ** Math.floor(Math.log10(session.doc.view.width / 50));
    return power;
  };
  const complete = () => ({
    do: "complete",
    count,
    seed: session.seed,
    pins: session.doc.view.elements.filter((e) => e.pinned).map((e) => e.id),
    forbid: session.doc.view.forbid,
  });
  /** Edits, and new answers to them. */
  const edit = (...edits: string[]) =>
    session.run(() => {
      const command = { do: "edit", edits };
      if (!live) return [command];
      const gone = new Set(edits.filter((e) => /^(remove|move|resize|relabel) /.test(e)).map((e) => e.split(" ")[1].split("=")[0]));
      const wish = complete();
      return [command, { ...wish, pins: wish.pins.filter((p) => !gone.has(p)) }];
    });
  /** Shows the rest as it would be completed after edits that are still under way. */
  function completed(edits: string[]) {
    if (!live || session.doc.view.answers.length === 0) return;
    const gone = new Set(edits.map((e) => e.split(" ")[1].split("=")[0]));
    const wish = complete();
    const pins = wish.pins.filter((p) => !gone.has(p));
    void session.preview([{ do: "edit", edits }, { ...wish, count: 1, pins }], (view) => {
      for (const node of drawing.layer.querySelectorAll("g.element.added")) if (!gone.has(node.getAttribute("data-id") ?? "")) node.remove();
      const added = view.elements.filter((e) => !e.observed && !e.pinned).sort(below);
      const nodes = added.map((e) => {
        const node = picture(e);
        node.classList.add("added");
        return node;
      });
      drawing.layer.querySelector("rect.wall")?.after(...nodes);
    });
  }
  const again = (change: Partial<ReturnType<typeof complete>> = {}) => session.run(() => [{ ...complete(), ...change }]);

  /** Another photograph, or none; where there were answers, the same again over it. */
  const put = (picture: string | null) =>
    session.run(() => [{ do: "photograph", picture }, ...(session.doc.view.answers.length > 0 ? [complete()] : [])]);

  /** A photograph as the rectangle between its corners; where there were answers, the same again over it. */
  const straighten = (wish: { picture: string | null; corners: [number, number][]; height: number | null }) =>
    session.run(() => [{ do: "straighten", ...wish }, ...(session.doc.view.answers.length > 0 ? [complete()] : [])]);

  /** Asks for the corners of the photograph that the drawing was opened from. */
  const straightenOriginal = (original: NonNullable<View["original"]>) =>
    session.calmly(async () => {
      const said = await session.ask<{ picture: string | null }>({ ask: "original" });
      if (!said?.picture) return;
      const source = held(said.picture);
      const empty = session.doc.view.elements.length === 0;
      const placed = await corners(source, [original.width, original.height], empty ? "new" : "kept");
      if (placed !== null) await straighten({ picture: null, ...placed });
    });
  /** True once the corners were asked for unasked. */
  let offered = false;

  /** The address of the photograph under the drawing, asked for once: it is not in every answer of the server. */
  function under(id: string | null): string | null {
    if (id === null) photograph = null;
    else if (photograph?.id !== id) {
      const asked = { id, address: "" };
      photograph = asked;
      void session.ask<{ picture: string | null }>({ ask: "photograph" }).then((said) => {
        asked.address = said?.picture ?? "";
        if (photograph === asked && asked.address !== "") show(session.doc);
      });
    }
    return photograph?.address || null;
  }

  function nudged(elements: Element_[]) {
    clearTimeout(nudge);
    nudge = setTimeout(() => edit(...elements.map((e) => `move ${e.id}=${four(e.x)},${four(e.y)}`)), 400);
  }

  function drawElement(e: Element_): SVGGElement {
    const g = picture(e);
    const state = e.observed ? "observed" : e.pinned ? "pinned" : "added";
    g.classList.add(state);
    if (selected.has(e.id)) g.classList.add("selected");
    const known = e.observed ? "given" : `completed, probability ${tidy(e.probability ?? 0)}${e.pinned ? ", pinned" : ""}`;
    for (const [k, v] of Object.entries({
      tabindex: 0,
      role: "button",
      "aria-pressed": String(selected.has(e.id)),
      "aria-label": `${e.label}, ${tidy(e.width)} by ${tidy(e.height)} at ${tidy(e.x)}, ${tidy(e.y)}, ${known}`,
      "data-id": e.id,
    }))
      g.setAttribute(k, String(v));
    if (!e.observed && e.probability !== null) g.setAttribute("opacity", String(0.45 + 0.55 * e.probability));
    g.append(s("title", {}, e.observed ? `${e.label}: given` : `${e.label}: ${tidy((e.probability ?? 0) * 100, 0)} %, ${e.reason ?? ""}`));
    const select = (add: boolean) => {
      if (add) selected.has(e.id) ? selected.delete(e.id) : selected.add(e.id);
      else if (!selected.has(e.id)) selected = new Set([e.id]);
      show(session.doc);
      (drawing.layer.querySelector(`[data-id="${CSS.escape(e.id)}"]`) as SVGGElement | null)?.focus();
    };
    g.addEventListener("focus", () => {
      if (!selected.has(e.id)) select(false);
    });
    g.addEventListener("keydown", (event) => {
      const by = arrow(event, grid());
      const own = session.doc.view.elements.filter((o) => selected.has(o.id));
      if (by) {
        event.preventDefault();
        for (const o of own) [o.x, o.y] = [snap(o.x + by[0], grid() / 10), snap(o.y + by[1], grid() / 10)];
        show(session.doc);
        (drawing.layer.querySelector(`[data-id="${CSS.escape(e.id)}"]`) as SVGGElement | null)?.focus();
        nudged(own);
      } else if (event.key === "Delete" || event.key === "Backspace") {
        event.preventDefault();
        const names = own.map((o) => `remove ${o.id}`);
        selected.clear();
        void edit(...names);
      }
    });
    drawing.draggable(g, (event) => {
      if (tool !== "select") return null;
      select(event.shiftKey || event.ctrlKey);
      const own = session.doc.view.elements.filter((o) => selected.has(o.id));
      const nodes = own.map((o) => drawing.layer.querySelector(`[data-id="${CSS.escape(o.id)}"]`));
      return (dx, dy, done) => {
        const [x, y] = [snap(e.x + dx, grid()) - e.x, snap(e.y + dy, grid()) - e.y];
        for (const node of nodes) node?.setAttribute("transform", `translate(${x},${y})`);
        if (x === 0 && y === 0) return;
        const moves = own.map((o) => `move ${o.id}=${four(o.x + x)},${four(o.y + y)}`);
        if (done) void edit(...moves);
        else completed(moves);
      };
    });
    return g;
  }

  /** Draws a new rectangle with the tool. */
  function begin(event: PointerEvent) {
    if (tool === "select") {
      selected.clear();
      show(session.doc);
      return null;
    }
    const { width, height } = session.doc.view;
    const [x, y] = drawing.at(event).map((v) => snap(v, grid()));
    const shape = s("rect", { class: `sketch ${tool}` });
    drawing.layer.append(shape);
    return (dx: number, dy: number, done: boolean) => {
      const clamp = (v: number, most: number) => Math.min(Math.max(snap(v, grid()), 0), most);
      const [x1, y1] = [clamp(x + dx, width), clamp(y + dy, height)];
      const [x0, y0] = [clamp(x, width), clamp(y, height)];
      const r = { x: Math.min(x0, x1), y: Math.min(y0, y1), width: Math.abs(x1 - x0), height: Math.abs(y1 - y0) };
      for (const [k, v] of Object.entries(place(r))) shape.setAttribute(k, String(v));
      if (!done) return;
      shape.remove();
      if (r.width === 0 || r.height === 0) return;
      const corners: Corners = [r.x, r.y, r.width, r.height];
      const text = corners.map(four).join(",");
      if (tool === "unknown") void edit(`unknown ${text}`);
      else if (tool === "forbid") void again({ forbid: [...session.doc.view.forbid, corners] });
      else void edit(`add ${tool}@${text}`);
    };
  }

  /** What a tool does, and by which keys. */
  const tips: Record<string, string> = {
    select: "Click or drag an element; Shift adds to the selection, arrow keys move it, Delete removes it, Escape lets go",
    unknown: "Drag over a part of which nothing is known",
    forbid: "Drag over a part that is to stay empty",
  };

  function toolbar(view: View) {
    const all: [string, string][] = [
      ["select", "Select"],
      ...view.labels.map((l): [string, string] => [l, l[0].toUpperCase() + l.slice(1)]),
      ["unknown", "Unknown"],
      ["forbid", "Forbid"],
    ];
    const file = h("input", { type: "file", accept: "image/*", class: "hidden", "aria-label": "Photograph to draw over" });
    file.addEventListener("change", async () => {
      const chosen = file.files?.[0];
      if (!chosen) return;
      await session.calmly(async () => {
        const sent = await address(chosen);
        const empty = view.elements.length === 0;
        const placed = await corners(chosen, [sent.width, sent.height], empty ? "new" : "kept");
        if (placed !== null) await straighten({ picture: sent.text, ...placed });
      });
    });
    swap(
      tools,
      ...all.map(([id, name]) =>
        button(name, () => {
          tool = id;
          show(session.doc);
        }, { "aria-pressed": String(tool === id), class: `tool ${id}`, title: tips[id] ?? `Drag over the wall: ${id}` }),
      ),
      view.original === null ? null : button("Straighten", () => straightenOriginal(view.original!), { class: "tool" }),
      h("label", { class: "tool file" }, "Photograph", file),
      view.photograph === null ? null : button("No photograph", () => put(null), { class: "tool" }),
    );
  }

  function inspector(view: View): HTMLElement {
    const own = view.elements.filter((e) => selected.has(e.id));
    if (own.length === 0) return section("Element", h("p", { class: "hint" }, "Select an element, or draw one with a tool above. Shift adds to the selection."));
    if (own.length > 1)
      return section(`${own.length} elements`, h("p", { class: "hint" }, "They move together."), button("Remove", () => edit(...own.map((e) => `remove ${e.id}`)), { class: "quiet", title: "Remove them (Delete, while the drawing is in focus)" }));
    const [e] = own;
    const label = h("select", { "aria-label": "Label" }, ...[...new Set([...view.labels, e.label])].map((l) => h("option", { value: l, selected: l === e.label }, l)));
    label.addEventListener("change", () => edit(`relabel ${e.id}=${label.value}`));
    const why = e.observed ? "Given: a completion keeps it." : `${tidy((e.probability ?? 0) * 100, 0)} % likely: ${e.reason ?? "completed"}.`;
    const pins = () => view.elements.filter((o) => o.pinned !== (o.id === e.id)).map((o) => o.id);
    return section(
      "Element",
      h("label", { class: "field" }, h("span", {}, "Label"), label),
      h(
        "div",
        { class: "fields" },
        field("x", e.x, (v) => edit(`move ${e.id}=${four(v)},${four(e.y)}`)),
        field("y", e.y, (v) => edit(`move ${e.id}=${four(e.x)},${four(v)}`)),
        field("Width", e.width, (v) => edit(`resize ${e.id}=${four(v)},${four(e.height)}`)),
        field("Height", e.height, (v) => edit(`resize ${e.id}=${four(e.width)},${four(v)}`)),
      ),
      h("p", { class: "hint" }, why),
      h(
        "div",
        { class: "row" },
        e.observed ? null : button(e.pinned ? "Unpin" : "Pin", () => again({ pins: pins() })),
        button("Remove", () => edit(`remove ${e.id}`), { class: "quiet", title: "Remove it (Delete, while the drawing is in focus)" }),
      ),
    );
  }

  function show(doc: Doc<View>) {
    const { view } = doc;
    const focused = document.activeElement?.getAttribute("data-id");
    const ids = new Set(view.elements.map((e) => e.id));
    selected = new Set([...selected].filter((id) => ids.has(id)));
    const domain = { x: 0, y: 0, width: view.width, height: view.height };
    drawing.frame(domain);
    drawing.svg.classList.toggle("drawing-tool", tool !== "select");
    const picture = under(view.photograph);
    const wall = s("rect", { class: picture ? "wall clear" : "wall", ...place(domain) });
    drawing.layer.replaceChildren(
      ...(picture ? [s("image", { href: picture, ...place(domain), transform: `translate(0,${view.height}) scale(1,-1)`, preserveAspectRatio: "none" })] : []),
      wall,
      ...(view.unknown ?? []).map(([x, y, width, height]) => s("rect", { class: "unknown", ...place({ x, y, width, height }) })),
      ...view.forbid.map(([x, y, width, height]) => s("rect", { class: "forbid", ...place({ x, y, width, height }) })),
      ...[...view.elements].sort(below).map(drawElement),
      ...[handle(view)].filter((n) => n !== null),
    );
    if (focused) (drawing.layer.querySelector(`[data-id="${CSS.escape(focused)}"]`) as SVGGElement | null)?.focus();
    toolbar(view);
    if (view.original && !offered && view.elements.length === 0) {
      offered = true;
      void straightenOriginal(view.original);
    }
    const box = h("input", { type: "checkbox", checked: live });
    box.addEventListener("change", () => (live = box.checked));
    const answers = view.answers.map((a, k) =>
      h(
        "li",
        {},
        h(
          "button",
          { type: "button", class: "answer", "aria-pressed": String(view.chosen === k + 1), onclick: () => session.run(() => [{ do: "choose", answer: k + 1 }]) },
          thumbnail(view, a.elements) as unknown as HTMLElement,
          h("span", {}, `${k + 1} · ${tidy(a.mass * 100, 0)} %`),
        ),
      ),
    );
    const marks = [
      ...(view.unknown ?? []).map((_, k) => button(`Unknown ${k + 1} ✕`, () => edit(`known ${k}`), { class: "quiet", "aria-label": `Remove unknown rectangle ${k + 1}` })),
      ...view.forbid.map((_, k) => button(`Forbidden ${k + 1} ✕`, () => again({ forbid: view.forbid.filter((_f, j) => j !== k) }), { class: "quiet", "aria-label": `Remove forbidden rectangle ${k + 1}` })),
    ];
    swap(
      panel,
      section(
        "Complete",
        h("div", { class: "row" }, button("Complete", () => again(), { class: "primary" }), field("Answers", count, (v) => (count = Math.min(Math.max(1, Math.round(v)), 12)), { step: 1, min: 1, max: 12 })),
        h("label", { class: "check" }, box, h("span", {}, "After every change")),
      ),
      answers.length > 0 ? section("Answers", h("p", { class: "hint" }, "The most probable first, each with its share of the probability."), h("ul", { class: "answers" }, ...answers)) : null,
      inspector(view),
      marks.length > 0 ? section("Marked", h("div", { class: "row" }, ...marks)) : null,
      section(
        `Outline (${view.unit})`,
        h("div", { class: "fields" }, field("Width", view.width, (v) => edit(`outline ${four(v)},${four(view.height)}`)), field("Height", view.height, (v) => edit(`outline ${four(view.width)},${four(v)}`))),
      ),
    );
  }

  /** The upper right corner of the one selected element, to change its size. */
  function handle(view: View): SVGElement | null {
    const own = view.elements.filter((e) => selected.has(e.id));
    if (own.length !== 1 || tool !== "select") return null;
    const [e] = own;
    const size = 9 * drawing.pixel();
    const corner = s("rect", { class: "handle", x: e.x + e.width - size / 2, y: e.y + e.height - size / 2, width: size, height: size }, s("title", {}, "Drag to change the size"));
    drawing.draggable(corner, () => {
      const node = drawing.layer.querySelector(`[data-id="${CSS.escape(e.id)}"] rect`);
      return (dx, dy, done) => {
        const width = Math.max(grid(), snap(e.width + dx, grid()));
        const height = Math.max(grid(), snap(e.height + dy, grid()));
        node?.setAttribute("width", String(width));
        node?.setAttribute("height", String(height));
        if (done && (width !== e.width || height !== e.height)) void edit(`resize ${e.id}=${four(width)},${four(height)}`);
      };
    });
    return corner;
  }

  drawing.draggable(drawing.svg, begin);
  const clear = () => {
    selected.clear();
    show(session.doc);
  };
  return { stage, panel, show, clear, close: () => {} };
}
