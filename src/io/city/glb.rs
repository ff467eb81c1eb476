//! Instance grammars as binary glTF 2.0: each template's mesh is stored once, and a node draws all its
//! instances by `EXT_mesh_gpu_instancing`, or, for viewers without it, a node stands for each instance.
//!
//! glTF is y up: (x, y, z) is written as (x, z, -y). The 64-bit origin stands in the `extras` of the scene;
//! identifiers of buildings in the `extras` of the asset's scene too, and `_BUILDING`, an attribute of the instances, is
//! an index into them.

use serde_json::{Value, json};

use crate::grammar::instance::{InstanceDerivation, InstanceGrammar, TemplateInstance};
use crate::io::glb_container::{TooLong, glb_container};
use crate::shape::triangles::TriangleMesh;

/// Why a city cannot be written.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GlbError {
    /// Nothing to draw: glTF forbids empty meshes and accessors.
    #[error("no triangles to write")]
    Empty,
    /// The format cannot say so many bytes.
    #[error(transparent)]
    TooLong(#[from] TooLong),
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
    let mut by_template: Vec<Vec<&TemplateInstance>> = vec![Vec::new(); grammar.templates.len()];
    for instance in &derivation.instances {
        by_template[instance.template].push(instance);
    }
    let mut file = Glb::default();
    let (mut meshes, mut nodes, mut roots) = (Vec::new(), Vec::new(), Vec::new());
    for (template, instances) in grammar.templates.iter().zip(&by_template) {
        if instances.is_empty() || template.mesh.triangles.is_empty() {
            continue;
        }
        let mesh = meshes.len();
        let [positions, indices] = file.mesh(&template.mesh);
        meshes.push(json!({ "name": template.symbol, "primitives": [
            { "attributes": { "POSITION": positions }, "indices": indices, "material": 0 } ] }));
        if instancing {
            roots.push(nodes.len());
            nodes.push(
                json!({ "mesh": mesh, "name": template.symbol, "extensions": {
                "EXT_mesh_gpu_instancing": { "attributes": file.instances(instances) } } }),
            );
        } else {
            for i in instances {
                roots.push(nodes.len());
                let id = i.building.and_then(|b| derivation.buildings.get(b));
                nodes.push(
                    json!({ "mesh": mesh, "name": id.map_or("", |b| b.0.as_str()),
                    "translation": translation(i), "rotation": rotation(i), "scale": scale(i) }),
                );
            }
        }
    }
    if meshes.is_empty() {
        return Err(GlbError::Empty);
    }
    let ids: Vec<&str> = derivation.buildings.iter().map(|b| b.0.as_str()).collect();
    let mut document = json!({
        "asset": { "version": "2.0", "generator": concat!("edifice ", env!("CARGO_PKG_VERSION")) },
        "scene": 0,
        "scenes": [ { "name": grammar.name, "nodes": roots, "extras": {
            "origin": grammar.origin, "reference_system": grammar.reference_system, "buildings": ids } } ],
        "nodes": nodes,
        "meshes": meshes,
        "materials": [ { "name": "building", "pbrMetallicRoughness": {
            "baseColorFactor": [0.75, 0.73, 0.7, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.9 } } ],
        "accessors": file.accessors,
        "bufferViews": file.views,
        "buffers": [ { "byteLength": file.binary.len() } ],
    });
    if instancing {
        document["extensionsUsed"] = json!(["EXT_mesh_gpu_instancing"]);
        document["extensionsRequired"] = json!(["EXT_mesh_gpu_instancing"]);
    }
    let text = document.to_string().into_bytes();
    Ok(glb_container(text, file.binary)?)
}

/// z up to y up.
fn turned(p: [f64; 3]) -> [f32; 3] {
    [p[0] as f32, p[2] as f32, -p[1] as f32]
}

fn translation(i: &TemplateInstance) -> [f32; 3] {
    turned(i.at)
}

fn rotation(i: &TemplateInstance) -> [f32; 4] {
    let (sin, cos) = (i.turn.rem_euclid(360.0).to_radians() / 2.0).sin_cos();
    [0.0, sin as f32, 0.0, cos as f32]
}

fn scale(i: &TemplateInstance) -> [f32; 3] {
    let [w, d, h] = i.size;
    [w as f32, h as f32, d as f32]
}

/// The binary part while it is written.
#[derive(Default)]
struct Glb {
    binary: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

/// Component types of the standard.
const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;

impl Glb {
    /// Accessors of a mesh: positions, indices.
    fn mesh(&mut self, mesh: &TriangleMesh) -> [usize; 2] {
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
            Some(34962),
        );
        let first = self.accessor(json!({ "bufferView": view, "componentType": FLOAT,
            "count": positions.len(), "type": "VEC3", "min": low, "max": high }));
        let indices = mesh.triangles.iter().flatten();
        let view = self.view(indices.flat_map(|i| i.to_le_bytes()), Some(34963));
        let second = self.accessor(json!({ "bufferView": view, "componentType": UNSIGNED_INT,
            "count": 3 * mesh.triangles.len(), "type": "SCALAR" }));
        [first, second]
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

    fn accessor(&mut self, accessor: Value) -> usize {
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }
}
