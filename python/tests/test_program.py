"""Tests of programs in Python, run on an installed wheel."""

import json
import math

import numpy as np
import pytest

import edifice
from edifice import program
from edifice.program import bernoulli, binomial, categorical, dirichlet, exact, factor, half_cauchy, importance, metropolis, normal, observe, poisson, sample, smc

EFFECTS = [28.0, 8.0, -3.0, 7.0, -1.0, 1.0, 18.0, 12.0]
ERRORS = [15.0, 10.0, 16.0, 11.0, 9.0, 11.0, 10.0, 18.0]


def schools(effects, errors):
    """Eight schools (Rubin 1981)."""
    mean = yield sample("mean", normal(0, 5))
    spread = yield sample("spread", half_cauchy(5))
    for i, (effect, error) in enumerate(zip(effects, errors)):
        own = yield sample(("own", i), normal(0, 1))
        yield observe(normal(mean + spread * own, error), effect)
    return mean


def dice(total, sides=6):
    """Two dice of which the sum is known."""
    first = yield sample(("die", 0), categorical([1.0] * sides))
    second = yield sample(("die", 1), categorical([1.0] * sides))
    yield factor(0.0 if first + second == total else -math.inf)
    return first


def chain(seen):
    """A hidden Markov chain."""
    state = False
    for i, x in enumerate(seen):
        state = yield sample(("state", i), bernoulli(0.8 if state else 0.2))
        yield observe(normal(1.0 if state else 0.0, 0.5), x)
    return state


SEEN = [0.1, 0.8, 1.2, 0.9, -0.2, 1.1]


def forward(seen):
    """The evidence of the chain by the forward recursion."""
    weight = {False: 1.0}
    for x in seen:
        density = lambda s: math.exp(-0.5 * ((x - s) / 0.5) ** 2) / (0.5 * math.sqrt(2 * math.pi))
        weight = {
            s: density(s) * sum(w * ((0.8 if before else 0.2) if s else (0.2 if before else 0.8)) for before, w in weight.items())
            for s in (False, True)
        }
    return math.log(sum(weight.values()))


def test_exact_is_exact():
    for total in range(11):
        ways = sum(1 for a in range(6) if 0 <= total - a < 6)
        posterior = exact(dice, total)
        assert abs(posterior.log_evidence - math.log(ways / 36)) < 1e-12
        assert len(posterior) == ways and abs(posterior.weights.sum() - 1) < 1e-12
        assert sorted(posterior.returned) == [a for a in range(6) if 0 <= total - a < 6]
    assert abs(exact(chain, SEEN).log_evidence - forward(SEEN)) < 1e-10


@pytest.mark.parametrize("run", [lambda seed: importance(chain, SEEN, count=4000, seed=seed), lambda seed: smc(chain, SEEN, count=4000, seed=seed)])
def test_weighted_draws_beside_the_exact_posterior(run):
    truth = exact(chain, SEEN)
    for seed in range(5):
        found = run(seed)
        assert abs(found.log_evidence - truth.log_evidence) < 5 * found.log_evidence_error
        assert all(abs(b["error"]) < 5 * b["mcse"] + 1e-3 for b in found.beside(truth))
    assert (run(3).weights == run(3).weights).all() and not (run(3).weights == run(4).weights).all()


def test_chains_beside_the_exact_posterior():
    found, truth = metropolis(chain, SEEN, draws=2000), exact(chain, SEEN)
    assert found.chains == 4 and len(found) == 8000 and found.log_evidence is None
    assert all(abs(b["error"]) < 0.05 for b in found.beside(truth))
    (first, *_) = found.summary()
    assert first["name"] == "state[0]" and first["r_hat"] < 1.05


def test_eight_schools():
    posterior = smc(schools, EFFECTS, ERRORS, count=8000)
    # The mean of a long run of NUTS.
    assert abs(posterior.mean("mean") - 4.4) < 1.0
    assert np.average(posterior.returned, weights=posterior.weights) == pytest.approx(posterior.mean("mean"))


def test_values_of_all_kinds():
    def kinds():
        shares = yield sample("shares", dirichlet([1.0, 2.0, 3.0]))
        count = yield sample("count", poisson(2.0))
        hits = yield sample("hits", binomial(5, 0.5))
        flag = yield sample(("deep", 1, 2), bernoulli(0.5))
        yield observe(poisson(1.0 + count), 3)
        yield observe(bernoulli(0.25), True)
        return [type(x) for x in (shares, count, hits, flag)], sum(shares)

    posterior = importance(kinds, count=50)
    kinds_of, total = posterior.returned[0]
    assert kinds_of == [list, int, int, bool] and abs(total - 1) < 1e-12
    assert abs(bernoulli(0.25).log_density(True) - math.log(0.25)) < 1e-15
    assert abs(normal(1, 2).log_density(3) - (-0.5 - math.log(2) - 0.5 * math.log(2 * math.pi))) < 1e-12
    assert posterior.to_csv().splitlines()[0].startswith("chain,draw,weight,log_prior,log_likelihood,shares[0],")


def test_errors_name_what_is_wrong():
    def wrong(effect):
        return lambda: (yield effect())

    def fails():
        yield sample("x", normal(0, 1))
        raise KeyError("mine")

    def twice():
        yield sample("x", normal(0, 1))
        yield sample("x", normal(0, 1))

    with pytest.raises(KeyError, match="mine"):
        importance(fails)
    with pytest.raises(TypeError, match="yielded 3, expected sample"):
        smc(wrong(lambda: 3))
    with pytest.raises(TypeError, match="generator function"):
        exact(lambda: 3)
    with pytest.raises(TypeError, match="is no address"):
        importance(wrong(lambda: sample(3, normal(0, 1))))
    with pytest.raises(TypeError):
        importance(wrong(lambda: observe(normal(0, 1), "three")))
    with pytest.raises(edifice.EdificeError, match="two choices are made at the address `x`"):
        importance(twice)
    with pytest.raises(edifice.EdificeError, match="at `x`: the density or the value is not a number"):
        importance(wrong(lambda: sample("x", normal(0, -1))))
    with pytest.raises(edifice.EdificeError, match="infinitely many"):
        exact(schools, EFFECTS, ERRORS)
    with pytest.raises(edifice.EdificeError, match="no run has a positive weight"):
        importance(wrong(lambda: factor(-math.inf)))


def test_arviz(tmp_path):
    arviz = pytest.importorskip("arviz")
    posterior = smc(schools, EFFECTS, ERRORS, count=4000)
    data = posterior.to_arviz()
    assert data.posterior["own"].shape == (1, 4000, 8)
    # Weighted draws are drawn anew, so that plain means are those of the posterior.
    assert abs(float(data.posterior["mean"].mean()) - posterior.mean("mean")) < 0.5
    chains = metropolis(schools, EFFECTS, ERRORS, draws=500)
    (tmp_path / "chains.json").write_text(chains.to_inference_data())
    data = program.read_arviz(tmp_path / "chains.json")
    assert data.posterior["mean"].shape == (4, 500)
    found = {row["name"]: row for row in chains.summary()}
    theirs = arviz.summary(data, var_names=["mean", "spread"], round_to="none")
    for name in ["mean", "spread"]:
        for ours, their in [("mean", "mean"), ("ess_bulk", "ess_bulk"), ("ess_tail", "ess_tail"), ("r_hat", "r_hat"), ("mcse", "mcse_mean")]:
            assert abs(found[name][ours] / theirs.loc[name, their] - 1) < 1e-6, (name, ours)


def test_html():
    page = exact(dice, 5)._repr_html_()
    assert page.startswith("<table>") and "die[0]" in page and "&lt;Posterior of" in page
    network = edifice.Network.from_bif("network n { } variable a { type discrete [ 2 ] { x, y }; } probability ( a ) { table 0.5, 0.5; }")
    assert "<td>x, y</td>" in network._repr_html_()
    json.loads(exact(dice, 5).to_inference_data())


def test_progress(capsys):
    pytest.importorskip("tqdm")
    labels = np.random.default_rng(1).integers(0, 3, (14, 14))
    facade = edifice.Facade.from_array(labels, ["a", "b", "c"])
    quiet, shown = facade.infer(iterations=4000), facade.infer(iterations=4000, progress=True)
    assert quiet == shown and "infer" in capsys.readouterr().err
