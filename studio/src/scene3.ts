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
/** Height of the eyes of somebody who walks, length of a step, and room kept before walls (m). */
const EYES = 1.65;
const STEP = 0.4;
const ROOM = 0.35;

/** Whether pictures are computed by the processor: then without shadows and smooth edges, which take most of the time. */
const software = (() => {
  const gl = document.createElement("canvas").getContext("webgl2");
  const info = gl?.getExtension("WEBGL_debug_renderer_info");
  const name = gl && info ? String(gl.getParameter(info.UNMASKED_RENDERER_WEBGL)) : "";
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software/i.test(name);
})();

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
  private plate: THREE.Mesh;
  /** Told when the view was turned, or somebody walked. */
  onMove: () => void = () => {};
  private size = 0;
  private walks = false;
  private asked = 0;
  private watch: ResizeObserver;

  constructor(label: string) {
    const canvas = h("canvas", { tabindex: 0, role: "img", "aria-label": label });
    this.element = h("div", { class: "view" }, canvas);
    this.scene.add(new THREE.HemisphereLight(0xeaf1fa, 0x9a948a, 1.7), this.sun, this.sun.target, this.content);
    this.ground = new THREE.Mesh(new THREE.CircleGeometry(1, 64), new THREE.ShadowMaterial({ opacity: 0.16 }));
    this.ground.rotateX(-Math.PI / 2);
    this.ground.receiveShadow = true;
    // A plate to stand on, which catches the eye less than what stands on it.
    this.plate = new THREE.Mesh(new THREE.CircleGeometry(1, 96), new THREE.MeshBasicMaterial({ color: dark.matches ? 0x2a3037 : 0xefece6 }));
    this.plate.rotateX(-Math.PI / 2);
    this.scene.add(this.plate, this.ground);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(2048, 2048);
    this.sun.shadow.bias = -0.0004;
    this.sun.shadow.normalBias = 0.03;
    try {
      this.renderer = new THREE.WebGLRenderer({ canvas, antialias: !software, alpha: true });
      this.renderer.shadowMap.enabled = !software;
      this.renderer.setPixelRatio(software ? 1 : Math.min(devicePixelRatio, 2));
      this.controls = new OrbitControls(this.camera, canvas);
      this.controls.maxPolarAngle = Math.PI / 2 - 0.02;
      this.controls.keyPanSpeed = 20;
      this.controls.addEventListener("change", () => {
        this.draw();
        this.onMove();
      });
      canvas.addEventListener("keydown", (event) => (this.walks ? this.step(event) : this.turn(event)));
      canvas.addEventListener("pointermove", (event) => {
        if (!this.walks || event.buttons === 0) return;
        this.camera.rotation.y += event.movementX * 0.004;
        this.camera.rotation.x = Math.min(Math.max(this.camera.rotation.x + event.movementY * 0.004, -1.2), 1.2);
        this.draw();
      });
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

  /** Begins or ends a walk on the ground; whether one is on. */
  walk(on: boolean): boolean {
    if (!this.controls) return false;
    this.walks = on;
    this.controls.enabled = !on;
    if (!on) {
      this.size = 0;
      this.camera.rotation.order = "XYZ";
      this.frame([0.55, 0.42, 1]);
      this.draw();
      return false;
    }
    const box = new THREE.Box3().setFromObject(this.content);
    const ball = box.getBoundingSphere(new THREE.Sphere());
    // Before the house, as one comes from the street.
    this.camera.position.set(ball.center.x - 0.3 * ball.radius, this.ground.position.y + EYES, box.max.z + 1.1 * ball.radius);
    this.camera.rotation.order = "YXZ";
    this.camera.rotation.set(0.08, -0.2, 0);
    this.camera.near = 0.1;
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
    this.element.querySelector("canvas")?.focus();
    this.plate.scale.setScalar(40 * ball.radius);
    this.draw();
    return true;
  }

  /** Where somebody who walks stands. */
  place(): [number, number, number] {
    return this.camera.position.toArray();
  }

  private step(event: KeyboardEvent) {
    const key = event.key.toLowerCase();
    const turn = { arrowleft: 0.12, arrowright: -0.12 }[key];
    const ahead = { arrowup: 1, w: 1, arrowdown: -1, s: -1 }[key];
    const aside = { a: -1, d: 1 }[key];
    if (turn === undefined && ahead === undefined && aside === undefined) return;
    event.preventDefault();
    if (turn) this.camera.rotation.y += turn;
    const angle = this.camera.rotation.y;
    const way = new THREE.Vector3(-Math.sin(angle), 0, -Math.cos(angle)).multiplyScalar(ahead ?? 0);
    way.add(new THREE.Vector3(Math.cos(angle), 0, -Math.sin(angle)).multiplyScalar(aside ?? 0));
    if (way.lengthSq() > 0) {
      const ray = new THREE.Raycaster(this.camera.position, way.normalize(), 0, STEP + ROOM);
      const walls = this.content.children.filter((o) => o instanceof THREE.Mesh);
      if (ray.intersectObjects(walls).length === 0) this.camera.position.addScaledVector(way, STEP);
    }
    this.draw();
    this.onMove();
  }

  /** Looks as another view does. */
  follow(other: Scene3) {
    if (!this.controls || !other.controls) return;
    this.camera.position.copy(other.camera.position);
    this.camera.near = other.camera.near;
    this.camera.far = other.camera.far;
    this.camera.updateProjectionMatrix();
    this.controls.target.copy(other.controls.target);
    this.controls.update();
    this.draw();
  }

  /** Looks at a place from where it is now, so near that what has this size fills the view. */
  lookAt(x: number, y: number, z: number, size: number) {
    if (!this.controls) return;
    const away = this.camera.position.clone().sub(this.controls.target).setLength(size * 2.2);
    this.controls.target.set(x, y, z);
    this.camera.position.copy(this.controls.target).add(away);
    this.controls.update();
    this.draw();
  }

  /** Where a ray through a point of the view meets the ground. */
  groundAt(event: MouseEvent): THREE.Vector3 | null {
    const plane = new THREE.Plane(new THREE.Vector3(0, 1, 0), -this.ground.position.y);
    return this.ray(event).ray.intersectPlane(plane, new THREE.Vector3());
  }

  /** The ray through a point of the view. */
  ray(event: MouseEvent): THREE.Raycaster {
    const box = this.element.getBoundingClientRect();
    const at = new THREE.Vector2(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2);
    const ray = new THREE.Raycaster();
    ray.setFromCamera(at, this.camera);
    return ray;
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

  /** How far from a point in this direction the camera stands to hold a box with a margin. */
  private distance(box: THREE.Box3, centre: THREE.Vector3, away: THREE.Vector3): number {
    const right = new THREE.Vector3(0, 1, 0).cross(away).normalize();
    const up = away.clone().cross(right);
    const tangent = Math.tan((this.camera.fov * Math.PI) / 360);
    const aspect = (this.element.clientWidth || 1) / (this.element.clientHeight || 1);
    let far = 0;
    for (let k = 0; k < 8; k++) {
      const side = (bit: number, axis: "x" | "y" | "z") => ((k >> bit) & 1 ? box.max : box.min)[axis];
      const corner = new THREE.Vector3(side(0, "x"), side(1, "y"), side(2, "z")).sub(centre);
      const wide = Math.max(Math.abs(corner.dot(up)), Math.abs(corner.dot(right)) / aspect);
      far = Math.max(far, (1.08 * wide) / tangent + corner.dot(away));
    }
    return far;
  }

  /** Looks at all of the content, the first time and when it has grown or shrunk much. */
  frame(from: [number, number, number], again = false) {
    const box = new THREE.Box3().setFromObject(this.content);
    if (box.isEmpty()) return;
    const ball = box.getBoundingSphere(new THREE.Sphere());
    this.ground.scale.setScalar(ball.radius * 3);
    this.ground.position.set(ball.center.x, box.min.y - 0.01, ball.center.z);
    this.plate.position.set(ball.center.x, box.min.y - 0.004 * ball.radius - 0.02, ball.center.z);
    this.plate.scale.setScalar(this.walks ? 40 * ball.radius : 0.55 * Math.hypot(box.max.x - box.min.x, box.max.z - box.min.z));
    if (this.walks) return;
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
    const away = turned.normalize();
    const distance = this.distance(box, ball.center, away);
    this.camera.position.copy(ball.center).add(away.multiplyScalar(distance));
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
    const faint = dark.matches ? 0x2c3138 : 0x77736c;
    for (const mesh of meshes) {
      const positions = new THREE.BufferAttribute(Float32Array.from(mesh.positions, (v) => v / 1000), 3);
      for (const part of mesh.parts) {
        const indexed = new THREE.BufferGeometry();
        indexed.setAttribute("position", positions);
        indexed.setIndex(part.indices);
        const geometry = indexed.toNonIndexed();
        geometry.computeVertexNormals();
        const [r, g, b] = part.color;
        const colour = new THREE.Color().setRGB(r / 255, g / 255, b / 255, THREE.SRGBColorSpace);
        const material = software
          ? new THREE.MeshLambertMaterial({ color: colour })
          : new THREE.MeshStandardMaterial({ color: colour, roughness: part.finish === "pane" ? 0.2 : 0.9 });
        const solid = new THREE.Mesh(geometry, material);
        solid.castShadow = solid.receiveShadow = true;
        this.content.add(solid);
      }
      // The edges of all parts at once; the processor draws them without mixing colours, and none around panes.
      const outlined = mesh.parts.filter((part) => !software || part.finish !== "pane");
      const whole = new THREE.BufferGeometry();
      whole.setAttribute("position", positions);
      whole.setIndex(outlined.flatMap((part) => part.indices));
      const material = new THREE.LineBasicMaterial({ color: software ? faint : line, transparent: !software, opacity: 0.42 });
      this.content.add(new THREE.LineSegments(new THREE.EdgesGeometry(whole, 20), material));
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
