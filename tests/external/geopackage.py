#!/usr/bin/env python3
"""Footprints with heights as GDAL writes them to a GeoPackage, against the same footprints as GeoJSON (needs `ogr2ogr`).

    tests/external/geopackage.py [PATH_OF_EDIFICE]

Polygons with and without holes, multipolygons, a third coordinate, heights as numbers, as text and as storeys, in metres of EPSG:28992 and in
degrees. The two cities must have the same buildings with the same volumes.
"""

import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile

EDIFICE = sys.argv[1] if len(sys.argv) > 1 else "target/debug/edifice"


def ring(rng, x, y, radius, turn, z):
    corners = rng.randint(3, 9)
    points = []
    for k in range(corners):
        angle = turn * 2 * math.pi * k / corners
        far = radius * rng.uniform(0.7, 1.0)
        points.append([x + far * math.cos(angle), y + far * math.sin(angle)] + z)
    return points + points[:1]


def features(rng, count, place):
    for k in range(count):
        x, y, radius = place(rng, k)
        z = [0.0] if k % 3 == 0 else []
        outer = [ring(rng, x, y, radius, 1, z)]
        if k % 2:
            outer.append(ring(rng, x, y, radius / 4, -1, z))
        geometry = {"type": "Polygon", "coordinates": outer}
        if k % 5 == 0:
            geometry = {"type": "MultiPolygon", "coordinates": [outer, [ring(rng, x + 2 * radius, y, radius / 2, 1, z)]]}
        height = [{"height": 3 + k % 40}, {"height": f"{5 + k % 7}.5 m"}, {"levels": 1 + k % 9}, {"name": "flat"}][k % 4]
        yield {"type": "Feature", "properties": {"id": f"b{k}", **height}, "geometry": geometry}


with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    cases = {
        "metres": ("EPSG:28992", lambda rng, k: (85000 + 40 * (k % 20), 446000 + 40 * (k // 20), rng.uniform(3, 9))),
        "degrees": ("EPSG:4326", lambda rng, k: (4.36 + 0.0006 * (k % 20), 52.01 + 0.0004 * (k // 20), rng.uniform(0.00003, 0.0001))),
    }
    for name, (system, place) in cases.items():
        rng = random.Random(5)
        document = {"type": "FeatureCollection", "features": list(features(rng, 400, place))}
        if name == "metres":
            document["crs"] = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::28992"}}
        plain = folder / f"{name}.geojson"
        plain.write_text(json.dumps(document))
        packed = folder / f"{name}.gpkg"
        subprocess.run(["ogr2ogr", "-f", "GPKG", "-a_srs", system, "-lco", "FID=key", packed, plain], check=True)
        said = subprocess.run([EDIFICE, "city", "compare", "--json", plain, packed], check=True, capture_output=True, text=True).stdout
        found = json.loads(said)
        print(name, {k: found[k] for k in found if not isinstance(found[k], (list, dict))})
        iou = found["iou"]
        if not iou > 0.999999:
            sys.exit(f"geopackage: {name}: IoU {iou}")
