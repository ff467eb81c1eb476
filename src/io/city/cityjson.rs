//! Cities as CityJSON 1.0 to 2.0 (`.city.json`) and CityJSONSeq (`.city.jsonl`): z up, metres.
//!
//! A first-level city object with its parts is a building. Read are `MultiSurface`, `CompositeSurface`, `Solid`,
//! `MultiSolid` and `CompositeSolid` of the highest level of detail; polygons with holes are triangulated. Where
//! surfaces are named (semantics) and windows among them, they are painted: openings dark, all else light.
//! Written is CityJSON 2.0 with a `MultiSurface` of triangles for each building.

use std::path::Path;
use std::sync::Arc;

use rustc_hash::FxHashMap;
use serde::Deserialize;
use serde_json::{Map, Value, json};

use super::CityError;
use crate::json::parse_json;
use crate::read_bytes;
use edifice_base::{Error, Result};
use edifice_shape::triangles::{
    City, CityBuilding, Painted, Surface, TriangleMesh, polygon_triangles,
};

#[derive(Deserialize)]
struct Document {
    #[serde(rename = "type")]
    kind: String,
    #[serde(default)]
    transform: Option<Transform>,
    #[serde(default)]
    metadata: Map<String, Value>,
    #[serde(rename = "CityObjects", default)]
    objects: Map<String, Value>,
    #[serde(default)]
    vertices: Vec<[f64; 3]>,
}

#[derive(Deserialize, Clone, Copy)]
struct Transform {
    scale: [f64; 3],
    translate: [f64; 3],
}

/// Reads a file; the first line of a CityJSONSeq carries the transform, each further line a feature.
///
/// # Errors
/// Names the file and the element that is wrong.
pub fn read(path: &Path) -> Result<City> {
    parse(&read_bytes(path)?, path)
}

/// Parses the bytes of a file; `path` only names it in errors.
///
/// # Errors
/// As [`read`].
pub fn parse(bytes: &[u8], path: &Path) -> Result<City> {
    let sequence = crate::packed::extension(path) == "jsonl";
    let mut parts: Vec<&[u8]> = match sequence {
        true => bytes.split(|&b| b == b'\n').collect(),
        false => vec![bytes],
    };
    parts.retain(|line| !line.trim_ascii().is_empty());
    let mut city = City {
        name: crate::file_stem(path),
        ..City::default()
    };
    let mut transform = Transform {
        scale: [1.0; 3],
        translate: [0.0; 3],
    };
    for (line, part) in parts.into_iter().enumerate() {
        let place = |inner: &str| match sequence {
            true => format!("line {}, {inner}", line + 1),
            false => inner.to_owned(),
        };
        let document: Document = parse_json(part, path)?;
        let expected = if line == 0 {
            "CityJSON"
        } else {
            "CityJSONFeature"
        };
        if document.kind != expected {
            let text = format!("{:?}, expected {expected:?}", document.kind);
            return Err(Error::input(path, place("type"), CityError::Format(text)));
        }
        if line == 0 {
            transform = document.transform.unwrap_or(transform);
            city.origin = transform.translate;
            let system = document.metadata.get("referenceSystem");
            city.reference_system = system.and_then(Value::as_str).map(str::to_owned);
        }
        let scaled = |v: &[f64; 3]| [0, 1, 2].map(|k| v[k] * transform.scale[k]);
        let vertices: Vec<[f64; 3]> = document.vertices.iter().map(scaled).collect();
        read_objects(&document.objects, &vertices, &mut city).map_err(|(id, error)| {
            Error::input(path, place(&format!("CityObjects.{id}")), error)
        })?;
    }
    Ok(city)
}

fn read_objects(
    objects: &Map<String, Value>,
    vertices: &[[f64; 3]],
    city: &mut City,
) -> std::result::Result<(), (String, CityError)> {
    let mut index: FxHashMap<&str, usize> = FxHashMap::default();
    for (id, object) in objects {
        if first_parent(object).is_none() {
            index.insert(id, city.buildings.len());
            let attributes = object.get("attributes").and_then(Value::as_object);
            city.buildings.push(CityBuilding {
                id: id.clone(),
                attributes: attributes.cloned().unwrap_or_default(),
                mesh: TriangleMesh::default(),
                ..CityBuilding::default()
            });
        }
    }
    for (id, object) in objects {
        // Parts may have parts; a circle of parents ends after as many steps as there are objects.
        let mut root = id.as_str();
        for _ in 0..objects.len() {
            match objects.get(root).and_then(first_parent) {
                Some(parent) => root = parent,
                None => break,
            }
        }
        let Some(&building) = index.get(root) else {
            let text = format!("its parent {root:?} does not exist");
            return Err((id.clone(), CityError::Format(text)));
        };
        let mut drawing = Drawing {
            vertices,
            kinds: Vec::new(),
            mesh: TriangleMesh::default(),
            paint: Vec::new(),
        };
        if let Some(geometry) = highest(object) {
            let boundaries = geometry.get("boundaries").unwrap_or(&Value::Null);
            drawing.kinds = greys(geometry);
            let values = geometry.pointer("/semantics/values");
            let drawn = drawing.surfaces(boundaries, values);
            drawn.map_err(|e| (id.clone(), e))?;
        }
        let building = &mut city.buildings[building];
        building.mesh.append(&drawing.mesh.welded(1e-6));
        building.paint.extend(drawing.paint);
    }
    city.buildings.retain(|b| !b.mesh.triangles.is_empty());
    Ok(())
}

fn first_parent(object: &Value) -> Option<&str> {
    object.get("parents")?.get(0)?.as_str()
}

/// The geometry with surfaces of the highest level of detail.
fn highest(object: &Value) -> Option<&Value> {
    let lod = |g: &&Value| match g.get("lod") {
        Some(Value::String(text)) => text.parse().unwrap_or(0.0),
        Some(number) => number.as_f64().unwrap_or(0.0),
        None => 0.0,
    };
    let solid = |g: &&Value| {
        let kind = g.get("type").and_then(Value::as_str).unwrap_or_default();
        kind.ends_with("Surface") || kind.ends_with("Solid")
    };
    let list = object.get("geometry")?.as_array()?;
    list.iter()
        .filter(solid)
        .max_by(|a, b| lod(a).total_cmp(&lod(b)))
}

/// Greys of openings and of everything else.
const OPENING: u8 = 40;
const WALL: u8 = 220;

/// The grey of each kind of surface of a geometry, if windows are among them: what a drawing of the building would show.
fn greys(geometry: &Value) -> Vec<Arc<Surface>> {
    let kinds = geometry.pointer("/semantics/surfaces");
    let kinds = kinds.and_then(Value::as_array).into_iter().flatten();
    let names: Vec<&str> = kinds
        .map(|k| k.get("type").and_then(Value::as_str).unwrap_or_default())
        .collect();
    if !names.contains(&"Window") {
        return Vec::new();
    }
    let grey = |name: &&str| match *name {
        "Window" | "Door" => OPENING,
        _ => WALL,
    };
    let surface = |name| Arc::new(Surface::Plain([grey(name); 3]));
    names.iter().map(surface).collect()
}

/// An object as it is drawn.
struct Drawing<'a> {
    vertices: &'a [[f64; 3]],
    /// The paint of the surfaces of each kind.
    kinds: Vec<Arc<Surface>>,
    mesh: TriangleMesh,
    paint: Vec<Painted>,
}

impl Drawing<'_> {
    /// Surfaces at any depth of nesting: a surface is a list of rings, a ring a list of indices. `kinds` are nested in the
    /// same way, down to one for each surface.
    fn surfaces(
        &mut self,
        value: &Value,
        kinds: Option<&Value>,
    ) -> std::result::Result<(), CityError> {
        let wrong = || CityError::Format("boundaries are not nested lists of indices".to_owned());
        let list = value.as_array().ok_or_else(wrong)?;
        let is_surface = list
            .first()
            .and_then(Value::as_array)
            .and_then(|ring| ring.first())
            .is_some_and(Value::is_number);
        if !is_surface {
            let own = |i: usize| kinds.and_then(|k| k.get(i));
            let mut inner = list.iter().enumerate();
            return inner.try_for_each(|(i, inner)| self.surfaces(inner, own(i)));
        }
        let mut rings: Vec<Vec<[f64; 3]>> = Vec::new();
        for ring in list {
            let mut corners = Vec::new();
            for index in ring.as_array().ok_or_else(wrong)? {
                let index = index.as_u64().ok_or_else(wrong)?;
                let count = self.vertices.len();
                let vertex = usize::try_from(index).ok();
                let vertex = vertex.and_then(|i| self.vertices.get(i));
                corners.push(*vertex.ok_or(CityError::Dangling { index, count })?);
            }
            rings.push(corners);
        }
        let kind = kinds.and_then(Value::as_u64);
        let kind = kind.and_then(|k| usize::try_from(k).ok());
        let surface = kind.and_then(|k| self.kinds.get(k)).cloned();
        for corners in polygon_triangles(&rings) {
            self.mesh.push(corners);
            self.paint.extend(surface.clone().map(|surface| Painted {
                corners,
                uv: [[0.0; 2]; 3],
                surface,
            }));
        }
        Ok(())
    }
}

/// Millimetres: coordinates are written as integers.
const SCALE: f64 = 0.001;

/// The text of a CityJSON 2.0 file.
pub fn to_string(city: &City) -> String {
    let mut known: FxHashMap<[i64; 3], usize> = FxHashMap::default();
    let mut vertices: Vec<[i64; 3]> = Vec::new();
    let mut objects = Map::new();
    for b in &city.buildings {
        let mut boundaries = Vec::new();
        for t in b.mesh.corners() {
            let ring = t.map(|p| {
                let key = p.map(|v| (v / SCALE).round() as i64);
                *known.entry(key).or_insert_with(|| {
                    vertices.push(key);
                    vertices.len() - 1
                })
            });
            if ring[0] != ring[1] && ring[1] != ring[2] && ring[2] != ring[0] {
                boundaries.push(json!([ring]));
            }
        }
        let mut object = json!({ "type": "Building", "geometry": [
            { "type": "MultiSurface", "lod": "2", "boundaries": boundaries } ] });
        if !b.attributes.is_empty() {
            object["attributes"] = Value::Object(b.attributes.clone());
        }
        objects.insert(b.id.clone(), object);
    }
    let mut document = json!({ "type": "CityJSON", "version": "2.0",
        "transform": { "scale": [SCALE, SCALE, SCALE], "translate": city.origin },
        "CityObjects": objects, "vertices": vertices });
    if let Some(system) = city.reference_system.as_deref().and_then(standard_name) {
        document["metadata"] = json!({ "referenceSystem": system });
    }
    document.to_string()
}

/// The beginning of the standard's names of reference systems.
const OPEN_GIS: &str = "https://www.opengis.net/def/crs/";

/// A reference system as CityJSON 2.0 names it: `EPSG:7415` is `https://www.opengis.net/def/crs/EPSG/0/7415`. The standard
/// allows no other names: such are left out.
pub(crate) fn standard_name(system: &str) -> Option<String> {
    if let Some(rest) = system.strip_prefix("http://www.opengis.net/def/crs/") {
        return Some(format!("{OPEN_GIS}{rest}"));
    }
    if system.starts_with(OPEN_GIS) {
        return Some(system.to_owned());
    }
    let code = system.rsplit(':').next().filter(|c| !c.is_empty())?;
    let digits = code.chars().all(|c| c.is_ascii_digit());
    (digits && system.to_uppercase().contains("EPSG")).then(|| format!("{OPEN_GIS}EPSG/0/{code}"))
}
