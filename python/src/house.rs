//! `edifice.House`.

use std::path::PathBuf;

use edifice_building_exteriors::attributes::{COLUMNS, attributes};
use edifice_building_exteriors::house::{Joining, model};
use edifice_io::building_json;
use edifice_shape::Building;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use super::arrays::{MeshArrays, mesh};
use super::errors::failed;
use super::html;
use super::worker::detached;

/// A house: boxes with roofs, and pieces of facades with windows and doors; metres.
#[pyclass(module = "edifice", frozen, eq, from_py_object)]
#[derive(Clone, PartialEq)]
pub struct House {
    inner: Building,
}

impl House {
    /// The house of a building.
    pub fn of(inner: Building) -> Self {
        Self { inner }
    }
}

#[pymethods]
impl House {
    /// Reads the houses of `.building.json` or `.buildings.jsonl`.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Vec<Self>> {
        let found = detached(py, move || building_json::read(&path))?.map_err(failed)?;
        Ok(found.into_iter().map(|inner| Self { inner }).collect())
    }

    /// Reads the text of `.building.json`.
    #[staticmethod]
    fn from_json(text: &str) -> PyResult<Self> {
        let found = building_json::parse(text.as_bytes(), "building.json".as_ref());
        found.map(|inner| Self { inner }).map_err(failed)
    }

    /// The text of `.building.json`; numbers read back to the same bits.
    fn to_json(&self) -> PyResult<String> {
        building_json::to_string(&self.inner).map_err(failed)
    }

    /// Writes `.building.json`: the bytes of the command line.
    fn write(&self, path: PathBuf) -> PyResult<()> {
        building_json::write(&self.inner, &path).map_err(failed)
    }

    /// Name of the house.
    #[getter]
    fn name(&self) -> &str {
        &self.inner.name
    }

    /// The attributes of Fan and Wonka 2016, Appendix A, by name; `None` for one that is not observed.
    #[getter]
    fn attributes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let row = attributes(&self.inner).map_err(failed)?;
        let about = PyDict::new(py);
        for (name, value) in COLUMNS.iter().zip(row) {
            about.set_item(name, value)?;
        }
        Ok(about)
    }

    /// The boxes, one dictionary each: `x`, `y`, `width`, `depth`, `height`, the last to the eaves.
    #[getter]
    fn boxes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let list = PyList::empty(py);
        for b in &self.inner.boxes {
            let about = PyDict::new(py);
            let plan = b.plan();
            let numbers = [
                ("x", plan.x),
                ("y", plan.y),
                ("width", plan.width),
                ("depth", plan.height),
                ("height", b.height),
            ];
            for (name, value) in numbers {
                about.set_item(name, value)?;
            }
            list.append(about)?;
        }
        Ok(list)
    }

    /// The closed surface with windows and doors: corners `(n, 3)` in metres, z up, and triangles `(m, 3)`, counterclockwise seen from outside; what
    /// `trimesh.Trimesh(*house.mesh())` takes.
    fn mesh<'py>(&self, py: Python<'py>) -> PyResult<MeshArrays<'py>> {
        let building = self.inner.clone();
        let found = detached(py, move || model(&building, Joining::default()))?;
        let surface = found.map_err(failed)?.surface;
        let triangles = surface.triangles.iter().map(|(corners, _)| *corners);
        mesh(py, &surface.positions, triangles)
    }

    /// The attributes that are observed, as a table, for notebooks.
    fn _repr_html_(&self) -> PyResult<String> {
        let row = attributes(&self.inner).map_err(failed)?;
        let found = COLUMNS.iter().zip(row);
        let found = found.filter_map(|(name, value)| {
            let value = value?;
            Some(((*name).to_string(), vec![format!("{value:.3}")]))
        });
        let rows: Vec<_> = found.collect();
        Ok(html::table(&self.__repr__(), &["value"], &rows))
    }

    fn __repr__(&self) -> String {
        format!(
            "<House {:?}: {} boxes, {} facades>",
            self.inner.name,
            self.inner.boxes.len(),
            self.inner.facades.len()
        )
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        let read = py.get_type::<Self>().getattr("from_json")?;
        Ok((read, (self.to_json()?,)))
    }
}
