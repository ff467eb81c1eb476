// The page of 3DTilesRendererJS: draws a tileset from above at 45 degrees and measures what was drawn, vertex by vertex.

import * as THREE from "three";
import { MeshoptDecoder } from "three/examples/jsm/libs/meshopt_decoder.module.js";
import { TilesRenderer } from "3d-tiles-renderer/three";
import { GLTFExtensionsPlugin } from "3d-tiles-renderer/three/plugins";

/** Metres from the middle of the earth from which on a tileset stands on it. */
const EARTH = 6.2e6;

/** How a point of the tileset is measured against a bounding volume: three numbers of a point, and their least and greatest values. */
function ruler(tiles, volume, transform) {
  if (volume.region) {
    // Longitude and latitude as metres at the equator.
    const [west, south, east, north, bottom, top] = volume.region;
    const radius = 6.378e6;
    const place = {};
    return {
      measure(p, out) {
        tiles.ellipsoid.getPositionToCartographic(p, place);
        out[0] = place.lon * radius;
        out[1] = place.lat * radius;
        out[2] = place.height;
      },
      low: [west * radius, south * radius, bottom],
      high: [east * radius, north * radius, top],
    };
  }
  if (!volume.box) throw new Error(`a bounding volume is neither box nor region: ${Object.keys(volume)}`);
  const back = transform.clone().invert();
  const centre = new THREE.Vector3().fromArray(volume.box);
  const axes = [3, 6, 9].map((k) => new THREE.Vector3().fromArray(volume.box, k));
  const half = axes.map((a) => a.length());
  axes.forEach((a) => a.normalize());
  const q = new THREE.Vector3();
  return {
    measure(p, out) {
      q.copy(p).applyMatrix4(back).sub(centre);
      for (let k = 0; k < 3; k++) out[k] = q.dot(axes[k]);
    },
    low: half.map((h) => -h),
    high: half,
  };
}

/** Every vertex that is drawn below an object, once for each instance. */
function eachVertex(object, visit) {
  const q = new THREE.Vector3();
  const matrix = new THREE.Matrix4();
  object.traverse((mesh) => {
    if (!mesh.isMesh) return;
    const position = mesh.geometry.attributes.position;
    const points = Array.from({ length: position.count }, (_, k) => new THREE.Vector3().fromBufferAttribute(position, k));
    for (let i = 0; i < (mesh.isInstancedMesh ? mesh.count : 1); i++) {
      if (mesh.isInstancedMesh) mesh.getMatrixAt(i, matrix);
      else matrix.identity();
      matrix.premultiply(mesh.matrixWorld);
      for (const p of points) visit(q.copy(p).applyMatrix4(matrix));
    }
  });
}

const renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
renderer.setSize(innerWidth, innerHeight);
document.body.append(renderer.domElement);
const scene = new THREE.Scene();
scene.background = new THREE.Color(globalThis.BACKGROUND);
const sun = new THREE.DirectionalLight(0xffffff, 2);
scene.add(new THREE.AmbientLight(0xffffff, 1), sun, sun.target);
const camera = new THREE.PerspectiveCamera(45, innerWidth / innerHeight);
let tiles;

/** Turns camera and sun to a sphere. Upwards is z, or, where the tileset stands on the earth, away from the ellipsoid. */
function face(sphere) {
  const onEarth = sphere.center.length() > EARTH;
  const up = onEarth ? tiles.ellipsoid.getPositionToNormal(sphere.center, new THREE.Vector3()) : new THREE.Vector3(0, 0, 1);
  const east = onEarth ? new THREE.Vector3(0, 0, 1).cross(up).normalize() : new THREE.Vector3(1, 0, 0);
  const south = east.clone().cross(up);
  const distance = sphere.radius / Math.sin(Math.PI / 8);
  camera.up.copy(up);
  camera.position.copy(sphere.center).addScaledVector(up.clone().add(south), distance * Math.SQRT1_2);
  camera.lookAt(sphere.center);
  camera.near = distance / 100;
  camera.far = distance * 100;
  camera.updateProjectionMatrix();
  camera.updateMatrixWorld();
  sun.target.position.copy(sphere.center);
  sun.position.copy(sphere.center).addScaledVector(up, 3).addScaledVector(south, 1).addScaledVector(east, -2);
}

function draw() {
  scene.updateMatrixWorld(true);
  renderer.render(scene, camera);
}

/**
 * Share of the drawn pixels at which the nearest surface turns its back, and so is left out: a viewer looks through it into the
 * building. None where surfaces are closed and face outwards, and none where a material has two sides.
 */
function backs() {
  const paint = (colour) => {
    const material = new THREE.MeshBasicMaterial({ side: THREE.DoubleSide });
    material.onBeforeCompile = (shader) => {
      shader.fragmentShader = shader.fragmentShader.replace("#include <dithering_fragment>", `gl_FragColor = ${colour};`);
    };
    material.customProgramCacheKey = () => colour;
    return material;
  };
  const front = "vec4(0.0, 1.0, 0.0, 1.0)";
  const [both, one] = [paint(front), paint(`gl_FrontFacing ? ${front} : vec4(1.0, 0.0, 0.0, 1.0)`)];
  const own = new Map();
  tiles.group.traverse((mesh) => mesh.isMesh && own.set(mesh, mesh.material));
  for (const [mesh, material] of own) mesh.material = material.side === THREE.DoubleSide ? both : one;
  draw();
  for (const [mesh, material] of own) mesh.material = material;
  const gl = renderer.getContext();
  const pixels = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
  gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  let [fronts, behind] = [0, 0];
  for (let i = 0; i < pixels.length; i += 4) {
    if (pixels[i + 2] !== 0) continue;
    if (pixels[i] === 0) fronts += 1;
    else if (pixels[i + 1] === 0) behind += 1;
  }
  return behind / Math.max(fronts + behind, 1);
}

/** Loads and draws the tileset; what was drawn, in numbers. */
globalThis.check = async (url, deadline) => {
  const failed = [];
  tiles = new TilesRenderer(url);
  tiles.registerPlugin(new GLTFExtensionsPlugin({ meshoptDecoder: MeshoptDecoder }));
  tiles.addEventListener("load-error", (e) => failed.push(`${e.url}: ${e.error?.message ?? e.error}`));
  tiles.errorTarget = 0.01;
  tiles.lruCache.maxBytesSize = Infinity;
  tiles.lruCache.minBytesSize = Infinity;
  tiles.setCamera(camera);
  tiles.setResolutionFromRenderer(camera, renderer);
  scene.add(tiles.group);

  const sphere = new THREE.Sphere();
  const end = Date.now() + deadline;
  let [quiet, faced] = [0, false];
  while (quiet < 5) {
    if (Date.now() > end) throw new Error(`not everything was loaded in ${deadline / 1000} s`);
    if (tiles.root && !faced && tiles.getBoundingSphere(sphere)) {
      face(sphere);
      faced = true;
    }
    tiles.update();
    const { queued, downloading, parsing } = tiles.stats;
    quiet = failed.length > 0 || (faced && queued + downloading + parsing === 0) ? quiet + 1 : 0;
    await new Promise((done) => setTimeout(done, 20));
  }
  if (!faced) throw new Error(failed.join("; "));
  draw();

  const numbers = { tiles: 0, instances: 0, triangles: 0, failed, outside: [], sphere: [...sphere.center.toArray(), sphere.radius] };
  const root = tiles.root;
  const whole = ruler(tiles, root.boundingVolume, root.engineData.transform);
  const [low, high, at] = [[1, 1, 1].map(() => Infinity), [1, 1, 1].map(() => -Infinity), [0, 0, 0]];
  const middle = sphere.center.clone();
  let nearest = Infinity;
  for (const tile of tiles.activeTiles) {
    const drawn = tile.engineData.scene;
    if (!drawn) continue;
    numbers.tiles += 1;
    drawn.traverse((mesh) => {
      if (!mesh.isMesh) return;
      const count = mesh.isInstancedMesh ? mesh.count : 1;
      numbers.instances += count;
      numbers.triangles += (count * (mesh.geometry.index ?? mesh.geometry.attributes.position).count) / 3;
    });
    // A viewer leaves out a tile whose volume is out of sight: what a tile draws must be within its own.
    const own = ruler(tiles, tile.boundingVolume, tile.engineData.transform);
    let beyond = 0;
    eachVertex(drawn, (p) => {
      own.measure(p, at);
      for (let k = 0; k < 3; k++) beyond = Math.max(beyond, own.low[k] - at[k], at[k] - own.high[k]);
      whole.measure(p, at);
      for (let k = 0; k < 3; k++) {
        low[k] = Math.min(low[k], at[k]);
        high[k] = Math.max(high[k], at[k]);
      }
      const distance = p.distanceToSquared(sphere.center);
      if (distance < nearest) {
        nearest = distance;
        middle.copy(p);
      }
    });
    numbers.outside.push([tile.content.uri, beyond]);
  }
  return { ...numbers, middle: middle.toArray(), region: "region" in root.boundingVolume, drawn: [low, high], volume: [whole.low, whole.high] };
};

/** Draws the loaded tileset as seen from nearer; the share of backs. */
globalThis.approach = ([x, y, z, radius]) => {
  face(new THREE.Sphere(new THREE.Vector3(x, y, z), radius));
  tiles.update();
  const share = backs();
  draw();
  return share;
};
