"""Edifice: facades, grammars, completion, houses, cities, models of tables, Bayesian networks.

The classes that need scikit-learn (``TableModel``, ``GaussianMixture``) and pandas (``sweep``) are loaded when they are asked for.
"""

from ._native import City, CityGrammar, EdificeError, Facade, Grammar, House, HouseModel, Logic, Network

__all__ = [
    "City",
    "CityGrammar",
    "EdificeError",
    "Facade",
    "GaussianMixture",
    "Grammar",
    "House",
    "HouseModel",
    "Logic",
    "Network",
    "TableModel",
    "compare",
    "complete",
    "hide",
    "program",
    "sweep",
]

__version__ = "0.1.0"


def complete(facade, method="best", count=1, seed=0):
    """Completes the unknown part of a facade in up to ``count`` ways, the best first."""
    return facade.complete(method=method, count=count, seed=seed)


def hide(facade, task, seed=0, frozen=False):
    """Hides a part of a whole facade: ``r20``, ``r50``, ``side50``, ``corner36``, ``bottom40``, ``tree``, ``car`` or ``cut``."""
    return facade.hide(task, seed=seed, frozen=frozen)


def compare(truth, predicted):
    """Compares a predicted layout of elements with the true one."""
    return truth.compare(predicted)


def __getattr__(name):
    import importlib

    if name in ("GaussianMixture", "TableModel"):
        return getattr(importlib.import_module("._estimators", __name__), name)
    if name in ("program", "sweep"):
        return importlib.import_module(f".{name}", __name__)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
