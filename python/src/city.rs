//! `edifice.City` and `edifice.CityGrammar`.

use std::path::PathBuf;
use std::sync::Arc;

use edifice_city_proceduralization::{Budget, Mode, Precision, Settings, proceduralize};
use edifice_grammar::instance::InstanceGrammar;
use edifice_io_city::{self as city, cityjson, grammar_file, obj};
use edifice_shape::triangles::{self, CityBuilding, TriangleMesh, VolumeRaster, repair};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::arrays::{MeshArrays, mesh};
use super::errors::failed;
use super::html;
use super::worker::{detached, watched};

/// Most pixels along a side of a template's textures.
const TEXTURE_PIXELS: usize = 128;

/// Buildings as triangle meshes, z up, in metres relative to `origin`.
#[pyclass(module = "edifice", frozen)]
pub struct City {
    inner: Arc<triangles::City>,
    /// True for a city that a grammar derived, which is judged as it is.
    derived: bool,
}

impl City {
    fn of(inner: triangles::City, derived: bool) -> Self {
        Self {
            inner: Arc::new(inner),
            derived,
        }
    }

    /// Meshes as they are judged: those that were read are repaired.
    fn judged(city: &triangles::City, derived: bool) -> Vec<TriangleMesh> {
        let mesh = |b: &CityBuilding| match derived {
            true => b.mesh.clone(),
            false => repair(&b.mesh).0,
        };
        city.buildings.iter().map(mesh).collect()
    }
}

#[pymethods]
impl City {
    /// Reads a city of any format that `edifice city` reads.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let found = detached(py, move || -> edifice_base::Result<triangles::City> {
            let mut all = city::read(&path)?;
            all.number_duplicates();
            Ok(all)
        })?;
        found.map(|inner| Self::of(inner, false)).map_err(failed)
    }

    /// A city of meshes, one building each: corners `(n, 3)` in metres, and triangles `(m, 3)` of indices of corners.
    #[staticmethod]
    #[pyo3(signature = (meshes, name = "city"))]
    fn from_arrays(
        meshes: Vec<(PyReadonlyArray2<'_, f64>, PyReadonlyArray2<'_, i64>)>,
        name: &str,
    ) -> PyResult<Self> {
        let mut inner = triangles::City {
            name: name.to_owned(),
            ..triangles::City::default()
        };
        for (number, (corners, faces)) in meshes.iter().enumerate() {
            let (corners, faces) = (corners.as_array(), faces.as_array());
            if corners.ncols() != 3 || faces.ncols() != 3 {
                return Err(failed(format!(
                    "meshes[{number}] has {} numbers a corner and {} a triangle, expected 3 and 3",
                    corners.ncols(),
                    faces.ncols()
                )));
            }
            let count = corners.nrows();
            let index = |i: i64| {
                let known = u32::try_from(i).ok().filter(|&i| (i as usize) < count);
                known.ok_or_else(|| {
                    failed(format!(
                        "meshes[{number}] has a triangle of corner {i}, of {count}"
                    ))
                })
            };
            let mut surface = TriangleMesh::default();
            for row in corners.rows() {
                if row.iter().any(|v| !v.is_finite()) {
                    return Err(failed(format!(
                        "meshes[{number}] has a corner that is no number"
                    )));
                }
                surface.positions.push([row[0], row[1], row[2]]);
            }
            for row in faces.rows() {
                let triangle = [index(row[0])?, index(row[1])?, index(row[2])?];
                surface.triangles.push(triangle);
            }
            inner.buildings.push(CityBuilding {
                id: format!("building_{}", number + 1),
                mesh: surface,
                ..CityBuilding::default()
            });
        }
        Ok(Self::of(inner, false))
    }

    /// Name of the city.
    #[getter]
    fn name(&self) -> &str {
        &self.inner.name
    }

    /// The shift from these coordinates to those of the reference system, metres.
    #[getter]
    fn origin(&self) -> (f64, f64, f64) {
        let [x, y, z] = self.inner.origin;
        (x, y, z)
    }

    /// Identifiers of the buildings.
    #[getter]
    fn ids(&self) -> Vec<String> {
        self.inner.buildings.iter().map(|b| b.id.clone()).collect()
    }

    /// Number of triangles.
    #[getter]
    fn triangles(&self) -> usize {
        self.inner.triangles()
    }

    /// Corners `(n, 3)` and triangles `(m, 3)` of a building.
    fn mesh<'py>(&self, py: Python<'py>, index: usize) -> PyResult<MeshArrays<'py>> {
        let count = self.inner.buildings.len();
        let building = self.inner.buildings.get(index);
        let building =
            building.ok_or_else(|| failed(format!("there is no building {index}, of {count}")))?;
        mesh(
            py,
            &building.mesh.positions,
            building.mesh.triangles.iter().copied(),
        )
    }

    /// Finds the grammar of the city (Demir et al. 2014): `templates` of them, or as many as components, halved `level` times. The same
    /// seed gives the bytes of `edifice city proceduralize`. `progress` shows a bar of tqdm.
    #[pyo3(signature = (level = 4, templates = None, mode = "best", precision = None, seed = 1, progress = false))]
    #[expect(clippy::too_many_arguments, reason = "keywords in Python")]
    fn proceduralize(
        &self,
        py: Python<'_>,
        level: u32,
        templates: Option<usize>,
        mode: &str,
        precision: Option<&str>,
        seed: u64,
        progress: bool,
    ) -> PyResult<CityGrammar> {
        let settings = Settings {
            mode: match mode {
                "best" => Mode::Best,
                "paper" => Mode::Paper,
                other => {
                    return Err(failed(format!(
                        "unknown mode {other:?}, expected best or paper"
                    )));
                }
            },
            budget: match templates {
                Some(0) => return Err(failed("a grammar has at least one template")),
                Some(count) => Budget::Templates(count),
                None => Budget::Level(level),
            },
            precision: match precision {
                None => None,
                Some("mm") => Some(Precision::Millimetre),
                Some("cm") => Some(Precision::Centimetre),
                Some("dm") => Some(Precision::Decimetre),
                Some(other) => {
                    return Err(failed(format!(
                        "unknown precision {other:?}, expected mm, cm or dm"
                    )));
                }
            },
            seed,
            ..Settings::default()
        };
        let input = Arc::clone(&self.inner);
        let bar = progress.then_some("proceduralize");
        let found = watched(py, bar, move |watch| -> Result<InstanceGrammar, String> {
            let made = proceduralize(&input, &settings, watch).map_err(|e| e.to_string())?;
            let textures = made.box_textures(&input, TEXTURE_PIXELS);
            let mut grammar = made.grammar;
            city::add_textures(&mut grammar, &textures).map_err(|e| e.to_string())?;
            Ok(grammar)
        })?;
        found.map(CityGrammar::of).map_err(failed)
    }

    /// Volumetric intersection over union with another city, by rasters of `resolution` metres: `iou`, `volumes`, `intersection`.
    #[pyo3(signature = (other, resolution = 0.5))]
    fn compare<'py>(
        &self,
        py: Python<'py>,
        other: &Self,
        resolution: f64,
    ) -> PyResult<Bound<'py, PyDict>> {
        if !(0.01..=100.0).contains(&resolution) {
            return Err(failed(format!(
                "{resolution} is not between 0.01 and 100 m"
            )));
        }
        let sides = [self, other].map(|side| (Arc::clone(&side.inner), side.derived));
        let (size, overlap) = detached(py, move || {
            let [a, b] = sides.map(|(city, derived)| Self::judged(&city, derived));
            let [a, b] = [&a, &b].map(|meshes| meshes.iter().collect::<Vec<_>>());
            let raster = VolumeRaster { size: resolution }.fitted(&a, &b);
            (raster.size, raster.compare(&a, &b))
        })?;
        let about = PyDict::new(py);
        about.set_item("iou", overlap.iou())?;
        about.set_item("resolution", size)?;
        about.set_item("volumes", (overlap.first, overlap.second))?;
        about.set_item("intersection", overlap.intersection)?;
        Ok(about)
    }

    /// Writes `.obj` or `.city.json`.
    fn write(&self, path: PathBuf) -> PyResult<()> {
        let written = match path.extension().and_then(|e| e.to_str()) {
            Some("obj") => obj::write(&self.inner, &path),
            Some("json") => {
                edifice_io::write_atomic(&path, cityjson::to_string(&self.inner).as_bytes())
            }
            _ => return Err(failed("expected a name with .obj or .city.json")),
        };
        written.map_err(failed)
    }

    fn __len__(&self) -> usize {
        self.inner.buildings.len()
    }

    fn __repr__(&self) -> String {
        format!(
            "<City {:?}: {} buildings, {} triangles>",
            self.inner.name,
            self.inner.buildings.len(),
            self.inner.triangles()
        )
    }
}

/// A grammar that derives a city: templates, building types with parameters, and their instances.
#[pyclass(module = "edifice", frozen)]
pub struct CityGrammar {
    inner: Arc<InstanceGrammar>,
}

impl CityGrammar {
    fn of(inner: InstanceGrammar) -> Self {
        Self {
            inner: Arc::new(inner),
        }
    }
}

#[pymethods]
impl CityGrammar {
    /// Reads `.city-grammar.json` (also with `.gz`) or `.city-grammar.bin`.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let found = detached(py, move || grammar_file::read(&path))?;
        found.map(Self::of).map_err(failed)
    }

    /// Writes `.city-grammar.json` (also with `.gz`) or `.city-grammar.bin`: the bytes of the command line.
    fn write(&self, path: PathBuf) -> PyResult<()> {
        grammar_file::write(&self.inner, &path).map_err(failed)
    }

    /// Derives the city.
    fn derive(&self, py: Python<'_>) -> PyResult<City> {
        let grammar = Arc::clone(&self.inner);
        let found = detached(py, move || -> Result<triangles::City, String> {
            let derivation = grammar.derive().map_err(|e| e.to_string())?;
            let mut derived = derivation.city(&grammar);
            city::paint_parts(&mut derived).map_err(|e| e.to_string())?;
            Ok(derived)
        })?;
        found.map(|inner| City::of(inner, true)).map_err(failed)
    }

    /// The same grammar without residuals, which tell where the parts of single instances stand.
    fn rules_only(&self) -> Self {
        Self::of(self.inner.rules_only())
    }

    /// Names of the templates.
    #[getter]
    fn templates(&self) -> Vec<String> {
        self.inner
            .templates
            .iter()
            .map(|t| t.symbol.clone())
            .collect()
    }

    /// Number of instances that no type explains, with meshes of their own.
    #[getter]
    fn escapes(&self) -> usize {
        self.inner.escapes()
    }

    /// Number of instances whose parts a residual moves.
    #[getter]
    fn residuals(&self) -> usize {
        self.inner.residuals()
    }

    /// The size of the grammar as a table, for notebooks.
    fn _repr_html_(&self) -> String {
        let rows = [
            ("rules", self.inner.rules.len()),
            ("templates", self.inner.templates.len()),
            ("escapes", self.escapes()),
            ("residuals", self.residuals()),
        ];
        let rows: Vec<_> = rows
            .map(|(name, n)| (name.to_owned(), vec![n.to_string()]))
            .into();
        html::table("Grammar of a city", &["number"], &rows)
    }

    fn __len__(&self) -> usize {
        self.inner.rules.len()
    }

    fn __repr__(&self) -> String {
        format!(
            "<CityGrammar: {} rules, {} templates>",
            self.inner.rules.len(),
            self.inner.templates.len()
        )
    }
}
