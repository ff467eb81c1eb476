//! Scenes as binary glTF 2.0 (`.glb`): one file, meshes stored once, a node for each instance.
//!
//! Meshes carry positions and indices only: glTF then asks the viewer for flat normals, which is
//! how walls and panes look, and corners are shared between faces.

use std::collections::BTreeMap;
use std::path::Path;

use gltf_json as json;
use json::Index;
use json::mesh::Semantic;
use json::validation::Checked::Valid;

use super::gltf_document::{Document, INDICES, VERTICES, linear, primitive};
pub use super::gltf_error::GltfError;
use super::write_atomic;
use edifice_base::{Error, Result};
use edifice_scene::{Group, Instance, Material, Mesh, Scene};

/// Writes a scene to a file, whole or not at all.
///
/// # Errors
/// [`Error::Content`] for a scene that glTF cannot hold; [`Error::Io`] when the file cannot be
/// written.
pub fn write(scene: &Scene, path: &Path) -> Result<()> {
    let bytes = to_bytes(scene).map_err(|e| Error::content(path, e))?;
    write_atomic(path, &bytes)
}

/// The bytes of a binary glTF file.
///
/// # Errors
/// [`GltfError`].
pub fn to_bytes(scene: &Scene) -> std::result::Result<Vec<u8>, GltfError> {
    check(scene)?;
    let mut document = Document::new(&[VERTICES, INDICES]);
    for surface in &scene.materials {
        document.root.materials.push(material(surface));
    }
    let positions = |mesh: &Mesh| document.vectors(0, &mesh.positions, true);
    let positions: Vec<Index<json::Accessor>> = scene.meshes.iter().map(positions).collect();
    for (mesh, positions) in scene.meshes.iter().zip(positions) {
        let attributes = BTreeMap::from([(Valid(Semantic::Positions), positions)]);
        let primitives = mesh.parts.iter().map(|(material, indices)| {
            let indices = document.indices(1, indices, mesh.positions.len());
            primitive(attributes.clone(), indices, Index::new(*material as u32))
        });
        let primitives = primitives.collect();
        document.mesh(&mesh.name, primitives);
    }
    let mut nodes = Vec::new();
    for group in &scene.groups {
        let first = document.root.nodes.len() as u32;
        let children = group.instances.iter().map(instance_node);
        document.root.nodes.extend(children);
        let last = document.root.nodes.len() as u32;
        document
            .root
            .nodes
            .push(group_node(group, (first..last).map(Index::new).collect()));
        nodes.push(Index::new(last));
    }
    document.glb(nodes)
}

fn check(scene: &Scene) -> std::result::Result<(), GltfError> {
    let within = |what, index, count| match index < count {
        true => Ok(()),
        false => Err(GltfError::Dangling { what, index, count }),
    };
    for (index, mesh) in scene.meshes.iter().enumerate() {
        let name = || mesh.name.clone();
        if mesh.positions.is_empty()
            || mesh.parts.iter().any(|(_, i)| i.is_empty())
            || mesh.parts.is_empty()
        {
            return Err(GltfError::EmptyMesh {
                index,
                name: name(),
            });
        }
        if mesh.positions.iter().flatten().any(|v| !v.is_finite()) {
            return Err(GltfError::NotFinite {
                index,
                name: name(),
            });
        }
        for (material, indices) in &mesh.parts {
            within("material", *material, scene.materials.len())?;
            let largest = indices.iter().max().map_or(0, |&i| i as usize);
            within("corner", largest, mesh.positions.len())?;
        }
    }
    let mut instances = scene.groups.iter().flat_map(|g| &g.instances);
    instances.try_for_each(|i| within("mesh", i.mesh, scene.meshes.len()))
}

fn material(surface: &Material) -> json::Material {
    let [r, g, b] = linear(surface.color);
    json::Material {
        name: Some(surface.name.clone()),
        pbr_metallic_roughness: json::material::PbrMetallicRoughness {
            base_color_factor: json::material::PbrBaseColorFactor([r, g, b, 1.0]),
            metallic_factor: json::material::StrengthFactor(0.0),
            roughness_factor: json::material::StrengthFactor(surface.roughness),
            ..Default::default()
        },
        ..Default::default()
    }
}

fn node(yaw: f32, translation: [f32; 3]) -> json::Node {
    let rotation = json::scene::UnitQuaternion([0.0, (yaw / 2.0).sin(), 0.0, (yaw / 2.0).cos()]);
    json::Node {
        rotation: (yaw != 0.0).then_some(rotation),
        translation: (translation != [0.0; 3]).then_some(translation),
        ..Default::default()
    }
}

fn instance_node(instance: &Instance) -> json::Node {
    json::Node {
        mesh: Some(Index::new(instance.mesh as u32)),
        scale: (instance.scale != [1.0; 3]).then_some(instance.scale),
        ..node(instance.yaw, instance.translation)
    }
}

fn group_node(group: &Group, children: Vec<Index<json::Node>>) -> json::Node {
    json::Node {
        name: Some(group.name.clone()),
        children: (!children.is_empty()).then_some(children),
        ..node(group.yaw, group.translation)
    }
}
