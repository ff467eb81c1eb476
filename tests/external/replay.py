#!/usr/bin/env python3
"""Lines that a build compiles again after each of the last commits, with today's crates.

A commit that changes a Rust file of a crate makes cargo compile that crate and all that depend on it. Files of old commits are
mapped to the crate in whose folder they stand today. Tests, benches and examples are not counted, nor are commits that change
no source. Prints the quantiles, and for comparison those of a single crate of all sources.

usage: tests/external/replay.py [COMMITS]      (300 by default; run in a checkout)
"""
import json
import os
import statistics
import subprocess
import sys

ROOT = subprocess.check_output(["git", "rev-parse", "--show-toplevel"], text=True).strip()
# Where sources stood before the crates.
MOVED = {"src/error.rs": "src/base", "src/rng.rs": "src/base", "src/file.rs": "src/base",
         "src/tables/": "src/model/tables/", "src/methods/mod.rs": "src/lib.rs", "src/bin/": "experiments/bin/",
         "experiments/frame/datasets.rs": "datasets/mod.rs", "experiments/sweep/sources.rs": "experiments/frame"}
# What all experiments share stands in the frame today.
MOVED.update({f"experiments/{name}.rs": "experiments/frame" for name in ("averages", "layouts", "parsed", "picture", "roc")})


def crates():
    """Folder of each crate, and the folders of the crates that depend on it, with itself."""
    out = subprocess.check_output(["cargo", "metadata", "--format-version", "1", "--no-deps", "--offline"], cwd=ROOT)
    packages = json.loads(out)["packages"]
    folder = {p["name"]: os.path.relpath(os.path.dirname(p["manifest_path"]), ROOT) for p in packages}
    above = {name: {name} for name in folder}
    changed = True
    while changed:
        changed = False
        for p in packages:
            for d in p["dependencies"]:
                if d["kind"] is None and d["name"] in folder:
                    for of, users in above.items():
                        if d["name"] in users and p["name"] not in users:
                            users.add(p["name"])
                            changed = True
    return folder, above


def main():
    commits = int(sys.argv[1]) if len(sys.argv) > 1 else 300
    folder, above = crates()
    # The crate of a file is the one with the longest folder around it; the root crate has src/lib.rs and src/main.rs.
    by_depth = sorted(((f, n) for n, f in folder.items() if f != "."), key=lambda x: -len(x[0]))

    def crate_of(path):
        for old, new in MOVED.items():
            if path.startswith(old):
                path = new + path[len(old):] if new.endswith("/") else new + "/" + os.path.basename(path)
        for f, name in by_depth:
            # A paper's list of artefacts stood beside its folder.
            if path.startswith(f + "/") or path == f + ".rs":
                return name
        return "edifice" if path in ("src/lib.rs", "src/main.rs") else None

    lines = dict.fromkeys(folder, 0)
    files = subprocess.check_output(["git", "ls-files", "*.rs"], cwd=ROOT, text=True).split()
    for path in files:
        name = crate_of(path)
        if name and os.path.exists(os.path.join(ROOT, path)):
            with open(os.path.join(ROOT, path), encoding="utf8") as f:
                lines[name] += sum(1 for _ in f)
    total = sum(lines.values())
    log = subprocess.check_output(["git", "log", "--no-merges", "--name-only", "--format=%x00%h", f"-n{commits}"], cwd=ROOT, text=True)
    again = []
    for entry in log.split("\0")[1:]:
        changed = {crate_of(p) for p in entry.split("\n")[1:] if p.endswith(".rs")} - {None}
        if changed:
            built = set().union(*(above[name] for name in changed))
            again.append(sum(lines[name] for name in built))
    again.sort()
    print(f"{len(again)} commits of {commits} change sources; {total} lines in {len(folder)} crates")
    print(f"lines compiled again: median {statistics.median(again):.0f}, quartiles "
          f"{again[len(again) // 4]} and {again[3 * len(again) // 4]}; as one crate {total}")


main()
