// A drawing in metres or pixels, y up, in which things are selected, dragged and drawn.

import { s } from "./dom";

export interface Rect {
  x: number;
  y: number;
  width: number;
  height: number;
}

/** What a drag does with the place it has come to; `done` when it ends. */
export type Drag = (dx: number, dy: number, done: boolean) => void;

/** The most that a drawing is enlarged. */
const MOST = 40;

/** An SVG drawing whose content is y up. The wheel and the keys + and - enlarge it, the middle button and Shift with the wheel move
 * it, 0 shows all of it again. */
export class Drawing {
  readonly svg: SVGSVGElement;
  readonly layer: SVGGElement;
  /** All that there is to see. */
  private whole: Rect = { x: 0, y: 0, width: 1, height: 1 };
  /** The part that is seen. */
  private box: Rect = this.whole;
  private zoomed: () => void;

  /** `zoomed` is called when another part is seen: handles are as large as before on the screen. */
  constructor(label: string, zoomed: () => void) {
    this.zoomed = zoomed;
    this.layer = s("g", { transform: "scale(1,-1)" });
    const keys = "Plus and minus zoom, 0 shows all.";
    this.svg = s("svg", { role: "group", "aria-label": `${label} ${keys}`, "aria-keyshortcuts": "+ - 0", class: "drawing" }, this.layer);
    this.svg.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    this.svg.addEventListener("keydown", (event) => this.key(event));
    this.svg.addEventListener("pointerdown", (event) => this.grab(event));
  }

  /** Shows this part of the plane, with a margin. Whoever looked at a part of it goes on to do so. */
  frame(box: Rect, margin = 0.06) {
    const m = margin * Math.max(box.width, box.height);
    const scale = this.scale();
    const middle: [number, number] = [this.box.x + this.box.width / 2, this.box.y + this.box.height / 2];
    this.whole = { x: box.x - m, y: box.y - m, width: box.width + 2 * m, height: box.height + 2 * m };
    this.see(scale, middle);
  }

  private scale(): number {
    return this.whole.width / this.box.width;
  }

  /** Shows a part, `scale` times enlarged, about a place; never what lies outside. */
  private see(scale: number, [x, y]: [number, number]) {
    const { whole } = this;
    const [width, height] = [whole.width / scale, whole.height / scale];
    const within = (v: number, low: number, high: number) => Math.min(Math.max(v, low), high);
    this.box = {
      x: within(x - width / 2, whole.x, whole.x + whole.width - width),
      y: within(y - height / 2, whole.y, whole.y + whole.height - height),
      width,
      height,
    };
    const b = this.box;
    this.svg.setAttribute("viewBox", `${b.x} ${-b.y - b.height} ${b.width} ${b.height}`);
    // Lines and letters keep their size whatever the unit of the drawing.
    this.svg.style.setProperty("--unit", String(this.pixel()));
  }

  /** Enlarges by a factor; the place `fixed` stays where it is. */
  private zoom(factor: number, fixed: [number, number]) {
    const before = this.scale();
    const scale = Math.min(Math.max(before * factor, 1), MOST);
    const share = before / scale;
    const { box } = this;
    const middle = [box.x + box.width / 2, box.y + box.height / 2];
    this.see(scale, [0, 1].map((k) => fixed[k] + (middle[k] - fixed[k]) * share) as [number, number]);
    this.zoomed();
  }

  /** Moves by a share of what is seen. */
  private move(right: number, up: number) {
    const { box } = this;
    this.see(this.scale(), [box.x + box.width * (0.5 + right), box.y + box.height * (0.5 + up)]);
    this.zoomed();
  }

  private wheel(event: WheelEvent) {
    // A whole drawing lets the page scroll where it does, and has nothing to move to.
    const out = event.deltaY > 0 && !event.shiftKey;
    if (this.scale() === 1 && (out || event.shiftKey)) return;
    event.preventDefault();
    const pixels = event.deltaMode === 0 ? 1 : 30;
    if (event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY)) {
      this.move(((event.deltaX || event.deltaY) * pixels) / 800, 0);
    } else this.zoom(Math.exp((-event.deltaY * pixels) / 400), this.at(event));
  }

  private key(event: KeyboardEvent) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const middle: [number, number] = [this.box.x + this.box.width / 2, this.box.y + this.box.height / 2];
    if (event.key === "+" || event.key === "=") this.zoom(1.25, middle);
    else if (event.key === "-") this.zoom(0.8, middle);
    else if (event.key === "0") this.zoom(0, middle);
    else return;
    event.preventDefault();
  }

  /** The middle button moves what is seen. */
  private grab(event: PointerEvent) {
    if (event.button !== 1) return;
    event.preventDefault();
    let last = [event.clientX, event.clientY];
    const move = (e: PointerEvent) => {
      const [dx, dy] = [e.clientX - last[0], e.clientY - last[1]];
      last = [e.clientX, e.clientY];
      this.move((-dx * this.pixel()) / this.box.width, (dy * this.pixel()) / this.box.height);
    };
    const up = () => {
      removeEventListener("pointermove", move);
      removeEventListener("pointerup", up);
    };
    addEventListener("pointermove", move);
    addEventListener("pointerup", up);
  }

  /** The length of a pixel. */
  pixel(): number {
    const { clientWidth: w, clientHeight: h } = this.svg;
    return Math.max(this.box.width / (w || 600), this.box.height / (h || 400));
  }

  /** Where an event is, in the drawing's own lengths. */
  at(event: PointerEvent | MouseEvent): [number, number] {
    const matrix = this.layer.getScreenCTM();
    if (!matrix) return [0, 0];
    const p = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix.inverse());
    return [p.x, p.y];
  }

  /** Lets an element be dragged; a press without a move is a click. */
  draggable(node: SVGElement, begin: (event: PointerEvent) => Drag | null) {
    node.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      const drag = begin(event);
      if (!drag) return;
      event.preventDefault();
      event.stopPropagation();
      const [x, y] = this.at(event);
      const start = [event.clientX, event.clientY];
      let moved = false;
      const move = (e: PointerEvent) => {
        moved ||= Math.hypot(e.clientX - start[0], e.clientY - start[1]) > 3;
        const [px, py] = this.at(e);
        if (moved) drag(px - x, py - y, false);
      };
      const up = (e: PointerEvent) => {
        removeEventListener("pointermove", move);
        removeEventListener("pointerup", up);
        const [px, py] = this.at(e);
        if (moved) drag(px - x, py - y, true);
      };
      addEventListener("pointermove", move);
      addEventListener("pointerup", up);
    });
  }
}

/** Attributes of a rectangle. */
export function place(r: Rect): Record<string, number> {
  return { x: r.x, y: r.y, width: Math.max(r.width, 0), height: Math.max(r.height, 0) };
}

/** To the grid of the drawing. */
export function snap(value: number, grid: number): number {
  return Math.round((Math.round(value / grid) * grid) * 1e6) / 1e6;
}

/** Arrow keys as a step. */
export function arrow(event: KeyboardEvent, step: number): [number, number] | null {
  const size = event.shiftKey ? 10 * step : step;
  switch (event.key) {
    case "ArrowLeft":
      return [-size, 0];
    case "ArrowRight":
      return [size, 0];
    case "ArrowUp":
      return [0, size];
    case "ArrowDown":
      return [0, -size];
    default:
      return null;
  }
}
