"""Probabilistic programs: models as code, and engines that find what data say of their choices.

A program is a generator function. It yields choices, observations and factors; a choice answers with its value::

    from edifice.program import normal, half_cauchy, observe, sample, smc

    def schools(effects, errors):
        mean = yield sample("mean", normal(0, 5))
        spread = yield sample("spread", half_cauchy(5))
        for i, (effect, error) in enumerate(zip(effects, errors)):
            own = yield sample(("own", i), normal(0, 1))
            yield observe(normal(mean + spread * own, error), effect)
        return mean

    posterior = smc(schools, [28, 8, -3], [15, 10, 16], count=8000, seed=1)
    posterior.log_evidence, posterior.mean("mean"), posterior.to_arviz()

The same answers have to lead to the same run: a program has no randomness of its own. Parts of programs are called by ``yield from``.

``exact`` tries every way through a program of finite choices and judges the others (``Posterior.beside``); ``importance`` and ``smc`` give
weighted draws and the evidence, ``metropolis`` gives chains.
"""

import json

from ._native import Distribution, Effect, Posterior, exact, factor, importance, metropolis, observe, sample, smc

normal = Distribution.normal
half_normal = Distribution.half_normal
log_normal = Distribution.log_normal
student_t = Distribution.student_t
cauchy = Distribution.cauchy
half_cauchy = Distribution.half_cauchy
exponential = Distribution.exponential
gamma = Distribution.gamma
inverse_gamma = Distribution.inverse_gamma
beta = Distribution.beta
uniform = Distribution.uniform
dirichlet = Distribution.dirichlet
bernoulli = Distribution.bernoulli
bernoulli_logit = Distribution.bernoulli_logit
categorical = Distribution.categorical
categorical_logit = Distribution.categorical_logit
binomial = Distribution.binomial
poisson = Distribution.poisson
poisson_log = Distribution.poisson_log

__all__ = [
    "Distribution",
    "Effect",
    "Posterior",
    "bernoulli",
    "bernoulli_logit",
    "beta",
    "binomial",
    "categorical",
    "categorical_logit",
    "cauchy",
    "dirichlet",
    "exact",
    "exponential",
    "factor",
    "gamma",
    "half_cauchy",
    "half_normal",
    "importance",
    "inverse_gamma",
    "log_normal",
    "metropolis",
    "normal",
    "observe",
    "poisson",
    "poisson_log",
    "read_arviz",
    "sample",
    "smc",
    "student_t",
    "uniform",
]


def read_arviz(path, seed=1):
    """ArviZ's data of a file that ``Posterior::to_inference_data`` of the Rust library wrote."""
    with open(path, encoding="utf-8") as file:
        return _to_arviz(file.read(), seed)


def _to_arviz(text, seed):
    """Draws of equal weight as they are, weighted ones drawn anew in proportion to their weights."""
    import arviz
    import numpy as np

    found = json.loads(text)
    number = lambda values: np.array(values, dtype=float)
    log_weight = number(found["sample_stats"].pop("log_weight"))
    posterior = {name: number(values) for name, values in found["posterior"].items()}
    stats = {name: np.array(values) for name, values in found["sample_stats"].items()}
    if np.ptp(log_weight) > 0:
        weight = np.exp(log_weight[0] - log_weight[0].max())
        kept = np.random.default_rng(seed).choice(weight.size, weight.size, p=weight / weight.sum())
        posterior = {name: values[:, kept] for name, values in posterior.items()}
        stats = {name: values[:, kept] for name, values in stats.items()}
    return arviz.from_dict(
        posterior=posterior, sample_stats=stats, posterior_attrs={"inference_library": "edifice"}
    )
