// The editor of cities: pick a building and its siblings, change a template, fill a drawn shape (Demir et al. 2014).

import * as THREE from "three";
import type { Doc } from "./api";
import { button, field, h, section, swap, tidy } from "./dom";
import type { Editor, Session } from "./session";
import { Scene3 } from "./scene3";

/** Place and size: x, y, z, width, depth, height, turn in degrees. */
type Place = [number, number, number, number, number, number, number];

interface View {
  templates: { symbol: string; positions: number[]; triangles: number[] }[];
  instances: [number, number | null, Place][];
  buildings: string[];
  rules: { rule: number; symbol: string; weight: number; parts: number }[];
  depth: number;
  nonTerminals: number;
}

type Colours = "template" | "height" | "plain";

/** The editor. */
export function city(session: Session<View>): Editor<View> {
  const view3 = new Scene3("City; arrow keys turn it, a click picks a building");
  const stage = h("div", { class: "stage" }, view3.element);
  const panel = h("div", {});
  let colours: Colours = "template";
  let picked: number | null = null;
  let meshes: { mesh: THREE.InstancedMesh; members: number[] }[] = [];
  let shown = -1;
  let factors: [number, number, number] = [1, 1, 1.25];

  function colour(view: View, index: number): THREE.Color {
    const [template, building, place] = view.instances[index];
    const own = picked === null ? null : view.instances[picked];
    if (own && building !== null && building === own[1]) return new THREE.Color(0xd9622b);
    if (own && template === own[0]) return new THREE.Color(0xe8b04a);
    if (colours === "template") return new THREE.Color().setHSL((template * 0.618034) % 1, own ? 0.12 : 0.38, 0.66);
    if (colours === "height") return new THREE.Color().setHSL(0.6 - 0.6 * Math.min(1, place[5] / 200), 0.5, 0.6);
    return new THREE.Color(0xc9c5bd);
  }

  function build(view: View) {
    view3.clear();
    const members = view.templates.map(() => [] as number[]);
    view.instances.forEach(([t], k) => members[t].push(k));
    const up = new THREE.Vector3(0, 1, 0);
    meshes = view.templates.flatMap((t, k) => {
      if (members[k].length === 0) return [];
      const indexed = new THREE.BufferGeometry();
      // From z up to y up.
      const positions = new Float32Array(t.positions.length);
      for (let i = 0; i < positions.length; i += 3) {
        positions[i] = t.positions[i] / 1000;
        positions[i + 1] = t.positions[i + 2] / 1000;
        positions[i + 2] = -t.positions[i + 1] / 1000;
      }
      indexed.setAttribute("position", new THREE.BufferAttribute(positions, 3));
      indexed.setIndex(t.triangles);
      const geometry = indexed.toNonIndexed();
      geometry.computeVertexNormals();
      const mesh = new THREE.InstancedMesh(geometry, new THREE.MeshStandardMaterial({ roughness: 0.95, side: THREE.DoubleSide }), members[k].length);
      members[k].forEach((index, i) => {
        const [x, y, z, w, d, hh, turn] = view.instances[index][2];
        const matrix = new THREE.Matrix4().compose(
          new THREE.Vector3(x, z, -y),
          new THREE.Quaternion().setFromAxisAngle(up, (turn * Math.PI) / 180),
          new THREE.Vector3(w, hh, d),
        );
        mesh.setMatrixAt(i, matrix);
      });
      mesh.computeBoundingSphere();
      view3.content.add(mesh);
      return [{ mesh, members: members[k] }];
    });
    view3.frame([0.5, 0.7, 1]);
  }

  function paint(view: View) {
    for (const { mesh, members } of meshes) {
      members.forEach((index, i) => mesh.setColorAt(i, colour(view, index)));
      if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
    }
    view3.draw();
  }

  view3.element.addEventListener("click", (event) => {
    const box = view3.element.getBoundingClientRect();
    const at = new THREE.Vector2(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2);
    const ray = new THREE.Raycaster();
    ray.setFromCamera(at, view3.camera);
    const hit = ray.intersectObjects(meshes.map((m) => m.mesh))[0];
    const found = hit && meshes.find((m) => m.mesh === hit.object);
    select(found && hit.instanceId !== undefined ? found.members[hit.instanceId] : null);
  });

  function select(instance: number | null) {
    picked = instance;
    show(session.doc);
  }

  function inspector(view: View): HTMLElement {
    if (picked === null || !view.instances[picked]) return section("Building", h("p", { class: "hint" }, "Click a building: those of its template light up."));
    const [template, building, place] = view.instances[picked];
    const symbol = view.templates[template].symbol;
    const siblings = view.instances.filter((i) => i[0] === template).length;
    const set = (k: number) => (v: number) => (factors[k] = Math.max(0.05, v));
    return section(
      "Building",
      h(
        "table",
        {},
        h(
          "tbody",
          {},
          ...[
            ["Id", building === null ? "none" : view.buildings[building]],
            ["Template", symbol],
            ["Of this template", String(siblings)],
            ["Size (m)", place.slice(3, 6).map((v) => tidy(v, 1)).join(" × ")],
          ].map(([k, v]) => h("tr", {}, h("th", { scope: "row" }, k), h("td", {}, v))),
        ),
      ),
      h("h3", {}, "Scale the template"),
      h("div", { class: "fields" }, ...["Width", "Depth", "Height"].map((name, k) => field(name, factors[k], set(k), { min: 0.05, step: 0.05 }))),
      button("Scale all of it", () => session.run(() => [{ do: "edit", edits: [`scale ${symbol}=${factors.join(",")}`] }])),
    );
  }

  /** A square of this share of the city's extent, as a shape to fill. */
  function quarter(view: View): [number, number][] {
    const xs = view.instances.map((i) => i[2][0]);
    const ys = view.instances.map((i) => i[2][1]);
    const side = Math.max(60, Math.min(400, 0.5 * Math.min(Math.max(...xs) - Math.min(...xs), Math.max(...ys) - Math.min(...ys))));
    return [
      [0, 0],
      [side, 0],
      [side, side],
      [0, side],
    ];
  }

  function show(doc: Doc<View>) {
    const { view } = doc;
    if (shown !== doc.revision) {
      shown = doc.revision;
      if (picked !== null && picked >= view.instances.length) picked = null;
      build(view);
    }
    paint(view);
    const choose = h("select", { "aria-label": "Colours" }, ...(["template", "height", "plain"] as Colours[]).map((c) => h("option", { value: c, selected: c === colours }, c)));
    choose.addEventListener("change", () => {
      colours = choose.value as Colours;
      paint(view);
    });
    const shape = h("textarea", { rows: 3, "aria-label": "Corners of the shape, x,y in metres", spellcheck: "false" });
    shape.value = quarter(view).map((p) => p.map((v) => tidy(v, 1)).join(",")).join(" ");
    const fill = () => {
      const polygon = shape.value.trim().split(/\s+/).map((p) => p.split(",").map(Number));
      void session.run(() => [{ do: "synthesize", polygon, seed: session.seed }]);
    };
    swap(
      panel,
      section(
        "City",
        h("p", { class: "hint" }, `${view.buildings.length} buildings, ${view.templates.length} templates, ${view.nonTerminals} non-terminals, depth ${view.depth}`),
        h("label", { class: "field" }, h("span", {}, "Colours"), choose),
      ),
      inspector(view),
      section("Fill a shape", h("p", { class: "hint" }, "Corners in metres; a new city of these buildings grows inside."), shape, button("Synthesize", fill)),
    );
  }

  return { stage, panel, show, close: () => view3.close() };
}
