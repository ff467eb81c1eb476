//! The native part of `edifice.TableModel`.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::Ordering;

use edifice_base::rng::stream;
use edifice_model::hierarchy::{Constant, Settings};
use edifice_model::tables::compare::BACKGROUND;
use edifice_model::tables::schema::{Kind, Schema, SchemaGroup};
use edifice_model::tables::table_model::TableModel;
use edifice_model::{Cell, ModelError, Table};
use numpy::PyArray1;
use pyo3::prelude::*;

use super::errors::failed;
use super::worker::{Stop, detached};

/// A learned hierarchical model of a table (Fan and Wonka 2016).
#[pyclass(module = "edifice._native", frozen)]
pub struct FittedTable {
    inner: Arc<TableModel>,
}

#[pymethods]
impl FittedTable {
    /// Learns from rows of text cells as `edifice model learn` does; an empty cell is missing. `kinds` names the kind of each column
    /// (`continuous`, `binary`, `category`); without it kinds are guessed.
    #[staticmethod]
    #[pyo3(signature = (header, rows, kinds, styles, most_kinds, seed))]
    fn learn(
        py: Python<'_>,
        header: Vec<String>,
        rows: Vec<Vec<String>>,
        kinds: Option<Vec<String>>,
        styles: (usize, usize),
        most_kinds: usize,
        seed: u64,
    ) -> PyResult<Self> {
        let schema = match kinds {
            None => Schema::guess(&header, &rows).map_err(failed)?,
            Some(kinds) => {
                let group = |(name, kind): (&String, &String)| {
                    Ok(SchemaGroup {
                        name: name.clone(),
                        kind: match kind.as_str() {
                            "continuous" => Kind::Continuous,
                            "binary" => Kind::Binary,
                            "category" => Kind::Category,
                            other => {
                                return Err(failed(format!(
                                    "kind of {name} is {other:?}, expected continuous, binary or category"
                                )));
                            }
                        },
                        columns: vec![name.clone()],
                    })
                };
                let groups = header.iter().zip(&kinds).map(group);
                Schema {
                    keep: Default::default(),
                    missing: vec![String::new()],
                    groups: groups.collect::<PyResult<_>>()?,
                    relations: None,
                }
            }
        };
        let data = schema.read(&header, &rows).map_err(failed)?;
        let settings = Settings {
            styles: styles.0..=styles.1,
            most_states: most_kinds,
            constant: Constant::Keep,
            background: BACKGROUND,
            ..Settings::default()
        };
        let stop = Stop(Arc::default());
        let stopped = Arc::clone(&stop.0);
        let found = detached(py, move || {
            let observer = |_: Option<&_>| match stopped.load(Ordering::Relaxed) {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            };
            TableModel::learn(&data, &schema, &settings, seed, &observer)
        })?;
        drop(stop);
        Ok(Self {
            inner: Arc::new(found.map_err(failed)?.model),
        })
    }

    /// Log density of each row, nats; missing values are integrated out.
    fn log_density<'py>(
        &self,
        py: Python<'py>,
        header: Vec<String>,
        rows: Vec<Vec<String>>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let data = self.rows(&header, &rows)?;
        let model = Arc::clone(&self.inner);
        let found = detached(py, move || model.log_likelihood(&data))?;
        Ok(PyArray1::from_vec(py, found.map_err(failed)?))
    }

    /// Draws rows of text cells, and the names of their columns.
    fn sample(&self, py: Python<'_>, count: usize, seed: u64) -> PyResult<Texts> {
        let model = Arc::clone(&self.inner);
        let found = detached(py, move || {
            let mut rng = stream(seed, "model/sample", 0);
            Ok::<_, ModelError>(texts(&model.sample(count, &mut rng)?))
        })?;
        found.map_err(failed)
    }

    /// Completes each row once: missing cells are drawn given the others.
    fn complete(
        &self,
        py: Python<'_>,
        header: Vec<String>,
        rows: Vec<Vec<String>>,
        seed: u64,
    ) -> PyResult<Texts> {
        let data = self.rows(&header, &rows)?;
        let model = Arc::clone(&self.inner);
        let stop = Stop(Arc::default());
        let stopped = Arc::clone(&stop.0);
        let found = detached(py, move || {
            let (mut names, mut completed) = (Vec::new(), Vec::new());
            for row in 0..data.rows() {
                if stopped.load(Ordering::Relaxed) {
                    break;
                }
                let mut rng = stream(seed, "model/complete", row as u64);
                let draws = model.complete(&data.select(&[row]), 1, &mut rng);
                let draws = draws.map_err(|e| e.in_row(row))?;
                let (header, drawn) = texts(&draws);
                names = header;
                completed.extend(drawn);
            }
            Ok::<_, ModelError>((names, completed))
        })?;
        drop(stop);
        found.map_err(failed)
    }

    /// Number of styles.
    #[getter]
    fn styles(&self) -> usize {
        self.inner.model.styles()
    }

    /// The text of `*.table-model.json`.
    fn to_json(&self) -> PyResult<String> {
        self.inner.to_json().map_err(failed)
    }

    /// Reads the text of `*.table-model.json`.
    #[staticmethod]
    fn from_json(text: &str) -> PyResult<Self> {
        let inner = TableModel::from_json(text).map_err(failed)?;
        Ok(Self {
            inner: Arc::new(inner),
        })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        let read = py.get_type::<Self>().getattr("from_json")?;
        Ok((read, (self.to_json()?,)))
    }
}

impl FittedTable {
    /// A table as the model's schema reads it; columns that it lacks are missing.
    fn rows(&self, header: &[String], rows: &[Vec<String>]) -> PyResult<Table> {
        let mut schema = self.inner.schema.clone();
        for group in &mut schema.groups {
            group.columns.retain(|column| header.contains(column));
        }
        schema.groups.retain(|group| !group.columns.is_empty());
        if schema.groups.is_empty() {
            return Err(failed("the table has none of the model's columns"));
        }
        Ok(schema.read(header, rows).map_err(failed)?.table)
    }
}

/// Names of columns, and cells as text.
type Texts = (Vec<String>, Vec<Vec<String>>);

/// Names of the columns and the cells as text, missing ones empty.
fn texts(table: &Table) -> Texts {
    let names = table.columns().iter().map(|c| c.name().to_owned());
    let cell = |column: &edifice_model::Column, row: usize| match column.cell(row) {
        Cell::Missing => String::new(),
        Cell::Real(value) => value.to_string(),
        Cell::Code(code) => match column.categories() {
            Some(categories) => categories.get(code).cloned().unwrap_or_default(),
            None => code.to_string(),
        },
    };
    let row = |row| table.columns().iter().map(|c| cell(c, row)).collect();
    (names.collect(), (0..table.rows()).map(row).collect())
}
