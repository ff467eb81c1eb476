#!/usr/bin/env python3
"""The rows of audited Canadian houses in `datasets/building_exteriors/real.houses.csv`, drawn anew from the public tables.

    tests/external/real_houses.py H2K CSV [--number 320] [--seed 1]

H2K is a folder with `single_detached_clean.csv.gz` and `windows.csv.gz` of the EnerGuide programme (Natural Resources Canada,
Open Government Licence). Prints CSV with its rows of the source `h2k` replaced; the others stay as they are.

Window-to-wall ratios are of walls above ground: windows of basements, crawl spaces and roofs are left out, and the glass of doors, for
which a door of 1.9 square metres counts on the front and, with two doors or more, on the back. The wall of a side is its length in the
rectangle of the main floor's area and perimeter, times the mean height of the walls. Houses whose walls are not 2.2 to 3.3 m high for
each storey are left out: their walls are those of one floor, or of other houses as well.
"""

import argparse
import csv
import gzip
import pathlib
import random
import sys
from collections import defaultdict

DOOR = 1.9
HEIGHT = (2.2, 3.3)
FACINGS = ["North", "Northeast", "East", "Southeast", "South", "Southwest", "West", "Northwest"]
# The side of a house by how many eighths of a turn it faces away from the front.
SIDES = {0: "front", 2: "left", 4: "back", 6: "right"}


def table(path):
    """The rows of a packed table."""
    with gzip.open(path, "rt", newline="") as file:
        yield from csv.DictReader(file)


def glass(folder):
    """Square metres of windows in walls above ground, for each house and facing."""
    areas = defaultdict(float)
    for row in table(folder / "windows.csv.gz"):
        if row["parent"] == "Wall":
            areas[row["id"], row["facing"]] += float(row["n"] or 1) * float(row["width_mm"]) * float(row["height_mm"]) / 1e6
    return areas


def yes(value):
    """A truth value as the table of attributes writes it."""
    return "yes" if value else "no"


def attributes(house, areas):
    """The attributes of one house, or none if it is not measured well enough."""
    known = ["wall_area", "perim_main", "bbox_w", "bbox_d", "n_storeys", "roof_style"]
    if any(not house[name] for name in known) or house["front_facing"] not in FACINGS:
        return None
    floors = float(house["n_storeys"])
    height = float(house["wall_area"]) / float(house["perim_main"])
    if floors not in (1, 2, 3) or not HEIGHT[0] <= height / floors <= HEIGHT[1]:
        return None
    front = FACINGS.index(house["front_facing"])
    doors = int(float(house["n_doors"] or 0))
    row = {"source": "h2k", "floors": f"{floors:.0f}"}
    for eighths, side in SIDES.items():
        area = areas[house["id"], FACINGS[(front + eighths) % 8]]
        area += DOOR if side == "front" and doors > 0 or side == "back" and doors > 1 else 0
        length = float(house["bbox_w" if side in ("front", "back") else "bbox_d"])
        row[f"wwr.{side}"] = f"{area / (length * height):.4f}"
    for kind in ("flat", "gable", "hip"):
        row[f"roof.{kind}"] = yes(house["roof_style"] == kind)
    row["window.bay"] = yes(float(house["kw_bay"] or 0) > 0)
    row["special.chimney"] = yes(float(house["chimney_proxy"] or 0) > 0)
    for part, column in [("garage", "garage"), ("porch.front", "porch_front"), ("porch.back", "porch_back")]:
        row[f"{part}.there"] = yes(float(house[column] or 0) > 0)
    return row


def main():
    """Writes the table with new rows."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("h2k", type=pathlib.Path)
    parser.add_argument("csv", type=pathlib.Path)
    parser.add_argument("--number", type=int, default=320)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    with open(arguments.csv, newline="") as file:
        reader = csv.DictReader(file)
        columns, rows = reader.fieldnames, list(reader)
    areas = glass(arguments.h2k)
    houses = [attributes(house, areas) for house in table(arguments.h2k / "single_detached_clean.csv.gz")]
    houses = [house for house in houses if house]
    print(f"{len(houses)} houses measured well enough, {arguments.number} drawn", file=sys.stderr)
    drawn = random.Random(arguments.seed).sample(houses, arguments.number)
    at = next(place for place, row in enumerate(rows) if row["source"] == "h2k")
    others = [row for row in rows if row["source"] != "h2k"]
    writer = csv.DictWriter(sys.stdout, columns, lineterminator="\n", restval="")
    writer.writeheader()
    writer.writerows(others[:at] + drawn + others[at:])


if __name__ == "__main__":
    main()
