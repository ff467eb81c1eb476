//! Cities as Wavefront OBJ: each object (`o`), or group (`g`) in a file without objects, is a building; z up, metres.
//! Faces of more than three corners are cut into fans. Materials (`.mtl`) and texture coordinates are read as what
//! the surface looks like; [`write()`] writes them beside the file.

use std::path::Path;
use std::sync::Arc;

use rustc_hash::FxHashMap;

use super::CityError;
use super::mtl::{self, Materials};
pub use super::obj_write::{to_string, write};
use crate::read_bytes;
use edifice_base::{Error, Result};
use edifice_shape::triangles::{City, CityBuilding, Painted, Surface, TriangleMesh};

/// Reads a file.
///
/// # Errors
/// Names the file and the line that is wrong.
pub fn read(path: &Path) -> Result<City> {
    parse(&read_bytes(path)?, path)
}

/// Parses the bytes of a file; materials that it names lie beside `path`.
///
/// # Errors
/// As [`read`].
pub fn parse(bytes: &[u8], path: &Path) -> Result<City> {
    let text = String::from_utf8_lossy(bytes);
    let objects = text.lines().any(|l| l.starts_with("o "));
    let mut positions: Vec<[f64; 3]> = Vec::new();
    let mut names: FxHashMap<String, usize> = FxHashMap::default();
    let mut faces: Vec<(String, Vec<[u32; 3]>)> = Vec::new();
    let mut current: Option<usize> = None;
    let mut coordinates: Vec<[f64; 2]> = Vec::new();
    let mut materials = Materials::default();
    let mut material: Option<Arc<Surface>> = None;
    let mut paint: Vec<Vec<Painted>> = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let fail = |error: CityError| Error::input(path, format!("line {}", number + 1), error);
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let mut p = [0.0; 3];
                for v in &mut p {
                    let word = words.next().unwrap_or_default();
                    let value: Option<f64> = word.parse().ok();
                    let bad = || CityError::Format(format!("{word:?} is not a coordinate"));
                    *v = value.filter(|v| v.is_finite()).ok_or_else(|| fail(bad()))?;
                }
                positions.push(p);
            }
            Some("vt") => {
                let mut next = || words.next().and_then(|w| w.parse().ok());
                let uv = next().zip(next().or(Some(0.0)));
                let uv = uv.filter(|(u, v): &(f64, f64)| u.is_finite() && v.is_finite());
                let bad = || CityError::Format("not texture coordinates".into());
                let (u, v) = uv.ok_or_else(|| fail(bad()))?;
                coordinates.push([u, v]);
            }
            Some("mtllib") => {
                for name in words {
                    mtl::read(&path.with_file_name(name), &mut materials)?;
                }
            }
            Some("usemtl") => {
                let name = words.collect::<Vec<_>>().join(" ");
                material = materials.get(&name).cloned();
            }
            Some("f") => {
                let mut corners: Vec<u32> = Vec::new();
                let mut uv: Vec<[f64; 2]> = Vec::new();
                for word in words {
                    let mut indices = word.split('/');
                    let mut next = |count: usize| -> Result<Option<usize>> {
                        let index = indices.next().filter(|i| !i.is_empty());
                        let bad = || CityError::Format(format!("{word:?} is not a corner"));
                        let index = index.map(|i| i.parse().map_err(|_| fail(bad())));
                        let index = index.transpose()?;
                        index.map(|i| place(i, count).map_err(&fail)).transpose()
                    };
                    let bad = || CityError::Format(format!("{word:?} is not a corner"));
                    let at = next(positions.len())?.ok_or_else(|| fail(bad()))?;
                    corners.push(at as u32);
                    uv.extend(next(coordinates.len())?.map(|i| coordinates[i]));
                }
                if corners.len() < 3 {
                    return Err(fail(CityError::Format(
                        "a face of fewer than 3 corners".into(),
                    )));
                }
                let building = *current.get_or_insert_with(|| {
                    faces.push((crate::file_stem(path), Vec::new()));
                    faces.len() - 1
                });
                uv.resize(corners.len(), [0.0; 2]);
                let fan = || (2..corners.len()).map(|k| [0, k - 1, k]);
                faces[building]
                    .1
                    .extend(fan().map(|t| t.map(|k| corners[k])));
                if let Some(surface) = &material {
                    paint.resize(paint.len().max(building + 1), Vec::new());
                    paint[building].extend(fan().map(|t| Painted {
                        corners: t.map(|k| positions[corners[k] as usize]),
                        uv: t.map(|k| uv[k]),
                        surface: surface.clone(),
                    }));
                }
            }
            Some(key) if key == if objects { "o" } else { "g" } => {
                let name = words.collect::<Vec<_>>().join(" ");
                current = Some(*names.entry(name.clone()).or_insert_with(|| {
                    faces.push((name, Vec::new()));
                    faces.len() - 1
                }));
            }
            _ => {}
        }
    }
    paint.resize(faces.len(), Vec::new());
    let buildings = faces.into_iter().zip(paint);
    let buildings = buildings.filter(|((_, triangles), _)| !triangles.is_empty());
    Ok(City {
        name: crate::file_stem(path),
        reference_system: None,
        origin: [0.0; 3],
        notes: Vec::new(),
        buildings: buildings
            .map(|((id, triangles), paint)| CityBuilding {
                id,
                mesh: own(&positions, &triangles),
                paint,
                ..CityBuilding::default()
            })
            .collect(),
    })
}

/// The position, among `count`, that an index of OBJ names; negative ones count from the last so far.
fn place(index: i64, count: usize) -> std::result::Result<usize, CityError> {
    let at = match index < 0 {
        true => index.checked_add_unsigned(count as u64),
        false => index.checked_sub(1),
    };
    let at = at.and_then(|at| usize::try_from(at).ok());
    let index = index.unsigned_abs();
    at.filter(|&at| at < count)
        .ok_or(CityError::Dangling { index, count })
}

/// A mesh with only the positions that its triangles use.
pub(super) fn own(positions: &[[f64; 3]], triangles: &[[u32; 3]]) -> TriangleMesh {
    let mut known: FxHashMap<u32, u32> = FxHashMap::default();
    let mut mesh = TriangleMesh::default();
    for t in triangles {
        let t = t.map(|i| {
            *known.entry(i).or_insert_with(|| {
                mesh.positions.push(positions[i as usize]);
                mesh.positions.len() as u32 - 1
            })
        });
        mesh.triangles.push(t);
    }
    mesh
}
