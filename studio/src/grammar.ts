// The editor of facades by their grammar: a change to one region changes every region of its rule (Wu et al. 2014, Sec. 5).

import { type Doc, exported, listing } from "./api";
import { button, field, h, s, section, swap, tidy } from "./dom";
import { Drawing, place, type Rect, snap } from "./drawing";
import { layout, type Line, lines, type Rule } from "./rules";
import type { Editor, Session } from "./session";

type Terminal = [string, number, number, number, number, [number, number] | null];
type Inner = [number, number, number, number, number, number];

interface View {
  unit: string;
  width: number;
  height: number;
  terminals: Terminal[];
  nonTerminals: Inner[];
  colors: Record<string, [number, number, number]>;
  rules: Rule[];
  starts: { name: string; width: number; height: number }[];
  start: number;
  seed: number;
  stochastic: boolean;
  size: [number, number] | null;
  cost: number;
  bound: number | null;
}

/** What is selected: a rule, or one part of it; and the region where it was clicked. */
interface Selection {
  rule: number;
  part: number | null;
  region: Rect | null;
}

const four = (v: number) => tidy(v, 4);
const rectOf = ([, , x, y, width, height]: Inner): Rect => ({ x, y, width, height });
const holds = (r: Rect, [x, y]: [number, number]) => x >= r.x && x <= r.x + r.width && y >= r.y && y <= r.y + r.height;

/** The editor. */
export function grammar(session: Session<View>): Editor<View> {
  const drawing = new Drawing("Facade derived from the grammar. Click a region; click again for the region around it.", () => session.redraw());
  const stage = h("div", { class: "stage" }, drawing.svg as unknown as HTMLElement);
  const panel = h("div", {});
  let selection: Selection | null = null;
  let trail: Selection[] = [];
  let size: [number, number] | null = null;
  let clicked: [number, number] | null = null;

  const edit = (...edits: string[]) => session.run(() => [{ do: "edit", edits }]);
  const derive = (to: [number, number] | null, seed = session.doc.view.seed, start = session.doc.view.start) =>
    session.run(() => [{ do: "derive", size: to, seed, start }]);

  /** Selects what is at a point, or what is around it when it is selected already. */
  function pick(at: [number, number]) {
    const { view } = session.doc;
    clicked = at;
    const inner = view.nonTerminals.filter((n) => holds(rectOf(n), at)).sort((a, b) => b[1] - a[1]);
    const terminal = view.terminals.find(([, x, y, width, height]) => holds({ x, y, width, height }, at));
    const next: Selection[] = [];
    if (terminal?.[5]) next.push({ rule: terminal[5][0], part: terminal[5][1], region: inner[0] ? rectOf(inner[0]) : null });
    for (const n of inner) next.push({ rule: n[0], part: null, region: rectOf(n) });
    const same = trail.length === next.length && trail.every((t, k) => t.rule === next[k].rule && t.part === next[k].part);
    const now = same && selection ? trail.findIndex((t) => t.rule === selection!.rule && t.part === selection!.part) : -1;
    trail = next;
    selection = next[(now + 1) % Math.max(next.length, 1)] ?? null;
    show(session.doc);
  }

  /** The borders between the parts of the selected rule, or the columns and rows of its grid, to be dragged. */
  function handles(view: View): SVGElement[] {
    const r = selection?.region;
    const rule = selection && view.rules[selection.rule];
    if (!r || !rule) return [];
    const own = selection!.rule;
    const thick = 7 * drawing.pixel();
    return lines(rule).flatMap((line) => {
      const along = line.axis === "x";
      const { order, scale } = layout(rule, line, along ? r.width : r.height);
      let at = along ? r.x : r.y;
      return order.slice(0, line.sizes.length - 1).map((part, k) => {
        const { size, relative } = line.sizes[part];
        at += size * (relative ? scale : 1);
        const border = s("rect", {
          class: `border ${line.axis}`,
          "data-border": line.names[part],
          ...place(along ? { x: at - thick / 2, y: r.y, width: thick, height: r.height } : { x: r.x, y: at - thick / 2, width: r.width, height: thick }),
        });
        border.append(s("title", {}, `Border between ${line.labels[part]} and ${line.labels[k + 1]}: drag it`));
        drawing.draggable(border, () => (dx, dy, done) => {
          const by = along ? dx : dy;
          border.setAttribute("transform", along ? `translate(${by},0)` : `translate(0,${by})`);
          const command = `border ${own}.${line.names[part]}=${four(by / (relative ? scale : 1))}`;
          if (done) void edit(command);
          else void session.preview([{ do: "edit", edits: [command] }], preview);
        });
        return border;
      });
    });
  }

  /** The right and upper edge, to derive at another size. */
  function edges(view: View): SVGElement[] {
    const t = 8 * drawing.pixel();
    const right = s("rect", { class: "edge x", ...place({ x: view.width, y: 0, width: t, height: view.height }) });
    const upper = s("rect", { class: "edge y", ...place({ x: 0, y: view.height, width: view.width, height: t }) });
    const resize = (dx: number, dy: number, done: boolean) => {
      const own = view.starts[view.start];
      const grid = Math.max(own.width, own.height) / 200;
      const w = Math.max(own.width / 10, snap(view.width + dx, grid));
      const hh = Math.max(own.height / 10, snap(view.height + dy, grid));
      size = done ? null : [w, hh];
      outline();
      if (done) void derive([w, hh]);
      else void session.preview([{ do: "derive", size: [w, hh], seed: view.seed, start: view.start }], preview);
    };
    drawing.draggable(right, () => (dx, _dy, done) => resize(dx, 0, done));
    drawing.draggable(upper, () => (_dx, dy, done) => resize(0, dy, done));
    return [right, upper];
  }

  const ghost = s("rect", { class: "ghost" });
  function outline() {
    ghost.setAttribute("visibility", size ? "visible" : "hidden");
    for (const [k, v] of Object.entries(place({ x: 0, y: 0, width: size?.[0] ?? 0, height: size?.[1] ?? 0 }))) ghost.setAttribute(k, String(v));
  }

  /** The regions of the facade, those of a label in one path; a selection lies over them. */
  function facade(view: View): SVGGElement {
    const paths = new Map<string, string[]>();
    for (const [label, x, y, width, height] of view.terminals) {
      const path = paths.get(label) ?? [];
      if (path.length === 0) paths.set(label, path);
      path.push(`M${x} ${y}h${width}v${height}h${-width}z`);
    }
    const cells = [...paths].map(([label, path]) => {
      const cell = s("path", { d: path.join(""), class: "terminal" }, s("title", {}, label));
      cell.style.fill = material(label, view.colors[label]);
      return cell;
    });
    return s("g", {}, ...cells);
  }

  /** Shows a facade while something is dragged, in the frame of the one before. */
  function preview(view: View) {
    const next = facade(view);
    cells.replaceWith(next);
    cells = next;
    drawn = null;
  }

  /** Materials, whatever the theme of the page. */
  const MATERIALS: [RegExp, string][] = [
    [/^(wall|facade|background)/i, "#e6dccb"],
    [/^(window|glass|pane)/i, "#9dbbd1"],
    [/^(shutter|blind)/i, "#7f9a86"],
    [/^door/i, "#8d6748"],
    [/^(balcony|rail)/i, "#8f8aa6"],
    [/^shop/i, "#7fa58c"],
    [/^(roof|chimney)/i, "#a2644f"],
    [/^(sky)/i, "#cfe0ec"],
    [/^(cornice|sill|molding|ledge|frame|deco|pillar|column|stone|base)/i, "#cbbfa8"],
    [/^(plant|tree|hedge)/i, "#86a172"],
  ];
  const material = (label: string, [r, g, b]: [number, number, number]) =>
    MATERIALS.find(([name]) => name.test(label))?.[1] ?? `color-mix(in srgb, rgb(${r},${g},${b}) 45%, #f4efe6)`;

  let drawn: View | null = null;
  let cells = s("g", {});
  function draw(view: View) {
    if (drawn !== view) {
      drawn = view;
      drawing.frame({ x: 0, y: 0, width: view.width, height: view.height });
      cells = facade(view);
    }
    cells.setAttribute("class", selection ? "cells dim" : "cells");
    const lit: SVGElement[] = [];
    if (selection) {
      for (const n of view.nonTerminals) if (n[0] === selection.rule) lit.push(s("rect", { ...place(rectOf(n)), class: selection.part === null ? "lit" : "lit weak" }));
      if (selection.part !== null)
        for (const [, x, y, width, height, origin] of view.terminals)
          if (origin?.[0] === selection.rule && origin[1] === selection.part) lit.push(s("rect", { ...place({ x, y, width, height }), class: "lit" }));
    }
    outline();
    drawing.layer.replaceChildren(cells, ...lit, ghost, ...edges(view), ...handles(view));
  }

  /** The rule along an axis that is nearest around the selected region, and which of its parts the region lies in. */
  function around(view: View, axis: "x" | "y"): { rule: number; line: Line; part: number } | null {
    const own = selection?.region;
    if (!selection || !own) return null;
    const middle: [number, number] = [own.x + own.width / 2, own.y + own.height / 2];
    const point = clicked ?? middle;
    // Around a region that is selected whole: a copy of it, not of a part of it.
    const same = (r: Rect) => r.x === own.x && r.y === own.y && r.width === own.width && r.height === own.height;
    const depth = view.nonTerminals.find((n) => n[0] === selection!.rule && same(rectOf(n)))?.[1] ?? Infinity;
    const below = selection.part === null ? depth : depth + 1;
    const inner = view.nonTerminals.filter((n) => n[1] < below && holds(rectOf(n), point)).sort((a, b) => b[1] - a[1]);
    for (const n of inner) {
      const r = rectOf(n);
      const rule = view.rules[n[0]];
      const line = lines(rule).find((l) => l.axis === axis);
      if (!line) continue;
      const { order, scale } = layout(rule, line, axis === "x" ? r.width : r.height);
      let at = axis === "x" ? r.x : r.y;
      for (const part of order) {
        const { size, relative } = line.sizes[part];
        at += size * (relative ? scale : 1);
        if (point[axis === "x" ? 0 : 1] < at + 1e-9) return { rule: n[0], line, part };
      }
    }
    return null;
  }

  /** Floors and columns at the selected place: the facade grows and shrinks by their length. */
  function floors(view: View): HTMLElement | null {
    const rows = (["y", "x"] as const).map((axis) => {
      const place = around(view, axis);
      if (!place) return null;
      const { line, part } = place;
      const name = axis === "y" ? "floor" : "column";
      const at = `${place.rule}.${line.names[part]}`;
      const what = line.repeats ? "One period more" : `A copy of ${line.labels[part]}`;
      return h(
        "div",
        { class: "row" },
        button(`Insert ${name}`, () => edit(`grow ${at}`), { title: `${what} in the rule of ${view.rules[place.rule].symbol}; the facade grows` }),
        button(`Remove ${name}`, () => edit(`shrink ${at}`), { disabled: !line.repeats && line.sizes.length < 2 }),
      );
    });
    return rows.some((r) => r) ? h("div", { class: "floors" }, ...rows) : null;
  }

  /** Another facade of this page, or one from a file, explained by the same grammar. */
  async function merge(texts: string[]) {
    if (texts.length > 0) await session.run(() => [{ do: "merge", facades: texts }]);
  }

  function merging(): HTMLElement {
    const file = h("input", { type: "file", accept: ".json", multiple: true, class: "hidden", "aria-label": "Facade files to merge" });
    file.addEventListener("change", async () => merge(await Promise.all([...(file.files ?? [])].map((f) => f.text()))));
    const list = h("div", { class: "row" });
    void session.calmly(async () => {
      const all = await listing();
      const others = all.documents.filter((d) => d.kind === "grammar" && d.mergesIn === session.doc.view.unit && d.id !== session.doc.id);
      list.replaceChildren(
        ...others.map((d) =>
          button(`With ${d.name}`, () => session.calmly(async () => merge([await (await exported(d.id, "facade.json")).text()])), { title: "One grammar of both facades, each as it is shown" }),
        ),
      );
    });
    return section("Joint grammar", h("p", { class: "hint" }, "One grammar of several facades, in which the rules that they share are written once."), list, h("label", { class: "tool file" }, "With files", file));
  }

  function select(rule: number, part: number | null = null) {
    const region = session.doc.view.nonTerminals.find((n) => n[0] === rule);
    selection = { rule, part, region: region ? rectOf(region) : null };
    trail = [];
    clicked = null;
    show(session.doc);
  }

  function text(label: string, value: string, set: (value: string) => void): HTMLInputElement {
    const input = h("input", { type: "text", value, "aria-label": label, spellcheck: "false", list: "symbols" });
    input.addEventListener("change", () => {
      if (input.value !== "" && input.value !== value) set(input.value);
    });
    return input;
  }

  function inspector(view: View): HTMLElement {
    const rule = selection ? view.rules[selection.rule] : undefined;
    if (!selection || !rule) return section("Rule", h("p", { class: "hint" }, "Click a region of the facade: all regions of its rule light up. Click again for the region around it."));
    const r = selection.rule;
    const count = view.nonTerminals.filter((n) => n[0] === r).length;
    const symbols = [...new Set([...view.rules.map((o) => o.symbol), ...view.rules.flatMap((o) => o.parts.map((p) => p.symbol))])].sort();
    const symbol = (k: number) => text(`Symbol of part ${k + 1}`, rule.parts[k].symbol, (v) => edit(`symbol ${r}.${k}=${v}`));
    /** The size of one entry of a line, and what can be done with it. */
    const sized = (line: Line, k: number, word: string) => {
      const at = `${r}.${line.names[k]}`;
      const { size } = line.sizes[k];
      const input = h("input", { type: "number", step: "any", value: tidy(size, 3), "aria-label": `Size of ${word}` });
      input.addEventListener("change", () => edit(`resize ${at}=${Number(input.value)}`));
      const two = rule.operation === "repeat_aba";
      return [
        h("td", {}, input),
        h(
          "td",
          { class: "row" },
          two ? null : button("Copy", () => edit(`insert ${at}=${four(size)}`), { class: "quiet", title: "Insert a copy before this one", "aria-label": `Insert a copy of ${word}` }),
          two || line.sizes.length < 2 ? null : button("✕", () => edit(`remove ${at}`), { class: "quiet", "aria-label": `Remove ${word}` }),
        ),
      ];
    };
    const all = lines(rule);
    const grid = rule.operation === "grid_split";
    const row = (k: number) => h("tr", { class: selection!.part === k ? "selected" : "" }, h("td", {}, symbol(k)), ...sized(all[0], k, `part ${k + 1}`));
    const tables = grid
      ? [
          // The cells as they stand in the facade, the lowest row last.
          h(
            "table",
            { class: "parts cells" },
            h(
              "tbody",
              {},
              ...rule.rows.map((_, j) => rule.rows.length - 1 - j).map((j) => {
                const row = rule.columns.map((_, i) => j * rule.columns.length + i);
                return h("tr", {}, ...row.map((k) => h("td", { class: selection!.part === k ? "selected" : "" }, symbol(k))));
              }),
            ),
          ),
          ...all.map((line) => {
            const each = line.sizes.map((_, k) => h("tr", {}, h("td", {}, line.labels[k]), ...sized(line, k, line.labels[k])));
            return h("table", { class: "parts lines" }, h("tbody", {}, ...(line.axis === "y" ? each.reverse() : each)));
          }),
        ]
      : [h("table", { class: "parts" }, h("tbody", {}, ...rule.parts.map((_, k) => row(k))))];
    const along = rule.axis === "x" ? "left to right" : rule.axis === "y" ? "bottom to top" : "row by row";
    return section(
      `Rule of ${rule.symbol}`,
      h("p", { class: "hint" }, `${rule.operation} ${along}, cost ${tidy(rule.cost)}; ${count} ${count === 1 ? "region" : "regions"}`),
      h("datalist", { id: "symbols" }, ...symbols.map((v) => h("option", { value: v }))),
      ...tables,
      h("div", { class: "row" }, rule.operation === "split" ? button("Turn into a repeat", () => edit(`repeat ${r}`)) : null, rule.weight !== null ? field("Weight", rule.weight, (v) => edit(`weight ${r}=${v}`)) : null),
      floors(view),
    );
  }

  /** Which facade of a joint grammar is shown. */
  function starts(view: View): HTMLElement {
    const choose = h("select", { "aria-label": "Facade of the joint grammar" }, ...view.starts.map((o, k) => h("option", { value: k, selected: k === view.start }, o.name)));
    choose.addEventListener("change", () => derive(null, view.seed, Number(choose.value)));
    return choose;
  }

  const joint = merging();
  function show(doc: Doc<View>) {
    const { view } = doc;
    if (selection && !view.rules[selection.rule]) selection = null;
    if (selection?.region) {
      // The region that was clicked may have moved with the edit.
      const now = view.nonTerminals.filter((n) => n[0] === selection!.rule).map(rectOf);
      const far = (r: Rect) => Math.hypot(r.x - selection!.region!.x, r.y - selection!.region!.y);
      selection.region = now.sort((a, b) => far(a) - far(b))[0] ?? null;
    }
    draw(view);
    const own = view.starts[view.start];
    const proof = view.bound === null ? "" : Math.abs(view.bound - view.cost) < 0.05 ? ", proven least" : `, none costs less than ${tidy(view.bound)}`;
    const rules = view.rules.map((rule, k) =>
      h(
        "li",
        {},
        h("button", { type: "button", class: "rule", "aria-pressed": String(selection?.rule === k), onclick: () => select(k) }, h("b", {}, rule.symbol), h("span", {}, rule.weight === null ? rule.text : `${rule.text}`)),
      ),
    );
    const set = (w: number, hh: number) => derive([w, hh]);
    swap(
      panel,
      inspector(view),
      section("Grammar", h("p", { class: "hint" }, `${view.rules.length} rules, cost ${tidy(view.cost)}${proof}; ${view.terminals.length} terminal regions`), h("ol", { class: "rules" }, ...rules)),
      section(
        `Size (${view.unit})`,
        h("div", { class: "fields" }, field("Width", view.width, (v) => set(v, view.height)), field("Height", view.height, (v) => set(view.width, v))),
        h(
          "div",
          { class: "row" },
          view.size ? button("Back to its own", () => derive(null), { class: "quiet" }) : null,
          view.size ? button("Make it its own", () => edit(`outline ${four(view.width)},${four(view.height)}`), { class: "quiet" }) : null,
          view.stochastic ? button("Draw another", () => derive(view.size, ++session.seed)) : null,
        ),
        h("p", { class: "hint" }, `Its own size is ${tidy(own.width)} × ${tidy(own.height)}. Drag the right or upper edge.`),
        view.starts.length > 1 ? h("label", { class: "field" }, h("span", {}, "Facade"), starts(view)) : null,
      ),
      joint,
    );
  }

  drawing.svg.addEventListener("click", (event) => {
    if (!(event.target as Element).matches(".border, .edge")) pick(drawing.at(event));
  });
  const clear = () => {
    selection = null;
    clicked = null;
    show(session.doc);
  };
  return { stage, panel, show, clear, close: () => {} };
}
