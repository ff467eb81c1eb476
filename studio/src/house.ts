// The editor of houses: plan and view side by side (Fan and Wonka 2016, Fig. 19).

import type { Doc } from "./api";
import { button, field, h, s, section, swap, tidy } from "./dom";
import { arrow, Drawing, place, snap } from "./drawing";
import type { Editor, Session } from "./session";
import { type MeshData, Scene3 } from "./scene3";
import { type Wishing, Wishes } from "./wishes";

interface Box {
  style: "main" | "garage" | "porch";
  x: number;
  y: number;
  width: number;
  depth: number;
  height: number;
  floors: number;
}

interface Answer {
  boxes: Box[];
  distance: number;
  volume: number;
}

interface View extends Wishing {
  boxes: Box[];
  locked: boolean[];
  report: { distance: number; donor: string | null; volume: number; unplaced: number } | null;
  scene: MeshData[];
  answers: Answer[];
  chosen: number | null;
}

const GRID = 0.1;
const NEW: Record<Box["style"], [number, number, number]> = { main: [5, 5, 2.9], garage: [4, 6, 2.6], porch: [3, 1.8, 2.6] };
const STYLES: Record<Box["style"], string> = { main: "Main", garage: "Garage", porch: "Porch" };

function rect(b: Box) {
  return { x: b.x - b.width / 2, y: b.y - b.depth / 2, width: b.width, height: b.depth };
}

function hull(boxes: Box[]) {
  const rects = boxes.map(rect);
  const x = Math.min(...rects.map((r) => r.x));
  const y = Math.min(...rects.map((r) => r.y));
  return {
    x,
    y,
    width: Math.max(...rects.map((r) => r.x + r.width)) - x,
    height: Math.max(...rects.map((r) => r.y + r.height)) - y,
  };
}

function thumbnail(boxes: Box[]): SVGSVGElement {
  const b = hull(boxes);
  const m = 1;
  return s(
    "svg",
    { viewBox: `${b.x - m} ${-b.y - b.height - m} ${b.width + 2 * m} ${b.height + 2 * m}`, "aria-hidden": "true" },
    s("g", { transform: "scale(1,-1)" }, ...boxes.map((o) => s("rect", { ...place(rect(o)), class: `box ${o.style}` }))),
  );
}

/** The editor. */
export function house(session: Session<View>): Editor<View> {
  const plan = new Drawing("Plan of the house. Tab to a box, arrow keys move it.", () => session.redraw());
  const view = new Scene3("View of the house; arrow keys turn it");
  const wishes = new Wishes(session as unknown as Session<Wishing>);
  const walking = button("Walk around", () => {
    const on = view.walk(walking.getAttribute("aria-pressed") !== "true");
    walking.setAttribute("aria-pressed", String(on));
  }, { class: "quiet", "aria-pressed": "false", title: "Arrow keys or W, A, S, D walk and turn, a drag looks around" });
  const stage = h(
    "div",
    { class: "stage two" },
    h("figure", {}, h("figcaption", {}, "Plan"), plan.svg as unknown as HTMLElement),
    h("figure", {}, h("figcaption", { class: "row" }, "View", walking), view.element),
  );
  const panel = h("div", {});
  let selected = 0;
  let suggest = false;
  let nudge = 0;

  const edit = (text: string) =>
    session.run(() => [{ do: "edit", edits: [text], suggest, seed: session.seed }]);
  const four = (v: number) => tidy(v, 4);

  function moveTo(index: number, x: number, y: number) {
    void edit(`move ${index}=${four(x)},${four(y)}`);
  }

  function resizeTo(index: number, w: number, d: number, height: number) {
    void edit(`resize ${index}=${four(w)},${four(d)},${four(height)}`);
  }

  function add(style: Box["style"]) {
    const b = hull(session.doc.view.boxes);
    const [w, d, height] = NEW[style];
    // To the right end, at the front: where it touches the house and can be dragged on.
    const y = style === "porch" ? b.y - d / 2 : b.y + d / 2;
    const x = style === "porch" ? b.x + b.width / 2 : b.x + b.width + w / 2;
    void edit(`add ${style}@${four(x)},${four(y)},${w},${d},${height}`);
  }

  function drawBox(b: Box, index: number, locked: boolean): { node: SVGGElement; corner: SVGRectElement } {
    const shape = s("rect", { class: "shape" });
    const corner = s("rect", { class: "handle" });
    const label = s("text", { transform: "scale(1,-1)", "text-anchor": "middle", "dominant-baseline": "central" });
    const now = { ...b };
    const node = s(
      "g",
      {
        class: `box ${b.style}${index === selected ? " selected" : ""}${locked ? " locked" : ""}`,
        "data-box": index,
        tabindex: 0,
        role: "button",
        "aria-pressed": index === selected ? "true" : "false",
        "aria-label": `${STYLES[b.style]} box ${index}, ${tidy(b.width, 1)} × ${tidy(b.depth, 1)} m, ${b.floors} floors${locked ? ", fixed by you" : ""}`,
      },
      shape,
      label,
    );
    const layout = () => {
      const r = rect(now);
      for (const [k, v] of Object.entries(place(r))) shape.setAttribute(k, String(v));
      label.setAttribute("x", String(now.x));
      label.setAttribute("y", String(-now.y));
      const size = 9 * plan.pixel();
      for (const [k, v] of Object.entries({ x: r.x + r.width - size / 2, y: r.y + r.height - size / 2, width: size, height: size }))
        corner.setAttribute(k, String(v));
      label.textContent = index === selected ? `${tidy(now.width, 1)} × ${tidy(now.depth, 1)} m` : "";
    };
    layout();
    node.addEventListener("focus", () => {
      if (selected !== index) {
        selected = index;
        show(session.doc);
        (plan.layer.querySelector(`g.box[data-box="${index}"]`) as SVGGElement | null)?.focus();
      }
    });
    node.addEventListener("keydown", (event) => {
      const by = arrow(event, GRID);
      if (by) {
        event.preventDefault();
        now.x = snap(now.x + by[0], 0.01);
        now.y = snap(now.y + by[1], 0.01);
        layout();
        clearTimeout(nudge);
        nudge = setTimeout(() => moveTo(index, now.x, now.y), 400);
      } else if (event.key === "Delete" || event.key === "Backspace") {
        event.preventDefault();
        void edit(`remove ${index}`);
      }
    });
    plan.draggable(shape, () => {
      node.focus();
      return (dx, dy, done) => {
        now.x = snap(b.x + dx - b.width / 2, GRID) + b.width / 2;
        now.y = snap(b.y + dy - b.depth / 2, GRID) + b.depth / 2;
        layout();
        if (done) moveTo(index, now.x, now.y);
      };
    });
    plan.draggable(corner, () => (dx, dy, done) => {
      // The lower left corner stays.
      now.width = Math.max(0.5, snap(b.width + dx, GRID));
      now.depth = Math.max(0.5, snap(b.depth + dy, GRID));
      now.x = b.x - b.width / 2 + now.width / 2;
      now.y = b.y - b.depth / 2 + now.depth / 2;
      layout();
      if (done) {
        const to = `move ${index}=${four(now.x)},${four(now.y)}`;
        const size = `resize ${index}=${four(now.width)},${four(now.depth)},${four(b.height)}`;
        void session.run(() => [{ do: "edit", edits: [to, size], suggest, seed: session.seed }]);
      }
    });
    return { node, corner };
  }

  function inspector(doc: Doc<View>): HTMLElement {
    const b = doc.view.boxes[selected];
    if (!b) return section("Box", h("p", { class: "hint" }, "Select a box in the plan."));
    const i = selected;
    return section(
      `${STYLES[b.style]} box`,
      h(
        "div",
        { class: "fields" },
        field("x", b.x, (v) => moveTo(i, v, b.y), { "aria-label": "Centre x in metres" }),
        field("y", b.y, (v) => moveTo(i, b.x, v), { "aria-label": "Centre y in metres" }),
        field("Width", b.width, (v) => resizeTo(i, v, b.depth, b.height), { min: 0.5 }),
        field("Depth", b.depth, (v) => resizeTo(i, b.width, v, b.height), { min: 0.5 }),
        field("Height", b.height, (v) => resizeTo(i, b.width, b.depth, v), { min: 1 }),
      ),
      h("div", { class: "row" }, h("span", { class: "hint" }, `${b.floors} ${b.floors === 1 ? "floor" : "floors"}, ${doc.view.locked[i] ? "fixed by you" : "given"}`), button("Remove", () => edit(`remove ${i}`), { class: "quiet", title: "Remove it (Delete, while the plan is in focus)" })),
    );
  }

  function answers(doc: Doc<View>): HTMLElement {
    const list = doc.view.answers.map((a, k) =>
      h(
        "li",
        {},
        h(
          "button",
          {
            type: "button",
            class: "answer",
            "aria-pressed": doc.view.chosen === k + 1 ? "true" : "false",
            onclick: () => session.run(() => [{ do: "choose", answer: k + 1 }]),
          },
          thumbnail(a.boxes) as unknown as HTMLElement,
          h("span", {}, `${k + 1} · ${tidy(a.distance)} sd`),
        ),
      ),
    );
    return section(
      "Other plans",
      h("p", { class: "hint" }, "Houses with the same attributes, nearest first; distance in standard deviations."),
      list.length > 0 ? h("ul", { class: "answers" }, ...list) : null,
      button("Find plans", () => session.run(() => [{ do: "variations", count: 6, seed: session.seed }])),
    );
  }

  function attributes(doc: Doc<View>): HTMLElement {
    const rows = doc.view.columns
      .filter((c) => c.value !== null && (c.value !== 0 || (c.wanted ?? 0) !== 0))
      .map((c) => {
        const off = c.wanted !== null && Math.abs(c.wanted - (c.value ?? 0)) > 0.005;
        return h("tr", {}, h("th", { scope: "row" }, c.name), h("td", {}, tidy(c.value ?? 0)), h("td", { class: "hint" }, off ? `wanted ${tidy(c.wanted ?? 0)}` : ""));
      });
    return h("details", {}, h("summary", {}, "Attributes"), h("table", {}, h("tbody", {}, ...rows)));
  }

  function show(doc: Doc<View>) {
    if (selected >= doc.view.boxes.length) selected = 0;
    const focused = plan.layer.contains(document.activeElement);
    plan.frame(hull(doc.view.boxes), 0.14);
    // Larger boxes below smaller ones, so that each can be reached.
    const order = doc.view.boxes.map((_, k) => k).sort((a, b) => {
      const area = (k: number) => doc.view.boxes[k].width * doc.view.boxes[k].depth;
      return area(b) - area(a);
    });
    const nodes = new Map(order.map((k) => [k, drawBox(doc.view.boxes[k], k, doc.view.locked[k] ?? false)]));
    const b = hull(doc.view.boxes);
    const street = s("line", { class: "street", x1: b.x - b.width, x2: b.x + 2 * b.width, y1: b.y - 0.7, y2: b.y - 0.7 });
    // The handle is on top, whatever lies over its box.
    plan.layer.replaceChildren(street, ...order.map((k) => nodes.get(k)!.node), ...(nodes.get(selected) ? [nodes.get(selected)!.corner] : []));
    if (focused) nodes.get(selected)?.node.focus();
    view.show(doc.view.scene);
    const choose = h("input", { type: "checkbox", checked: suggest });
    choose.addEventListener("change", () => (suggest = choose.checked));
    const r = doc.view.report;
    swap(
      panel,
      section(
        "Add",
        h("div", { class: "row" }, ...(Object.keys(STYLES) as Box["style"][]).map((k) => button(STYLES[k], () => add(k)))),
        h("label", { class: "check" }, choose, h("span", {}, "The model suggests the rest")),
        h("p", { class: "hint" }, suggest ? "Boxes that you touch stay; all others are the model's most probable answer." : "All boxes stay; facades and roofs are laid out anew."),
      ),
      inspector(doc),
      wishes.panel(doc),
      answers(doc),
      r ? h("p", { class: "hint" }, `Facades ${tidy(r.distance)} sd from what was wanted, ${tidy(r.volume, 0)} m³${r.donor ? `, boxes like ${r.donor}` : ""}`) : null,
      attributes(doc),
    );
    choose.addEventListener("change", () => show(session.doc));
  }

  return { stage, panel, show, close: () => view.close() };
}
