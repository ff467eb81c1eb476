//! Cities as glTF 2.0: `.glb`, and `.gltf` with buffers inside it or beside it.
//!
//! A node of the scene with a mesh is a building, called by its name; what lies below a node whose `extras` say
//! `"kind": "Building"`, as those of [`edifice_io::detailed_gltf`] do, is one building. Instances of `EXT_mesh_gpu_instancing` are drawn out.
//! A file that Edifice wrote ([`super::glb`]) says which building an instance belongs to (`_BUILDING` and the scene's `extras`): those
//! of one building become one, which knows the instances it is put together from ([`Part`](edifice_shape::triangles::Part)). glTF is y up: (x, y, z) is read as (x, -z, y). Read are triangles, strips and fans; points and
//! lines are left out. Textures of base colours are read as the paint of the surfaces. Every index and length is checked against the bytes there are.

use std::collections::hash_map::Entry;
use std::path::Path;

use rustc_hash::FxHashMap;
use serde::Deserialize;
use serde_json::{Map, Value};

use super::CityError;
use super::gltf_data::{self, Accessor, Buffer, Buffers, View};
use super::gltf_instances::drawn;
use super::gltf_mesh::{Mesh, MeshRead, Meshes};
use super::gltf_properties;
use super::gltf_textures::{Image, Material, Texture, looks};
use super::gltf_transform::{
    IDENTITY, Matrix, applied, composed, determinant, product, upright_box,
};
use edifice_base::{Error, Result};
use edifice_io::glb_container::split;
use edifice_io::json::parse_json;
use edifice_io::read_bytes;
use edifice_shape::triangles::{City, CityBuilding, Painted};

/// Extensions that may be required.
const KNOWN: [&str; 6] = [
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "KHR_meshopt_compression",
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
    extensions: Value,
    #[serde(default)]
    extensions_required: Vec<String>,
    #[serde(default)]
    materials: Vec<Material>,
    #[serde(default)]
    textures: Vec<Texture>,
    #[serde(default)]
    images: Vec<Image>,
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
        let bytes = gltf_data::buffer(buffer, binary, path)?;
        if bytes.len() < buffer.byte_length && !buffer.is_fallback() {
            let text = format!("{} bytes, not {}", bytes.len(), buffer.byte_length);
            return Err(Error::input(
                path,
                format!("buffers[{i}]"),
                CityError::Format(text),
            ));
        }
        data.push(bytes);
    }
    let fault = |(place, error): (String, CityError)| Error::input(path, place, error);
    let buffers = Buffers::new(data, &document.buffer_views, &document.accessors).map_err(fault)?;
    let Document {
        materials,
        textures,
        images,
        ..
    } = &document;
    let looks = looks(materials, textures, images, &buffers, path).map_err(fault)?;
    let mut reader = Reader {
        document: &document,
        buffers: &buffers,
        meshes: Meshes::new(&document.meshes, looks, &buffers),
        city: City {
            name: edifice_io::file_stem(path),
            ..City::default()
        },
        ids: Vec::new(),
        listed: FxHashMap::default(),
        triangles: 0,
    };
    reader.scene().map_err(fault)?;
    Ok(reader.city)
}

type Fault = (String, CityError);

/// The city as it is read.
struct Reader<'a> {
    document: &'a Document,
    buffers: &'a Buffers<'a>,
    meshes: Meshes<'a>,
    city: City,
    /// Identifiers of the buildings that instances belong to; they are the first buildings of the city.
    ids: Vec<String>,
    /// Index of the building of the city, by identifier.
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
        // The origin is taken off again where a node adds it.
        let above = match scene.extras.get("origin_node") {
            Some(_) => {
                let [x, y, z] = self.city.origin;
                composed(Some([-x, -z, y]), None, None)
            }
            None => IDENTITY,
        };
        let system = scene.extras.get("reference_system").and_then(Value::as_str);
        self.city.reference_system = system.map(str::to_owned);
        let ids = scene.extras.get("buildings").cloned();
        let ids = ids.and_then(|ids| serde_json::from_value(ids).ok());
        let properties = &self.document.extensions[gltf_properties::EXTENSION];
        let ids = ids.or_else(|| gltf_properties::identifiers(properties, self.buffers));
        self.ids = ids.unwrap_or_default();
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
            self.node(root, &above, 0)?;
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
            let instances = node.extensions.get("EXT_mesh_gpu_instancing");
            let instances = instances.and_then(|e| e.get("attributes"));
            match instances {
                Some(attributes) => {
                    let all = drawn(self.meshes.buffers, attributes).map_err(|e| (place(), e))?;
                    for (i, (transform, building)) in all.into_iter().enumerate() {
                        let id = match building.and_then(|b| self.ids.get(b)) {
                            Some(id) => id.clone(),
                            None => format!("{name}_{}", i + 1),
                        };
                        self.place(mesh, &product(&own, &transform), id, &node.extras)?;
                    }
                }
                None => self.whole(mesh, &own, &name, &node.extras)?,
            }
        }
        let first = self.city.buildings.len();
        let mut children = node.children.iter();
        children.try_for_each(|&child| self.node(child, &own, depth + 1))?;
        let is_whole = node.extras.get("kind").and_then(Value::as_str) == Some("Building");
        let parts = match is_whole && self.city.buildings.len() > first {
            true => self.city.buildings.split_off(first),
            false => return Ok(()),
        };
        let mut whole = CityBuilding {
            id: node.name.clone(),
            attributes: node.extras.as_object().cloned().unwrap_or_default(),
            ..CityBuilding::default()
        };
        for mut part in parts {
            whole.mesh.append(&part.mesh);
            whole.paint.append(&mut part.paint);
        }
        self.city.buildings.push(whole);
        Ok(())
    }

    /// Adds a mesh as a building, or, where its corners say which building they belong to, to those buildings.
    fn whole(
        &mut self,
        mesh: usize,
        transform: &Matrix,
        name: &str,
        extras: &Value,
    ) -> std::result::Result<(), Fault> {
        let parts = match self.ids.is_empty() {
            true => Vec::new(),
            false => self.meshes.mesh(mesh)?.by_building(),
        };
        if parts.is_empty() {
            return self.place(mesh, transform, name.to_owned(), extras);
        }
        for (building, mut part) in parts {
            self.count(part.triangles.len())?;
            for p in &mut part.positions {
                let [x, y, z] = applied(transform, *p);
                *p = [x, -z, y];
            }
            if determinant(transform) < 0.0 {
                part.flip();
            }
            let id = self.ids.get(building);
            match id.and_then(|id| self.listed.get(id)) {
                Some(&at) => self.city.buildings[at].mesh.append(&part),
                None => self.city.buildings.push(CityBuilding {
                    id: name.to_owned(),
                    mesh: part,
                    ..CityBuilding::default()
                }),
            }
        }
        Ok(())
    }

    /// Counts triangles.
    fn count(&mut self, triangles: usize) -> std::result::Result<(), Fault> {
        self.triangles += triangles;
        if self.triangles > MOST_TRIANGLES {
            let text = format!("more than {MOST_TRIANGLES} triangles with all instances");
            return Err(("scene".into(), CityError::Format(text)));
        }
        Ok(())
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
        let triangles = self.meshes.mesh(template)?.mesh.triangles.len();
        self.count(triangles)?;
        let MeshRead {
            mesh,
            paint,
            texture,
            ..
        } = self.meshes.mesh(template)?;
        let (mut moved, mut paint) = (mesh.clone(), paint.clone());
        let painted = paint.iter_mut().flat_map(|p| &mut p.corners);
        for p in moved.positions.iter_mut().chain(painted) {
            let [x, y, z] = applied(transform, *p);
            *p = [x, -z, y];
        }
        if determinant(transform) < 0.0 {
            moved.flip();
            paint.iter_mut().for_each(Painted::flip);
        }
        if let Some(&at) = self.listed.get(&id) {
            let building = &mut self.city.buildings[at];
            let frame = upright_box(transform);
            building.append_instance(&moved, template, frame, texture.clone());
            building.paint.append(&mut paint);
            if let Some(extras) = extras.as_object() {
                building.attributes.extend(extras.clone());
            }
            return Ok(());
        }
        self.city.buildings.push(CityBuilding {
            id,
            attributes: extras.as_object().cloned().unwrap_or_default(),
            mesh: moved,
            paint,
            ..CityBuilding::default()
        });
        Ok(())
    }
}

impl Node {
    fn transform(&self) -> Matrix {
        self.matrix
            .unwrap_or_else(|| composed(self.translation, self.rotation, self.scale))
    }
}
