//! Footprints with heights as GeoJSON or, by [`geopackage`](super::geopackage), as a GeoPackage: each `Polygon` or `MultiPolygon` of a feature is a building with upright walls and a flat roof.
//!
//! Heights are read from the first of these properties that is a number above 0, or text that begins with one: `height`,
//! `building:height`, `measuredHeight`, `render_height`; else storeys of 3 m by `building:levels`, `levels`, `storeys`. `min_height` is the
//! base. Coordinates are metres where the `crs` of the file or their size says so; else degrees of longitude and latitude (RFC 7946),
//! which become metres east and north of the first corner.

use std::path::Path;

use proj4rs::Proj;
use proj4rs::transform::transform;
use serde_json::Value;

use super::CityError;
use super::units::in_metres;
use edifice_base::{Error, Result};
use edifice_io::json::parse_json;
use edifice_io::read_bytes;
use edifice_shape::triangles::{City, CityBuilding, TriangleMesh, polygon_triangles};

const HEIGHTS: [&str; 4] = [
    "height",
    "building:height",
    "measuredHeight",
    "render_height",
];
const STOREYS: [&str; 3] = ["building:levels", "levels", "storeys"];
/// Height of a storey, in metres.
const STOREY: f64 = 3.0;

type Ring = Vec<[f64; 2]>;

/// Reads a file.
///
/// # Errors
/// Names the file and the feature that is wrong.
pub fn read(path: &Path) -> Result<City> {
    parse(&read_bytes(path)?, path)
}

/// Parses the bytes of a file; `path` only names it in errors.
///
/// # Errors
/// As [`read`].
pub fn parse(bytes: &[u8], path: &Path) -> Result<City> {
    let document: Value = parse_json(bytes, path)?;
    let one = [document.clone()];
    let features = match document["features"].as_array() {
        Some(features) => features.as_slice(),
        None => &one,
    };
    let system = document.pointer("/crs/properties/name");
    let system = system.and_then(Value::as_str).map(str::to_owned);
    of_features(features, system, path)
}

/// The buildings of the features of GeoJSON; `path` only names them in errors.
pub(super) fn of_features(
    features: &[Value],
    reference_system: Option<String>,
    path: &Path,
) -> Result<City> {
    let mut city = City {
        name: edifice_io::file_stem(path),
        reference_system,
        ..City::default()
    };
    let mut found: Vec<(CityBuilding, Vec<Vec<Ring>>, [f64; 2])> = Vec::new();
    let mut flat = 0;
    for (i, feature) in features.iter().enumerate() {
        let place = || format!("features[{i}]");
        let fault = |text: &str| Error::input(path, place(), CityError::Format(text.to_owned()));
        let shape = polygons(&feature["geometry"]).ok_or_else(|| fault("no rings of points"))?;
        if shape.is_empty() {
            continue;
        }
        let properties = &feature["properties"];
        let Some(height) = height(properties) else {
            flat += 1;
            continue;
        };
        let id = [&feature["id"], &properties["id"], &properties["@id"]];
        let id = id.into_iter().find_map(|id| match id {
            Value::String(text) => Some(text.clone()),
            Value::Number(number) => Some(number.to_string()),
            _ => None,
        });
        let building = CityBuilding {
            id: id.unwrap_or_else(|| format!("building_{}", i + 1)),
            attributes: properties.as_object().cloned().unwrap_or_default(),
            ..CityBuilding::default()
        };
        let base = number(&properties["min_height"]).unwrap_or(0.0);
        found.push((building, shape, [base, height.max(base)]));
    }
    if flat > 0 {
        city.notes
            .push(format!("left out: {flat} footprints without a height"));
    }
    let points = || found.iter().flat_map(|f| f.1.iter().flatten().flatten());
    let degrees = points().all(|p| p[0].abs() <= 180.0 && p[1].abs() <= 90.0);
    let place = match points().next() {
        Some(&first) if degrees => {
            city.notes
                .push("degrees were projected to metres around the first corner".into());
            city.reference_system = None;
            Place::around(first)
        }
        first => first.map(|p| Place::Metres(p.map(f64::floor))),
    };
    let Some(place) = place else {
        return Err(Error::content(path, CityError::NoBuildings));
    };
    if let Place::Metres([x, y]) = place {
        city.origin = [x, y, 0.0];
    }
    for (i, (mut building, shape, levels)) in found.into_iter().enumerate() {
        for rings in shape {
            let moved = |ring: Ring| ring.into_iter().map(|p| place.metres(p)).collect();
            let rings: Option<Vec<Ring>> = rings.into_iter().map(moved).collect();
            let rings = rings.ok_or_else(|| {
                let text = "coordinates that cannot be projected".to_owned();
                Error::input(
                    path,
                    format!("footprint {}", i + 1),
                    CityError::Format(text),
                )
            })?;
            building.mesh.append(&extruded(rings, levels));
        }
        building.mesh = building.mesh.welded(1e-6);
        city.buildings.push(building);
    }
    city.buildings.retain(|b| !b.mesh.triangles.is_empty());
    in_metres(&mut city);
    Ok(city)
}

/// The polygons of a geometry, each an outer ring and its holes; none for other geometries, `None` for one that is damaged.
fn polygons(geometry: &Value) -> Option<Vec<Vec<Ring>>> {
    let ring = |ring: &Value| -> Option<Ring> {
        let point =
            |p: &Value| -> Option<[f64; 2]> { Some([p.get(0)?.as_f64()?, p.get(1)?.as_f64()?]) };
        let mut points: Ring = ring.as_array()?.iter().map(point).collect::<Option<_>>()?;
        // The last corner repeats the first.
        if points.len() > 1 && points.first() == points.last() {
            points.pop();
        }
        Some(points)
    };
    let polygon =
        |rings: &Value| -> Option<Vec<Ring>> { rings.as_array()?.iter().map(ring).collect() };
    let coordinates = &geometry["coordinates"];
    match geometry["type"].as_str() {
        Some("Polygon") => Some(vec![polygon(coordinates)?]),
        Some("MultiPolygon") => coordinates.as_array()?.iter().map(polygon).collect(),
        _ => Some(Vec::new()),
    }
}

/// A number, or the number that a text such as `12.5 m` begins with.
fn number(value: &Value) -> Option<f64> {
    let read = match value {
        Value::String(text) => {
            let text = text.trim();
            let digit = |c: char| c.is_ascii_digit() || c == '.' || c == '-';
            let end = text.find(|c| !digit(c)).unwrap_or(text.len());
            text[..end].parse().ok()
        }
        value => value.as_f64(),
    };
    read.filter(|v: &f64| v.is_finite())
}

fn height(properties: &Value) -> Option<f64> {
    let first = |names: &[&str]| {
        let all = names.iter().filter_map(|name| number(&properties[*name]));
        all.into_iter().find(|v| *v > 0.0)
    };
    first(&HEIGHTS).or_else(|| Some(STOREY * first(&STOREYS)?))
}

/// The coordinates of a file as metres.
enum Place {
    /// Less whole metres.
    Metres([f64; 2]),
    /// By a transverse Mercator projection around a point.
    Degrees(Box<[Proj; 2]>),
}

impl Place {
    fn around([longitude, latitude]: [f64; 2]) -> Option<Self> {
        let from = Proj::from_proj_string("+proj=longlat +datum=WGS84 +no_defs").ok()?;
        let to = format!(
            "+proj=tmerc +lat_0={latitude} +lon_0={longitude} +k=1 +datum=WGS84 +units=m +no_defs"
        );
        Some(Self::Degrees(Box::new([
            from,
            Proj::from_proj_string(&to).ok()?,
        ])))
    }

    fn metres(&self, p: [f64; 2]) -> Option<[f64; 2]> {
        match self {
            Self::Metres(origin) => Some([p[0] - origin[0], p[1] - origin[1]]),
            Self::Degrees(projections) => {
                let mut point = (p[0].to_radians(), p[1].to_radians(), 0.0);
                transform(&projections[0], &projections[1], &mut point).ok()?;
                Some([point.0, point.1])
            }
        }
    }
}

/// A polygon with holes between two levels, closed.
fn extruded(mut rings: Vec<Ring>, [base, top]: [f64; 2]) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    for (i, ring) in rings.iter_mut().enumerate() {
        let n = ring.len();
        let twice: f64 = (0..n)
            .map(|k| ring[k][0] * ring[(k + 1) % n][1] - ring[(k + 1) % n][0] * ring[k][1])
            .sum();
        // The outer ring counterclockwise, holes clockwise.
        if (twice < 0.0) == (i == 0) {
            ring.reverse();
        }
    }
    let at = |z: f64| -> Vec<Vec<[f64; 3]>> {
        let lifted = |ring: &Ring| ring.iter().map(|p| [p[0], p[1], z]).collect();
        rings.iter().map(lifted).collect()
    };
    for [a, b, c] in polygon_triangles(&at(top)) {
        mesh.push([a, b, c]);
    }
    for [a, b, c] in polygon_triangles(&at(base)) {
        mesh.push([a, c, b]);
    }
    for ring in &rings {
        for (k, &[x, y]) in ring.iter().enumerate() {
            let [u, v] = ring[(k + 1) % ring.len()];
            mesh.push([[x, y, base], [u, v, base], [u, v, top]]);
            mesh.push([[x, y, base], [u, v, top], [x, y, top]]);
        }
    }
    mesh
}
