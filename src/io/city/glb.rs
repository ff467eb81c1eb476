//! Instance grammars as binary glTF 2.0: each template's mesh is stored once, and a node draws all its
//! instances by `EXT_mesh_gpu_instancing`, or, for viewers without it, a node stands for each instance.
//!
//! glTF is y up: (x, y, z) is written as (x, z, -y). The 64-bit origin is the translation of a root node, whose numbers are JSON and lose
//! nothing, and stands in the `extras` of the scene, where `origin_node` is the index of that node;
//! identifiers of buildings in the `extras` of the asset's scene too, and `_BUILDING`, an attribute of the instances, is
//! an index into them. A template's texture becomes a material of the name [`BOX_MAPPED`].

use serde_json::{Value, json};

use super::faceted::Faceted;
use super::gltf_properties;
use super::pictures::media_type;
use edifice_grammar::instance::{InstanceDerivation, InstanceGrammar, Template, TemplateInstance};
use edifice_io::glb_container::{TooLong, glb_container};
use edifice_shape::triangles::{TriangleMesh, VIEWS, box_coordinates, box_view};

/// Name of the materials of box-mapped templates.
pub const BOX_MAPPED: &str = "box mapping";

/// Why a city cannot be written.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GlbError {
    /// Nothing to draw: glTF forbids empty meshes and accessors.
    #[error("no triangles to write")]
    Empty,
    /// The file would have more bytes than the format can say.
    #[error(transparent)]
    TooLong(#[from] TooLong),
    /// The codec of numbers or triangles failed.
    #[error("meshoptimizer: {0}")]
    Codec(String),
    /// A part of the city is where its reference system is not.
    #[error("{0} knows no place on the earth for a part of the city")]
    NoPlace(String),
}

impl From<meshopt::Error> for GlbError {
    fn from(error: meshopt::Error) -> Self {
        Self::Codec(error.to_string())
    }
}

/// The bytes of a file.
///
/// # Errors
/// [`GlbError`].
pub fn to_bytes(
    grammar: &InstanceGrammar,
    derivation: &InstanceDerivation,
    instancing: bool,
) -> Result<Vec<u8>, GlbError> {
    write(Glb::default(), grammar, derivation, instancing)
}

/// The bytes of a tile of 3D Tiles: with instances, and with normals, without which some viewers draw no light; the origin is left to
/// the tileset.
///
/// # Errors
/// [`GlbError`].
pub(super) fn tile_to_bytes(
    grammar: &InstanceGrammar,
    derivation: &InstanceDerivation,
) -> Result<Vec<u8>, GlbError> {
    write(Glb::tile(), grammar, derivation, true)
}

fn write(
    mut file: Glb,
    grammar: &InstanceGrammar,
    derivation: &InstanceDerivation,
    instancing: bool,
) -> Result<Vec<u8>, GlbError> {
    for (template, instances) in by_template(grammar, derivation) {
        if file.is_tile && Faceted::new(&template.mesh).mesh.triangles.is_empty() {
            continue;
        }
        match instancing {
            true => file.instanced(template, &instances),
            false => {
                let mesh = file.mesh(template);
                for i in instances {
                    let id = i.building.and_then(|b| derivation.buildings.get(b));
                    file.node(
                        json!({ "mesh": mesh, "name": id.map_or("", |b| b.0.as_str()),
                        "translation": translation(i), "rotation": rotation(i), "scale": scale(i) }),
                    );
                }
            }
        }
    }
    let required: &[&str] = match instancing {
        true => &[INSTANCING],
        false => &[],
    };
    file.finish(grammar, derivation, required)
}

/// The extension of glTF that draws a mesh at many places.
pub(super) const INSTANCING: &str = "EXT_mesh_gpu_instancing";

/// Each template that is drawn, with its instances.
pub(super) fn by_template<'a>(
    grammar: &'a InstanceGrammar,
    derivation: &'a InstanceDerivation,
) -> impl Iterator<Item = (&'a Template, Vec<&'a TemplateInstance>)> {
    let mut by_template: Vec<Vec<&TemplateInstance>> = vec![Vec::new(); grammar.templates.len()];
    for instance in &derivation.instances {
        by_template[instance.template].push(instance);
    }
    let all = grammar.templates.iter().zip(by_template);
    all.filter(|(t, instances)| !instances.is_empty() && !t.mesh.triangles.is_empty())
}

/// z up to y up.
pub(super) fn turned(p: [f64; 3]) -> [f32; 3] {
    [p[0] as f32, p[2] as f32, -p[1] as f32]
}

pub(super) fn translation(i: &TemplateInstance) -> [f32; 3] {
    turned(i.at)
}

pub(super) fn rotation(i: &TemplateInstance) -> [f32; 4] {
    let (sin, cos) = (i.turn.rem_euclid(360.0).to_radians() / 2.0).sin_cos();
    [0.0, sin as f32, 0.0, cos as f32]
}

fn scale(i: &TemplateInstance) -> [f32; 3] {
    let [w, d, h] = i.size;
    [w as f32, h as f32, d as f32]
}

/// A file while it is written.
#[derive(Default)]
pub(super) struct Glb {
    pub(super) binary: Vec<u8>,
    /// Buffers beside that of the file's own bytes.
    pub(super) more_buffers: Vec<Value>,
    pub(super) views: Vec<Value>,
    accessors: Vec<Value>,
    images: Vec<Value>,
    pub(super) meshes: Vec<Value>,
    nodes: Vec<Value>,
    /// The property table of buildings, where it has their identifiers instead of the scene.
    pub(super) properties: Option<Value>,
    /// True for the content of a tile.
    pub(super) is_tile: bool,
}

/// Component types of the standard.
pub(super) const FLOAT: u32 = 5126;
pub(super) const UNSIGNED_INT: u32 = 5125;
/// Targets of buffer views.
pub(super) const VERTICES: u32 = 34962;
pub(super) const INDICES: u32 = 34963;
/// Textures end at their edges.
const CLAMP: u32 = 33071;

impl Glb {
    /// The content of a tile, while it is written.
    pub(super) fn tile() -> Self {
        Self {
            is_tile: true,
            ..Self::default()
        }
    }

    /// The index of a view that is written later.
    pub(super) fn view_to_come(&mut self) -> usize {
        self.views.push(Value::Null);
        self.views.len() - 1
    }

    /// Adds a node below the origin.
    pub(super) fn node(&mut self, node: Value) {
        self.nodes.push(node);
    }

    /// Adds a mesh and a node that draws it at many places.
    pub(super) fn instanced(&mut self, template: &Template, instances: &[&TemplateInstance]) {
        let mesh = self.mesh(template);
        let attributes = self.instances(instances);
        self.node(
            json!({ "mesh": mesh, "name": template.symbol, "extensions": { INSTANCING: { "attributes": attributes } } }),
        );
    }

    fn mesh(&mut self, template: &Template) -> usize {
        let primitives = self.primitives(template);
        self.meshes
            .push(json!({ "name": template.symbol, "primitives": primitives }));
        self.meshes.len() - 1
    }

    /// The bytes of the file, with the extensions that a reader must know.
    ///
    /// # Errors
    /// [`GlbError`].
    pub(super) fn finish(
        mut self,
        grammar: &InstanceGrammar,
        derivation: &InstanceDerivation,
        required: &[&str],
    ) -> Result<Vec<u8>, GlbError> {
        if self.meshes.is_empty() {
            return Err(GlbError::Empty);
        }
        let mut roots: Vec<usize> = (0..self.nodes.len()).collect();
        // A tileset says where its tiles are.
        let origin = match self.is_tile {
            true => [0.0; 3],
            false => grammar.origin,
        };
        let mut extras = json!({ "origin": origin, "reference_system": grammar.reference_system });
        if origin != [0.0; 3] {
            let [x, y, z] = origin;
            extras["origin_node"] = json!(self.nodes.len());
            self.nodes
                .push(json!({ "name": "origin", "translation": [x, z, -y], "children": roots }));
            roots = vec![self.nodes.len() - 1];
        }
        if self.properties.is_none() {
            let ids = derivation.buildings.iter().map(|b| b.0.as_str());
            extras["buildings"] = ids.collect();
        }
        let materials = self.materials();
        let mut buffers = vec![json!({ "byteLength": self.binary.len() })];
        buffers.append(&mut self.more_buffers);
        let mut document = json!({
            "asset": { "version": "2.0", "generator": concat!("edifice ", env!("CARGO_PKG_VERSION")) },
            "scene": 0,
            "scenes": [ { "name": grammar.name, "nodes": roots, "extras": extras } ],
            "nodes": self.nodes,
            "meshes": self.meshes,
            "materials": materials,
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": buffers,
        });
        if !self.images.is_empty() {
            let count = self.images.len();
            document["images"] = json!(self.images);
            document["textures"] = (0..count)
                .map(|i| json!({ "source": i, "sampler": 0 }))
                .collect();
            document["samplers"] = json!([{ "wrapS": CLAMP, "wrapT": CLAMP }]);
        }
        let mut used = required.to_vec();
        if let Some(properties) = self.properties {
            document["extensions"] = json!({ gltf_properties::EXTENSION: properties });
            used.push(gltf_properties::EXTENSION);
        }
        if !used.is_empty() {
            document["extensionsUsed"] = json!(used);
        }
        if !required.is_empty() {
            document["extensionsRequired"] = json!(required);
        }
        let text = document.to_string().into_bytes();
        Ok(glb_container(text, self.binary)?)
    }

    /// A template's primitives. One without a texture is one; with a texture there is one for each side of its box, all over the
    /// same positions, since a corner has other texture coordinates on each.
    fn primitives(&mut self, template: &Template) -> Vec<Value> {
        let faceted = self.is_tile.then(|| Faceted::new(&template.mesh));
        let mesh = faceted.as_ref().map_or(&template.mesh, |f| &f.mesh);
        let mut attributes = json!({ "POSITION": self.positions(mesh) });
        if let Some(faceted) = &faceted {
            attributes["NORMAL"] = json!(self.normals(&faceted.normals));
        }
        let Some(texture) = &template.texture else {
            let indices = self.indices(mesh.triangles.iter());
            return vec![json!({ "attributes": attributes, "indices": indices, "material": 0 })];
        };
        let view = self.view(texture.iter().copied(), None);
        self.images
            .push(json!({ "bufferView": view, "mimeType": media_type(texture) }));
        let material = self.images.len();
        let seen = |t: &[u32; 3]| box_view(t.map(|i| mesh.positions[i as usize]));
        let mut out = Vec::new();
        for view in 0..VIEWS {
            let own: Vec<&[u32; 3]> = mesh.triangles.iter().filter(|t| seen(t) == view).collect();
            if own.is_empty() {
                continue;
            }
            // glTF's v goes downwards.
            let coordinates = mesh.positions.iter().flat_map(|&p| {
                let [u, v] = box_coordinates(p, view);
                [u as f32, 1.0 - v as f32]
            });
            let bytes: Vec<u8> = coordinates.flat_map(f32::to_le_bytes).collect();
            let coordinates = self.view(bytes.into_iter(), Some(VERTICES));
            let coordinates = self.accessor(json!({ "bufferView": coordinates,
                "componentType": FLOAT, "count": mesh.positions.len(), "type": "VEC2" }));
            let indices = self.indices(own.into_iter());
            let mut attributes = attributes.clone();
            attributes["TEXCOORD_0"] = json!(coordinates);
            out.push(json!({ "attributes": attributes, "indices": indices, "material": material }));
        }
        out
    }

    /// The plain material, then one for each image.
    fn materials(&self) -> Vec<Value> {
        // Not all surfaces of a city show their outside; they are walls from both sides.
        let plain = json!({ "name": "building", "doubleSided": true, "pbrMetallicRoughness": {
            "baseColorFactor": [0.75, 0.73, 0.7, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.9 } });
        let textured = (0..self.images.len()).map(|i| {
            json!({ "name": BOX_MAPPED, "doubleSided": true, "pbrMetallicRoughness": {
                "baseColorTexture": { "index": i }, "metallicFactor": 0.0, "roughnessFactor": 0.9 } })
        });
        std::iter::once(plain).chain(textured).collect()
    }

    fn positions(&mut self, mesh: &TriangleMesh) -> usize {
        let positions: Vec<[f32; 3]> = mesh.positions.iter().map(|&p| turned(p)).collect();
        let bound = |pick: fn(f32, f32) -> f32, start: f32| {
            let along = |k: usize| positions.iter().fold(start, |m, p| pick(m, p[k]));
            [along(0), along(1), along(2)]
        };
        let (low, high) = (
            bound(f32::min, f32::INFINITY),
            bound(f32::max, f32::NEG_INFINITY),
        );
        let view = self.view(
            positions.iter().flatten().flat_map(|v| v.to_le_bytes()),
            Some(VERTICES),
        );
        self.accessor(json!({ "bufferView": view, "componentType": FLOAT,
            "count": positions.len(), "type": "VEC3", "min": low, "max": high }))
    }

    fn normals(&mut self, normals: &[[f64; 3]]) -> usize {
        let numbers = normals.iter().flat_map(|&n| turned(n));
        let view = self.view(numbers.flat_map(f32::to_le_bytes), Some(VERTICES));
        self.accessor(json!({ "bufferView": view, "componentType": FLOAT,
            "count": normals.len(), "type": "VEC3" }))
    }

    fn indices<'a>(&mut self, triangles: impl Iterator<Item = &'a [u32; 3]>) -> usize {
        let indices: Vec<u32> = triangles.flatten().copied().collect();
        let bytes = indices.iter().flat_map(|i| i.to_le_bytes());
        let view = self.view(bytes, Some(INDICES));
        self.accessor(json!({ "bufferView": view, "componentType": UNSIGNED_INT,
            "count": indices.len(), "type": "SCALAR" }))
    }

    /// The attributes of a node's instances.
    fn instances(&mut self, instances: &[&TemplateInstance]) -> Value {
        let n = instances.len();
        let mut floats = |values: Vec<f32>, kind: &str| {
            let view = self.view(values.iter().flat_map(|v| v.to_le_bytes()), None);
            self.accessor(
                json!({ "bufferView": view, "componentType": FLOAT, "count": n, "type": kind }),
            )
        };
        let t = floats(
            instances.iter().flat_map(|i| translation(i)).collect(),
            "VEC3",
        );
        let r = floats(instances.iter().flat_map(|i| rotation(i)).collect(), "VEC4");
        let s = floats(instances.iter().flat_map(|i| scale(i)).collect(), "VEC3");
        let building = |i: &&TemplateInstance| i.building.map_or(-1.0, |b| b as f32);
        let b = floats(instances.iter().map(building).collect(), "SCALAR");
        json!({ "TRANSLATION": t, "ROTATION": r, "SCALE": s, "_BUILDING": b })
    }

    fn view(&mut self, bytes: impl Iterator<Item = u8>, target: Option<u32>) -> usize {
        // Numbers begin at multiples of their size; a picture may end anywhere.
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        let offset = self.binary.len();
        self.binary.extend(bytes);
        let mut view =
            json!({ "buffer": 0, "byteOffset": offset, "byteLength": self.binary.len() - offset });
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.views.push(view);
        self.views.len() - 1
    }

    pub(super) fn accessor(&mut self, accessor: Value) -> usize {
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }
}
