#!/usr/bin/env python3
"""Houses as IFC4 judged by IfcOpenShell: the schema, its express rules, and the triangles that its geometry library makes.

usage: tests/external/ifc.py COUNT FOLDER...
Each folder holds NAME.ifc beside NAME.building.json, NAME.obj and NAME.report.json of `edifice building`. Exit code 1 when there are not COUNT files, when a
file has an error, when a wall, a window or a door has no triangles, when windows and doors are not those of the house, or when the area of all products
differs from that of the surface."""
import json, pathlib, sys
import ifcopenshell, ifcopenshell.geom, ifcopenshell.validate
import numpy as np

CLASSES = ["IfcWall", "IfcSlab", "IfcWindow", "IfcDoor", "IfcCovering", "IfcChimney", "IfcBuildingElementProxy"]


def area(vertices, faces):
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def read_obj(path):
    lines = [line.split() for line in path.read_text().splitlines()]
    vertices = np.array([line[1:4] for line in lines if line[:1] == ["v"]], float)
    faces = np.array([line[1:4] for line in lines if line[:1] == ["f"]], int) - 1
    return vertices, faces


def shapes(model):
    """Vertices in world coordinates and triangles of each product by its GlobalId."""
    settings = ifcopenshell.geom.settings()
    settings.set("use-world-coords", True)
    settings.set("weld-vertices", False)
    iterator = ifcopenshell.geom.iterator(settings, model, 1)
    found = {}
    more = iterator.initialize()
    while more:
        shape = iterator.get()
        geometry = shape.geometry
        found[shape.guid] = (np.array(geometry.verts).reshape(-1, 3), np.array(geometry.faces, int).reshape(-1, 3))
        more = iterator.next()
    return found


def expected(house, report):
    """Windows and doors of a house: elements that found a place; garage doors are no elements."""
    elements = [e for piece in house["facades"] for e in piece["elements"]]
    doors = sum(e["style"] == "door" for e in elements)
    return len(elements) - doors, doors, report["unplaced"]


def judge(path):
    """Faults of a file in words, and its numbers of windows and doors."""
    logger = ifcopenshell.validate.json_logger()
    ifcopenshell.validate.validate(str(path), logger, express_rules=True)
    faults = [str(s.get("message", s))[:300] for s in logger.statements]
    model = ifcopenshell.open(str(path))
    made = shapes(model)
    products = [p for name in CLASSES for p in model.by_type(name)]
    for product in products:
        _, faces = made.get(product.GlobalId, (None, []))
        if len(faces) == 0:
            faults.append(f"{product.Name} has no triangles")
    stem = path.with_suffix("")
    house = json.loads(pathlib.Path(f"{stem}.building.json").read_text())
    report = json.loads(pathlib.Path(f"{stem}.report.json").read_text())
    windows = model.by_type("IfcWindow")
    doors = [d for d in model.by_type("IfcDoor") if d.ObjectType != "garage"]
    wanted_windows, wanted_doors, unplaced = expected(house, report)
    if unplaced == 0 and (len(windows), len(doors)) != (wanted_windows, wanted_doors):
        faults.append(f"{len(windows)} windows and {len(doors)} doors, the house has {wanted_windows} and {wanted_doors}")
    if len(windows) + len(doors) + unplaced != wanted_windows + wanted_doors:
        faults.append(f"{len(windows)} windows and {len(doors)} doors of {wanted_windows + wanted_doors}, {unplaced} without a place")
    storeys = len(model.by_type("IfcBuildingStorey"))
    filled = sum(len(w.FillsVoids) for w in windows)
    if storeys == 0 or filled != len(windows):
        faults.append(f"{storeys} storeys, {filled} of {len(windows)} windows in an opening")
    surface = read_obj(pathlib.Path(f"{stem}.obj"))
    both = sum(area(*made[p.GlobalId]) for p in products if p.GlobalId in made), area(*surface)
    if abs(both[0] - both[1]) > 1e-4 * both[1]:
        faults.append(f"the area of the products is {both[0]:.4f}, that of the surface {both[1]:.4f}")
    low, high = (f(np.concatenate([made[p.GlobalId][0] for p in products]), axis=0) for f in (np.min, np.max))
    if max(np.abs(low - surface[0].min(axis=0)).max(), np.abs(high - surface[0].max(axis=0)).max()) > 1e-4:
        faults.append("the box around the products is not that around the surface")
    return faults, len(windows), len(doors)


def main():
    count, folders = int(sys.argv[1]), sys.argv[2:]
    files = sorted(p for folder in folders for p in pathlib.Path(folder).glob("*.ifc"))
    bad, windows, doors = 0, 0, 0
    for path in files:
        faults, own_windows, own_doors = judge(path)
        windows, doors = windows + own_windows, doors + own_doors
        bad += bool(faults)
        for fault in faults[:10]:
            print(f"{path.parent.name}/{path.name}: {fault}")
    print(f"ifc: {len(files) - bad} of {len(files)} files without errors; {windows} windows and {doors} doors")
    sys.exit(bad > 0 or len(files) != count)


if __name__ == "__main__":
    main()
