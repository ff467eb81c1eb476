// The editor of cities: choose how much is instanced, pick a building and its siblings, change a template, fill a drawn shape,
// find where one is (Demir et al. 2014).

import * as THREE from "three";
import { type Doc, exported } from "./api";
import { Buildings, type Instance, originalMesh, outline } from "./city3";
import { button, field, h, section, swap, tidy } from "./dom";
import type { Editor, Session } from "./session";
import { Scene3 } from "./scene3";

interface View {
  templates: { symbol: string; positions: number[]; triangles: number[] }[];
  instances: Instance[];
  buildings: string[];
  types: (number | null)[];
  typeNames: string[];
  errors: (number | null)[] | null;
  rules: { rule: number; symbol: string; weight: number; parts: number }[];
  depth: number;
  nonTerminals: number;
  level: number | null;
  original: { buildings: number; triangles: number; file: string } | null;
}

interface Known {
  id: string;
  type: string;
  attributes: Record<string, unknown>;
  path: { rule: number; symbol: string; part: number; parts: number }[];
  siblings: number[];
}

interface Found {
  places: { building: number; id: string; at: [number, number]; cost: number; matched: number[] }[];
}

type Colours = "template" | "type" | "height" | "level" | "error" | "plain";
type Shown = "made" | "original" | "beside" | "blended";
const SHOWN: Record<Shown, string> = { made: "the grammar's city", original: "the original", beside: "side by side", blended: "blended" };
const LEVELS = 8;

/** The editor. */
export function city(session: Session<View>): Editor<View> {
  const view3 = new Scene3("City; arrow keys turn it, a click picks a building, with Shift it is added to the picked ones");
  const buildings = new Buildings(view3);
  const stage = h("div", { class: "stage" }, h("figure", {}, view3.element));
  const panel = h("div", {});
  let beside: Scene3 | null = null;
  let original: THREE.Mesh | null = null;
  let fetched: string | null = null;
  let colours: Colours = "template";
  let mode: Shown = session.doc.view.level === null && session.doc.view.original && session.doc.view.templates.length === 0 ? "original" : "made";
  let picked: number | null = null;
  let known: Known | null = null;
  let set = new Set<number>();
  let places: Found["places"] = [];
  let corners: [number, number][] = [];
  let drawing = false;
  let shown = -1;
  let factors: [number, number, number] = [1, 1, 1.25];
  const line = new THREE.Group();
  view3.scene.add(line);

  const ofBuilding = (view: View, building: number) => view.instances.findIndex((i) => i[1] === building);

  function colour(view: View, index: number): THREE.Color {
    const [template, building, place, depth] = view.instances[index];
    const own = picked === null ? null : view.instances[picked];
    if (building !== null && (set.has(building) || (own && building === own[1]))) return new THREE.Color(0xd9622b);
    const sibling = known && building !== null && known.siblings.includes(building);
    if (sibling || (own && template === own[0])) return new THREE.Color(0xe8b04a);
    const pale = own ? 0.12 : 0.38;
    const turn = (k: number) => new THREE.Color().setHSL((k * 0.618034) % 1, pale, 0.66);
    const scale = (share: number) => new THREE.Color().setHSL(0.6 - 0.6 * Math.min(1, Math.max(0, share)), 0.5, 0.6);
    if (colours === "template") return turn(template);
    if (colours === "type") return turn(building === null ? 0 : (view.types[building] ?? 0) + 1);
    if (colours === "height") return scale(place[5] / 200);
    if (colours === "level") return scale(depth / Math.max(1, view.depth));
    // A third of the volume or more is red.
    if (colours === "error") return scale(3 * ((building === null ? null : view.errors?.[building]) ?? 0));
    return new THREE.Color(0xc9c5bd);
  }

  function paint() {
    const { view } = session.doc;
    buildings.paint((index) => colour(view, index));
  }

  /** The triangles, once they are asked for. */
  async function triangles(): Promise<THREE.Mesh | null> {
    const source = session.doc.view.original?.file ?? null;
    if (source === null) return null;
    if (fetched !== source) {
      fetched = source;
      await session.calmly(async () => {
        original = originalMesh(await (await exported(session.doc.id, "original")).arrayBuffer());
      });
      if (!original) fetched = null;
    }
    return original;
  }

  async function arrange() {
    const { view } = session.doc;
    const mesh = mode === "made" ? null : await triangles();
    original?.removeFromParent();
    const hasMade = view.instances.length > 0;
    view3.content.visible = mode !== "original";
    if (mesh) {
      const material = mesh.material as THREE.MeshLambertMaterial;
      material.transparent = mode === "blended";
      material.opacity = mode === "blended" ? 0.45 : 1;
      if (mode === "beside") {
        beside ??= new Scene3("The original city, turned with the other view");
        beside.content.add(mesh);
      } else view3.scene.add(mesh);
    }
    stage.classList.toggle("two", mode === "beside");
    const figures = [view3, ...(mode === "beside" && beside ? [beside] : [])];
    stage.replaceChildren(...figures.map((v, k) => h("figure", {}, mode === "beside" ? h("figcaption", {}, k === 0 ? "Grammar" : "Original") : null, v.element)));
    if (mesh && (mode === "original" || !hasMade)) {
      view3.content.add(mesh);
      view3.content.visible = true;
      view3.content.children.forEach((o) => (o.visible = o === mesh || mode !== "original"));
    } else view3.content.children.forEach((o) => (o.visible = true));
    // Once the views have their sizes.
    requestAnimationFrame(() => {
      view3.frame([0.5, 0.7, 1], true);
      if (beside && mode === "beside") {
        beside.frame([0.5, 0.7, 1], true);
        beside.follow(view3);
      }
      view3.draw();
    });
  }
  view3.onMove = () => beside && mode === "beside" && beside.follow(view3);

  function drawLine() {
    line.clear();
    if (corners.length > 1) line.add(outline(corners, 0.3));
    view3.draw();
  }

  let down: [number, number] = [0, 0];
  view3.element.addEventListener("pointerdown", (event) => (down = [event.clientX, event.clientY]));
  view3.element.addEventListener("click", (event) => {
    // The end of a turn is no click.
    if (Math.hypot(event.clientX - down[0], event.clientY - down[1]) > 4) return;
    if (drawing) {
      const at = view3.groundAt(event);
      if (at) corners.push([Number(tidy(at.x, 1)), Number(tidy(-at.z, 1))]);
      drawLine();
      show(session.doc);
      return;
    }
    void select(buildings.pick(event), event.shiftKey);
  });

  async function select(instance: number | null, add = false) {
    const { view } = session.doc;
    picked = instance;
    known = null;
    const building = instance === null ? null : view.instances[instance][1];
    if (!add) set = new Set();
    if (building !== null) {
      set.add(building);
      known = await session.ask<Known>({ ask: "building", building });
    }
    show(session.doc);
  }

  /** The next building, or the one before: for the keyboard. */
  function step(by: number) {
    const { view } = session.doc;
    const own = picked === null ? null : view.instances[picked][1];
    const next = own === null ? 0 : (own + by + view.buildings.length) % view.buildings.length;
    const index = ofBuilding(view, next);
    if (index >= 0) void select(index);
  }

  async function locate() {
    const found = await session.ask<Found>({ ask: "locate", buildings: [...set] });
    places = found?.places ?? [];
    show(session.doc);
  }

  function goTo(place: Found["places"][number]) {
    const { view } = session.doc;
    set = new Set(place.matched);
    known = null;
    picked = null;
    view3.lookAt(place.at[0], 0, -place.at[1], 60);
    if (view.instances.length > 0) show(session.doc);
  }

  function inspector(view: View): HTMLElement {
    const search = h("input", { type: "text", "aria-label": "Building by its identifier", placeholder: "identifier", spellcheck: "false" });
    search.addEventListener("change", () => {
      const at = view.buildings.indexOf(search.value.trim());
      if (at >= 0) void select(ofBuilding(view, at));
      else session.note(`There is no building ${search.value}.`);
    });
    const steps = h("div", { class: "row" }, button("Previous", () => step(-1), { "aria-label": "Previous building" }), button("Next", () => step(1), { "aria-label": "Next building" }), search);
    if (picked === null || !view.instances[picked]) return section("Building", h("p", { class: "hint" }, "Click a building: those of its type and template light up. Shift adds it to the picked ones."), steps, locator(view));
    const [template, building, place] = view.instances[picked];
    const symbol = view.templates[template].symbol;
    const siblings = view.instances.filter((i) => i[0] === template).length;
    const error = building === null ? null : (view.errors?.[building] ?? null);
    const put = (k: number) => (v: number) => (factors[k] = Math.max(0.05, v));
    const path = known?.path.map((t) => `${t.symbol} (rule ${t.rule}, part ${t.part + 1} of ${t.parts})`).join(" → ");
    const rows: [string, string][] = [
      ["Id", building === null ? "none" : view.buildings[building]],
      ["Template", symbol],
      ["Of this template", String(siblings)],
      ["Size (m)", place.slice(3, 6).map((v) => tidy(v, 1)).join(" × ")],
      ...(known ? ([["Type", known.type], ["Siblings", String(known.siblings.length)], ["Rules", path ?? ""]] as [string, string][]) : []),
      ...(error === null ? [] : ([["Volume differs by", `${tidy(error * 100, 1)} %`]] as [string, string][])),
    ];
    return section(
      "Building",
      steps,
      h("table", { class: "facts" }, h("tbody", {}, ...rows.map(([k, v]) => h("tr", {}, h("th", { scope: "row" }, k), h("td", {}, v))))),
      h("h3", {}, "Scale the template"),
      h("div", { class: "fields" }, ...["Width", "Depth", "Height"].map((name, k) => field(name, factors[k], put(k), { min: 0.05, step: 0.05 }))),
      button("Scale all of it", () => session.run(() => [{ do: "edit", edits: [`scale ${symbol}=${factors.join(",")}`] }])),
      locator(view),
    );
  }

  function locator(view: View): HTMLElement | null {
    if (set.size === 0 && places.length === 0) return null;
    const items = places.map((p, k) => h("li", {}, button(`${k + 1}: near ${p.id}, cost ${tidy(p.cost, 3)}`, () => goTo(p), { class: "quiet" })));
    const names = [...set].map((b) => view.buildings[b]).slice(0, 10).join(", ");
    return h("div", { class: "locate" }, h("h3", {}, `Picked: ${names || "none"}`), button("Where do I see these?", () => locate(), { disabled: set.size === 0 }), h("ol", {}, ...items));
  }

  /** A square of half the city's extent, as a shape to fill. */
  function quarter(view: View): [number, number][] {
    if (view.instances.length === 0) return [];
    const extent = (k: 0 | 1) => {
      const [low, high] = view.instances.reduce(([l, u], i) => [Math.min(l, i[2][k]), Math.max(u, i[2][k])], [Infinity, -Infinity]);
      return high - low;
    };
    const side = Math.max(60, Math.min(400, 0.5 * Math.min(extent(0), extent(1))));
    return [[0, 0], [side, 0], [side, side], [0, side]];
  }

  function levels(view: View): HTMLElement | null {
    if (!view.original) return h("p", { class: "hint" }, "A grammar without its city: open the city itself (.npz, .obj, .glb, .city.json) to choose a level.");
    const now = view.level ?? 4;
    const said = h("output", {}, view.level === null ? "not chosen" : `${now}`);
    const slider = h("input", { type: "range", min: 0, max: LEVELS, step: 1, value: now, "aria-label": "Level of de-instancing: halvings of the number of components" });
    slider.addEventListener("input", () => (said.textContent = slider.value));
    const choose = () => session.run(() => [{ do: "proceduralize", level: Number(slider.value) }]);
    slider.addEventListener("change", choose);
    const select = h("select", { "aria-label": "What is shown" }, ...(Object.keys(SHOWN) as Shown[]).map((m) => h("option", { value: m, selected: m === mode }, SHOWN[m])));
    select.addEventListener("change", () => {
      mode = select.value as Shown;
      void arrange();
    });
    return h(
      "div",
      {},
      h("div", { class: "wish" }, h("span", {}, "Level"), h("span", { class: "slide" }, slider, said)),
      h("p", { class: "hint" }, "At level 0 each component is its own template; each level halves their number."),
      view.level === null ? button("Make a grammar", choose, { class: "primary" }) : null,
      h("label", { class: "field" }, h("span", {}, "Show"), select),
    );
  }

  function shaper(view: View): HTMLElement {
    const shape = h("textarea", { rows: 3, "aria-label": "Corners of the shape, x,y in metres", spellcheck: "false" });
    const own = corners.length > 0 ? corners : quarter(view);
    shape.value = own.map((p) => p.map((v) => tidy(v, 1)).join(",")).join(" ");
    const fill = () => {
      const polygon = shape.value.trim().split(/\s+/).map((p) => p.split(",").map(Number));
      drawing = false;
      corners = [];
      drawLine();
      void session.run(() => [{ do: "synthesize", polygon, seed: session.seed }]);
    };
    const draw = button(drawing ? "Drawing: click on the ground" : "Draw with the mouse", () => {
      drawing = !drawing;
      if (drawing) corners = [];
      drawLine();
      show(session.doc);
    }, { "aria-pressed": String(drawing) });
    const back = corners.length > 0 ? button("Last corner back", () => {
      corners.pop();
      drawLine();
      show(session.doc);
    }, { class: "quiet" }) : null;
    return section("Fill a shape", h("p", { class: "hint" }, "Corners in metres, clicked or typed; a new city of these buildings grows inside."), h("div", { class: "row" }, draw, back), shape, button("Synthesize", fill));
  }

  function show(doc: Doc<View>) {
    const { view } = doc;
    if (shown !== doc.revision) {
      shown = doc.revision;
      if (picked !== null && picked >= view.instances.length) picked = null;
      known = null;
      places = [];
      set = new Set();
      original?.removeFromParent();
      buildings.build(view);
      if (mode === "original" && view.instances.length > 0 && view.level !== null) mode = "made";
      void arrange();
    }
    paint();
    const all: Colours[] = ["template", "type", "height", "level", ...(view.errors ? (["error"] as Colours[]) : []), "plain"];
    const choose = h("select", { "aria-label": "Colours" }, ...all.map((c) => h("option", { value: c, selected: c === colours }, c)));
    choose.addEventListener("change", () => {
      colours = choose.value as Colours;
      paint();
    });
    const made = view.templates.length > 0;
    const said = made
      ? `${view.buildings.length} buildings, ${view.templates.length} templates, ${view.nonTerminals} non-terminals, depth ${view.depth}`
      : `${view.original?.buildings ?? 0} buildings, ${view.original?.triangles ?? 0} triangles, no grammar yet`;
    swap(
      panel,
      section("City", h("p", { class: "hint" }, said), made ? h("label", { class: "field" }, h("span", {}, "Colours"), choose) : null),
      section("De-instancing", levels(view)),
      made ? inspector(view) : null,
      made ? shaper(view) : null,
    );
  }

  return {
    stage,
    panel,
    show,
    clear: () => {
      picked = null;
      known = null;
      set = new Set();
      show(session.doc);
    },
    close: () => {
      original?.geometry.dispose();
      beside?.close();
      view3.close();
    },
  };
}
