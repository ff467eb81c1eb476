//! Scenes as binary glTF 2.0 (`.glb`): one file, meshes stored once, a node for each instance.
//!
//! Meshes carry positions and indices only: glTF then asks the viewer for flat normals, which is
//! how walls and panes look, and corners are shared between faces.

use std::collections::BTreeMap;
use std::path::Path;

use gltf_json as json;
use json::accessor::{ComponentType, GenericComponentType, Type};
use json::validation::Checked::Valid;
use json::validation::USize64;
use json::{Index, Root};

use super::glb_container::{TooLong, glb_container};
use super::write_atomic;
use edifice_base::{Error, Result};
use edifice_scene::{Group, Instance, Material, Mesh, Scene};

/// Why a scene cannot be written.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GltfError {
    /// A mesh has no positions or no triangles, which glTF does not allow.
    #[error("mesh {index} ({name}) is empty")]
    EmptyMesh {
        /// Index of the mesh.
        index: usize,
        /// Its name.
        name: String,
    },
    /// An index leads nowhere.
    #[error("{what} {index} does not exist, there are {count}")]
    Dangling {
        /// `mesh`, `material` or `corner`.
        what: &'static str,
        /// The index.
        index: usize,
        /// Number of them in the scene.
        count: usize,
    },
    /// A position is not finite.
    #[error("mesh {index} ({name}) has a corner that is not finite")]
    NotFinite {
        /// Index of the mesh.
        index: usize,
        /// Its name.
        name: String,
    },
    /// The file would be larger than the format can say (4 GiB).
    #[error("the scene takes {bytes} bytes, more than a binary glTF can hold")]
    TooLarge {
        /// Its size.
        bytes: u64,
    },
    /// The document could not be written as JSON.
    #[error("the document cannot be written: {0}")]
    Json(String),
}

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
    let mut document = Document::default();
    for surface in &scene.materials {
        document.root.materials.push(material(surface));
    }
    for mesh in &scene.meshes {
        document.positions(mesh);
    }
    for mesh in &scene.meshes {
        document.indices(mesh);
    }
    document.finish_buffers();
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
    document.root.scenes.push(json::Scene {
        name: None,
        nodes,
        extensions: None,
        extras: Default::default(),
    });
    document.root.scene = Some(Index::new(0));
    document.root.asset.generator = Some(format!("edifice {}", env!("CARGO_PKG_VERSION")));
    document.glb()
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

/// The document and its binary part while they are written.
#[derive(Default)]
struct Document {
    root: Root,
    positions: Vec<u8>,
    indices: Vec<u8>,
    /// Accessor of each mesh's positions.
    accessors: Vec<Index<json::Accessor>>,
}

/// Buffer views: positions, three numbers of four bytes, then indices. Several accessors share the first, which
/// therefore must say its stride.
const VIEWS: [(json::buffer::Target, Option<json::buffer::Stride>); 2] = [
    (
        json::buffer::Target::ArrayBuffer,
        Some(json::buffer::Stride(12)),
    ),
    (json::buffer::Target::ElementArrayBuffer, None),
];

impl Document {
    fn positions(&mut self, mesh: &Mesh) {
        let offset = self.positions.len();
        let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        for p in &mesh.positions {
            for i in 0..3 {
                low[i] = low[i].min(p[i]);
                high[i] = high[i].max(p[i]);
                self.positions.extend(p[i].to_le_bytes());
            }
        }
        let mut accessor = accessor(
            0,
            offset,
            mesh.positions.len(),
            ComponentType::F32,
            Type::Vec3,
        );
        accessor.min = Some(serde_json::json!(low));
        accessor.max = Some(serde_json::json!(high));
        let index = self.root.push(accessor);
        self.accessors.push(index);
    }

    fn indices(&mut self, mesh: &Mesh) {
        let position = self.accessors[self.root.meshes.len()];
        // The largest 16-bit number is not allowed as an index.
        let short = mesh.positions.len() < usize::from(u16::MAX);
        let primitives = mesh.parts.iter().map(|(material, indices)| {
            let offset = self.indices.len();
            for &index in indices {
                match short {
                    true => self.indices.extend((index as u16).to_le_bytes()),
                    false => self.indices.extend(index.to_le_bytes()),
                }
            }
            self.indices
                .resize(self.indices.len().next_multiple_of(4), 0);
            let component = if short {
                ComponentType::U16
            } else {
                ComponentType::U32
            };
            let accessor = accessor(1, offset, indices.len(), component, Type::Scalar);
            json::mesh::Primitive {
                attributes: BTreeMap::from([(Valid(json::mesh::Semantic::Positions), position)]),
                indices: Some(self.root.push(accessor)),
                material: Some(Index::new(*material as u32)),
                mode: Valid(json::mesh::Mode::Triangles),
                targets: None,
                extensions: None,
                extras: Default::default(),
            }
        });
        let primitives = primitives.collect();
        self.root.meshes.push(json::Mesh {
            name: Some(mesh.name.clone()),
            primitives,
            weights: None,
            extensions: None,
            extras: Default::default(),
        });
    }

    fn finish_buffers(&mut self) {
        let lengths = [self.positions.len(), self.indices.len()];
        if lengths[0] == 0 {
            return;
        }
        let buffer = self.root.push(json::Buffer {
            byte_length: USize64::from(lengths[0] + lengths[1]),
            name: None,
            uri: None,
            extensions: None,
            extras: Default::default(),
        });
        let mut offset = 0;
        for (length, (target, byte_stride)) in lengths.into_iter().zip(VIEWS) {
            self.root.push(json::buffer::View {
                buffer,
                byte_length: USize64::from(length),
                byte_offset: Some(USize64::from(offset)),
                byte_stride,
                name: None,
                target: Some(Valid(target)),
                extensions: None,
                extras: Default::default(),
            });
            offset += length;
        }
    }

    fn glb(self) -> std::result::Result<Vec<u8>, GltfError> {
        let text = self
            .root
            .to_vec()
            .map_err(|e| GltfError::Json(e.to_string()))?;
        let mut binary = self.positions;
        binary.extend(self.indices);
        glb_container(text, binary).map_err(|TooLong(bytes)| GltfError::TooLarge { bytes })
    }
}

fn accessor(
    view: u32,
    offset: usize,
    count: usize,
    component: ComponentType,
    kind: Type,
) -> json::Accessor {
    json::Accessor {
        buffer_view: Some(Index::new(view)),
        byte_offset: Some(USize64::from(offset)),
        count: USize64::from(count),
        component_type: Valid(GenericComponentType(component)),
        type_: Valid(kind),
        min: None,
        max: None,
        name: None,
        normalized: false,
        sparse: None,
        extensions: None,
        extras: Default::default(),
    }
}

fn material(surface: &Material) -> json::Material {
    // glTF takes linear colours.
    let linear = |c: u8| {
        let c = f32::from(c) / 255.0;
        if c <= 0.04045 {
            c / 12.92
        } else {
            ((c + 0.055) / 1.055).powf(2.4)
        }
    };
    let [r, g, b] = surface.color.map(linear);
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
