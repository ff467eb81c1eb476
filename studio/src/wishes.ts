// What is wished of a house: sliders whose ranges are the model's, and its styles.

import type { Doc } from "./api";
import { button, h, section, tidy } from "./dom";
import type { Session } from "./session";

/** An attribute of a house. */
export interface Column {
  name: string;
  group: string;
  value: number | null;
  wanted: number | null;
  /** Yes or no. */
  flag: boolean;
  low: number;
  high: number;
  wish: number | null;
}

export interface Wishing {
  columns: Column[];
  styles: number[];
  style: number | null;
  keep: boolean;
}

const GROUPS: Record<string, string> = {
  bbox: "Size",
  bcr: "Coverage",
  bdry: "Boundary",
  far: "Floor area ratio",
  arf: "Shares of the floors",
  garage: "Garage",
  porch: "Porches",
  wwr: "Windows in the walls",
  symmetry: "Symmetry",
  alignment: "Alignment",
  roof: "Roofs",
  window: "Windows",
  special: "Special",
};
const WORDS: Record<string, string> = { "bbox.w": "Width (m)", "bbox.d": "Depth (m)", "bbox.h": "Height (m)", bcr: "Coverage", bdry: "Boundary", far: "Floor area ratio" };
/** Groups that are open at first. */
const OPEN = new Set(["bbox", "wwr", "roof"]);

/** What a column is called: without its group, which stands above. */
function word(column: Column): string {
  const own = WORDS[column.name] ?? column.name.slice(column.group.length + 1).replaceAll(".", " ");
  return own === "" ? GROUPS[column.group] : own;
}

/** The wishes of a house; they are kept while the model looks for it, and where it says that two clash. */
export class Wishes {
  private wanted = new Map<string, number>();
  private style: number | null = null;
  private keep = true;
  private opened = new Set(OPEN);
  private seen = -1;

  constructor(private session: Session<Wishing>) {}

  private ask() {
    if (this.wanted.size === 0 && this.style === null) return;
    void this.session.run(() => {
      const flags = new Set(this.session.doc.view.columns.filter((c) => c.flag).map((c) => c.name));
      const given = [...this.wanted].map(([name, v]) => `${name}=${flags.has(name) ? (v > 0.5 ? "yes" : "no") : tidy(v, 4)}`);
      return [{ do: "wish", given, style: this.style, keep: this.keep && this.style === null, seed: this.session.seed }];
    });
  }

  private set(name: string, value: number | null) {
    if (value === null) this.wanted.delete(name);
    else this.wanted.set(name, value);
    this.ask();
  }

  private row(column: Column): HTMLElement {
    const { name, low, high } = column;
    const wish = this.wanted.get(name) ?? null;
    const value = wish ?? column.value ?? low;
    // The message of a contradiction names the columns.
    const clash = wish !== null && this.session.failure.split(/[^a-z0-9.]+/).some((t) => t === name || t === column.group);
    const title = `${GROUPS[column.group]}: ${word(column)}`;
    let control: HTMLElement;
    if (column.flag) {
      const choice = wish === null ? "" : wish > 0.5 ? "yes" : "no";
      const options = [["", `as it is: ${(column.value ?? 0) > 0.5 ? "yes" : "no"}`], ["yes", "yes"], ["no", "no"]];
      const select = h("select", { "aria-label": title }, ...options.map(([v, text]) => h("option", { value: v, selected: v === choice }, text)));
      select.addEventListener("change", () => this.set(name, select.value === "" ? null : select.value === "yes" ? 1 : 0));
      control = select;
    } else {
      const shown = h("output", {}, tidy(value));
      const from = Math.min(low, value);
      const to = Math.max(high, value);
      const slider = h("input", { type: "range", min: from, max: to, step: (to - from) / 200 || 0.01, value, "aria-label": title, "aria-valuetext": tidy(value) });
      slider.addEventListener("input", () => {
        shown.textContent = tidy(Number(slider.value));
        slider.setAttribute("aria-valuetext", shown.textContent);
      });
      slider.addEventListener("change", () => this.set(name, Number(slider.value)));
      control = h("span", { class: "slide" }, slider, shown);
    }
    const free = wish === null ? null : button("✕", () => this.set(name, null), { class: "quiet", "aria-label": `Take back the wish ${title}` });
    return h("div", { class: `wish${wish === null ? "" : " fixed"}${clash ? " clash" : ""}`, "data-column": name }, h("span", {}, word(column)), control, free);
  }

  /** The panel. */
  panel(doc: Doc<Wishing>): HTMLElement {
    const { columns, styles } = doc.view;
    if (this.seen !== doc.revision) {
      this.seen = doc.revision;
      this.wanted = new Map(columns.flatMap((c) => (c.wish === null ? [] : [[c.name, c.wish] as [string, number]])));
      this.style = doc.view.style;
      this.keep = doc.view.keep;
    }
    const style = h(
      "select",
      { "aria-label": "Style of the model" },
      h("option", { value: "", selected: this.style === null }, "any"),
      ...styles.map((p, k) => h("option", { value: String(k + 1), selected: this.style === k + 1 }, `style ${k + 1}, ${tidy(p * 100, 0)} % of houses`)),
    );
    style.addEventListener("change", () => {
      this.style = style.value === "" ? null : Number(style.value);
      this.ask();
    });
    const keep = h("input", { type: "checkbox", checked: this.keep && this.style === null, disabled: this.style !== null });
    keep.addEventListener("change", () => {
      this.keep = keep.checked;
      this.ask();
    });
    const groups = Object.keys(GROUPS).map((group) => {
      const own = columns.filter((c) => c.group === group);
      const wished = own.filter((c) => this.wanted.has(c.name)).length;
      const details = h("details", { open: this.opened.has(group) || wished > 0 }, h("summary", {}, GROUPS[group] + (wished > 0 ? ` · ${wished} fixed` : "")), ...own.map((c) => this.row(c)));
      details.addEventListener("toggle", () => (details.open ? this.opened.add(group) : this.opened.delete(group)));
      return details;
    });
    return section(
      "Wishes",
      h("p", { class: "hint" }, "Sliders reach from what 1 to what 99 of 100 houses of the model have. What you set is fixed; wishes that contradict each other are named and marked."),
      h("label", { class: "field" }, h("span", {}, "Style"), style),
      h("label", { class: "check" }, keep, h("span", {}, "All else stays as it is")),
      h("div", { class: "wishes" }, ...groups),
      this.wanted.size > 0 || this.style !== null
        ? button("Forget the wishes", () => {
            this.wanted.clear();
            this.style = null;
            this.session.failure = "";
            this.session.redraw();
          }, { class: "quiet" })
        : null,
    );
  }
}
