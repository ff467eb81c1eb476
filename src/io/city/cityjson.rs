//! Cities as CityJSON 1.0 to 2.0 (`.city.json`) and CityJSONSeq (`.city.jsonl`): z up, metres.
//!
//! A building, a first-level city object, is read with its parts; objects that are no buildings are counted in the city's notes. Read are `MultiSurface`, `CompositeSurface`, `Solid`,
//! `MultiSolid` and `CompositeSolid` of the highest level of detail, and instances of geometry templates; polygons with holes are triangulated. Where
//! surfaces are named (semantics) and windows among them, they are painted: openings dark, all else light.
//! Written is CityJSON 2.0 with a `MultiSurface` of triangles for each building.

use std::borrow::Cow;
use std::path::Path;

use rustc_hash::FxHashMap;
use serde::Deserialize;
use serde_json::{Map, Value, json};

use super::CityError;
use super::cityjson_drawing::Drawing;
use super::units::in_metres;
use edifice_base::{Error, Result};
use edifice_io::json::parse_json;
use edifice_io::read_bytes;
use edifice_io::reference_system::standard_name;
use edifice_shape::triangles::{City, CityBuilding, TriangleMesh};

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
    #[serde(rename = "geometry-templates", default)]
    templates: Option<Templates>,
}

/// Geometries that instances refer to, in coordinates of their own.
#[derive(Default, Deserialize)]
struct Templates {
    #[serde(default)]
    templates: Vec<Value>,
    #[serde(rename = "vertices-templates", default)]
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
    let sequence = edifice_io::extension(path) == "jsonl";
    let mut parts: Vec<&[u8]> = match sequence {
        true => bytes.split(|&b| b == b'\n').collect(),
        false => vec![bytes],
    };
    parts.retain(|line| !line.trim_ascii().is_empty());
    let mut city = City {
        name: edifice_io::file_stem(path),
        ..City::default()
    };
    let mut transform = Transform {
        scale: [1.0; 3],
        translate: [0.0; 3],
    };
    let (mut templates, mut others) = (Templates::default(), 0);
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
        // Those of the first line hold for all features.
        templates = document.templates.unwrap_or(templates);
        let objects = Objects {
            objects: &document.objects,
            vertices: &vertices,
            templates: &templates,
        };
        others += objects.read(&mut city).map_err(|(id, error)| {
            Error::input(path, place(&format!("CityObjects.{id}")), error)
        })?;
    }
    if others > 0 {
        let note = format!("left out: {others} city objects that are no buildings");
        city.notes.push(note);
    }
    in_metres(&mut city);
    Ok(city)
}

/// The city objects of a document.
struct Objects<'a> {
    objects: &'a Map<String, Value>,
    vertices: &'a [[f64; 3]],
    templates: &'a Templates,
}

impl Objects<'_> {
    /// Adds the buildings; the number of first-level objects that are none.
    fn read(&self, city: &mut City) -> std::result::Result<usize, (String, CityError)> {
        let mut index: FxHashMap<&str, Option<usize>> = FxHashMap::default();
        let mut others = 0;
        for (id, object) in self.objects {
            if first_parent(object).is_some() {
                continue;
            }
            if !is_building(object) {
                others += 1;
                index.insert(id, None);
                continue;
            }
            index.insert(id, Some(city.buildings.len()));
            let attributes = object.get("attributes").and_then(Value::as_object);
            city.buildings.push(CityBuilding {
                id: id.clone(),
                attributes: attributes.cloned().unwrap_or_default(),
                mesh: TriangleMesh::default(),
                ..CityBuilding::default()
            });
        }
        for (id, object) in self.objects {
            // Parts may have parts; a circle of parents ends after as many steps as there are objects.
            let mut root = id.as_str();
            for _ in 0..self.objects.len() {
                match self.objects.get(root).and_then(first_parent) {
                    Some(parent) => root = parent,
                    None => break,
                }
            }
            let Some(&building) = index.get(root) else {
                let text = format!("its parent {root:?} does not exist");
                return Err((id.clone(), CityError::Format(text)));
            };
            let (Some(building), Some(geometry)) = (building, self.highest(object)) else {
                continue;
            };
            let drawing = self.drawn(geometry).map_err(|e| (id.clone(), e))?;
            let building = &mut city.buildings[building];
            building.mesh.append(&drawing.mesh.welded(1e-6));
            building.paint.extend(drawing.paint);
        }
        city.buildings.retain(|b| !b.mesh.triangles.is_empty());
        Ok(others)
    }

    /// The geometry with surfaces of the highest level of detail.
    fn highest<'a>(&'a self, object: &'a Value) -> Option<&'a Value> {
        let lod = |g: &&Value| {
            let geometry = self.template(g).unwrap_or(g);
            match geometry.get("lod") {
                Some(Value::String(text)) => text.parse().unwrap_or(0.0),
                Some(number) => number.as_f64().unwrap_or(0.0),
                None => 0.0,
            }
        };
        let solid = |g: &&Value| {
            let kind = g.get("type").and_then(Value::as_str).unwrap_or_default();
            kind.ends_with("Surface") || kind.ends_with("Solid") || kind == INSTANCE
        };
        let list = object.get("geometry")?.as_array()?;
        list.iter()
            .filter(solid)
            .max_by(|a, b| lod(a).total_cmp(&lod(b)))
    }

    /// The template of a geometry that is an instance.
    fn template(&self, geometry: &Value) -> Option<&Value> {
        let index = geometry.get("template")?.as_u64()?;
        self.templates.templates.get(usize::try_from(index).ok()?)
    }

    fn drawn(&self, geometry: &Value) -> std::result::Result<Drawing<'_>, CityError> {
        let is_instance = geometry.get("type").and_then(Value::as_str) == Some(INSTANCE);
        let (shape, vertices) = match is_instance {
            true => self.instance(geometry)?,
            false => (geometry, Cow::Borrowed(self.vertices)),
        };
        let mut drawing = Drawing::new(shape, vertices);
        let boundaries = shape.get("boundaries").unwrap_or(&Value::Null);
        drawing.surfaces(boundaries, shape.pointer("/semantics/values"))?;
        Ok(drawing)
    }

    /// The template of an instance, and the vertices of templates where the instance puts them: turned, stretched and moved by its matrix,
    /// then moved to its point.
    fn instance<'a>(&'a self, geometry: &Value) -> std::result::Result<Instance<'a>, CityError> {
        let wrong = |what: &str| CityError::Format(format!("a geometry instance {what}"));
        let template = self
            .template(geometry)
            .ok_or_else(|| wrong("without a template"))?;
        let matrix: [f64; 16] = geometry
            .get("transformationMatrix")
            .and_then(|m| serde_json::from_value(m.clone()).ok())
            .ok_or_else(|| wrong("without a matrix of 16 numbers"))?;
        let index = geometry.pointer("/boundaries/0").and_then(Value::as_u64);
        let index = index.ok_or_else(|| wrong("without a point"))?;
        let count = self.vertices.len();
        let at = usize::try_from(index)
            .ok()
            .and_then(|i| self.vertices.get(i));
        let at = at.ok_or(CityError::Dangling { index, count })?;
        let moved = |p: &[f64; 3]| {
            [0, 1, 2].map(|k| {
                let row = &matrix[4 * k..4 * k + 4];
                row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3] + at[k]
            })
        };
        let vertices = self.templates.vertices.iter().map(moved).collect();
        Ok((template, Cow::Owned(vertices)))
    }
}

/// A template, and the vertices of templates in their places.
type Instance<'a> = (&'a Value, Cow<'a, [[f64; 3]]>);

/// The type of geometries that refer to a template.
const INSTANCE: &str = "GeometryInstance";

/// True for a building; roads, terrain, plants and the like are none. An object without a type is taken for one.
fn is_building(object: &Value) -> bool {
    let kind = object.get("type").and_then(Value::as_str);
    kind.is_none_or(|kind| kind.contains("Building"))
}

fn first_parent(object: &Value) -> Option<&str> {
    object.get("parents")?.get(0)?.as_str()
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
