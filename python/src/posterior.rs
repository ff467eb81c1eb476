//! `edifice.program.Posterior`.

use edifice_model::program;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use super::errors::failed;
use super::html;
use super::program::{Returned, address};

/// The posterior distribution of a program as an engine found it.
#[pyclass(module = "edifice.program", frozen)]
pub struct Posterior {
    inner: program::Posterior<Returned>,
}

impl Posterior {
    pub fn of(inner: program::Posterior<Returned>) -> Self {
        Self { inner }
    }
}

#[pymethods]
impl Posterior {
    /// Log evidence, nats; `None` from chains, which do not know it.
    #[getter]
    fn log_evidence(&self) -> Option<f64> {
        self.inner.evidence.map(|e| e.log)
    }

    /// Standard error of the log evidence, nats.
    #[getter]
    fn log_evidence_error(&self) -> Option<f64> {
        self.inner.evidence.map(|e| e.error)
    }

    /// Pareto's k of importance weights; above 0.7 the draws are not to be trusted.
    #[getter]
    fn pareto_k(&self) -> Option<f64> {
        self.inner.pareto_k
    }

    /// Share of proposals that chains accepted.
    #[getter]
    fn acceptance(&self) -> Option<f64> {
        self.inner.acceptance
    }

    /// Effective number of draws by their weights.
    #[getter]
    fn ess(&self) -> f64 {
        self.inner.ess()
    }

    /// Number of chains; 1 of weighted draws.
    #[getter]
    fn chains(&self) -> usize {
        self.inner.chains()
    }

    /// Weight of each draw; they sum to 1.
    #[getter]
    fn weights<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let weights = self.inner.draws.iter().map(|d| d.log_weight.exp());
        PyArray1::from_vec(py, weights.collect())
    }

    /// The value that the program returned in each draw.
    #[getter]
    fn returned<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let out = |d: &program::Draw<Returned>| d.out.as_ref().map(|out| out.clone_ref(py));
        PyList::new(py, self.inner.draws.iter().map(out))
    }

    /// The number chosen at an address in each draw; an error where a draw has none.
    fn numbers<'py>(
        &self,
        py: Python<'py>,
        at: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let found = self.inner.numbers(address(at)?);
        let found = found.ok_or_else(|| failed(format!("not every draw has a choice at {at}")))?;
        Ok(PyArray1::from_vec(py, found))
    }

    /// Posterior mean of the number at an address.
    fn mean(&self, at: &Bound<'_, PyAny>) -> PyResult<f64> {
        let found = self.inner.mean(address(at)?);
        found.ok_or_else(|| failed(format!("not every draw has a choice at {at}")))
    }

    /// Posterior probability that the choice at an address is this whole number, and its Monte Carlo standard error.
    fn probability(&self, at: &Bound<'_, PyAny>, value: u64) -> PyResult<(f64, f64)> {
        let found = self.inner.probability(address(at)?, value);
        Ok((found.mean, found.error))
    }

    /// One dictionary for each choice: `name, mean, sd, mcse, ess_bulk, ess_tail, r_hat`.
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let list = PyList::empty(py);
        for one in self.inner.summary() {
            let row = PyDict::new(py);
            row.set_item("name", one.name)?;
            for (name, value) in [
                ("mean", one.mean),
                ("sd", one.sd),
                ("mcse", one.mcse),
                ("ess_bulk", one.ess_bulk),
                ("ess_tail", one.ess_tail),
                ("r_hat", one.r_hat),
            ] {
                row.set_item(name, value)?;
            }
            list.append(row)?;
        }
        Ok(list)
    }

    /// The estimates beside those of an exact posterior of the same program: `name, estimate, mcse, truth, error`.
    fn beside<'py>(&self, py: Python<'py>, truth: &Self) -> PyResult<Bound<'py, PyList>> {
        let list = PyList::empty(py);
        for one in self.inner.beside(&truth.inner) {
            let row = PyDict::new(py);
            row.set_item("name", &one.name)?;
            row.set_item("estimate", one.estimate.mean)?;
            row.set_item("mcse", one.estimate.error)?;
            row.set_item("truth", one.truth)?;
            row.set_item("error", one.error())?;
            list.append(row)?;
        }
        Ok(list)
    }

    /// The draws as CSV: `chain,draw,weight,log_prior,log_likelihood` and a column for each number that was chosen.
    fn to_csv(&self) -> String {
        self.inner.to_csv()
    }

    /// The draws as the JSON of ArviZ's `InferenceData`, with the logarithm of each draw's weight.
    fn to_inference_data(&self) -> String {
        self.inner.to_inference_data()
    }

    /// The draws as ArviZ's `InferenceData`. Weighted draws are drawn anew in proportion to their weights, as many of them, by the
    /// seed, since ArviZ knows no weights.
    #[pyo3(signature = (seed = 1))]
    fn to_arviz<'py>(&self, py: Python<'py>, seed: u64) -> PyResult<Bound<'py, PyAny>> {
        let module = py.import("edifice.program")?;
        module.call_method1("_to_arviz", (self.to_inference_data(), seed))
    }

    /// The summary as a table, for notebooks.
    fn _repr_html_(&self) -> String {
        let cell = |x: f64| {
            if x.is_nan() {
                "–".into()
            } else {
                format!("{x:.4}")
            }
        };
        let row = |s: &program::Summary| {
            let numbers = [s.mean, s.sd, s.mcse, s.ess_bulk, s.ess_tail, s.r_hat].map(cell);
            (s.name.clone(), numbers.to_vec())
        };
        let rows: Vec<_> = self.inner.summary().iter().map(row).collect();
        let names = ["mean", "sd", "mcse", "ess_bulk", "ess_tail", "r_hat"];
        html::table(&self.__repr__(), &names, &rows)
    }

    fn __len__(&self) -> usize {
        self.inner.draws.len()
    }

    fn __repr__(&self) -> String {
        let n = self.inner.draws.len();
        let evidence = self
            .inner
            .evidence
            .map(|e| format!(", log evidence {:.4} ± {:.4}", e.log, e.error));
        match self.inner.chains() {
            1 => format!(
                "<Posterior of {n} draws, {:.1} effective{}>",
                self.inner.ess(),
                evidence.unwrap_or_default()
            ),
            chains => format!("<Posterior of {chains} chains, {n} draws>"),
        }
    }
}
