"""Discrete inference: pgmpy and pyAgrum on the networks that the peers run of the project wrote.
For each network and evidence: all marginals; the answers are compared with the project's.

    python benches/peers/inference.py FOLDER
"""
import json
import logging
import statistics
import sys
import time
import warnings
from pathlib import Path

warnings.filterwarnings("ignore")
logging.disable(logging.CRITICAL)
try:
    import pyagrum as gum
except ImportError:
    import pyAgrum as gum
import pgmpy
from pgmpy.inference import VariableElimination
from pgmpy.readwrite import BIFReader

folder = Path(sys.argv[1])
print("pyagrum", gum.__version__, "pgmpy", pgmpy.__version__)


def timed(repeats, run):
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        answer = run()
        times.append(time.perf_counter() - start)
    return statistics.median(times), answer


for case in sorted(folder.glob("net_*.json")):
    spec = json.loads(case.read_text())
    path = str(folder / spec["bif"])
    evidence = spec["evidence"]
    ours = spec["marginals"]

    bn = gum.loadBN(path)

    def agrum():
        engine = gum.LazyPropagation(bn)
        engine.setEvidence(evidence)
        engine.makeInference()
        return {v: list(engine.posterior(v).toarray()) for v in ours}

    seconds, answer = timed(spec["repeats"], agrum)
    labels = {v: bn.variable(v).labels() for v in ours}
    worst = max(abs(p - ours[v][c]) for v in ours for c, p in zip(labels[v], answer[v]))
    print(f"{case.stem} pyagrum seconds {seconds:.6f} worst difference {worst:.2e}")

    network = BIFReader(path).get_model()

    def pgm():
        engine = VariableElimination(network)
        free = [v for v in ours if v not in evidence]
        return {v: engine.query([v], evidence=evidence, show_progress=False) for v in free}

    seconds, answer = timed(max(1, spec["repeats"] // 20), pgm)
    worst = max(
        abs(f.values[i] - ours[v][c]) for v, f in answer.items() for i, c in enumerate(f.state_names[v])
    )
    print(f"{case.stem} pgmpy seconds {seconds:.6f} worst difference {worst:.2e}")
