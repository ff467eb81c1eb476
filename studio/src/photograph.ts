// A photograph of a facade, made rectangular by its four corners, to draw over. What is outside them stays in this page.

import { button, h } from "./dom";

type Point = [number, number];

/** Longest side of the straightened picture in pixels. */
const LONGEST = 1400;
/** Most letters of its address: a request with it is within what the server takes. */
const MOST = 1_500_000;

/** The projective map that takes the corners of the unit square (0,0), (1,0), (1,1), (0,1) to these four points, as nine numbers
 * row by row (Heckbert 1989, Sec. 2.2.3). */
export function homography([p0, p1, p2, p3]: [Point, Point, Point, Point]): number[] {
  const [dx1, dy1] = [p1[0] - p2[0], p1[1] - p2[1]];
  const [dx2, dy2] = [p3[0] - p2[0], p3[1] - p2[1]];
  const [sx, sy] = [p0[0] - p1[0] + p2[0] - p3[0], p0[1] - p1[1] + p2[1] - p3[1]];
  const det = dx1 * dy2 - dx2 * dy1;
  const g = (sx * dy2 - dx2 * sy) / det;
  const k = (dx1 * sy - sx * dy1) / det;
  return [p1[0] - p0[0] + g * p1[0], p3[0] - p0[0] + k * p3[0], p0[0], p1[1] - p0[1] + g * p1[1], p3[1] - p0[1] + k * p3[1], p0[1], g, k, 1];
}

/** Where the map takes a point. */
export function mapped(m: number[], [u, v]: Point): Point {
  const w = m[6] * u + m[7] * v + m[8];
  return [(m[0] * u + m[1] * v + m[2]) / w, (m[3] * u + m[4] * v + m[5]) / w];
}

/** The picture inside four corners, as a rectangle of these proportions; bilinear. */
function straightened(source: ImageData, corners: [Point, Point, Point, Point], proportion: number): HTMLCanvasElement {
  const width = Math.round(proportion >= 1 ? LONGEST : LONGEST * proportion);
  const height = Math.round(width / proportion);
  const canvas = h("canvas", { width, height });
  const context = canvas.getContext("2d")!;
  const out = context.createImageData(width, height);
  const m = homography(corners);
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      const [sx, sy] = mapped(m, [(x + 0.5) / width, (y + 0.5) / height]);
      const u = Math.min(Math.max(sx - 0.5, 0), source.width - 1.001);
      const v = Math.min(Math.max(sy - 0.5, 0), source.height - 1.001);
      const [i, j] = [Math.floor(u), Math.floor(v)];
      const [a, b] = [u - i, v - j];
      for (let c = 0; c < 4; c++) {
        const at = (dx: number, dy: number) => source.data[4 * ((j + dy) * source.width + i + dx) + c];
        const value = (1 - b) * ((1 - a) * at(0, 0) + a * at(1, 0)) + b * ((1 - a) * at(0, 1) + a * at(1, 1));
        out.data[4 * (y * width + x) + c] = value;
      }
    }
  }
  context.putImageData(out, 0, 0);
  return canvas;
}

/** The picture as an address that holds it, as good as there is room for. */
function address(canvas: HTMLCanvasElement): string {
  let text = "";
  for (const quality of [0.9, 0.75, 0.5, 0.25]) {
    text = canvas.toDataURL("image/jpeg", quality);
    if (text.length <= MOST) break;
  }
  return text;
}

/** Asks for the four corners of the facade in a photograph; the straightened picture as a `data:` address, or none. */
export async function rectified(file: File, proportion: number): Promise<string | null> {
  const bitmap = await createImageBitmap(file);
  const canvas = h("canvas", { width: bitmap.width, height: bitmap.height });
  const context = canvas.getContext("2d", { willReadFrequently: true })!;
  context.drawImage(bitmap, 0, 0);
  const source = context.getImageData(0, 0, bitmap.width, bitmap.height);
  const names = ["upper left", "upper right", "lower right", "lower left"];
  const share: Point[] = [[0.05, 0.05], [0.95, 0.05], [0.95, 0.95], [0.05, 0.95]];
  const corners = share.map(([u, v]): Point => [u * bitmap.width, v * bitmap.height]) as [Point, Point, Point, Point];
  return new Promise((answer) => {
    const dialog = h("dialog", { class: "rectify", "aria-label": "Corners of the facade in the photograph" });
    const picture = h("div", { class: "photograph" }, canvas);
    const draw = () => {
      context.putImageData(source, 0, 0);
      context.lineWidth = Math.max(2, bitmap.width / 300);
      context.strokeStyle = "#d9622b";
      context.beginPath();
      corners.forEach(([x, y], k) => (k === 0 ? context.moveTo(x, y) : context.lineTo(x, y)));
      context.closePath();
      context.stroke();
    };
    const knobs = corners.map((corner, k) => {
      const knob = h("button", { type: "button", class: "knob", "aria-label": `The facade's ${names[k]} corner; arrow keys move it` });
      const put = () => {
        corner[0] = Math.min(Math.max(corner[0], 0), bitmap.width);
        corner[1] = Math.min(Math.max(corner[1], 0), bitmap.height);
        knob.style.left = `${(100 * corner[0]) / bitmap.width}%`;
        knob.style.top = `${(100 * corner[1]) / bitmap.height}%`;
        draw();
      };
      knob.addEventListener("pointerdown", (event) => knob.setPointerCapture(event.pointerId));
      knob.addEventListener("pointermove", (event) => {
        if (!knob.hasPointerCapture(event.pointerId)) return;
        const box = canvas.getBoundingClientRect();
        corner[0] = ((event.clientX - box.left) / box.width) * bitmap.width;
        corner[1] = ((event.clientY - box.top) / box.height) * bitmap.height;
        put();
      });
      knob.addEventListener("keydown", (event) => {
        const by = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
        if (!by) return;
        event.preventDefault();
        const size = ((event.shiftKey ? 10 : 1) * bitmap.width) / 400;
        corner[0] += by[0] * size;
        corner[1] += by[1] * size;
        put();
      });
      put();
      return knob;
    });
    const end = (picture: string | null) => {
      dialog.close();
      dialog.remove();
      answer(picture);
    };
    const straighten = () => end(address(straightened(source, corners, proportion)));
    picture.append(...knobs);
    dialog.addEventListener("cancel", () => end(null));
    dialog.append(
      h("p", { class: "hint" }, "Put the four corners on those of the facade's outline; what is inside becomes its rectangle."),
      picture,
      h("div", { class: "row" }, button("Straighten", straighten, { class: "primary" }), button("Cancel", () => end(null))),
    );
    document.body.append(dialog);
    dialog.showModal();
  });
}
