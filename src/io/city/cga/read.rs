//! Rules, start shapes and assets, read and evaluated to triangles.

use std::collections::BTreeMap;
use std::path::Path;

use rustc_hash::FxHashMap;
use serde_json::Value;

use super::super::{CityError, obj};
use super::shapes_path;
use edifice_base::{Error, Result};
use edifice_io::grammar_cga::solids::{Scope, Solid, SolidRules};
use edifice_io::json::parse_json;
use edifice_io::{file_stem, read_bytes};
use edifice_shape::triangles::{City, CityBuilding, TriangleMesh};

/// The unit box, y up.
const CUBE: ([[f64; 3]; 8], [[u32; 3]; 12]) = (
    [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 1.0],
        [1.0, 1.0, 1.0],
        [0.0, 1.0, 1.0],
    ],
    [
        [0, 2, 1],
        [0, 3, 2],
        [4, 5, 6],
        [4, 6, 7],
        [0, 1, 5],
        [0, 5, 4],
        [3, 7, 6],
        [3, 6, 2],
        [0, 4, 7],
        [0, 7, 3],
        [1, 2, 6],
        [1, 6, 5],
    ],
);

/// Reads rules, with the start shapes and assets beside them, and evaluates them; shapes of one `id` are one building.
///
/// # Errors
/// Names the file, and the line or the element that is wrong.
pub fn read(path: &Path) -> Result<City> {
    let bytes = read_bytes(path)?;
    let text = std::str::from_utf8(&bytes).map_err(|e| Error::content(path, e))?;
    let fail = |e: edifice_io::grammar_cga::CgaError| {
        let place = format!("line {}, column {}", e.line, e.column);
        Error::input(path, place, e)
    };
    let rules = SolidRules::parse(text).map_err(fail)?;
    let shapes = shapes_path(path);
    let mut assets: FxHashMap<String, TriangleMesh> = FxHashMap::default();
    let mut known: FxHashMap<String, usize> = FxHashMap::default();
    let value: Value = parse_json(&read_bytes(&shapes)?, &shapes)?;
    let mut city = City {
        name: file_stem(path),
        reference_system: value["crs"]["properties"]["name"]
            .as_str()
            .map(str::to_owned),
        ..City::default()
    };
    for (i, feature) in value["features"]
        .as_array()
        .into_iter()
        .flatten()
        .enumerate()
    {
        let wrong = |place: &str, text: String| {
            let place = format!("features[{i}].{place}");
            Error::input(&shapes, place, CityError::Format(text))
        };
        let properties = &feature["properties"];
        let rule = properties["rule"].as_str().filter(|r| rules.has_rule(r));
        let rule = rule.ok_or_else(|| {
            let text = format!("{} names no rule", properties["rule"]);
            wrong("properties.rule", text)
        })?;
        let scope = scope(&feature["geometry"]["coordinates"][0]).ok_or_else(|| {
            let text = "expected a rectangle of corners of two or three numbers".to_owned();
            wrong("geometry.coordinates", text)
        })?;
        let stated = properties.as_object().into_iter().flatten();
        let stated: BTreeMap<String, f64> = stated
            .filter_map(|(name, v)| Some((name.clone(), v.as_f64()?)))
            .collect();
        let id = match &properties["id"] {
            Value::String(id) => id.clone(),
            _ => format!("shape-{i}"),
        };
        let building = *known.entry(id.clone()).or_insert_with(|| {
            city.buildings.push(CityBuilding {
                id,
                ..CityBuilding::default()
            });
            city.buildings.len() - 1
        });
        for solid in rules.evaluate(rule, &stated, scope).map_err(fail)? {
            let unit = match &solid.asset {
                None => &cube(),
                Some(name) => match assets.get(name) {
                    Some(mesh) => mesh,
                    None => {
                        let mesh = asset(&path.with_file_name(name))?;
                        assets.entry(name.clone()).or_insert(mesh)
                    }
                },
            };
            city.buildings[building].mesh.append(&placed(unit, &solid));
        }
    }
    Ok(city)
}

/// The scope of a rectangle on the ground: x along its first edge, y up.
fn scope(ring: &Value) -> Option<Scope> {
    let corner = |i: usize| -> Option<[f64; 3]> {
        let p = ring.get(i)?;
        let z = p.get(2).map_or(Some(0.0), Value::as_f64)?;
        Some([p.get(0)?.as_f64()?, z, -p.get(1)?.as_f64()?])
    };
    let [a, b, c, d] = [corner(0)?, corner(1)?, corner(2)?, corner(3)?];
    let length = |p: [f64; 3], q: [f64; 3]| (q[0] - p[0]).hypot(q[2] - p[2]);
    let middle = [0, 2].map(|k| (a[k] + b[k] + c[k] + d[k]) / 4.0);
    let mut scope = Scope {
        at: [middle[0], a[1], middle[1]],
        turn: (a[2] - b[2]).atan2(b[0] - a[0]).to_degrees(),
        size: [length(a, b), 0.0, length(b, c)],
    };
    scope.at = scope.point([-scope.size[0] / 2.0, 0.0, -scope.size[2] / 2.0]);
    Some(scope).filter(|s| s.size[0] > 0.0 && s.size[2] > 0.0)
}

fn cube() -> TriangleMesh {
    TriangleMesh {
        positions: CUBE.0.to_vec(),
        triangles: CUBE.1.to_vec(),
    }
}

/// An asset in shares of its bounding box, y up.
fn asset(path: &Path) -> Result<TriangleMesh> {
    let mut mesh = TriangleMesh::default();
    for building in &obj::read(path)?.buildings {
        mesh.append(&building.mesh);
    }
    let (low, high) = mesh
        .bounds()
        .ok_or_else(|| Error::content(path, CityError::NoBuildings))?;
    for p in &mut mesh.positions {
        *p = [0, 1, 2].map(|k| (p[k] - low[k]) / (high[k] - low[k]));
    }
    Ok(mesh)
}

/// A mesh in the box of a solid, z up.
fn placed(unit: &TriangleMesh, solid: &Solid) -> TriangleMesh {
    let scope = &solid.scope;
    let place = |p: &[f64; 3]| {
        let [x, y, z] = scope.point([0, 1, 2].map(|k| p[k] * scope.size[k]));
        [x, -z, y]
    };
    TriangleMesh {
        positions: unit.positions.iter().map(place).collect(),
        triangles: unit.triangles.clone(),
    }
}
