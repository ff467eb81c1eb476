"""Grammar inference: floors as one split, each floor as one split, equal floors sharing their rule."""
import json, sys

facade, output = json.load(open(sys.argv[1])), sys.argv[2]
floors = sorted({r["y"] for r in facade["regions"]} | {facade["height"]})
rows, rules = {}, []
root = {"symbol": "Facade", "op": "split", "axis": "y", "successors": []}
for low, high in zip(floors, floors[1:]):
    row = sorted((r for r in facade["regions"] if r["y"] <= low < r["y"] + r["height"]), key=lambda r: r["x"])
    parts = [{"symbol": r["label"], "size": r["width"]} for r in row]
    known = rows.setdefault(json.dumps([parts, high - low]), f"Row{len(rows)}")
    root["successors"].append({"symbol": known, "size": high - low})
    if known == f"Row{len(rules)}":
        rules.append({"symbol": known, "op": "split", "axis": "x", "successors": parts})
json.dump({"format": "edifice/grammar", "version": 1, "axiom": "Facade", "unit": facade["unit"],
           "width": facade["width"], "height": facade["height"], "rules": [root, *rules]}, open(output, "w"))
