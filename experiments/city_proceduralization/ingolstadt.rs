//! The houses of Ingolstadt, whose polygons are named (walls, roofs, windows, doors), as CityJSON with semantics.

use std::path::Path;

use serde::Deserialize;
use serde_json::{Map, Value, json};

use edifice_base::{Error, Result};
use edifice_io::json::parse_json;
use edifice_io::read_bytes;
use edifice_io_city::cityjson;
use edifice_shape::triangles::City;

/// The file.
#[derive(Deserialize)]
struct Document {
    buildings: Vec<House>,
}

#[derive(Deserialize)]
struct House {
    id: String,
    polys: Vec<Polygon>,
}

/// A polygon: what it is of, and its rings, each closed.
#[derive(Deserialize)]
struct Polygon {
    s: Option<String>,
    r: Vec<Vec<[f64; 3]>>,
}

/// Reads the file.
pub(crate) fn read(path: &Path) -> Result<City> {
    let document: Document = parse_json(&read_bytes(path)?, path)?;
    let mut vertices: Vec<[f64; 3]> = Vec::new();
    let mut objects = Map::new();
    for house in document.buildings {
        let mut names: Vec<String> = Vec::new();
        let (mut boundaries, mut values) = (Vec::new(), Vec::new());
        for polygon in house.polys {
            let name = polygon.s.unwrap_or_default();
            let known = names.iter().position(|n| *n == name);
            values.push(known.unwrap_or(names.len()));
            if known.is_none() {
                names.push(name);
            }
            let ring = |ring: &Vec<[f64; 3]>| {
                let first = vertices.len();
                let open = ring
                    .len()
                    .saturating_sub(usize::from(ring.first() == ring.last()));
                vertices.extend(&ring[..open]);
                (first..first + open).collect::<Vec<usize>>()
            };
            let rings: Vec<Vec<usize>> = polygon.r.iter().map(ring).collect();
            boundaries.push(rings);
        }
        let kinds: Vec<Value> = names.iter().map(|n| json!({ "type": n })).collect();
        let object = json!({ "type": "Building", "geometry": [ { "type": "MultiSurface", "lod": "3",
            "boundaries": boundaries, "semantics": { "surfaces": kinds, "values": values } } ] });
        objects.insert(house.id, object);
    }
    let document = json!({ "type": "CityJSON", "version": "2.0", "CityObjects": objects, "vertices": vertices });
    let bytes = serde_json::to_vec(&document).map_err(Error::method)?;
    cityjson::parse(&bytes, path)
}
