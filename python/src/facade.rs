//! `edifice.Facade`.

use std::path::PathBuf;

use edifice_editing::structure_completion as completing;
use edifice_editing::structure_completion::hiding::hide;
use edifice_facade_grammar::{Method, Operations, Settings, infer};
use edifice_grammar::Costs;
use edifice_io::{
    ReadOptions, draw, facade_json, read_bytes, read_source, write_atomic, write_facade,
};
use edifice_shape::{AnnotatedFacade, LabelGrid, Rect, Region, decompose, elements_of_facade};
use edifice_structure_completion::method;
use edifice_structure_completion::sights::Sight;
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use super::comparison::comparison;
use super::errors::failed;
use super::grammar::Grammar;
use super::worker::{detached, watched};

/// A facade: labelled rectangles in an outline, origin at the lower left, y up.
///
/// A tiling covers the outline without gaps or overlaps (what `infer` needs); a layout of elements lists windows, doors, ... on a wall (what `complete`
/// needs). The unit of all lengths is `unit`.
#[pyclass(module = "edifice", frozen, eq, from_py_object)]
#[derive(Clone, PartialEq)]
pub struct Facade {
    pub inner: AnnotatedFacade,
}

impl Facade {
    pub fn plain(facade: edifice_shape::Facade) -> Self {
        Self {
            inner: AnnotatedFacade::plain(facade),
        }
    }

    /// The facade as the commands on layouts of elements read it.
    fn annotated(&self) -> PyResult<AnnotatedFacade> {
        let text = self.to_json();
        let source = edifice_io::Source::Layout(self.inner.facade.clone());
        let path = PathBuf::from(format!("{}.facade.json", self.inner.facade.name));
        completing::annotated(source, text.as_bytes(), &path).map_err(failed)
    }
}

#[pymethods]
impl Facade {
    /// A tiling from a picture of labels: `labels[row, column]` is an index into `names`, row 0 at the top.
    #[staticmethod]
    #[pyo3(signature = (labels, names, name = "facade"))]
    fn from_array(
        py: Python<'_>,
        labels: PyReadonlyArray2<'_, i64>,
        names: Vec<String>,
        name: &str,
    ) -> PyResult<Self> {
        let view = labels.as_array();
        let (rows, columns) = view.dim();
        let mut cells = Vec::with_capacity(rows * columns);
        for row in (0..rows).rev() {
            for column in 0..columns {
                let index = view[(row, column)];
                let known = u16::try_from(index).ok();
                let known = known.filter(|&i| usize::from(i) < names.len());
                cells.push(known.ok_or_else(|| {
                    failed(format!(
                        "labels[{row}, {column}] is {index}, expected an index into {} names",
                        names.len()
                    ))
                })?);
            }
        }
        let grid = LabelGrid {
            name: name.to_owned(),
            unit: "px".into(),
            xs: (0..=columns).map(|x| x as f64).collect(),
            ys: (0..=rows).map(|y| y as f64).collect(),
            labels: names,
            cells,
        };
        let found = detached(py, move || {
            grid.check()
                .and_then(|()| decompose(&grid))
                .map_err(|e| e.to_string())
        })?;
        found.map(|made| Self::plain(made.facade)).map_err(failed)
    }

    /// A layout of labelled rectangles: `(label, x, y, width, height)` each.
    #[staticmethod]
    #[pyo3(signature = (width, height, regions, name = "facade", unit = "px"))]
    fn from_regions(
        width: f64,
        height: f64,
        regions: Vec<(String, f64, f64, f64, f64)>,
        name: &str,
        unit: &str,
    ) -> PyResult<Self> {
        let region = |(label, x, y, width, height)| Region {
            label,
            rect: Rect::new(x, y, width, height),
        };
        let regions = regions.into_iter().map(region).collect();
        let facade = edifice_shape::Facade::new(name, unit, width, height, regions);
        facade.map(Self::plain).map_err(failed)
    }

    /// Reads a facade of any format that `edifice facade convert` reads; a picture becomes a tiling.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let found = detached(py, move || -> edifice_base::Result<AnnotatedFacade> {
            let source = read_source(&path, &ReadOptions::default())?;
            if matches!(source, edifice_io::Source::Layout(_))
                && let Ok(annotated) = facade_json::parse_annotated(&read_bytes(&path)?, &path)
            {
                return Ok(annotated);
            }
            source.facade(&path).map(AnnotatedFacade::plain)
        })?;
        found.map(|inner| Self { inner }).map_err(failed)
    }

    /// Reads the text of a facade file.
    #[staticmethod]
    fn from_json(text: &str) -> PyResult<Self> {
        let found = facade_json::parse_annotated(text.as_bytes(), "facade.json".as_ref());
        found.map(|inner| Self { inner }).map_err(failed)
    }

    /// The text of the facade file; numbers read back to the same bits.
    fn to_json(&self) -> String {
        facade_json::annotated_to_string(&self.inner)
    }

    /// Writes the facade: `.facade.json`, `.svg`, `.png` or `.txt`.
    fn write(&self, path: PathBuf) -> PyResult<()> {
        let written = match path.extension().is_some_and(|e| e == "json") {
            true => write_atomic(&path, self.to_json().as_bytes()),
            false => write_facade(&self.inner.facade, &path),
        };
        written.map_err(failed)
    }

    /// Name of the facade.
    #[getter]
    fn name(&self) -> &str {
        &self.inner.facade.name
    }

    /// Unit of all lengths.
    #[getter]
    fn unit(&self) -> &str {
        &self.inner.facade.unit
    }

    /// Extent along x.
    #[getter]
    fn width(&self) -> f64 {
        self.inner.facade.width
    }

    /// Extent along y.
    #[getter]
    fn height(&self) -> f64 {
        self.inner.facade.height
    }

    /// The regions, one dictionary each: `label`, `x`, `y`, `width`, `height`, and of completions `observed`, `probability`, `reason`.
    #[getter]
    fn regions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let list = PyList::empty(py);
        for (region, note) in self.inner.facade.regions.iter().zip(&self.inner.notes) {
            let about = PyDict::new(py);
            let r = region.rect;
            about.set_item("label", &region.label)?;
            for (name, value) in [
                ("x", r.x),
                ("y", r.y),
                ("width", r.width),
                ("height", r.height),
            ] {
                about.set_item(name, value)?;
            }
            if let Some(observed) = note.observed {
                about.set_item("observed", observed)?;
            }
            if let Some(probability) = note.probability {
                about.set_item("probability", probability)?;
            }
            if let Some(reason) = &note.reason {
                about.set_item("reason", reason)?;
            }
            list.append(about)?;
        }
        Ok(list)
    }

    /// Rectangles `(x, y, width, height)` whose content is not known; `None` when all that is not observed is unknown.
    #[getter]
    fn unknown(&self) -> Option<Vec<(f64, f64, f64, f64)>> {
        let rects = self.inner.unknown.as_ref()?;
        Some(
            rects
                .iter()
                .map(|r| (r.x, r.y, r.width, r.height))
                .collect(),
        )
    }

    /// The same facade, whose content in these rectangles `(x, y, width, height)` is not known.
    fn with_unknown(&self, rects: Vec<(f64, f64, f64, f64)>) -> PyResult<Self> {
        let rects = rects.into_iter().map(|(x, y, w, h)| Rect::new(x, y, w, h));
        let inner = AnnotatedFacade {
            unknown: Some(rects.collect()),
            ..self.inner.clone()
        };
        inner.check().map_err(failed)?;
        Ok(Self { inner })
    }

    /// Only the elements (windows, doors, ...), not the wall.
    fn elements(&self) -> Self {
        Self::plain(elements_of_facade(&self.inner.facade))
    }

    /// Infers the smallest split grammar (Wu et al. 2014); the same seed gives the bytes of `edifice grammar infer`.
    /// `progress` shows a bar of tqdm.
    #[allow(clippy::too_many_arguments)]
    #[pyo3(signature = (method = "lagrangian", iterations = None, seed = 0, ops = None, split_cost = None, repeat_cost = None, progress = false))]
    fn infer(
        &self,
        py: Python<'_>,
        method: &str,
        iterations: Option<u64>,
        seed: u64,
        ops: Option<Vec<String>>,
        split_cost: Option<f64>,
        repeat_cost: Option<f64>,
        progress: bool,
    ) -> PyResult<Grammar> {
        let defaults = Settings::default();
        let usual = Costs::default();
        let operations = match ops {
            None => defaults.operations,
            Some(mut names) => {
                names.push("split".into());
                names.join(",").parse::<Operations>().map_err(failed)?
            }
        };
        let settings = Settings {
            method: method.parse::<Method>().map_err(failed)?,
            iterations: iterations.unwrap_or(defaults.iterations),
            seed,
            operations,
            costs: Costs::of(
                split_cost.unwrap_or(usual.split),
                repeat_cost.unwrap_or(usual.repeat),
            ),
            ..defaults
        };
        let facade = self.inner.facade.clone();
        let bar = progress.then_some("infer");
        let found = watched(py, bar, move |watch| -> Result<_, String> {
            facade.check_tiling().map_err(|e| e.to_string())?;
            edifice_shape::splittable(&facade).map_err(|e| e.to_string())?;
            infer(&[facade], &settings, watch).map_err(|e| e.to_string())
        })?;
        let found = found.map_err(failed)?;
        Ok(Grammar {
            inner: found.grammar,
            lower_bound: found.lower_bound,
        })
    }

    /// Hides a part (`r20`, `r50`, `side50`, `corner36`, `bottom40`, `tree`, `car`, `cut`; `_maskless` behind a name for no mask), by the seed or by
    /// the frozen mask of the facade: the bytes of `edifice facade hide`.
    #[pyo3(signature = (task, seed = 0, frozen = false))]
    fn hide(&self, task: &str, seed: u64, frozen: bool) -> PyResult<Self> {
        let Some(sight) = Sight::named(task) else {
            let names: Vec<String> = Sight::all().into_iter().map(Sight::name).collect();
            return Err(failed(format!(
                "unknown task {task:?}, expected {}",
                names.join(", ")
            )));
        };
        let seed = (!frozen).then_some(seed);
        let made = hide(&self.annotated()?, sight, seed).map_err(failed)?;
        Ok(Self {
            inner: made.partial,
        })
    }

    /// Completes the unknown part in up to `count` ways, the best first: the bytes of `edifice facade complete` with its default model.
    #[pyo3(signature = (method = "best", count = 1, seed = 0))]
    fn complete(
        &self,
        py: Python<'_>,
        method: &str,
        count: usize,
        seed: u64,
    ) -> PyResult<Vec<Self>> {
        let Some(method) = method::Method::of_option(method) else {
            let names = method::Method::ALL.map(method::Method::option);
            return Err(failed(format!(
                "unknown method, expected {}",
                names.join(", ")
            )));
        };
        let layout = self.annotated()?;
        let found = detached(py, move || -> edifice_base::Result<Vec<AnnotatedFacade>> {
            let path = PathBuf::from(&layout.facade.name);
            let wanted = completing::Wanted {
                width: None,
                height: None,
                pins: &[],
                forbidden: &[],
            };
            let model = completing::shipped_model()?;
            let answers = completing::complete(layout, &wanted, method, model, count, seed, &path)?;
            Ok(answers.whole())
        })?;
        let found = found.map_err(failed)?;
        Ok(found.into_iter().map(|inner| Self { inner }).collect())
    }

    /// Compares a predicted layout of elements with this true one: `f1` by IoU, `mean_f1`, `iou`, counts, of all and of each label, as
    /// `edifice facade compare` tells them.
    fn compare<'py>(&self, py: Python<'py>, predicted: &Self) -> PyResult<Bound<'py, PyDict>> {
        comparison(py, self.annotated()?, predicted.annotated()?)
    }

    /// The facade drawn as SVG, for notebooks.
    fn _repr_svg_(&self) -> String {
        draw::svg(&self.inner.facade)
    }

    fn __len__(&self) -> usize {
        self.inner.facade.regions.len()
    }

    fn __repr__(&self) -> String {
        let f = &self.inner.facade;
        format!(
            "<Facade {:?}: {} regions, {} x {} {}>",
            f.name,
            f.regions.len(),
            f.width,
            f.height,
            f.unit
        )
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        let read = py.get_type::<Self>().getattr("from_json")?;
        Ok((read, (self.to_json(),)))
    }
}
