//! The triangles of a city, beside the grammar made of them.

use std::path::Path;
use std::sync::OnceLock;

use rayon::prelude::*;

use super::super::work::Work;
use edifice_base::{Error, Progress, Result};
use edifice_city_proceduralization::{Budget, Decomposition, Settings, decompose, from_components};
use edifice_grammar::instance::InstanceGrammar;
use edifice_shape::triangles::{City, OrientedBox, TriangleMesh};

/// The name of the format of [`Original::packed`].
pub(super) const FORMAT: &str = "original";
/// Corners of a packed part at most, so that an index has 16 bits.
const CORNERS: usize = 65_535;
/// Steps of a packed coordinate.
const STEPS: f64 = 65_535.0;

/// A city of triangles and the file that it is in.
pub(super) struct Original {
    /// The city; no two buildings have one identifier.
    pub city: City,
    /// Name of its file.
    pub file: String,
    cut: OnceLock<Decomposition>,
}

impl Original {
    /// A city that was read from a file.
    pub(super) fn new(mut city: City, path: &Path) -> Self {
        city.number_duplicates();
        if city.name.is_empty() {
            let file = path.file_name().unwrap_or_default().to_string_lossy();
            file.split('.')
                .next()
                .unwrap_or_default()
                .clone_into(&mut city.name);
        }
        let file = path.file_name().unwrap_or_default();
        Self {
            file: file.to_string_lossy().into_owned(),
            city,
            cut: OnceLock::new(),
        }
    }

    /// Its grammar with the number of components halved `level` times, as `edifice city proceduralize` makes it.
    ///
    /// # Errors
    /// When there is nothing to proceduralize, or the work is stopped.
    pub(super) fn proceduralized(&self, level: u32, work: &Work) -> Result<InstanceGrammar> {
        let count = self.city.buildings.len();
        work.tell(
            &format!("cutting {count} buildings into components"),
            Some(0.05),
        )?;
        let watch = |_: Progress| work.go_on();
        let cut = match self.cut.get() {
            Some(cut) => cut.clone(),
            None => {
                let cut = decompose(&self.city, true, &watch);
                work.whole(cut.ended)?;
                self.cut.get_or_init(|| cut).clone()
            }
        };
        let count = cut.components.len();
        work.tell(&format!("types and rules of {count} components"), Some(0.3))?;
        let settings = Settings {
            budget: Budget::Level(level),
            ..Settings::default()
        };
        let made = from_components(&self.city, cut, &settings, &watch).map_err(Error::method)?;
        work.whole(made.ended)?;
        Ok(made.grammar)
    }

    /// The triangles in 16 bits a number, little-endian: parts, each with the index of its building (u32), its lower corner and
    /// the length of a step (4 x f32, metres), corners and triangles (2 x u32), corners in steps (3 x u16 each), indices (3 x
    /// u16 each). A part has at most 65,535 corners.
    pub(super) fn packed(&self) -> Vec<u8> {
        let buildings = self.city.buildings.par_iter().enumerate();
        let parts: Vec<Vec<u8>> = buildings.map(|(k, b)| packed(k as u32, &b.mesh)).collect();
        parts.concat()
    }

    /// The difference of each building's volume from that in another city, as a share of its own; by identifier.
    pub(super) fn volume_errors(&self, derived: &City) -> rustc_hash::FxHashMap<String, f64> {
        let volumes = |city: &City| -> rustc_hash::FxHashMap<String, f64> {
            let one = |b: &edifice_shape::triangles::CityBuilding| {
                let base = OrientedBox::around(&b.mesh)?.base[2];
                Some((b.id.clone(), b.mesh.volume_above(base)))
            };
            city.buildings.par_iter().filter_map(one).collect()
        };
        let (own, other) = (volumes(&self.city), volumes(derived));
        let error = |(id, volume): (&String, &f64)| {
            let made = other.get(id)?;
            (*volume > 0.0).then(|| (id.clone(), (made - volume).abs() / volume))
        };
        own.iter().filter_map(error).collect()
    }
}

/// A building in parts of few enough corners.
fn packed(index: u32, mesh: &TriangleMesh) -> Vec<u8> {
    let mut out = Vec::new();
    // A triangle has three corners: so many triangles never have too many.
    let chunk = match mesh.positions.len() <= CORNERS {
        true => mesh.triangles.len().max(1),
        false => CORNERS / 3,
    };
    for triangles in mesh.triangles.chunks(chunk) {
        let mut number = rustc_hash::FxHashMap::default();
        let mut corners: Vec<[f64; 3]> = Vec::new();
        let mut indices: Vec<u16> = Vec::with_capacity(3 * triangles.len());
        for &i in triangles.iter().flatten() {
            let own = *number.entry(i).or_insert_with(|| {
                corners.push(mesh.positions[i as usize]);
                corners.len() - 1
            });
            indices.push(own as u16);
        }
        let bound = |k: usize, from: f64, pick: fn(f64, f64) -> f64| {
            corners.iter().map(|p| p[k]).fold(from, pick)
        };
        let low = [0, 1, 2].map(|k| bound(k, f64::INFINITY, f64::min));
        let extents = [0, 1, 2].map(|k| bound(k, f64::NEG_INFINITY, f64::max) - low[k]);
        let step = extents.into_iter().fold(1e-3, f64::max) / STEPS;
        out.extend(index.to_le_bytes());
        for v in [low[0], low[1], low[2], step] {
            out.extend((v as f32).to_le_bytes());
        }
        for count in [corners.len(), triangles.len()] {
            out.extend((count as u32).to_le_bytes());
        }
        for p in &corners {
            for k in 0..3 {
                out.extend((((p[k] - low[k]) / step).round() as u16).to_le_bytes());
            }
        }
        out.extend(indices.iter().flat_map(|i| i.to_le_bytes()));
    }
    out
}
