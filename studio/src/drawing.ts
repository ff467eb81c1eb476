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

/** An SVG drawing whose content is y up. */
export class Drawing {
  readonly svg: SVGSVGElement;
  readonly layer: SVGGElement;
  private box: Rect = { x: 0, y: 0, width: 1, height: 1 };

  constructor(label: string) {
    this.layer = s("g", { transform: "scale(1,-1)" });
    this.svg = s("svg", { role: "group", "aria-label": label, class: "drawing" }, this.layer);
  }

  /** Shows this part of the plane, with a margin. */
  frame(box: Rect, margin = 0.06) {
    const m = margin * Math.max(box.width, box.height);
    this.box = { x: box.x - m, y: box.y - m, width: box.width + 2 * m, height: box.height + 2 * m };
    const b = this.box;
    this.svg.setAttribute("viewBox", `${b.x} ${-b.y - b.height} ${b.width} ${b.height}`);
    // Lines and letters keep their size whatever the unit of the drawing.
    this.svg.style.setProperty("--unit", String(this.pixel()));
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
