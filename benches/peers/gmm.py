"""Gaussian mixtures: scikit-learn on the data and from the starts that `cargo bench --bench model`
(or `cargo run --release --example model_peers`) wrote. Prints one line a case: seconds of the fit
(median of the repeats), rounds, total log-likelihood.

    python benches/peers/gmm.py FOLDER
"""
import json
import statistics
import sys
import time
import warnings
from pathlib import Path

import numpy as np
import sklearn
from sklearn.mixture import GaussianMixture

warnings.filterwarnings("ignore")
folder = Path(sys.argv[1])
print("scikit-learn", sklearn.__version__, "numpy", np.__version__)
for case in sorted(folder.glob("gmm_*.json")):
    spec = json.loads(case.read_text())
    n, d, k = spec["rows"], spec["columns"], spec["components"]
    x = np.fromfile(folder / spec["data"], dtype="<f8").reshape(n, d)
    means = np.array(spec["means"]).reshape(k, d)
    precisions = np.array([np.linalg.inv(np.array(c).reshape(d, d)) for c in spec["covariances"]])
    times = []
    for _ in range(spec["repeats"]):
        model = GaussianMixture(
            k,
            covariance_type="full",
            tol=spec["gain"] / n,
            reg_covar=1e-6,
            max_iter=spec["max_rounds"],
            weights_init=np.array(spec["weights"]),
            means_init=means,
            precisions_init=precisions,
        )
        start = time.perf_counter()
        model.fit(x)
        times.append(time.perf_counter() - start)
    total = model.score(x) * n
    print(f"{case.stem} seconds {statistics.median(times):.4f} rounds {model.n_iter_} log_likelihood {total:.6f}")
