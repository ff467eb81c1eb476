//! `edifice.Grammar`.

use std::path::PathBuf;

use edifice_editing::split_grammar::{Resizing, Wish, derived};
use edifice_grammar::{Costs, evaluate, listing};
use edifice_io::{draw, grammar_cga, grammar_json, read_grammar, write_grammar};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::errors::failed;
use super::facade::Facade;
use super::worker::detached;

/// A split grammar: rules that derive a facade.
#[pyclass(module = "edifice", frozen)]
pub struct Grammar {
    pub inner: edifice_grammar::Grammar,
    pub lower_bound: Option<f64>,
}

impl Grammar {
    fn of(inner: edifice_grammar::Grammar) -> Self {
        Self {
            inner,
            lower_bound: None,
        }
    }
}

#[pymethods]
impl Grammar {
    /// Reads `.grammar.json` or `.cga`.
    #[staticmethod]
    fn read(path: PathBuf) -> PyResult<Self> {
        read_grammar(&path).map(Self::of).map_err(failed)
    }

    /// Reads the text of a grammar file.
    #[staticmethod]
    fn from_json(text: &str) -> PyResult<Self> {
        let found = grammar_json::parse(text.as_bytes(), "grammar.json".as_ref());
        found.map(Self::of).map_err(failed)
    }

    /// Reads CGA text.
    #[staticmethod]
    fn from_cga(text: &str) -> PyResult<Self> {
        grammar_cga::from_str(text).map(Self::of).map_err(failed)
    }

    /// The text of the grammar file; numbers read back to the same bits.
    fn to_json(&self) -> String {
        grammar_json::to_string(&self.inner)
    }

    /// The grammar in CityEngine's syntax.
    fn to_cga(&self) -> String {
        grammar_cga::to_string(&self.inner)
    }

    /// Writes `.grammar.json` or `.cga`: the bytes of the command line.
    fn write(&self, path: PathBuf) -> PyResult<()> {
        write_grammar(&self.inner, &path).map_err(failed)
    }

    /// The rules, one line each.
    #[getter]
    fn rules(&self) -> Vec<String> {
        listing(&self.inner, true)
    }

    /// Cost by Eq. 1 and 2 of Wu et al. 2014, with their costs of operations.
    #[getter]
    fn cost(&self) -> f64 {
        Costs::default().grammar(&self.inner)
    }

    /// No grammar of the facade costs less, as far as `infer` proved it; `None` where it did not, or was not asked.
    #[getter]
    fn lower_bound(&self) -> Option<f64> {
        self.lower_bound
    }

    /// Derives a facade, at its own size or another: the bytes of `edifice grammar derive`.
    #[pyo3(signature = (width = None, height = None, seed = 0, start = 0, align = true))]
    fn derive(
        &self,
        py: Python<'_>,
        width: Option<f64>,
        height: Option<f64>,
        seed: u64,
        start: usize,
        align: bool,
    ) -> PyResult<Facade> {
        let own = self.inner.starts.get(start);
        let own = own.ok_or_else(|| failed(format!("the grammar has no start {start}")))?;
        let size = (width.unwrap_or(own.width), height.unwrap_or(own.height));
        let wish = Wish {
            start,
            size: Some(size),
            seed,
            resizing: match align {
                true => Resizing::Aligned,
                false => Resizing::Rules,
            },
        };
        let grammar = self.inner.clone();
        let made = detached(py, move || derived(&grammar, &wish))?;
        Ok(Facade::plain(made.map_err(failed)?.facade))
    }

    /// Judges the grammar by the facade that it should derive: `derives_back`, `reason`, `cost`, `rules`.
    fn evaluate<'py>(&self, py: Python<'py>, facade: &Facade) -> PyResult<Bound<'py, PyDict>> {
        let costs = Costs::default();
        let (grammar, facades) = (self.inner.clone(), [facade.inner.facade.clone()]);
        let judged = detached(py, move || evaluate(&grammar, &facades, &Costs::default()))?;
        let about = PyDict::new(py);
        about.set_item("derives_back", judged.is_ok())?;
        about.set_item("reason", judged.err().map(|e| e.to_string()))?;
        about.set_item("cost", costs.grammar(&self.inner))?;
        about.set_item("rules", self.inner.rules.len())?;
        Ok(about)
    }

    /// The derivation of the grammar at its own size, drawn as SVG for notebooks; `None` where it derives nothing.
    fn _repr_svg_(&self) -> Option<String> {
        let derived = edifice_grammar::derive(&self.inner, 0).ok()?;
        Some(draw::svg(&derived))
    }

    fn __len__(&self) -> usize {
        self.inner.rules.len()
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.inner == other.inner
    }

    fn __repr__(&self) -> String {
        format!(
            "<Grammar: {} rules, cost {}>",
            self.inner.rules.len(),
            self.cost()
        )
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        let read = py.get_type::<Self>().getattr("from_json")?;
        Ok((read, (self.to_json(),)))
    }
}
