//! `edifice.HouseModel`.

use std::path::PathBuf;
use std::sync::Arc;

use edifice_building_exteriors::house::Options;
use edifice_building_exteriors::model_file::ModelFile;
use edifice_editing::building_exteriors::draws::{Draws, ordered};
use edifice_editing::building_exteriors::redraws::{Redraws, houses};
use edifice_editing::building_exteriors::{shipped_database, shipped_model};
use edifice_io::read_bytes;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::errors::failed;
use super::house::House;
use super::worker::watched;

/// A learned model of houses (Fan and Wonka 2016): a hierarchy of Gaussians over 49 attributes.
#[pyclass(module = "edifice", frozen)]
pub struct HouseModel {
    inner: Arc<ModelFile>,
}

#[pymethods]
impl HouseModel {
    /// The model that ships.
    #[staticmethod]
    fn shipped() -> PyResult<Self> {
        let inner = Arc::new(shipped_model().map_err(failed)?.clone());
        Ok(Self { inner })
    }

    /// Reads `*.houses.json`, which `edifice building learn` writes.
    #[staticmethod]
    fn read(path: PathBuf) -> PyResult<Self> {
        let bytes = read_bytes(&path).map_err(failed)?;
        let wrong = |e: String| failed(format!("{}: {e}", path.display()));
        let text = String::from_utf8(bytes).map_err(|e| wrong(e.to_string()))?;
        let inner = ModelFile::from_json(&text).map_err(|e| wrong(e.to_string()))?;
        Ok(Self {
            inner: Arc::new(inner),
        })
    }

    /// Reads the text of `*.houses.json`.
    #[staticmethod]
    fn from_json(text: &str) -> PyResult<Self> {
        let inner = ModelFile::from_json(text).map_err(failed)?;
        Ok(Self {
            inner: Arc::new(inner),
        })
    }

    /// The text of `*.houses.json`.
    fn to_json(&self) -> PyResult<String> {
        self.inner.to_json().map_err(failed)
    }

    /// Number of styles.
    #[getter]
    fn styles(&self) -> usize {
        self.inner.styles()
    }

    /// The attributes that `given` may name, each with its columns, which it may name as well.
    #[getter]
    fn attributes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let about = PyDict::new(py);
        for group in self.inner.attributes() {
            about.set_item(group.name, group.columns)?;
        }
        Ok(about)
    }

    /// Draws houses; the same seed gives the bytes of `edifice building generate`. `given` maps a column or an attribute to its value: a number, a truth
    /// value, a text (`none`: all zero), or a list with a value for each column of an attribute. `style` draws from one style only, the first is 1;
    /// `most_probable` draws many and keeps the most probable that differ. Samples that no house can have, or whose houses miss them or are not believable, are drawn anew, unless `untruncated`. `progress` shows a bar of tqdm.
    #[pyo3(signature = (given = None, count = 10, seed = 1, style = None, most_probable = false, untruncated = false, progress = false))]
    #[expect(clippy::too_many_arguments, reason = "keywords in Python")]
    fn generate(
        &self,
        py: Python<'_>,
        given: Option<&Bound<'_, PyDict>>,
        count: usize,
        seed: u64,
        style: Option<usize>,
        most_probable: bool,
        untruncated: bool,
        progress: bool,
    ) -> PyResult<Vec<House>> {
        let given = given.map_or(Ok(Vec::new()), evidence)?;
        if style.is_some() && (most_probable || !given.is_empty()) {
            return Err(failed(
                "style stands alone: neither given nor most_probable",
            ));
        }
        let draws = Draws {
            given,
            style,
            count,
            most_probable,
            untruncated,
            seed,
        };
        let model = Arc::clone(&self.inner);
        let bar = progress.then_some("generate");
        let made = watched(py, bar, move |watch| {
            let database = shipped_database()?;
            let drawn = ordered(&model, &draws, None, database)?;
            let redraws = Redraws::new(&model, &draws, database, false);
            let options = Options::default();
            houses(
                &drawn.orders,
                database,
                &options,
                seed,
                redraws.as_ref(),
                watch,
            )
        })?;
        let made = made.map_err(failed)?;
        Ok(made.into_iter().map(|h| House::of(h.building)).collect())
    }

    fn __repr__(&self) -> String {
        format!("<HouseModel: {} styles>", self.inner.styles())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        let read = py.get_type::<Self>().getattr("from_json")?;
        Ok((read, (self.to_json()?,)))
    }
}

/// Evidence in words, in the order of the dictionary.
fn evidence(given: &Bound<'_, PyDict>) -> PyResult<Vec<String>> {
    let word = |(name, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
        let name: String = name.extract()?;
        let value = match value.extract::<Vec<Bound<'_, PyAny>>>() {
            Ok(values) if !value.is_instance_of::<pyo3::types::PyString>() => {
                let values = values.iter().map(|v| written(&name, v));
                values.collect::<PyResult<Vec<_>>>()?.join(",")
            }
            _ => written(&name, &value)?,
        };
        Ok(format!("{name}={value}"))
    };
    given.iter().map(word).collect()
}

/// A value as on the command line.
fn written(name: &str, value: &Bound<'_, PyAny>) -> PyResult<String> {
    if let Ok(text) = value.extract::<String>() {
        return Ok(text);
    }
    if let Ok(truth) = value.extract::<bool>() {
        return Ok(u8::from(truth).to_string());
    }
    let number = value.extract::<f64>();
    let number =
        number.map_err(|_| failed(format!("{name}: {value} is no number, truth value or text")))?;
    Ok(number.to_string())
}
