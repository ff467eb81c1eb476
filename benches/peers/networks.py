"""Public Bayesian networks: pyAgrum's times for all posteriors, and the largest difference to ours.

pgmpy ships the networks: `pip download --no-deps pgmpy`, unpack `pgmpy/utils/example_models/*.bif.gz` into a folder, run
`cargo bench --bench network_peers -- FOLDER`, then

    python benches/peers/networks.py FOLDER

pyAgrum's reader takes neither slashes nor signs in the names of categories: they are renamed on the way.
"""
import json
import os
import re
import signal
import sys
import tempfile
import time
from pathlib import Path

import pyagrum as gum

LIMIT = 100  # seconds a network


def renamed(text):
    """The network with categories c0, c1, ..."""
    categories = {}

    def variable(match):
        name, names = match.group(1), [n.strip() for n in match.group(3).split(",")]
        categories[name] = {n: f"c{i}" for i, n in enumerate(names)}
        own = ", ".join(categories[name].values())
        return f"variable {name} {{\n  type discrete [ {len(names)} ] {{ {own} }};\n}}"

    def table(match):
        head, body = match.groups()
        parents = [p.strip() for p in head.split("|")[1].split(",")] if "|" in head else []

        def row(found):
            values = [v.strip() for v in found.group(1).split(",")]
            return "(" + ", ".join(categories[p][v] for p, v in zip(parents, values)) + ")"

        body = re.sub(r"\(([^)]*)\)", row, body) if parents else body
        return f"probability ({head}) {{{body}}}"

    text = re.sub(
        r"variable\s+(\S+)\s*\{\s*type discrete \[\s*(\d+)\s*\]\s*\{([^}]*)\};\s*\}", variable, text
    )
    return re.sub(r"probability\s*\(([^)]*)\)\s*\{([^}]*)\}", table, text)


def compare(path):
    with tempfile.NamedTemporaryFile("w", suffix=".bif") as file:
        file.write(renamed(path.read_text()))
        file.flush()
        network = gum.loadBN(file.name)
    ours = json.loads(path.with_suffix(".ours.json").read_text())
    signal.alarm(LIMIT)
    times = []
    while len(times) < 5 and sum(times) < 20:
        start = time.perf_counter()
        engine = gum.LazyPropagation(network)
        engine.makeInference()
        answers = {v: engine.posterior(v).toarray() for v in network.names()}
        times.append(time.perf_counter() - start)
    worst = max(
        (abs(p - q) for v in ours for p, q in zip(ours[v], answers[v])), default=float("nan")
    )
    print(f"{path.stem},{network.size()},{min(times):.6f},{len(ours)},{worst:.1e}", flush=True)


print("network,variables,pyagrum_all_seconds,compared,largest_difference")
for path in sorted(Path(sys.argv[1]).glob("*.bif"), key=lambda p: p.stat().st_size):
    # Each in a process of its own: some end for want of time or memory.
    child = os.fork()
    if child == 0:
        compare(path)
        os._exit(0)
    if os.waitpid(child, 0)[1]:
        print(f"{path.stem},,none within {LIMIT} s,,", flush=True)
