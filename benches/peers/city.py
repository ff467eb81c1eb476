"""A NumPy archive of a city as two binary glTF files: one mesh, and a mesh for each building.

usage: city.py CITY.npz ONE.glb EACH.glb
"""

import json
import struct
import sys

import numpy as np


def glb(path, meshes):
    """Writes (name, positions, triangles) each, z up to y up, relative to the middle of all."""
    binary, views, accessors, out, nodes = bytearray(), [], [], [], []

    def accessor(values, target, component, kind, count, **more):
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": values.nbytes, "target": target})
        binary.extend(values.tobytes())
        accessors.append({"bufferView": len(views) - 1, "componentType": component, "count": count, "type": kind, **more})
        return len(accessors) - 1

    for name, positions, triangles in meshes:
        p = np.stack([positions[:, 0], positions[:, 2], -positions[:, 1]], 1).astype("<f4")
        a = accessor(p, 34962, 5126, "VEC3", len(p), min=p.min(0).tolist(), max=p.max(0).tolist())
        i = accessor(triangles.astype("<u4"), 34963, 5125, "SCALAR", triangles.size)
        nodes.append({"mesh": len(out), "name": name})
        out.append({"primitives": [{"attributes": {"POSITION": a}, "indices": i}]})
    while len(binary) % 4:
        binary.append(0)
    text = json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes,
        "meshes": out, "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": len(binary)}]}).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as f:
        f.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary)))
        f.write(struct.pack("<I4s", len(text), b"JSON") + text)
        f.write(struct.pack("<I4s", len(binary), b"BIN\0") + binary)


archive = np.load(sys.argv[1])
unit = 1.0 if archive["V"].dtype.kind == "f" else 0.01
v, f, voff, foff = archive["V"] * unit, archive["F"].astype(np.int64), archive["voff"], archive["foff"]
each = []
for b in range(len(voff) - 1):
    own, faces = v[voff[b]:voff[b + 1]], f[foff[b]:foff[b + 1]]
    if len(faces):
        each.append((str(b), own, faces))
shift = [voff[b] for b in range(len(voff) - 1)]
owner = np.repeat(np.asarray(shift), np.diff(foff))
glb(sys.argv[2], [("city", v, f + owner[:, None])])
glb(sys.argv[3], each)
