"""Grammar inference: split at all full lines, in y or else in x, and share the rules of equal parts."""
import json, sys
facade, rules, known = json.load(open(sys.argv[1])), [], {}
def symbol(box, inside):
    if len(inside) == 1:
        return inside[0]["label"]
    place = lambda r: (r["label"], round(r["x"] - box["x"], 6), round(r["y"] - box["y"], 6), r["width"], r["height"])
    key = str(sorted(map(place, inside)))
    if key not in known:
        known[key] = f"Part{len(known)}"
        rules.append(rule := {"symbol": known[key], "op": "split"})
        for axis, size in ("y", "height"), ("x", "width"):
            cuts = sorted({r[axis] for r in inside} | {box[axis] + box[size]})
            cuts = [c for c in cuts if not any(r[axis] + 1e-6 < c < r[axis] + r[size] - 1e-6 for r in inside)]
            if len(cuts) > 2: break
        part = lambda a, b: (dict(box, **{axis: a, size: b - a}), [r for r in inside if a - 1e-6 < r[axis] < b - 1e-6])
        rule.update(axis=axis, successors=[{"symbol": symbol(*part(a, b)), "size": b - a} for a, b in zip(cuts, cuts[1:])])
    return known[key]
axiom = symbol(dict(x=0, y=0, width=facade["width"], height=facade["height"]), facade["regions"])
json.dump(dict({k: facade[k] for k in ("unit", "width", "height")}, format="edifice/grammar", version=1, axiom=axiom, rules=rules), open(sys.argv[2], "w"))
