"""Density models as scikit-learn estimators. NaN (and ``None``) is a missing value, which is integrated out."""

import numpy as np
from sklearn.base import BaseEstimator, DensityMixin
from sklearn.utils import check_random_state
from sklearn.utils.validation import check_is_fitted, validate_data

from ._native import FittedTable, MixtureModel


def _seed(random_state):
    """A seed for the streams of the library."""
    if isinstance(random_state, (int, np.integer)):
        return int(random_state)
    if random_state is None:
        return 0
    return int(check_random_state(random_state).randint(np.iinfo(np.int32).max))


class GaussianMixture(DensityMixin, BaseEstimator):
    """A Gaussian mixture, whose number of components a criterion chooses.

    Parameters
    ----------
    n_components : int or None
        Number of components; ``None`` for the one of 1 to ``max_components`` that minimizes ``criterion``.
    max_components : int
        Most components where none are given.
    criterion : {"mdl", "bic"}
        Description length (Rissanen 1983), or BIC (Schwarz 1978).
    covariance_type : {"full", "diagonal", "tied"}
        Shape of the covariances.
    n_init : int
        Number of k-means++ starts.
    random_state : int, RandomState or None
        Seed; ``None`` is 0, so that the same data give the same model.
    """

    def __init__(
        self,
        n_components=None,
        *,
        max_components=8,
        criterion="mdl",
        covariance_type="full",
        n_init=5,
        random_state=None,
    ):
        self.n_components = n_components
        self.max_components = max_components
        self.criterion = criterion
        self.covariance_type = covariance_type
        self.n_init = n_init
        self.random_state = random_state

    def __sklearn_tags__(self):
        tags = super().__sklearn_tags__()
        tags.input_tags.allow_nan = True
        return tags

    def _rows(self, X, reset):
        return validate_data(
            self, X, reset=reset, dtype=np.float64, ensure_all_finite="allow-nan", ensure_min_samples=2 if reset else 1
        )

    def fit(self, X, y=None):
        """Fits the mixture to rows."""
        X = self._rows(X, reset=True)
        self.model_ = MixtureModel.fit(
            np.ascontiguousarray(X),
            self.n_components,
            self.max_components,
            self.criterion,
            self.covariance_type,
            self.n_init,
            _seed(self.random_state),
        )
        self.weights_ = self.model_.weights
        self.means_ = self.model_.means
        d = X.shape[1]
        self.covariances_ = self.model_.covariances.reshape(-1, d, d)
        return self

    def score_samples(self, X):
        """Log density of each row, nats."""
        check_is_fitted(self)
        return self.model_.log_density(np.ascontiguousarray(self._rows(X, reset=False)))

    def score(self, X, y=None):
        """Mean log density of the rows, nats."""
        return float(np.mean(self.score_samples(X)))

    def predict_proba(self, X):
        """Probability of each component for each row."""
        check_is_fitted(self)
        return self.model_.posterior(np.ascontiguousarray(self._rows(X, reset=False)))

    def predict(self, X):
        """The most probable component of each row."""
        return self.predict_proba(X).argmax(axis=1)

    def sample(self, n_samples=1, random_state=None):
        """Draws rows."""
        check_is_fitted(self)
        return self.model_.sample(n_samples, _seed(random_state))


def _columns(X):
    """Names and columns of a data frame of any library with the Arrow PyCapsule interface, or ``None`` for arrays."""
    # The columns of a table of pyarrow are no names.
    if hasattr(X, "columns") and hasattr(X, "__getitem__") and not hasattr(X, "column_names"):
        names = [str(name) for name in X.columns]
        return names, [list(X[name]) for name in X.columns]
    if hasattr(X, "__arrow_c_stream__"):
        import pyarrow

        table = pyarrow.table(X)
        return list(table.column_names), [column.to_pylist() for column in table.columns]
    return None


def _text(value):
    """A cell as the library reads it; a missing one is empty."""
    if value is None:
        return ""
    if isinstance(value, (float, np.floating)):
        return "" if np.isnan(value) else repr(float(value))
    if isinstance(value, (bool, np.bool_)):
        return "yes" if value else "no"
    return str(value) if str(value) not in ("<NA>", "NaT", "nan") else ""


class TableModel(DensityMixin, BaseEstimator):
    """The hierarchical model of a table with hidden styles (Fan and Wonka 2016), of numbers, flags and categories.

    Rows are given as an array of numbers, or as a data frame (pandas, polars, or any other that exports Arrow) whose columns may be texts.

    Parameters
    ----------
    min_styles, max_styles : int
        Range of the number of styles (states of the root).
    max_kinds : int
        Most states of the hidden variable of one attribute.
    kinds : dict or None
        ``continuous``, ``binary`` or ``category`` by name of column; the kind of a column that it does not name is ``continuous`` for
        numbers and ``category`` for texts.
    random_state : int, RandomState or None
        Seed; ``None`` is 0, so that the same data give the same model.
    """

    def __init__(self, min_styles=2, max_styles=6, max_kinds=6, kinds=None, random_state=None):
        self.min_styles = min_styles
        self.max_styles = max_styles
        self.max_kinds = max_kinds
        self.kinds = kinds
        self.random_state = random_state

    def __sklearn_tags__(self):
        tags = super().__sklearn_tags__()
        tags.input_tags.allow_nan = True
        return tags

    def _table(self, X, reset):
        """Names, kinds and rows of text cells."""
        found = _columns(X)
        if found is not None:
            names, columns = found
            numeric = [
                all(v is None or isinstance(v, (int, float, np.integer, np.floating)) and not isinstance(v, bool) for v in c)
                for c in columns
            ]
            if not all(numeric):
                if reset:
                    self.n_features_in_ = len(names)
                    self.feature_names_in_ = np.array(names, dtype=object)
                kinds = ["continuous" if n else "category" for n in numeric]
                texts = [[_text(v) for v in column] for column in columns]
                return names, kinds, [list(row) for row in zip(*texts)]
        X = validate_data(
            self, X, reset=reset, dtype=np.float64, ensure_all_finite="allow-nan", ensure_min_samples=2 if reset else 1
        )
        names = list(getattr(self, "feature_names_in_", [f"x{i}" for i in range(X.shape[1])]))
        rows = [[_text(v) for v in row] for row in X]
        return [str(n) for n in names], ["continuous"] * X.shape[1], rows

    def fit(self, X, y=None):
        """Learns structure and parameters from rows."""
        names, kinds, rows = self._table(X, reset=True)
        given = self.kinds or {}
        kinds = [given.get(name, kind) for name, kind in zip(names, kinds)]
        styles = (self.min_styles, self.max_styles)
        self.model_ = FittedTable.learn(names, rows, kinds, styles, self.max_kinds, _seed(self.random_state))
        self.n_styles_ = self.model_.styles
        return self

    def score_samples(self, X):
        """Log density of each row, nats; missing cells are integrated out."""
        check_is_fitted(self)
        names, _, rows = self._table(X, reset=False)
        return self.model_.log_density(names, rows)

    def score(self, X, y=None):
        """Mean log density of the rows, nats."""
        return float(np.mean(self.score_samples(X)))

    def sample(self, n_samples=1, random_state=None):
        """Draws rows: an array where all columns are numbers, otherwise a dictionary of columns."""
        check_is_fitted(self)
        names, rows = self.model_.sample(n_samples, _seed(random_state))
        return self._back(names, rows)

    def complete(self, X, random_state=None):
        """Draws the missing cells of each row given the others."""
        check_is_fitted(self)
        names, _, rows = self._table(X, reset=False)
        return self._back(*self.model_.complete(names, rows, _seed(random_state)))

    @staticmethod
    def _back(names, rows):
        try:
            return np.array([[float(v) if v else np.nan for v in row] for row in rows])
        except ValueError:
            return {name: [row[i] for row in rows] for i, name in enumerate(names)}
