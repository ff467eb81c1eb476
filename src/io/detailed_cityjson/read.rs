//! Solids of triangles as a file has them, to be checked: the whole numbers of CityJSON, not rounded once more.

use std::path::Path;

use serde::Deserialize;
use serde_json::{Map, Value};

use crate::json::parse_json;
use crate::read_bytes;
use edifice_base::{Error, Result};

/// The shell of a building in the units of its file.
#[derive(Debug, Clone, PartialEq)]
pub struct Shell {
    /// Identifier of the building.
    pub name: String,
    /// True for a solid, false for a set of surfaces.
    pub is_solid: bool,
    /// Corners, as the file has them.
    pub positions: Vec<[i64; 3]>,
    /// Corners of each triangle, and the index of its surface.
    pub triangles: Vec<([u32; 3], usize)>,
    /// The described surfaces.
    pub surfaces: Vec<Described>,
    /// Metres in a unit of the coordinates.
    pub scale: [f64; 3],
}

/// The description of a surface.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Described {
    /// Its class.
    #[serde(rename = "type")]
    pub class: String,
    /// Its name.
    #[serde(default)]
    pub name: String,
    /// Index of the surface that it lies in.
    #[serde(default)]
    pub parent: Option<usize>,
    /// Indices of the surfaces that lie in it.
    #[serde(default)]
    pub children: Vec<usize>,
    /// Everything else that is said of it.
    #[serde(flatten)]
    pub attributes: Map<String, Value>,
}

/// Why a file is no set of shells of triangles.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ShellError {
    /// Not CityJSON.
    #[error("{0:?}, expected \"CityJSON\"")]
    Kind(String),
    /// A geometry without triangles of level of detail 3.
    #[error("no geometry of level of detail 3")]
    NoGeometry,
    /// A surface with more or less than three corners, or with a hole.
    #[error("surface {0} is no triangle")]
    NoTriangle(usize),
    /// An index that leads nowhere.
    #[error("surface {surface} names corner or description {index}, which does not exist")]
    Dangling {
        /// Number of the surface.
        surface: usize,
        /// The index.
        index: u64,
    },
}

#[derive(Deserialize)]
struct Document {
    #[serde(rename = "type")]
    kind: String,
    transform: Transform,
    #[serde(rename = "CityObjects")]
    objects: Map<String, Value>,
    vertices: Vec<[i64; 3]>,
}

#[derive(Deserialize)]
struct Transform {
    scale: [f64; 3],
}

/// Reads the shells of level of detail 3 of all buildings of a CityJSON file.
///
/// # Errors
/// Names the file and the building; [`ShellError`].
pub fn shells(path: &Path) -> Result<Vec<Shell>> {
    parse(&read_bytes(path)?, path)
}

/// Parses the bytes of a file; `path` only names it in errors.
///
/// # Errors
/// As [`shells`].
pub fn parse(bytes: &[u8], path: &Path) -> Result<Vec<Shell>> {
    let document: Document = parse_json(bytes, path)?;
    if document.kind != "CityJSON" {
        return Err(Error::input(path, "type", ShellError::Kind(document.kind)));
    }
    let one = |(name, object): (&String, &Value)| {
        let shell = shell(name, object, &document);
        shell.map_err(|e| Error::input(path, format!("CityObjects.{name}"), e))
    };
    document.objects.iter().map(one).collect()
}

fn shell(
    name: &str,
    object: &Value,
    document: &Document,
) -> std::result::Result<Shell, ShellError> {
    let geometries = object.get("geometry").and_then(Value::as_array);
    let detailed = |g: &&Value| {
        let lod = g.get("lod").and_then(Value::as_str).unwrap_or_default();
        lod.starts_with('3')
    };
    let geometry = geometries.into_iter().flatten().find(detailed);
    let geometry = geometry.ok_or(ShellError::NoGeometry)?;
    let is_solid = geometry.get("type").and_then(Value::as_str) == Some("Solid");
    // A solid has shells, of which the first is the outer one.
    let at = |path: &str| match is_solid {
        true => geometry.pointer(&format!("{path}/0")),
        false => geometry.pointer(path),
    };
    let list = |path: &str| {
        at(path)
            .and_then(Value::as_array)
            .cloned()
            .unwrap_or_default()
    };
    let (boundaries, values) = (list("/boundaries"), list("/semantics/values"));
    let surfaces = geometry
        .pointer("/semantics/surfaces")
        .cloned()
        .unwrap_or_default();
    let surfaces: Vec<Described> = serde_json::from_value(surfaces).unwrap_or_default();
    let mut local: std::collections::HashMap<u64, u32> = std::collections::HashMap::new();
    let mut out = Shell {
        name: name.to_owned(),
        is_solid,
        positions: Vec::new(),
        triangles: Vec::new(),
        surfaces,
        scale: document.transform.scale,
    };
    for (k, surface) in boundaries.iter().enumerate() {
        let rings: Vec<Vec<u64>> =
            serde_json::from_value(surface.clone()).map_err(|_| ShellError::NoTriangle(k))?;
        let [ring] = &rings[..] else {
            return Err(ShellError::NoTriangle(k));
        };
        let Ok(ring) = <[u64; 3]>::try_from(&ring[..]) else {
            return Err(ShellError::NoTriangle(k));
        };
        let dangling = |index| ShellError::Dangling { surface: k, index };
        let mut corners = [0; 3];
        for (corner, index) in corners.iter_mut().zip(ring) {
            let place = usize::try_from(index).ok();
            let place = place.and_then(|i| document.vertices.get(i));
            let place = *place.ok_or_else(|| dangling(index))?;
            *corner = *local.entry(index).or_insert_with(|| {
                out.positions.push(place);
                out.positions.len() as u32 - 1
            });
        }
        let described = values.get(k).and_then(Value::as_u64).unwrap_or(u64::MAX);
        let described_at = usize::try_from(described).ok();
        let described_at = described_at.filter(|i| *i < out.surfaces.len());
        let described_at = described_at.ok_or_else(|| dangling(described))?;
        out.triangles.push((corners, described_at));
    }
    Ok(out)
}
