//! `edifice.Network`.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use edifice_model::ModelError;
use edifice_model::network::{self, Evidence};
use pyo3::prelude::*;

use super::errors::failed;
use super::html;
use super::worker::detached;

/// A Bayesian network of discrete variables.
#[pyclass(module = "edifice", frozen)]
pub struct Network {
    inner: Arc<network::Network>,
}

fn evidence(given: Option<BTreeMap<String, String>>) -> Evidence {
    let given = given.unwrap_or_default();
    let mut evidence = Evidence::new();
    for (name, category) in &given {
        evidence = evidence.is(name, category);
    }
    evidence
}

#[pymethods]
impl Network {
    /// Reads a network in the interchange format (BIF).
    #[staticmethod]
    fn from_bif(text: &str) -> PyResult<Self> {
        let inner = Arc::new(network::Network::from_bif(text).map_err(failed)?);
        Ok(Self { inner })
    }

    /// Reads a BIF file.
    #[staticmethod]
    fn read(path: PathBuf) -> PyResult<Self> {
        let bytes = edifice_io::read_bytes(&path).map_err(failed)?;
        let text = String::from_utf8(bytes).map_err(failed)?;
        let inner = network::Network::from_bif(&text)
            .map_err(|e| failed(format!("{}: {e}", path.display())))?;
        Ok(Self {
            inner: Arc::new(inner),
        })
    }

    /// The network in BIF.
    fn to_bif(&self) -> PyResult<String> {
        self.inner.to_bif().map_err(failed)
    }

    /// Names of the variables.
    #[getter]
    fn variables(&self) -> Vec<String> {
        self.inner.names().map(str::to_owned).collect()
    }

    /// Categories of a variable.
    fn categories(&self, name: &str) -> PyResult<Vec<String>> {
        let found = self.inner.categories(name).map_err(failed)?;
        Ok(found.to_vec())
    }

    /// Parents of a variable.
    fn parents(&self, name: &str) -> PyResult<Vec<String>> {
        let found = self.inner.parents(name).map_err(failed)?;
        Ok(found.into_iter().map(str::to_owned).collect())
    }

    /// Probability of each category of a variable, given the categories of others.
    #[pyo3(signature = (name, given = None))]
    fn query(
        &self,
        py: Python<'_>,
        name: String,
        given: Option<BTreeMap<String, String>>,
    ) -> PyResult<BTreeMap<String, f64>> {
        let (network, evidence) = (Arc::clone(&self.inner), evidence(given));
        let found = detached(py, move || {
            let found = network.marginal(&evidence, &name)?;
            let categories = network.categories(&name)?.iter().cloned();
            Ok::<_, ModelError>(categories.zip(found).collect())
        })?;
        found.map_err(failed)
    }

    /// Log probability of what is given, nats.
    fn log_probability(&self, py: Python<'_>, given: BTreeMap<String, String>) -> PyResult<f64> {
        let (network, evidence) = (Arc::clone(&self.inner), evidence(Some(given)));
        detached(py, move || network.log_probability(&evidence))?.map_err(failed)
    }

    /// The most probable category of all variables together, given those of some.
    #[pyo3(signature = (given = None))]
    fn explain(
        &self,
        py: Python<'_>,
        given: Option<BTreeMap<String, String>>,
    ) -> PyResult<BTreeMap<String, String>> {
        let (network, evidence) = (Arc::clone(&self.inner), evidence(given));
        let found = detached(py, move || network.explain(&evidence))?;
        Ok(found.map_err(failed)?.values.into_iter().collect())
    }

    /// Variables, their parents and categories as a table, for notebooks.
    fn _repr_html_(&self) -> PyResult<String> {
        let mut rows = Vec::new();
        for name in self.inner.names() {
            let parents = self.inner.parents(name).map_err(failed)?.join(", ");
            let categories = self.inner.categories(name).map_err(failed)?.join(", ");
            rows.push((name.to_owned(), vec![parents, categories]));
        }
        Ok(html::table(
            &self.__repr__(),
            &["parents", "categories"],
            &rows,
        ))
    }

    fn __len__(&self) -> usize {
        self.inner.names().count()
    }

    fn __repr__(&self) -> String {
        format!("<Network of {} variables>", self.inner.names().count())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        let read = py.get_type::<Self>().getattr("from_bif")?;
        Ok((read, (self.to_bif()?,)))
    }
}
