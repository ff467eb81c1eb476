//! The native part of `edifice.GaussianMixture`.

use edifice_base::rng::stream;
use edifice_model::gmm::{self, Covariance, Criterion, Mixture, Points, fit, select};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;

use super::errors::failed;
use super::worker::detached;

/// A fitted Gaussian mixture.
#[pyclass(module = "edifice._native", frozen)]
pub struct MixtureModel {
    inner: Mixture,
    /// Mean log likelihood of the rows that it was fitted to, nats.
    #[pyo3(get)]
    mean_log_likelihood: f64,
}

/// The values of an array row by row, and the number of its columns.
fn values(rows: &PyReadonlyArray2<'_, f64>) -> (Vec<f64>, usize) {
    let view = rows.as_array();
    (view.iter().copied().collect(), view.ncols())
}

/// Rows where NaN stands for a missing value.
fn points(d: usize, values: &[f64]) -> Result<Points<'_>, edifice_model::ModelError> {
    match values.iter().any(|v| v.is_nan()) {
        true => Points::with_missing(d, values),
        false => Points::new(d, values),
    }
}

#[pymethods]
impl MixtureModel {
    /// Fits `components` Gaussians, or as many of 1 to `most` as minimize a criterion (`mdl` or `bic`). NaN is a missing value.
    #[staticmethod]
    #[allow(clippy::too_many_arguments)]
    #[pyo3(signature = (rows, components, most, criterion, covariance, restarts, seed))]
    fn fit(
        py: Python<'_>,
        rows: PyReadonlyArray2<'_, f64>,
        components: Option<usize>,
        most: usize,
        criterion: &str,
        covariance: &str,
        restarts: usize,
        seed: u64,
    ) -> PyResult<Self> {
        let (values, d) = values(&rows);
        let criterion = match criterion {
            "mdl" => Criterion::Mdl,
            "bic" => Criterion::Bic,
            other => {
                return Err(failed(format!(
                    "criterion is {other:?}, expected mdl or bic"
                )));
            }
        };
        let settings = gmm::Settings {
            covariance: match covariance {
                "full" => Covariance::Full,
                "diagonal" => Covariance::Diagonal,
                "tied" => Covariance::Tied,
                other => {
                    return Err(failed(format!(
                        "covariance is {other:?}, expected full, diagonal or tied"
                    )));
                }
            },
            restarts,
            ..gmm::Settings::default()
        };
        let found = detached(py, move || {
            let points = points(d, &values).map_err(|e| e.to_string())?;
            let fitted = match components {
                Some(k) => fit(&points, k, &settings, &mut stream(seed, "gmm", k as u64)),
                None => select(&points, most, criterion, &settings, seed).map(|s| s.fitted),
            };
            let fitted = fitted.map_err(|e| e.to_string())?;
            let mean = fitted.log_likelihood / points.len().max(1) as f64;
            Ok::<_, String>((fitted.mixture, mean))
        })?;
        let (inner, mean_log_likelihood) = found.map_err(failed)?;
        Ok(Self {
            inner,
            mean_log_likelihood,
        })
    }

    /// Log density of each row, nats; missing values are integrated out.
    fn log_density<'py>(
        &self,
        py: Python<'py>,
        rows: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let (values, d) = values(&rows);
        let mixture = self.inner.clone();
        let found = detached(py, move || {
            let points = points(d, &values).map_err(|e| e.to_string())?;
            mixture.log_density(&points).map_err(|e| e.to_string())
        })?;
        Ok(PyArray1::from_vec(py, found.map_err(failed)?))
    }

    /// Probability of each component for each row.
    fn posterior<'py>(
        &self,
        py: Python<'py>,
        rows: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let (values, d) = values(&rows);
        let mixture = self.inner.clone();
        let found = detached(py, move || {
            let points = points(d, &values).map_err(|e| e.to_string())?;
            mixture.posterior(&points).map_err(|e| e.to_string())
        })?;
        PyArray2::from_vec2(py, &found.map_err(failed)?).map_err(failed)
    }

    /// Draws rows.
    fn sample<'py>(
        &self,
        py: Python<'py>,
        count: usize,
        seed: u64,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let mixture = self.inner.clone();
        let drawn = detached(py, move || {
            mixture.sample(count, &mut stream(seed, "gmm sample", 0))
        })?;
        let d = self.inner.dimension();
        PyArray1::from_vec(py, drawn).reshape([count, d])
    }

    /// Weights of the components.
    #[getter]
    fn weights<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.inner.weights())
    }

    /// Mean of each component.
    #[getter]
    fn means<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let rows = (0..self.inner.components()).map(|k| self.inner.mean(k).to_vec());
        PyArray2::from_vec2(py, &rows.collect::<Vec<_>>()).map_err(failed)
    }

    /// Covariance of each component, row by row.
    #[getter]
    fn covariances<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let rows = (0..self.inner.components()).map(|k| self.inner.covariance(k).to_vec());
        PyArray2::from_vec2(py, &rows.collect::<Vec<_>>()).map_err(failed)
    }

    /// A mixture of given weights, means and covariances (row by row).
    #[staticmethod]
    fn restored(
        weights: Vec<f64>,
        means: Vec<Vec<f64>>,
        covariances: Vec<Vec<f64>>,
        mean_log_likelihood: f64,
    ) -> PyResult<Self> {
        let d = means.first().map_or(0, Vec::len);
        let (means, covariances) = (means.concat(), covariances.concat());
        let inner = Mixture::new(d, Covariance::Full, weights, means, covariances);
        let inner = inner.map_err(failed)?;
        Ok(Self {
            inner,
            mean_log_likelihood,
        })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Restored)> {
        let read = py.get_type::<Self>().getattr("restored")?;
        let all = 0..self.inner.components();
        let state = (
            self.inner.weights().to_vec(),
            all.clone().map(|k| self.inner.mean(k).to_vec()).collect(),
            all.map(|k| self.inner.covariance(k).to_vec()).collect(),
            self.mean_log_likelihood,
        );
        Ok((read, state))
    }
}

/// Weights, means, covariances, mean log likelihood.
type Restored = (Vec<f64>, Vec<Vec<f64>>, Vec<Vec<f64>>, f64);
