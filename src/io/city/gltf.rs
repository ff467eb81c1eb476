//! Cities as glTF 2.0: `.glb`, and `.gltf` with buffers inside it or beside it.
//!
//! A node of the scene with a mesh is a building, called by its name. Instances of `EXT_mesh_gpu_instancing` are drawn out.
//! What Edifice wrote ([`super::glb`]) says which building an instance belongs to (`_BUILDING` and the scene's `extras`): those
//! of one building become one, which knows the instances it is put together from ([`Part`](crate::shape::triangles::Part)). glTF is y up: (x, y, z) is read as (x, -z, y). Read are triangles, strips and fans; points and
//! lines are left out. Every index and length is checked against the bytes there are.

use std::collections::hash_map::Entry;
use std::path::Path;

use rustc_hash::FxHashMap;
use serde::Deserialize;
use serde_json::{Map, Value};

use super::CityError;
use super::gltf_data::{Accessor, Buffer, Buffers, View, load};
use super::gltf_transform::{
    IDENTITY, Matrix, applied, composed, determinant, product, upright_box,
};
use crate::io::glb_container::split;
use crate::io::json::parse_json;
use crate::io::read_bytes;
use crate::shape::triangles::{City, CityBuilding, TriangleMesh};
use crate::{Error, Result};

/// Extensions that may be required.
const KNOWN: [&str; 4] = [
    "EXT_mesh_gpu_instancing",
    "KHR_materials_unlit",
    "KHR_texture_transform",
    "KHR_mesh_quantization",
];
/// Depth of nodes below nodes; a circle is deeper.
const DEEPEST: usize = 64;
/// Triangles that the instances of a file may stand for.
const MOST_TRIANGLES: usize = 200_000_000;

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Document {
    #[serde(default)]
    scene: usize,
    #[serde(default)]
    scenes: Vec<Scene>,
    #[serde(default)]
    nodes: Vec<Node>,
    #[serde(default)]
    meshes: Vec<Mesh>,
    #[serde(default)]
    accessors: Vec<Accessor>,
    #[serde(default)]
    buffer_views: Vec<View>,
    #[serde(default)]
    buffers: Vec<Buffer>,
    #[serde(default)]
    extensions_required: Vec<String>,
}

#[derive(Deserialize)]
struct Scene {
    #[serde(default)]
    name: String,
    #[serde(default)]
    nodes: Vec<usize>,
    #[serde(default)]
    extras: Value,
}

#[derive(Deserialize)]
struct Node {
    #[serde(default)]
    name: String,
    #[serde(default)]
    children: Vec<usize>,
    mesh: Option<usize>,
    matrix: Option<Matrix>,
    translation: Option<[f64; 3]>,
    rotation: Option<[f64; 4]>,
    scale: Option<[f64; 3]>,
    #[serde(default)]
    extensions: Map<String, Value>,
    #[serde(default)]
    extras: Value,
}

#[derive(Deserialize)]
struct Mesh {
    primitives: Vec<Primitive>,
}

#[derive(Deserialize)]
struct Primitive {
    attributes: FxHashMap<String, usize>,
    indices: Option<usize>,
    #[serde(default = "triangles")]
    mode: u32,
}

fn triangles() -> u32 {
    4
}

/// Reads a file.
///
/// # Errors
/// Names the file and the element that is wrong.
pub fn read(path: &Path) -> Result<City> {
    parse(&read_bytes(path)?, path)
}

/// Parses the bytes of a file; buffers that it names lie beside `path`.
///
/// # Errors
/// As [`read`].
pub fn parse(bytes: &[u8], path: &Path) -> Result<City> {
    let (text, binary) = match bytes.starts_with(b"glTF") {
        true => split(bytes).map_err(|e| Error::content(path, e))?,
        false => (bytes, None),
    };
    let document: Document = parse_json(text, path)?;
    let required = document.extensions_required.iter();
    if let Some(unknown) = required.clone().find(|e| !KNOWN.contains(&e.as_str())) {
        let text = format!("{unknown} is required and not known");
        return Err(Error::input(
            path,
            "extensionsRequired",
            CityError::Format(text),
        ));
    }
    let mut data = Vec::with_capacity(document.buffers.len());
    for (i, buffer) in document.buffers.iter().enumerate() {
        let bytes = load(buffer, binary, path)?;
        if bytes.len() < buffer.byte_length {
            let text = format!("{} bytes, not {}", bytes.len(), buffer.byte_length);
            return Err(Error::input(
                path,
                format!("buffers[{i}]"),
                CityError::Format(text),
            ));
        }
        data.push(bytes);
    }
    let buffers = Buffers {
        data,
        views: &document.buffer_views,
        accessors: &document.accessors,
    };
    let mut reader = Reader {
        document: &document,
        buffers,
        meshes: FxHashMap::default(),
        city: City {
            name: crate::io::file_stem(path),
            ..City::default()
        },
        ids: Vec::new(),
        listed: FxHashMap::default(),
        triangles: 0,
    };
    let fault = |(place, error): (String, CityError)| Error::input(path, place, error);
    reader.scene().map_err(fault)?;
    Ok(reader.city)
}

type Fault = (String, CityError);

/// The city as it is read.
struct Reader<'a> {
    document: &'a Document,
    buffers: Buffers<'a>,
    /// Meshes read so far, in glTF's axes.
    meshes: FxHashMap<usize, TriangleMesh>,
    city: City,
    /// Identifiers of the buildings that instances belong to; they are the first buildings of the city.
    ids: Vec<String>,
    /// Which building of the city has the identifier.
    listed: FxHashMap<String, usize>,
    triangles: usize,
}

impl Reader<'_> {
    fn scene(&mut self) -> std::result::Result<(), Fault> {
        let place = || format!("scenes[{}]", self.document.scene);
        let scene = self.document.scenes.get(self.document.scene);
        let scene = scene.ok_or_else(|| (place(), CityError::NoBuildings))?;
        let origin = scene.extras.get("origin").cloned();
        if let Some(Ok(origin)) = origin.map(serde_json::from_value::<[f64; 3]>) {
            self.city.origin = origin;
        }
        let system = scene.extras.get("reference_system").and_then(Value::as_str);
        self.city.reference_system = system.map(str::to_owned);
        let ids = scene.extras.get("buildings").cloned();
        self.ids = ids
            .and_then(|ids| serde_json::from_value(ids).ok())
            .unwrap_or_default();
        // Other programs call every scene "Scene".
        if !self.ids.is_empty() && !scene.name.is_empty() {
            self.city.name.clone_from(&scene.name);
        }
        for id in &self.ids {
            let next = self.listed.len();
            if let Entry::Vacant(new) = self.listed.entry(id.clone()) {
                new.insert(next);
                self.city.buildings.push(CityBuilding {
                    id: id.clone(),
                    ..CityBuilding::default()
                });
            }
        }
        for &root in &scene.nodes {
            self.node(root, &IDENTITY, 0)?;
        }
        // One that is listed and has no instance is no building.
        let listed = &self.listed;
        let missing = |b: &CityBuilding| b.mesh.positions.is_empty() && listed.contains_key(&b.id);
        self.city.buildings.retain(|b| !missing(b));
        self.city.number_duplicates();
        Ok(())
    }

    fn node(
        &mut self,
        index: usize,
        above: &Matrix,
        depth: usize,
    ) -> std::result::Result<(), Fault> {
        let place = || format!("nodes[{index}]");
        let document = self.document;
        let node = document.nodes.get(index);
        let node = node.ok_or_else(|| (place(), CityError::Format("does not exist".into())))?;
        if depth > DEEPEST {
            let text = format!("is more than {DEEPEST} nodes deep: a circle?");
            return Err((place(), CityError::Format(text)));
        }
        let own = product(above, &node.transform());
        if let Some(mesh) = node.mesh {
            let name = match node.name.is_empty() {
                true => format!("node_{index}"),
                false => node.name.clone(),
            };
            self.mesh(mesh)?;
            let instances = node.extensions.get("EXT_mesh_gpu_instancing");
            let instances = instances.and_then(|e| e.get("attributes"));
            match instances {
                Some(attributes) => {
                    let drawn = self.instances(attributes).map_err(|e| (place(), e))?;
                    for (i, (transform, building)) in drawn.into_iter().enumerate() {
                        let id = match building.and_then(|b| self.ids.get(b)) {
                            Some(id) => id.clone(),
                            None => format!("{name}_{}", i + 1),
                        };
                        self.place(mesh, &product(&own, &transform), id, &node.extras)?;
                    }
                }
                None => self.place(mesh, &own, name, &node.extras)?,
            }
        }
        node.children
            .iter()
            .try_for_each(|&child| self.node(child, &own, depth + 1))
    }

    /// Adds a mesh to the building of that identifier; one that the scene does not list gets a building of its own.
    fn place(
        &mut self,
        mesh: usize,
        transform: &Matrix,
        id: String,
        extras: &Value,
    ) -> std::result::Result<(), Fault> {
        let template = mesh;
        let mesh = &self.meshes[&template];
        self.triangles += mesh.triangles.len();
        if self.triangles > MOST_TRIANGLES {
            let text = format!("more than {MOST_TRIANGLES} triangles with all instances");
            return Err(("scene".into(), CityError::Format(text)));
        }
        let mut moved = mesh.clone();
        for p in &mut moved.positions {
            let [x, y, z] = applied(transform, *p);
            *p = [x, -z, y];
        }
        if determinant(transform) < 0.0 {
            moved.flip();
        }
        if let Some(&at) = self.listed.get(&id) {
            let building = &mut self.city.buildings[at];
            building.append_instance(&moved, template, upright_box(transform));
            if let Some(extras) = extras.as_object() {
                building.attributes.extend(extras.clone());
            }
            return Ok(());
        }
        self.city.buildings.push(CityBuilding {
            id,
            attributes: extras.as_object().cloned().unwrap_or_default(),
            mesh: moved,
            ..CityBuilding::default()
        });
        Ok(())
    }

    /// Reads a mesh, once.
    fn mesh(&mut self, index: usize) -> std::result::Result<(), Fault> {
        if self.meshes.contains_key(&index) {
            return Ok(());
        }
        let place = || format!("meshes[{index}]");
        let mesh = self.document.meshes.get(index);
        let mesh = mesh.ok_or_else(|| (place(), CityError::Format("does not exist".into())))?;
        let mut all = TriangleMesh::default();
        for (i, primitive) in mesh.primitives.iter().enumerate() {
            let part = self.primitive(primitive);
            all.append(&part.map_err(|e| (format!("meshes[{index}].primitives[{i}]"), e))?);
        }
        self.meshes.insert(index, all);
        Ok(())
    }

    fn primitive(&self, primitive: &Primitive) -> std::result::Result<TriangleMesh, CityError> {
        let Some(&positions) = primitive.attributes.get("POSITION") else {
            return Ok(TriangleMesh::default());
        };
        let numbers = self.buffers.floats(positions, 3)?;
        let positions: Vec<[f64; 3]> = numbers
            .chunks_exact(3)
            .map(|p| [p[0], p[1], p[2]])
            .collect();
        let count = positions.len();
        let corners: Vec<u32> = match primitive.indices {
            Some(accessor) => self.buffers.indices(accessor)?,
            None => (0..count as u32).collect(),
        };
        if let Some(&index) = corners.iter().find(|&&i| i as usize >= count) {
            let index = u64::from(index);
            return Err(CityError::Dangling { index, count });
        }
        let three = |i: usize, j: usize, k: usize| [corners[i], corners[j], corners[k]];
        let ends = 2..corners.len();
        let triangles = match primitive.mode {
            4 => corners
                .chunks_exact(3)
                .map(|t| [t[0], t[1], t[2]])
                .collect(),
            // A strip turns every second triangle round.
            5 => ends
                .map(|k| match k % 2 {
                    0 => three(k - 2, k - 1, k),
                    _ => three(k - 1, k - 2, k),
                })
                .collect(),
            6 => ends.map(|k| three(0, k - 1, k)).collect(),
            _ => Vec::new(),
        };
        Ok(TriangleMesh {
            positions,
            triangles,
        })
    }

    /// Transforms of a node's instances, and the building of each.
    fn instances(
        &self,
        attributes: &Value,
    ) -> std::result::Result<Vec<(Matrix, Option<usize>)>, CityError> {
        let accessor = |name: &str| -> std::result::Result<Option<usize>, CityError> {
            let wrong = || CityError::Format(format!("{name} is no accessor"));
            let value = attributes.get(name);
            let index = value.map(|v| v.as_u64().and_then(|i| usize::try_from(i).ok()));
            index.map(|i| i.ok_or_else(wrong)).transpose()
        };
        let read = |name: &str, width: usize| match accessor(name)? {
            Some(accessor) => self.buffers.floats(accessor, width).map(Some),
            None => Ok(None),
        };
        let (t, r, s) = (
            read("TRANSLATION", 3)?,
            read("ROTATION", 4)?,
            read("SCALE", 3)?,
        );
        let buildings = read("_BUILDING", 1)?;
        let lengths = [(&t, 3), (&r, 4), (&s, 3), (&buildings, 1)];
        let mut lengths = lengths
            .iter()
            .filter_map(|(v, w)| v.as_ref().map(|v| v.len() / w));
        let count = lengths.next().unwrap_or(0);
        if lengths.any(|n| n != count) {
            return Err(CityError::Format("instances of different numbers".into()));
        }
        let vector = |v: &Option<Vec<f64>>, i: usize| {
            v.as_ref().map(|v| [v[3 * i], v[3 * i + 1], v[3 * i + 2]])
        };
        let all = (0..count).map(|i| {
            let turn = r
                .as_ref()
                .map(|r| [r[4 * i], r[4 * i + 1], r[4 * i + 2], r[4 * i + 3]]);
            let building = buildings.as_ref().map(|b| b[i]).filter(|b| *b >= 0.0);
            let transform = composed(vector(&t, i), turn, vector(&s, i));
            (transform, building.map(|b| b as usize))
        });
        Ok(all.collect())
    }
}

impl Node {
    fn transform(&self) -> Matrix {
        self.matrix
            .unwrap_or_else(|| composed(self.translation, self.rotation, self.scale))
    }
}
