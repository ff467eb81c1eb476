// A city in three dimensions: templates stand many times, each drawn once; the triangles it was made of beside or over them.

import * as THREE from "three";
import { Scene3 } from "./scene3";

/** Place and size: x, y, z, width, depth, height, turn in degrees. */
export type Place = [number, number, number, number, number, number, number];
/** Template, building, place, rules applied one inside another. */
export type Instance = [number, number | null, Place, number];

/** What is shown. */
export interface Content {
  templates: { symbol: string; positions: number[]; triangles: number[] }[];
  instances: Instance[];
}

/** Instances of templates in a view. */
export class Buildings {
  private meshes: { mesh: THREE.InstancedMesh; members: number[] }[] = [];

  constructor(readonly view: Scene3) {}

  /** Builds what stands. */
  build(content: Content) {
    const { view } = this;
    view.clear();
    const members = content.templates.map(() => [] as number[]);
    content.instances.forEach(([t], k) => members[t].push(k));
    const up = new THREE.Vector3(0, 1, 0);
    this.meshes = content.templates.flatMap((t, k) => {
      if (members[k].length === 0) return [];
      const geometry = new THREE.BufferGeometry();
      // From z up to y up.
      const positions = new Float32Array(t.positions.length);
      for (let i = 0; i < positions.length; i += 3) {
        positions[i] = t.positions[i] / 1000;
        positions[i + 1] = t.positions[i + 2] / 1000;
        positions[i + 2] = -t.positions[i + 1] / 1000;
      }
      geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
      geometry.setIndex(t.triangles);
      const mesh = new THREE.InstancedMesh(geometry, new THREE.MeshLambertMaterial({ flatShading: true, side: THREE.DoubleSide }), members[k].length);
      members[k].forEach((index, i) => {
        const [x, y, z, w, d, hh, turn] = content.instances[index][2];
        const matrix = new THREE.Matrix4().compose(
          new THREE.Vector3(x, z, -y),
          new THREE.Quaternion().setFromAxisAngle(up, (turn * Math.PI) / 180),
          new THREE.Vector3(w, hh, d),
        );
        mesh.setMatrixAt(i, matrix);
      });
      mesh.computeBoundingSphere();
      view.content.add(mesh);
      return [{ mesh, members: members[k] }];
    });
  }

  /** Colours every instance. */
  paint(colour: (index: number) => THREE.Color) {
    for (const { mesh, members } of this.meshes) {
      members.forEach((index, i) => mesh.setColorAt(i, colour(index)));
      if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
    }
    this.view.draw();
  }

  /** The instance under a point of the view. */
  pick(event: MouseEvent): number | null {
    const hit = this.view.ray(event).intersectObjects(this.meshes.map((m) => m.mesh))[0];
    const found = hit && this.meshes.find((m) => m.mesh === hit.object);
    return found && hit.instanceId !== undefined ? found.members[hit.instanceId] : null;
  }
}

/** Triangles as the server packs them: parts of buildings in 16 bits a number. */
export function unpacked(bytes: ArrayBuffer): { positions: Float32Array; indices: Uint32Array } {
  const data = new DataView(bytes);
  let [corners, triangles] = [0, 0];
  const head = 28;
  for (let at = 0; at < bytes.byteLength; ) {
    const [c, t] = [data.getUint32(at + 20, true), data.getUint32(at + 24, true)];
    corners += c;
    triangles += t;
    at += head + 6 * (c + t);
  }
  const positions = new Float32Array(3 * corners);
  const indices = new Uint32Array(3 * triangles);
  let [p, i] = [0, 0];
  for (let at = 0; at < bytes.byteLength; ) {
    const low = [4, 8, 12].map((k) => data.getFloat32(at + k, true));
    const step = data.getFloat32(at + 16, true);
    const [c, t] = [data.getUint32(at + 20, true), data.getUint32(at + 24, true)];
    const first = p / 3;
    at += head;
    for (let k = 0; k < c; k++, at += 6) {
      const [x, y, z] = [0, 1, 2].map((j) => low[j] + step * data.getUint16(at + 2 * j, true));
      positions[p++] = x;
      positions[p++] = z;
      positions[p++] = -y;
    }
    for (let k = 0; k < 3 * t; k++, at += 2) indices[i++] = first + data.getUint16(at, true);
  }
  return { positions, indices };
}

/** The triangles that a city was made of. */
export function originalMesh(bytes: ArrayBuffer): THREE.Mesh {
  const { positions, indices } = unpacked(bytes);
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
  geometry.setIndex(new THREE.BufferAttribute(indices, 1));
  return new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({ color: 0xb9c4d0, flatShading: true, side: THREE.DoubleSide }));
}

/** The line of a shape that is drawn on the ground. */
export function outline(corners: [number, number][], ground: number): THREE.LineSegments {
  const points = corners.flatMap(([x, y], k) => {
    const [u, v] = corners[(k + 1) % corners.length];
    return [x, ground, -y, u, ground, -v];
  });
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(points, 3));
  const line = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: 0xd9622b, depthTest: false }));
  line.renderOrder = 1;
  return line;
}
