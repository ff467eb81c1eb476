// Draco on the meshes of a plain binary glTF (float positions, 32- or 16-bit indices, nothing else).
//
// usage: node city.cjs IN.glb OUT BITS,BITS,...
// For each number of bits: writes OUT-BITS.obj, what the compressed file decodes to, and prints bits, bytes of the
// compressed glTF, name of the OBJ. Connected parts are objects of their own; they are told apart before quantization moves
// corners of neighbours together.
const fs = require("fs");
const zlib = require("zlib");
const draco = require("draco3dgltf");

const [input, output, list] = process.argv.slice(2);
const file = fs.readFileSync(input);
const size = file.readUInt32LE(12);
const json = JSON.parse(file.subarray(20, 20 + size));
const binary = file.subarray(28 + size);

function values(accessor) {
  const a = json.accessors[accessor];
  const view = json.bufferViews[a.bufferView];
  const start = (view.byteOffset || 0) + (a.byteOffset || 0);
  const width = { SCALAR: 1, VEC2: 2, VEC3: 3 }[a.type];
  const stride = view.byteStride || width * { 5126: 4, 5125: 4, 5123: 2, 5121: 1 }[a.componentType];
  const read = { 5126: "readFloatLE", 5125: "readUInt32LE", 5123: "readUInt16LE", 5121: "readUInt8" }[a.componentType];
  const step = { 5126: 4, 5125: 4, 5123: 2, 5121: 1 }[a.componentType];
  const out = a.componentType === 5126 ? new Float32Array(a.count * width) : new Uint32Array(a.count * width);
  for (let i = 0; i < a.count; i++) for (let k = 0; k < width; k++) out[i * width + k] = binary[read](start + i * stride + k * step);
  return out;
}

function matrixOf(node) {
  const s = node.scale || [1, 1, 1];
  const t = node.translation || [0, 0, 0];
  if (node.matrix || node.rotation) throw new Error("only translation and scale are expected");
  return (p) => [p[0] * s[0] + t[0], p[1] * s[1] + t[1], p[2] * s[2] + t[2]];
}

const meshes = [];
for (const node of json.nodes) {
  if (node.mesh === undefined) continue;
  const place = matrixOf(node);
  for (const p of json.meshes[node.mesh].primitives) {
    const raw = values(p.attributes.POSITION);
    const indices = p.indices === undefined ? Uint32Array.from({ length: raw.length / 3 }, (_, i) => i) : values(p.indices);
    const positions = new Float32Array(raw.length);
    for (let i = 0; i < raw.length; i += 3) positions.set(place([raw[i], raw[i + 1], raw[i + 2]]), i);
    meshes.push({ name: node.name || "", positions, indices });
  }
}

/** Corners at one place are one corner. */
function welded({ name, positions, indices }) {
  const known = new Map();
  const points = [];
  const number = new Uint32Array(positions.length / 3);
  for (let i = 0; i < number.length; i++) {
    const key = `${positions[3 * i]},${positions[3 * i + 1]},${positions[3 * i + 2]}`;
    if (!known.has(key)) {
      known.set(key, points.length / 3);
      points.push(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]);
    }
    number[i] = known.get(key);
  }
  const faces = [];
  for (let i = 0; i < indices.length; i += 3) {
    const [a, b, c] = [number[indices[i]], number[indices[i + 1]], number[indices[i + 2]]];
    if (a !== b && b !== c && c !== a) faces.push(a, b, c);
  }
  return { name, positions: Float32Array.from(points), indices: Uint32Array.from(faces) };
}

/** The connected part of each corner. */
function parts({ positions, indices }) {
  const parent = Uint32Array.from({ length: positions.length / 3 }, (_, i) => i);
  const root = (i) => {
    while (parent[i] !== i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (let i = 0; i < indices.length; i += 3) {
    parent[root(indices[i])] = root(indices[i + 1]);
    parent[root(indices[i + 1])] = root(indices[i + 2]);
  }
  return Uint32Array.from(parent, (_, i) => root(i));
}

/** Where Draco's quantization moves corners to: a cube around the mesh, 2^bits - 1 steps. */
function quantized({ positions }, bits) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  positions.forEach((v, i) => {
    low[i % 3] = Math.min(low[i % 3], v);
    high[i % 3] = Math.max(high[i % 3], v);
  });
  const range = Math.max(...[0, 1, 2].map((k) => high[k] - low[k])) || 1;
  const steps = 2 ** bits - 1;
  return positions.map((v, i) => low[i % 3] + (Math.floor(((v - low[i % 3]) / range) * steps + 0.5) * range) / steps);
}

(async () => {
  const module = await draco.createEncoderModule();
  const ready = meshes.map(welded).filter((m) => m.indices.length > 0);
  const all = ready.map(parts);
  for (const bits of list.split(",").map(Number)) {
    let bytes = 0;
    const views = [];
    for (const m of ready) {
      const encoder = new module.Encoder();
      const builder = new module.MeshBuilder();
      const mesh = new module.Mesh();
      builder.AddFacesToMesh(mesh, m.indices.length / 3, m.indices);
      builder.AddFloatAttributeToMesh(mesh, module.POSITION, m.positions.length / 3, 3, m.positions);
      encoder.SetSpeedOptions(0, 0);
      encoder.SetEncodingMethod(module.MESH_EDGEBREAKER_ENCODING);
      encoder.SetAttributeQuantization(module.POSITION, bits);
      const out = new module.DracoInt8Array();
      const length = encoder.EncodeMeshToDracoBuffer(mesh, out);
      if (length <= 0) throw new Error(`Draco cannot encode ${m.name}`);
      bytes += length;
      views.push(length);
      for (const object of [out, mesh, builder, encoder]) module.destroy(object);
    }
    // The JSON of the glTF around them counts as well, gzipped: names, accessors, views.
    const document = {
      asset: { version: "2.0" }, extensionsUsed: ["KHR_draco_mesh_compression"], extensionsRequired: ["KHR_draco_mesh_compression"],
      scene: 0, scenes: [{ nodes: ready.map((_, i) => i) }], nodes: ready.map((m, i) => ({ mesh: i, ...(ready.length > 1 ? { name: m.name } : {}) })),
      meshes: ready.map((_, i) => ({ primitives: [{ attributes: { POSITION: 2 * i }, indices: 2 * i + 1,
        extensions: { KHR_draco_mesh_compression: { bufferView: i, attributes: { POSITION: 0 } } } }] })),
      accessors: ready.flatMap((m) => [{ componentType: 5126, count: m.positions.length / 3, type: "VEC3" },
        { componentType: 5125, count: m.indices.length, type: "SCALAR" }]),
      bufferViews: views.map((byteLength) => ({ buffer: 0, byteLength })), buffers: [{ byteLength: bytes }],
    };
    bytes += zlib.gzipSync(JSON.stringify(document), { level: 9 }).length + 28;
    const name = `${output}-${bits}.obj`;
    const lines = fs.createWriteStream(name);
    let first = 1;
    ready.forEach((m, k) => {
      const moved = quantized(m, bits);
      for (let i = 0; i < moved.length; i += 3) lines.write(`v ${moved[i].toFixed(3)} ${(-moved[i + 2]).toFixed(3)} ${moved[i + 1].toFixed(3)}\n`);
      const groups = new Map();
      for (let i = 0; i < m.indices.length; i += 3) {
        const part = all[k][m.indices[i]];
        if (!groups.has(part)) groups.set(part, []);
        groups.get(part).push(i);
      }
      for (const [part, faces] of groups) {
        lines.write(`o ${k}-${part}\n`);
        for (const i of faces) lines.write(`f ${m.indices[i] + first} ${m.indices[i + 1] + first} ${m.indices[i + 2] + first}\n`);
      }
      first += moved.length / 3;
    });
    await new Promise((done) => lines.end(done));
    console.log(bits, bytes, name);
  }
})();
