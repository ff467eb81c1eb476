"""Whose rounding is it? The networks of the peers run: what pyAgrum reads from the file against the
file's own digits, and its marginals when the same tables are set by hand; exact marginals of ASIA.

    python benches/peers/rounding.py FOLDER
"""
import itertools
import json
import logging
import sys
import warnings
from fractions import Fraction
from pathlib import Path

import numpy as np

warnings.filterwarnings("ignore")
logging.disable(logging.CRITICAL)
import pyagrum as gum
from pgmpy.readwrite import BIFReader

folder = Path(sys.argv[1])
print("pyagrum", gum.__version__, "numpy", np.__version__)


def marginals(bn, evidence, variables):
    engine = gum.LazyPropagation(bn)
    engine.setEvidence(evidence)
    engine.makeInference()
    return {v: dict(zip(bn.variable(v).labels(), engine.posterior(v).toarray())) for v in variables}


def worst(answer, ours):
    return max(abs(answer[v][c] - p) for v, row in ours.items() for c, p in row.items())


def exact(network, evidence, variables):
    """By enumeration, in fractions; the file's decimal digits are taken at their word."""
    names = list(network.nodes())
    tables = {}
    for cpd in network.get_cpds():
        for states in itertools.product(*(cpd.state_names[v] for v in cpd.variables)):
            at = tuple(cpd.name_to_no[v][s] for v, s in zip(cpd.variables, states))
            tables[cpd.variable, states] = Fraction(repr(float(cpd.values[at])))
    order = {cpd.variable: cpd.variables for cpd in network.get_cpds()}
    domain = {v: network.get_cpds(v).state_names[v] for v in names}
    domain.update({v: [s] for v, s in evidence.items()})
    totals = {v: {s: Fraction(0) for s in network.get_cpds(v).state_names[v]} for v in variables}
    for states in itertools.product(*(domain[v] for v in names)):
        row = dict(zip(names, states))
        p = Fraction(1)
        for v in names:
            p *= tables[v, tuple(row[u] for u in order[v])]
        for v in variables:
            totals[v][row[v]] += p
    return {v: {s: float(p / sum(row.values())) for s, p in row.items()} for v, row in totals.items()}


for case in sorted(folder.glob("net_*.json")):
    spec = json.loads(case.read_text())
    ours, evidence = spec["marginals"], spec["evidence"]
    path = str(folder / spec["bif"])
    network = BIFReader(path).get_model()
    bn = gum.loadBN(path)
    double, single = 0.0, 0.0
    set_by_hand = gum.BayesNet(bn)
    for cpd in network.get_cpds():
        labels = {v: bn.variable(v).labels() for v in cpd.variables}
        for states in itertools.product(*(cpd.state_names[v] for v in cpd.variables)):
            p = cpd.values[tuple(cpd.name_to_no[v][s] for v, s in zip(cpd.variables, states))]
            at = {v: labels[v].index(s) for v, s in zip(cpd.variables, states)}
            read = bn.cpt(cpd.variable)[at]
            double = max(double, abs(read - p))
            single = max(single, abs(read - float(np.float32(p))))
            set_by_hand.cpt(cpd.variable)[at] = p
    print(case.stem)
    print(f"  tables read by pyagrum: from the digits {double:.1e}, from the digits in single precision {single:.1e}")
    print(f"  marginals, ours and pyagrum: tables from the file {worst(marginals(bn, evidence, ours), ours):.1e}, "
          f"the same tables set in double {worst(marginals(set_by_hand, evidence, ours), ours):.1e}")
    if len(network.nodes()) < 10:
        truth = exact(network, evidence, ours)
        print(f"  exact enumeration in fractions: ours {worst(truth, ours):.1e}, "
              f"pyagrum {worst(marginals(bn, evidence, ours), truth):.1e}")
