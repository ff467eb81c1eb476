"""An independent judge of `edifice facade compare`: 1,000 random pairs of layouts, every number compared to 1e-9.

    python3 tests/external/facade_compare.py target/debug/edifice [PAIRS]

It shares no code with the library: intersections are of exact fractions, areas of unions are sums over cells.
"""

import json
import pathlib
import random
import subprocess
import sys
import tempfile
from fractions import Fraction as F

PROGRAM = sys.argv[1]
PAIRS = int(sys.argv[2]) if len(sys.argv) > 2 else 1000
LABELS = ["window", "door", "balcony", "shop"]
WIDTH, HEIGHT = 320, 240
THRESHOLDS = [F(k, 100) for k in range(50, 100, 5)]


def layout(rng):
    regions = []
    for _ in range(rng.randrange(0, 12)):
        w, h = rng.randrange(4, 60), rng.randrange(4, 60)
        regions.append((rng.choice(LABELS), rng.randrange(0, WIDTH - w), rng.randrange(0, HEIGHT - h), w, h))
    return regions


def moved(rng, regions):
    found = []
    for label, x, y, w, h in regions:
        chance = rng.random()
        if chance < 0.15:
            continue
        dx, dy, dw, dh = (rng.randrange(-4, 5) if chance < 0.8 else 0 for _ in range(4))
        w, h = max(1, w + dw), max(1, h + dh)
        x, y = min(max(0, x + dx), WIDTH - w), min(max(0, y + dy), HEIGHT - h)
        found.append((label if chance < 0.95 else rng.choice(LABELS), x, y, w, h))
    return found + layout(rng)[: rng.randrange(0, 3)]


def shared(a, b):
    w = min(a[1] + a[3], b[1] + b[3]) - max(a[1], b[1])
    h = min(a[2] + a[4], b[2] + b[4]) - max(a[2], b[2])
    return max(w, 0) * max(h, 0)


def iou(a, b):
    both = shared(a, b)
    return F(both, a[3] * a[4] + b[3] * b[4] - both)


def cells(regions):
    return {(i, j) for _, x, y, w, h in regions for i in range(x, x + w) for j in range(y, y + h)}


def pairs(truth, found, least):
    order = sorted(
        ((-iou(t, p), i, j) for i, t in enumerate(truth) for j, p in enumerate(found) if iou(t, p) >= least)
    )
    used, hits = set(), []
    for _, i, j in order:
        if ("t", i) not in used and ("p", j) not in used:
            used |= {("t", i), ("p", j)}
            hits.append(j)
    return hits


def agreement(truth, found, labels):
    told = {"f1": {}, "truth": len(truth), "predicted": len(found)}
    both = len(truth) + len(found)
    of = lambda side, label: [r for r in side if r[0] == label]
    for least in THRESHOLDS:
        n = sum(len(pairs(of(truth, l), of(found, l), least)) for l in labels)
        told["f1"][float(least)] = 2 * n / both if both else 1.0
    told["mean_f1"] = sum(told["f1"].values()) / 10
    inter = union = 0
    for label in labels:
        a, b = cells(of(truth, label)), cells(of(found, label))
        inter, union = inter + len(a & b), union + len(a | b)
    told["iou"] = inter / union if union else 1.0
    return told


def regularity(regions):
    if not regions:
        return {"overlap": 0.0, "distinct_edges": 0.0}
    doubled = sum(
        shared(a, b) for i, a in enumerate(regions) for b in regions[:i] if a[0] == b[0]
    )
    edges = 0
    for k, size in ((1, 3), (2, 4)):
        values = sorted(v for r in regions for v in (r[k], r[k] + r[size]))
        edges += 1 + sum(b - a > 0.002 * max(WIDTH, HEIGHT) for a, b in zip(values, values[1:]))
    return {
        "overlap": doubled / sum(r[3] * r[4] for r in regions),
        "distinct_edges": edges / (4 * len(regions)),
    }


def calibration(truth, found, probabilities):
    hits = set()
    for label in LABELS:
        own = [j for j, r in enumerate(found) if r[0] == label]
        hit = pairs([r for r in truth if r[0] == label], [found[j] for j in own], F(1, 2))
        hits |= {own[j] for j in hit}
    if not found:
        return None
    n = len(found)
    bins = {}
    for j, p in enumerate(probabilities):
        total = bins.setdefault(min(int(p * 10), 9), [0.0, 0])
        total[0] += p
        total[1] += j in hits
    return {
        "elements": n,
        "brier": sum((p - (j in hits)) ** 2 for j, p in enumerate(probabilities)) / n,
        "expected_calibration_error": sum(abs(p - h) for p, h in bins.values()) / n,
    }


def write(path, regions, probabilities=None):
    told = [dict(label=l, x=x, y=y, width=w, height=h) for l, x, y, w, h in regions]
    for region, p in zip(told, probabilities or []):
        region["probability"] = p
    head = {"format": "edifice/facade", "version": 1, "name": path.stem, "unit": "px", "width": WIDTH, "height": HEIGHT}
    path.write_text(json.dumps(dict(head, regions=told)))


def close(a, b, place):
    if isinstance(a, dict):
        assert isinstance(b, dict), place
        for key in a:
            other = b.get(key, b.get(str(key))) if not isinstance(key, float) else b[f"{key:g}"]
            close(a[key], other, f"{place}.{key}")
    elif a is None:
        assert b is None, place
    else:
        assert abs(a - b) <= 1e-9, f"{place}: ours {a}, the program's {b}"


def main():
    rng = random.Random(1)
    with tempfile.TemporaryDirectory() as folder:
        folder, done = pathlib.Path(folder), 0
        while done < PAIRS:
            truth = layout(rng)
            write(folder / "truth.facade.json", truth)
            several = []
            for k in range(min(50, PAIRS - done)):
                found = moved(rng, truth)
                probabilities = [rng.random() for _ in found]
                write(folder / f"p{k}.facade.json", found, probabilities)
                several.append((found, probabilities))
            names = [str(folder / f"p{k}.facade.json") for k in range(len(several))]
            words = [PROGRAM, "facade", "compare", str(folder / "truth.facade.json"), *names, "--json"]
            text = subprocess.run(words, check=True, capture_output=True, text=True).stdout
            told = json.loads(text.splitlines()[-1])["predictions"]
            for (found, probabilities), program in zip(several, told):
                labels = sorted({r[0] for r in truth + found})
                close(agreement(truth, found, labels), program, "all")
                for label in labels:
                    of = lambda side: [r for r in side if r[0] == label]
                    close(agreement(of(truth), of(found), [label]), program["labels"][label], label)
                close(regularity(truth), program["regularity"]["truth"], "truth")
                close(regularity(found), program["regularity"]["predicted"], "predicted")
                close(calibration(truth, found, probabilities), program["calibration"], "calibration")
                done += 1
    print(f"{done} pairs agree to 1e-9")


main()
