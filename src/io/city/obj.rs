//! Cities as Wavefront OBJ: each object (`o`), or group (`g`) in a file without objects, is a building; z up, metres.
//! Faces of more than three corners are cut into fans. Materials and texture coordinates are not read.

use std::fmt::Write;
use std::path::Path;

use rustc_hash::FxHashMap;

use super::CityError;
use crate::io::read_bytes;
use crate::shape::triangles::{City, CityBuilding, TriangleMesh};
use crate::{Error, Result};

/// Reads a file.
///
/// # Errors
/// Names the file and the line that is wrong.
pub fn read(path: &Path) -> Result<City> {
    parse(&read_bytes(path)?, path)
}

/// Parses the bytes of a file; `path` only names it in errors.
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
            Some("f") => {
                let mut corners: Vec<u32> = Vec::new();
                for word in words {
                    let index = word.split('/').next().unwrap_or_default();
                    let bad = || CityError::Format(format!("{word:?} is not a corner"));
                    let index: i64 = index.parse().map_err(|_| fail(bad()))?;
                    // Negative indices count from the last position so far.
                    let count = positions.len();
                    let at = if index < 0 {
                        count as i64 + index
                    } else {
                        index - 1
                    };
                    if at < 0 || at >= count as i64 {
                        let index = index.unsigned_abs();
                        return Err(fail(CityError::Dangling { index, count }));
                    }
                    corners.push(at as u32);
                }
                if corners.len() < 3 {
                    return Err(fail(CityError::Format(
                        "a face of fewer than 3 corners".into(),
                    )));
                }
                let building = *current.get_or_insert_with(|| {
                    faces.push((crate::io::file_stem(path), Vec::new()));
                    faces.len() - 1
                });
                let fan = (2..corners.len()).map(|k| [corners[0], corners[k - 1], corners[k]]);
                faces[building].1.extend(fan);
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
    let buildings = faces
        .into_iter()
        .filter(|(_, triangles)| !triangles.is_empty());
    Ok(City {
        name: crate::io::file_stem(path),
        reference_system: None,
        origin: [0.0; 3],
        buildings: buildings
            .map(|(id, triangles)| CityBuilding {
                id,
                attributes: serde_json::Map::new(),
                mesh: own(&positions, &triangles),
                parts: Vec::new(),
            })
            .collect(),
    })
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

/// The text of a file: an object a building, in the input's own coordinates, to the millimetre.
pub fn to_string(city: &City) -> String {
    let mut out = String::from("# metres, z up\n");
    let mut first = 1;
    for b in &city.buildings {
        // Writing to a String cannot fail.
        let _ = writeln!(out, "o {}", b.id.replace(['\n', '\r'], " "));
        for p in &b.mesh.positions {
            let [x, y, z] = [0, 1, 2].map(|k| p[k] + city.origin[k]);
            let _ = writeln!(out, "v {x:.3} {y:.3} {z:.3}");
        }
        for t in &b.mesh.triangles {
            let [i, j, k] = t.map(|i| i as usize + first);
            let _ = writeln!(out, "f {i} {j} {k}");
        }
        first += b.mesh.positions.len();
    }
    out
}
