// A photograph of a facade: its four corners are put by hand, and the server makes a rectangle of what they enclose.

import { button, field, h } from "./dom";

type Point = [number, number];

/** Longest side of a picture that is sent, in pixels. */
const LONGEST = 2400;
/** Most letters of its address: a request with it is within what the server takes. */
const MOST = 1_500_000;
/** Height of a facade in metres before another is typed. */
const HEIGHT = 12;

/** The corners of a facade in a picture, clockwise from the upper left one, in its pixels, and the facade's height in metres. */
export interface Placed {
  corners: [Point, Point, Point, Point];
  height: number | null;
}

/** A picture as an address that holds it, as good as there is room for, with its size. */
export async function address(file: Blob): Promise<{ text: string; width: number; height: number }> {
  const bitmap = await createImageBitmap(file);
  const scale = Math.min(1, LONGEST / Math.max(bitmap.width, bitmap.height));
  const [width, height] = [bitmap.width, bitmap.height].map((v) => Math.max(1, Math.round(v * scale)));
  const canvas = h("canvas", { width, height });
  canvas.getContext("2d")!.drawImage(bitmap, 0, 0, width, height);
  let text = "";
  for (const quality of [0.9, 0.75, 0.5, 0.25]) {
    text = canvas.toDataURL("image/jpeg", quality);
    if (text.length <= MOST) break;
  }
  return { text, width, height };
}

/** The picture that a `data:` address holds; the page may fetch nothing but answers of its server. */
export function held(address: string): Blob {
  const [head, text] = address.split(",");
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  return new Blob([bytes], { type: head.slice("data:".length).split(";")[0] });
}

/** Asks for the four corners of the facade in a picture of this size, and for its height where that is not known; null if nothing
 * is to be done. */
export async function corners(source: Blob, [width, height]: Point, outline: "new" | "kept"): Promise<Placed | null> {
  const bitmap = await createImageBitmap(source);
  // Drawn at the size of the screen: a photograph has more pixels than can be drawn while a corner is dragged.
  const shown = Math.min(1, 1600 / Math.max(bitmap.width, bitmap.height));
  const canvas = h("canvas", { width: Math.round(bitmap.width * shown), height: Math.round(bitmap.height * shown) });
  const context = canvas.getContext("2d")!;
  const names = ["upper left", "upper right", "lower right", "lower left"];
  // Shares of the picture's width and height.
  const share: Placed["corners"] = [[0.05, 0.05], [0.95, 0.05], [0.95, 0.95], [0.05, 0.95]];
  let metres = HEIGHT;
  return new Promise((answer) => {
    const dialog = h("dialog", { class: "rectify", "aria-label": "Corners of the facade in the photograph" });
    const picture = h("div", { class: "photograph" }, canvas);
    const draw = () => {
      context.drawImage(bitmap, 0, 0, canvas.width, canvas.height);
      context.lineWidth = Math.max(2, canvas.width / 300);
      context.strokeStyle = "#d9622b";
      context.beginPath();
      share.forEach(([u, v], k) => context[k === 0 ? "moveTo" : "lineTo"](u * canvas.width, v * canvas.height));
      context.closePath();
      context.stroke();
    };
    const knobs = share.map((corner, k) => {
      const knob = h("button", { type: "button", class: "knob", "aria-label": `The facade's ${names[k]} corner; arrow keys move it` });
      const put = () => {
        for (const c of [0, 1]) corner[c] = Math.min(Math.max(corner[c], 0), 1);
        knob.style.left = `${100 * corner[0]}%`;
        knob.style.top = `${100 * corner[1]}%`;
        draw();
      };
      knob.addEventListener("pointerdown", (event) => knob.setPointerCapture(event.pointerId));
      knob.addEventListener("pointermove", (event) => {
        if (!knob.hasPointerCapture(event.pointerId)) return;
        const box = canvas.getBoundingClientRect();
        corner[0] = (event.clientX - box.left) / box.width;
        corner[1] = (event.clientY - box.top) / box.height;
        put();
      });
      knob.addEventListener("keydown", (event) => {
        const by = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
        if (!by) return;
        event.preventDefault();
        const size = (event.shiftKey ? 10 : 1) / 400;
        corner[0] += by[0] * size;
        corner[1] += (by[1] * size * canvas.width) / canvas.height;
        put();
      });
      put();
      return knob;
    });
    const end = (placed: Placed | null) => {
      dialog.close();
      dialog.remove();
      answer(placed);
    };
    const straighten = () => {
      const corners = share.map(([u, v]): Point => [u * width, v * height]) as Placed["corners"];
      end({ corners, height: outline === "new" ? metres : null });
    };
    picture.append(...knobs);
    dialog.addEventListener("cancel", (event) => {
      event.preventDefault();
      end(null);
    });
    dialog.append(
      h(
        "p",
        { class: "hint" },
        "Put the four corners on those of the facade's outline; what is inside becomes its rectangle." +
          (outline === "new" ? " Its proportions follow from the perspective, its scale from the height." : ""),
      ),
      picture,
      h(
        "div",
        { class: "row" },
        outline === "new" ? field("Height in metres", metres, (v) => (metres = Math.max(0.1, v)), { min: 0.1 }) : "",
        button("Straighten", straighten, { class: "primary" }),
        button("Cancel", () => end(null)),
      ),
    );
    document.body.append(dialog);
    dialog.showModal();
  });
}
