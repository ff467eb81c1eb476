"""Completion: what is seen is mirrored at the middle of the facade."""
import json, sys

facade, output = json.load(open(sys.argv[1])), sys.argv[2]
seen, width = facade["regions"], facade["width"]
unknown = facade.get("unknown", [dict(x=0, y=0, width=width, height=facade["height"])])
inside = lambda x, y: any(u["x"] < x < u["x"] + u["width"] and u["y"] < y < u["y"] + u["height"] for u in unknown)
mirrored = [dict(r, x=width - r["x"] - r["width"], observed=False) for r in seen]
free = lambda r: not any(abs(r["x"] - o["x"]) < r["width"] / 2 and abs(r["y"] - o["y"]) < r["height"] / 2 for o in seen)
centre = lambda r: (r["x"] + r["width"] / 2, r["y"] + r["height"] / 2)
fits = lambda r: r["x"] >= 0 and inside(*centre(r)) and free(r)
facade["regions"] = seen + [r for r in mirrored if fits(r)]
json.dump(facade, open(output, "w"))
