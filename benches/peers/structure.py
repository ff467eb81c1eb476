"""Structures learned by pyAgrum and pgmpy from the rows that `cargo bench --bench structure_peers -- FOLDER` wrote, scored
by code of its own (BDeu with an equivalent sample size of 1, and BIC, natural logarithms).

    pip install pyagrum pgmpy pandas
    python benches/peers/structure.py FOLDER [SECONDS]

A learner that takes longer than SECONDS (120) is ended.
"""
import math
import multiprocessing
import sys
import time
import warnings
from pathlib import Path

import pandas as pd

warnings.filterwarnings("ignore")


def score(data, sizes, parents, kind):
    total = 0.0
    for child, own in parents.items():
        r, q = sizes[child], math.prod(sizes[p] for p in own)
        keys = own + [child]
        counts = data.groupby(keys, observed=True).size()
        groups = counts.groupby(level=list(range(len(own)))) if own else [((), counts)]
        for _, group in groups:
            n = group.sum()
            if kind == "bic":
                total += sum(k * math.log(k / n) for k in group)
            else:
                a, a_k = 1.0 / q, 1.0 / (q * r)
                total += math.lgamma(a) - math.lgamma(a + n)
                total += sum(math.lgamma(a_k + k) - math.lgamma(a_k) for k in group)
        if kind == "bic":
            total -= 0.5 * (r - 1) * q * math.log(len(data))
    return total


def agrum(path, bif, kind, method, out):
    import pyagrum as gum

    data = pd.read_csv(path)
    learner = gum.BNLearner(data)
    learner.useScoreBDeu() if kind == "bdeu" else learner.useScoreBIC()
    {"greedy": learner.useGreedyHillClimbing, "tabu": lambda: learner.useLocalSearchWithTabuList(20, 2)}[method]()
    learner.setMaxIndegree(6)
    start = time.perf_counter()
    found = learner.learnDAG()
    seconds = time.perf_counter() - start
    out.put((seconds, [(learner.nameFromId(a), learner.nameFromId(b)) for a, b in found.arcs()]))


def pgmpy(path, bif, kind, method, out):
    from pgmpy.causal_discovery import HillClimbSearch
    from pgmpy.structure_score import BDeu, BIC

    data = pd.read_csv(path).astype("category")
    scorer = BDeu(data, equivalent_sample_size=1) if kind == "bdeu" else BIC(data)
    start = time.perf_counter()
    search = HillClimbSearch(scoring_method=scorer, tabu_length=20, max_indegree=6, return_type="dag", show_progress=False)
    search.fit(data)
    seconds = time.perf_counter() - start
    out.put((seconds, list(search.causal_graph_.edges())))


def limited(work, arguments, limit):
    out = multiprocessing.Queue()
    process = multiprocessing.Process(target=work, args=(*arguments, out))
    process.start()
    try:
        return out.get(timeout=limit)
    except Exception:
        return None
    finally:
        process.terminate()
        process.join()


def main():
    folder, limit = Path(sys.argv[1]), float(sys.argv[2]) if len(sys.argv) > 2 else 120.0
    import pgmpy as pg
    import pyagrum as gum

    print("pyAgrum", gum.__version__, "pgmpy", pg.__version__)
    print("network,learner,score,lost,added,score_found,seconds")
    for bif in sorted(folder.glob("*.bif")):
        path = bif.with_suffix(".csv")
        truth = gum.loadBN(str(bif))
        known = {frozenset((truth.variable(a).name(), truth.variable(b).name())) for a, b in truth.arcs()}
        data = pd.read_csv(path)
        sizes = {c: truth.variable(c).domainSize() for c in data.columns}
        for name, work, method in [("pyAgrum greedy", agrum, "greedy"), ("pyAgrum tabu", agrum, "tabu"), ("pgmpy", pgmpy, "tabu")]:
            for kind in ["bdeu", "bic"]:
                found = limited(work, (path, bif, kind, method), limit)
                if found is None:
                    print(f"{bif.stem},{name},{kind},,,,over {limit:.0f} or failed", flush=True)
                    continue
                seconds, edges = found
                learned = {frozenset(e) for e in edges}
                parents = {c: [a for a, b in edges if b == c] for c in data.columns}
                total = score(data, sizes, parents, kind)
                print(f"{bif.stem},{name},{kind},{len(known - learned)},{len(learned - known)},{total:.2f},{seconds:.3f}", flush=True)


if __name__ == "__main__":
    main()
