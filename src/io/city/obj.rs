//! Cities as Wavefront OBJ: each object (`o`), or group (`g`) in a file without objects, is a building; z up, metres. The faces
//! of a file with neither are split into buildings by the surfaces that they make up (`shells`).
//! Faces of more than three corners are cut into fans. Materials (`.mtl`) and texture coordinates are read as what
//! the surface looks like; [`write()`] writes them beside the file.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use rustc_hash::FxHashMap;

use super::CityError;
use super::mtl::{self, Materials};
pub use super::obj_write::{to_string, write};
use super::shells;
use edifice_base::{Error, Result};
use edifice_io::read_bytes;
use edifice_shape::triangles::{City, CityBuilding, Painted, Surface, TriangleMesh};

/// Elements without a surface, and their names in notes.
const LEFT_OUT: [(&str, &str); 5] = [
    ("l", "lines"),
    ("p", "points"),
    ("curv", "curves"),
    ("curv2", "curves"),
    ("surf", "free-form surfaces"),
];

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
    // Triangles of the paint of the first building, and lines that are left out, by what they are.
    let mut painted: Vec<usize> = Vec::new();
    let mut left: BTreeMap<&str, usize> = BTreeMap::new();
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
                    faces.push((edifice_io::file_stem(path), Vec::new()));
                    faces.len() - 1
                });
                uv.resize(corners.len(), [0.0; 2]);
                let fan = || (2..corners.len()).map(|k| [0, k - 1, k]);
                let first = faces[building].1.len();
                faces[building]
                    .1
                    .extend(fan().map(|t| t.map(|k| corners[k])));
                if let Some(surface) = &material {
                    paint.resize(paint.len().max(building + 1), Vec::new());
                    if building == 0 {
                        painted.extend(first..faces[0].1.len());
                    }
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
            Some(word) => {
                if let Some(what) = LEFT_OUT.iter().find(|w| w.0 == word) {
                    *left.entry(what.1).or_default() += 1;
                }
            }
            None => {}
        }
    }
    let mut notes: Vec<String> = left
        .into_iter()
        .map(|(what, n)| format!("{n} {what} left out: they have no surface"))
        .collect();
    if let ([(name, triangles)], true) = (&faces[..], names.is_empty()) {
        let mesh = own(&positions, triangles);
        let labels = shells::buildings(&mesh);
        let count = labels.iter().max().map_or(0, |m| m + 1);
        if count > 1 {
            notes.push(format!(
                "no objects or groups: split into {count} buildings by connected surfaces"
            ));
            let mut split: Vec<(String, Vec<[u32; 3]>)> = (1..=count)
                .map(|k| (format!("{name}-{k}"), Vec::new()))
                .collect();
            for (t, &l) in triangles.iter().zip(&labels) {
                split[l].1.push(*t);
            }
            let mut shown: Vec<Vec<Painted>> = vec![Vec::new(); count];
            for (p, i) in paint.pop().into_iter().flatten().zip(painted) {
                shown[labels[i]].push(p);
            }
            (faces, paint) = (split, shown);
        }
    }
    paint.resize(faces.len(), Vec::new());
    let buildings = faces.into_iter().zip(paint);
    let buildings = buildings.filter(|((_, triangles), _)| !triangles.is_empty());
    Ok(City {
        name: edifice_io::file_stem(path),
        reference_system: None,
        origin: [0.0; 3],
        notes,
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
