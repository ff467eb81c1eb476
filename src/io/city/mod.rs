//! Cities: buildings as triangles, in and out.
//!
//! | extension | read | written |
//! | --- | --- | --- |
//! | `.npz` | [`npz`]: NumPy archive of vertices, triangles and offsets | no |
//! | `.obj` | [`obj`]: an object or group is a building, without either a surface is; materials and textures of its `.mtl` | yes |
//! | `.city.json`, `.city.jsonl` | [`cityjson`]: CityJSON 1.0 to 2.0, CityJSONSeq | yes |
//! | `.gml`, `.citygml`, `.xml` (also `.xz`) | [`citygml`]: CityGML 2 and 3, as a stream | no |
//! | `.glb`, `.gltf` | [`gltf`]: a node is a building | `.glb`, [`glb`]: a node with instances for each template |
//! | `.tar`, `.tar.xz` | the `.obj` files in it, with their materials and textures, as one city | no |
//! | `.city-grammar.json` | [`grammar_json`]: instance grammars | yes |
//! | `.city-grammar.bin` | [`compact`]: the same in few bytes | yes |
//! | `.cga` | [`cga`]: rules of CityEngine, with the start shapes and assets beside them | of a grammar |
//! | `tileset.json` | [`tileset`]: 3D Tiles 1.0 and 1.1 | [`tiles`]: 3D Tiles 1.1 |
//! | `.gpkg` | [`geopackage`]: footprints with heights | no |
//! | `.geojson` | [`footprints`]: footprints with heights; [`geojson`]: a shape on the ground | no |
//! | `.json` | [`view_json`]: buildings that one sees | no |

mod archive;
pub mod cga;
pub mod citygml;
pub mod cityjson;
mod cityjson_drawing;
pub mod compact;
pub mod earth;
mod faceted;
pub mod footprints;
pub mod geojson;
pub mod geopackage;
pub mod glb;
pub mod glb_compressed;
pub mod gltf;
mod gltf_data;
mod gltf_instances;
mod gltf_mesh;
mod gltf_properties;
mod gltf_textures;
mod gltf_transform;
pub mod grammar_file;
pub mod grammar_json;
mod meshopt_views;
mod mtl;
pub mod npz;
pub mod obj;
mod obj_write;
pub mod picture;
mod pictures;
pub mod proposal_json;
pub mod region;
mod shells;
mod tile_boxes;
pub mod tiles;
pub mod tileset;
mod units;
pub mod view_json;

pub use pictures::{add_textures, paint_parts};

use std::path::Path;

use edifice_base::{Error, Result};
use edifice_io::extension;
use edifice_shape::triangles::City;

/// Coordinates beyond this are no metres.
const FARTHEST: f64 = 1e8;

/// Coordinates beyond this are moved by whole metres, which become the city's origin: single precision has millimetres up to here.
const NEAR: f64 = 20_000.0;

/// Why a file holds no city.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CityError {
    /// There is no building, or none has a triangle.
    #[error("no buildings with triangles")]
    NoBuildings,
    /// An extension that is no city format.
    #[error(
        "unknown city format; expected .npz, .obj, .glb, .gltf, .gml, .city.json, .city.jsonl, .tar.xz or .cga"
    )]
    UnknownFormat,
    /// Coordinates look like degrees.
    #[error(
        "all coordinates lie within {0:.4} units: degrees, not metres? project them to metres first"
    )]
    Degrees(f64),
    /// A coordinate is not finite, or too large to be metres.
    #[error("coordinate {0} is no length in metres")]
    Coordinate(f64),
    /// A triangle's index leads nowhere.
    #[error("index {index} does not exist, there are {count} positions")]
    Dangling {
        /// The index.
        index: u64,
        /// Number of positions.
        count: usize,
    },
    /// Anything else that the format does not allow.
    #[error("{0}")]
    Format(String),
}

/// Reads a city; the extension tells the format, and every text format may be gzipped.
///
/// # Errors
/// Names the file and the element that is wrong.
pub fn read(path: &Path) -> Result<City> {
    let city = match extension(path).as_str() {
        "npz" => npz::read(path)?,
        "cga" => cga::read(path)?,
        "obj" => obj::read(path)?,
        "glb" | "gltf" => gltf::read(path)?,
        "geojson" => footprints::read(path)?,
        "gpkg" => geopackage::read(path)?,
        "json" if tileset::is_tileset(path) => tileset::read(path)?,
        "json" | "jsonl" => cityjson::read(path)?,
        "gml" | "citygml" | "xml" => citygml::read(path)?,
        "xz" if is_gml(path) => citygml::read(path)?,
        "tar" | "xz" => archive::read(path)?,
        _ => return Err(Error::content(path, CityError::UnknownFormat)),
    };
    check(city, path)
}

/// True if a packed file is CityGML by its name.
fn is_gml(path: &Path) -> bool {
    let inner = extension(&path.with_extension(""));
    matches!(inner.as_str(), "gml" | "citygml" | "xml")
}

/// Checks of every format: a building with triangles, finite metres; an identifier that occurs again gets a number.
fn check(mut city: City, path: &Path) -> Result<City> {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for building in &city.buildings {
        for p in &building.mesh.positions {
            if let Some(&v) = p.iter().find(|v| !v.is_finite() || v.abs() > FARTHEST) {
                let place = format!("building {:?}", building.id);
                return Err(Error::input(path, place, CityError::Coordinate(v)));
            }
            for k in 0..2 {
                low[k] = low[k].min(p[k]);
                high[k] = high[k].max(p[k]);
            }
        }
    }
    if city.triangles() == 0 {
        return Err(Error::content(path, CityError::NoBuildings));
    }
    // Several buildings within a metre are degrees of longitude and latitude.
    let extent = (high[0] - low[0]).max(high[1] - low[1]);
    if extent < 1.0 {
        return Err(Error::content(path, CityError::Degrees(extent)));
    }
    if !low.iter().chain(&high).all(|v| v.abs() <= NEAR) {
        city.take_off_origin();
    }
    city.number_duplicates();
    Ok(city)
}
