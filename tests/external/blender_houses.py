"""Houses as Blender reads them: `blender_houses.py FILE.glb ...`, with the module bpy.

Each file is imported into an empty scene. Its nodes must be objects of their names below the same parents, with the custom
properties of their extras; meshes must have texture coordinates and materials; each material whose glTF has a texture must
have an image, and a node that scales it; panes must let light through. Exit code 1 names what is wrong.
"""

import json
import struct
import sys
from pathlib import Path

import bpy


def document(path: Path) -> dict:
    """The JSON chunk of a binary glTF file."""
    data = path.read_bytes()
    (length,) = struct.unpack("<I", data[12:16])
    return json.loads(data[20 : 20 + length])


def nodes_of(material, kind: str) -> list:
    """Shader nodes of a kind."""
    return [n for n in material.node_tree.nodes if n.type == kind]


def faults(path: Path) -> list[str]:
    """All that is wrong with a file once it is imported."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=str(path))
    gltf = document(path)
    nodes = gltf["nodes"]
    parents = {child: k for k, node in enumerate(nodes) for child in node.get("children", [])}
    found = []
    for k, node in enumerate(nodes):
        name = node["name"]
        own = bpy.data.objects.get(name)
        if own is None:
            found.append(f"no object {name}")
            continue
        parent = own.parent.name if own.parent else None
        wanted = nodes[parents[k]]["name"] if k in parents else None
        if parent != wanted:
            found.append(f"{name} is below {parent}, not {wanted}")
        for key, value in node["extras"].items():
            got = own.get(key)
            same = abs(got - value) < 1e-6 if isinstance(value, float) and got is not None else got == value
            if not same:
                found.append(f"{name}: {key} is {got!r}, not {value!r}")
        if "mesh" not in node:
            continue
        if own.type != "MESH" or not own.data.uv_layers:
            found.append(f"{name} has no texture coordinates")
        elif not own.data.materials or None in list(own.data.materials):
            found.append(f"{name} has no material")
    for wanted in gltf["materials"]:
        name = wanted["name"]
        material = bpy.data.materials.get(name)
        if material is None:
            found.append(f"no material {name}")
            continue
        images = [n.image for n in nodes_of(material, "TEX_IMAGE")]
        textured = ["baseColorTexture" in wanted["pbrMetallicRoughness"], "normalTexture" in wanted]
        if len(images) != sum(textured):
            found.append(f"{name} has {len(images)} images, not {sum(textured)}")
        if any(i is None or min(i.size) < 128 or not i.has_data and not i.packed_file for i in images):
            found.append(f"{name} has an image without pixels")
        if any(textured) and not nodes_of(material, "MAPPING"):
            found.append(f"{name} has no mapping of metres to repeats")
        transmission = wanted.get("extensions", {}).get("KHR_materials_transmission")
        if transmission:
            shader = nodes_of(material, "BSDF_PRINCIPLED")[0]
            got = shader.inputs["Transmission Weight"].default_value
            if abs(got - transmission["transmissionFactor"]) > 1e-6:
                found.append(f"{name} lets {got} of the light through")
    objects = sum("mesh" in node for node in nodes)
    print(f"blender: {path.name}: {objects} meshes, {len(gltf['materials'])} materials, {len(bpy.data.images)} images")
    return found


def main() -> int:
    """Checks all files."""
    bad = 0
    for path in map(Path, sys.argv[1:]):
        for fault in faults(path):
            print(f"blender: {path.name}: {fault}", file=sys.stderr)
            bad += 1
    print(f"blender {bpy.app.version_string}: {len(sys.argv) - 1} houses, {bad} faults")
    return int(bad > 0 or len(sys.argv) < 2)


if __name__ == "__main__":
    sys.exit(main())
