//! `edifice.Logic`.

use std::sync::Arc;

use edifice_procedural_logic::{Measure, Model, Parameters};
use edifice_shape::{Facade as Layout, LabelGrid};
use numpy::PyArray2;
use pyo3::prelude::*;

use super::errors::failed;
use super::facade::Facade;
use super::worker::detached;

/// The procedural logic of facades (Weissenberg et al. 2013): split rules that they share, whatever their sizes.
#[pyclass(module = "edifice", frozen)]
pub struct Logic {
    inner: Arc<Model>,
}

/// Tilings as pictures of labels.
fn grids(facades: &[PyRef<'_, Facade>]) -> PyResult<Vec<LabelGrid>> {
    let grid = |facade: &PyRef<'_, Facade>| {
        let layout: &Layout = &facade.inner.facade;
        let made = LabelGrid::from_facade(layout, None);
        made.map_err(|e| failed(format!("{}: {e}", layout.name)))
    };
    facades.iter().map(grid).collect()
}

#[pymethods]
impl Logic {
    /// Learns affinities and rules from tilings, with the parameters of Sec. 5.4 unless others are given.
    #[staticmethod]
    #[pyo3(signature = (facades, alpha = None, parental_bias = None, horizontal_bias = None))]
    fn fit(
        py: Python<'_>,
        facades: Vec<PyRef<'_, Facade>>,
        alpha: Option<f64>,
        parental_bias: Option<f64>,
        horizontal_bias: Option<f64>,
    ) -> PyResult<Self> {
        let printed = Parameters::RETRIEVAL;
        let parameters = Parameters::new(
            alpha.unwrap_or(printed.alpha),
            parental_bias.unwrap_or(printed.parental_bias),
            horizontal_bias.unwrap_or(printed.horizontal_bias),
        );
        let parameters = parameters.map_err(failed)?;
        let grids = grids(&facades)?;
        let found = detached(py, move || Model::fit(&grids, parameters))?;
        let inner = Arc::new(found.map_err(failed)?);
        Ok(Self { inner })
    }

    /// Names of the facades, in order.
    #[getter]
    fn facades(&self) -> Vec<String> {
        self.inner.facades.iter().map(|f| f.name.clone()).collect()
    }

    /// The layout that the rules and parameters of a facade derive.
    fn derive(&self, index: usize) -> PyResult<Facade> {
        let known = self.inner.facades.get(index);
        let count = self.inner.facades.len();
        let known =
            known.ok_or_else(|| failed(format!("there is no facade {index}, of {count}")))?;
        self.inner.layout(known).map(Facade::plain).map_err(failed)
    }

    /// Distances between all facades, `(n, n)`: `powerset`, `common_rules`, `all_rules` or `rule_union` (Sec. 4.3), or `lattice`.
    #[pyo3(signature = (measure = "powerset"))]
    fn distances<'py>(
        &self,
        py: Python<'py>,
        measure: &str,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let known = Measure::ALL.into_iter().find(|m| m.name() == measure);
        let measure = known.ok_or_else(|| {
            let names = Measure::ALL.map(Measure::name).join(", ");
            failed(format!("unknown measure {measure:?}, expected {names}"))
        })?;
        let model = Arc::clone(&self.inner);
        let found = detached(py, move || model.profiles().map(|p| measure.matrix(&p)))?;
        let found = found.map_err(failed)?;
        let row = |i: usize| found.row(i).iter().copied().collect::<Vec<f64>>();
        let rows: Vec<Vec<f64>> = (0..found.nrows()).map(row).collect();
        PyArray2::from_vec2(py, &rows).map_err(failed)
    }

    /// Number of rules.
    fn __len__(&self) -> usize {
        self.inner.inference.rules.len()
    }

    fn __repr__(&self) -> String {
        format!(
            "<Logic of {} facades: {} rules>",
            self.inner.facades.len(),
            self.inner.inference.rules.len()
        )
    }
}
