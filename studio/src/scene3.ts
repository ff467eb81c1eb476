// A view in three dimensions: a house, or the instances of a city.

import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { h } from "./dom";

/** A mesh: corners in millimetres, y up, triangles by material. */
export interface MeshData {
  positions: number[];
  parts: { finish: string; color: [number, number, number]; indices: number[] }[];
}

const dark = matchMedia("(prefers-color-scheme: dark)");

/** A view that is drawn when something changed. */
export class Scene3 {
  readonly element: HTMLElement;
  readonly scene = new THREE.Scene();
  readonly camera = new THREE.PerspectiveCamera(32, 1, 0.5, 20000);
  readonly content = new THREE.Group();
  private renderer: THREE.WebGLRenderer | null = null;
  private controls: OrbitControls | null = null;
  private sun = new THREE.DirectionalLight(0xfff4e2, 2.4);
  private ground: THREE.Mesh;
  private size = 0;
  private asked = 0;
  private watch: ResizeObserver;

  constructor(label: string) {
    const canvas = h("canvas", { tabindex: 0, role: "img", "aria-label": label });
    this.element = h("div", { class: "view" }, canvas);
    this.scene.add(new THREE.HemisphereLight(0xeaf1fa, 0x9a948a, 1.7), this.sun, this.sun.target, this.content);
    this.ground = new THREE.Mesh(new THREE.CircleGeometry(1, 64), new THREE.ShadowMaterial({ opacity: 0.16 }));
    this.ground.rotateX(-Math.PI / 2);
    this.ground.receiveShadow = true;
    this.scene.add(this.ground);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(2048, 2048);
    this.sun.shadow.bias = -0.0004;
    this.sun.shadow.normalBias = 0.03;
    try {
      this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true });
      this.renderer.shadowMap.enabled = true;
      this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
      this.controls = new OrbitControls(this.camera, canvas);
      this.controls.maxPolarAngle = Math.PI / 2 - 0.02;
      this.controls.keyPanSpeed = 20;
      this.controls.addEventListener("change", () => this.draw());
      canvas.addEventListener("keydown", (event) => this.turn(event));
    } catch {
      this.element.replaceChildren(h("p", { class: "hint" }, "This browser draws nothing in three dimensions; the plan works without."));
    }
    this.watch = new ResizeObserver(() => this.resize());
    this.watch.observe(this.element);
  }

  private turn(event: KeyboardEvent) {
    const by: Record<string, [number, number]> = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.06], ArrowDown: [0, 0.06] };
    const turn = by[event.key];
    if (!turn || !this.controls) return;
    event.preventDefault();
    const offset = new THREE.Spherical().setFromVector3(this.camera.position.clone().sub(this.controls.target));
    offset.theta += turn[0];
    offset.phi = Math.min(Math.max(offset.phi + turn[1], 0.1), Math.PI / 2 - 0.02);
    this.camera.position.setFromSpherical(offset).add(this.controls.target);
    this.controls.update();
  }

  private resize() {
    const { clientWidth: w, clientHeight: hh } = this.element;
    if (!this.renderer || w === 0 || hh === 0) return;
    this.renderer.setSize(w, hh, false);
    this.camera.aspect = w / hh;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  /** Draws once, soon. */
  draw() {
    if (!this.renderer || this.asked) return;
    this.asked = requestAnimationFrame(() => {
      this.asked = 0;
      this.renderer?.render(this.scene, this.camera);
    });
  }

  /** Looks at all of the content, the first time and when it has grown or shrunk much. */
  frame(from: [number, number, number], again = false) {
    const box = new THREE.Box3().setFromObject(this.content);
    if (box.isEmpty()) return;
    const ball = box.getBoundingSphere(new THREE.Sphere());
    this.ground.scale.setScalar(ball.radius * 3);
    this.ground.position.set(ball.center.x, box.min.y - 0.01, ball.center.z);
    this.sun.position.copy(ball.center).add(new THREE.Vector3(-0.9, 1.5, 1.1).multiplyScalar(ball.radius * 2));
    this.sun.target.position.copy(ball.center);
    const reach = ball.radius * 1.5;
    Object.assign(this.sun.shadow.camera, { left: -reach, right: reach, top: reach, bottom: -reach, near: 0.1, far: ball.radius * 8 });
    this.sun.shadow.camera.updateProjectionMatrix();
    const ratio = ball.radius / this.size;
    if (!again && ratio > 0.88 && ratio < 1.1) return;
    // From where the user looks at it, once there was something to look at.
    const turned = this.size > 0 && this.controls ? this.camera.position.clone().sub(this.controls.target) : new THREE.Vector3(...from);
    this.size = ball.radius;
    // The narrower side of the picture holds the whole.
    const narrow = Math.min(1, (this.element.clientWidth || 1) / (this.element.clientHeight || 1));
    const distance = (ball.radius / Math.sin((this.camera.fov * Math.PI) / 360) / narrow) * 0.9;
    const away = turned.normalize().multiplyScalar(distance);
    this.camera.position.copy(ball.center).add(away);
    this.camera.near = distance / 100;
    this.camera.far = distance * 10;
    this.camera.updateProjectionMatrix();
    this.controls?.target.copy(ball.center);
    this.controls?.update();
  }

  /** Forgets the content. */
  clear() {
    this.content.traverse((o) => {
      if (o instanceof THREE.Mesh || o instanceof THREE.LineSegments) {
        o.geometry.dispose();
        for (const m of [o.material].flat()) m.dispose();
      }
    });
    this.content.clear();
  }

  /** Shows meshes with the edges of their faces. */
  show(meshes: MeshData[]) {
    this.clear();
    const line = dark.matches ? 0x10151c : 0x3a3f47;
    for (const mesh of meshes) {
      const positions = new THREE.BufferAttribute(Float32Array.from(mesh.positions, (v) => v / 1000), 3);
      for (const part of mesh.parts) {
        const indexed = new THREE.BufferGeometry();
        indexed.setAttribute("position", positions);
        indexed.setIndex(part.indices);
        const geometry = indexed.toNonIndexed();
        geometry.computeVertexNormals();
        const [r, g, b] = part.color;
        const material = new THREE.MeshStandardMaterial({
          color: new THREE.Color().setRGB(r / 255, g / 255, b / 255, THREE.SRGBColorSpace),
          roughness: part.finish === "pane" ? 0.2 : 0.9,
        });
        const solid = new THREE.Mesh(geometry, material);
        solid.castShadow = solid.receiveShadow = true;
        const edges = new THREE.LineSegments(
          new THREE.EdgesGeometry(indexed, 20),
          new THREE.LineBasicMaterial({ color: line, transparent: true, opacity: part.finish === "pane" ? 0.25 : 0.45 }),
        );
        this.content.add(solid, edges);
      }
    }
    this.frame([0.55, 0.42, 1]);
    this.draw();
  }

  close() {
    this.clear();
    this.watch.disconnect();
    this.controls?.dispose();
    this.renderer?.dispose();
  }
}
