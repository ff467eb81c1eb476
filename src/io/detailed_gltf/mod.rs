//! Buildings of level of detail 3 as binary glTF 2.0 with textures: a node for each part, called by its name.
//!
//! The root node is the building; walls, roofs and the rest are its children, windows and doors those of their wall. The
//! `extras` of a node say the class of its part (`kind`) and what else is known of it. Corners carry flat normals and
//! texture coordinates in metres (Khronos glTF 2.0, Sec. 3.7.2.1): the first along the wall or the eaves, the second
//! downwards, as glTF's images run, and 0 at the ground or the eaves, so that courses begin there; where there is a map of
//! normals, also tangents. Materials are those of a [`Palette`] (Sec. 3.9.2); `KHR_texture_transform` scales metres to repeats of the texture, panes have
//! `KHR_materials_transmission`. Each image is stored once, as PNG (Sec. 3.8.3.1).
//!
//! glTF is y up: (x, y, z) is written as (x, z, -y).

mod materials;
mod mesh;

use std::collections::BTreeMap;
use std::path::Path;

use gltf_json as json;
use json::extras::RawValue;
use json::mesh::Semantic;
use json::validation::Checked::Valid;
use json::{Extras, Index};
use serde_json::{Map, Value, json};

use super::gltf_document::{COORDINATES, Document, INDICES, TANGENTS, VERTICES, primitive};
use super::gltf_error::GltfError;
use super::write_atomic;
use edifice_base::{Error, Result};
use edifice_scene::palette::Palette;
use edifice_shape::{DetailedBuilding, Part};
use materials::Materials;
use mesh::Corners;

/// Writes a building to a file, whole or not at all.
///
/// # Errors
/// [`Error::Content`] for a building that glTF cannot hold; [`Error::Io`] when the file cannot be written.
pub fn write(building: &DetailedBuilding, palette: &Palette, path: &Path) -> Result<()> {
    let bytes = to_bytes(building, palette).map_err(|e| Error::content(path, e))?;
    write_atomic(path, &bytes)
}

/// Streams of the document.
const POSITIONS: usize = 0;
const NORMALS: usize = 1;
const UVS: usize = 2;
const ALONG: usize = 3;
const CORNERS: usize = 4;

/// The bytes of a binary glTF file. Triangles without area are left out.
///
/// # Errors
/// [`GltfError::EmptyMesh`] for a building without triangles, [`GltfError::Dangling`] for a corner or a wall that is not
/// there (a wall must come before what lies in it), [`GltfError::NotFinite`] for a corner at no place.
pub fn to_bytes(
    building: &DetailedBuilding,
    palette: &Palette,
) -> std::result::Result<Vec<u8>, GltfError> {
    check(building)?;
    let mut document = Document::new(&[VERTICES, VERTICES, COORDINATES, TANGENTS, INDICES]);
    let mut materials = Materials::new(palette);
    // Node 0 is the building, node k + 1 part k.
    let mut children: Vec<Vec<Index<json::Node>>> = vec![Vec::new(); building.parts.len() + 1];
    let mut nodes = Vec::new();
    for (k, part) in building.parts.iter().enumerate() {
        children[part.wall.map_or(0, |wall| wall + 1)].push(Index::new(k as u32 + 1));
        let corners = mesh::corners(building, part, palette);
        let mesh = match corners.triangles.is_empty() {
            true => None,
            false => Some(add_mesh(&mut document, &mut materials, part, &corners)?),
        };
        let mut extras = part.attributes.clone();
        extras.insert("kind".into(), json!(part.kind.name()));
        nodes.push(node(&part.name, mesh, &extras)?);
    }
    if document.root.meshes.is_empty() {
        return Err(GltfError::EmptyMesh {
            index: 0,
            name: building.name.clone(),
        });
    }
    let mut extras = building.attributes.clone();
    extras.insert("kind".into(), json!("Building"));
    nodes.insert(0, node(&building.name, None, &extras)?);
    for (node, children) in nodes.iter_mut().zip(children) {
        node.children = (!children.is_empty()).then_some(children);
    }
    document.root.nodes = nodes;
    document.root.extensions_used = materials.extensions();
    document.glb(vec![Index::new(0)])
}

fn check(building: &DetailedBuilding) -> std::result::Result<(), GltfError> {
    let count = building.positions.len();
    for (index, part) in building.parts.iter().enumerate() {
        if let Some(wall) = part.wall.filter(|&wall| wall >= index) {
            let what = "wall";
            return Err(GltfError::Dangling {
                what,
                index: wall,
                count: index,
            });
        }
        for &corner in part.triangles.iter().flat_map(|(t, _)| t) {
            let place = building.positions.get(corner as usize);
            let place = place.ok_or(GltfError::Dangling {
                what: "corner",
                index: corner as usize,
                count,
            })?;
            // The file has numbers of 32 bits.
            if place.iter().any(|v| !(*v as f32).is_finite()) {
                return Err(GltfError::NotFinite {
                    index,
                    name: part.name.clone(),
                });
            }
        }
    }
    Ok(())
}

fn add_mesh(
    document: &mut Document,
    materials: &mut Materials,
    part: &Part,
    corners: &Corners,
) -> std::result::Result<Index<json::Mesh>, GltfError> {
    let mut attributes = BTreeMap::from([
        (
            Valid(Semantic::Positions),
            document.vectors(POSITIONS, &corners.positions, true),
        ),
        (
            Valid(Semantic::Normals),
            document.vectors(NORMALS, &corners.normals, false),
        ),
        (
            Valid(Semantic::TexCoords(0)),
            document.vectors(UVS, &corners.coordinates, false),
        ),
    ]);
    // Maps of normals stand on tangents.
    if (corners.triangles.keys()).any(|&(finish, is_level)| materials.has_relief(finish, is_level))
    {
        let tangents = document.vectors(ALONG, &corners.tangents, false);
        attributes.insert(Valid(Semantic::Tangents), tangents);
    }
    let mut primitives = Vec::new();
    for (&(finish, is_level), indices) in &corners.triangles {
        let material = materials.index(document, finish, is_level)?;
        let indices = document.indices(CORNERS, indices, corners.positions.len());
        primitives.push(primitive(attributes.clone(), indices, material));
    }
    Ok(document.mesh(&part.name, primitives))
}

fn node(
    name: &str,
    mesh: Option<Index<json::Mesh>>,
    extras: &Map<String, Value>,
) -> std::result::Result<json::Node, GltfError> {
    let text = serde_json::to_string(extras).and_then(RawValue::from_string);
    let extras: Extras = Some(text.map_err(|e| GltfError::Json(e.to_string()))?);
    Ok(json::Node {
        name: Some(name.to_owned()),
        mesh,
        extras,
        ..Default::default()
    })
}
