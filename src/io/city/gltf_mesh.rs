//! Meshes of a glTF file: triangles with what they look like.

use std::collections::BTreeMap;
use std::sync::Arc;

use rustc_hash::FxHashMap;
use serde::Deserialize;

use super::CityError;
use super::gltf_data::Buffers;
use super::gltf_textures::Looks;
use edifice_shape::triangles::{Painted, Surface, TriangleMesh};

/// A mesh as the file says it.
#[derive(Deserialize)]
pub(super) struct Mesh {
    primitives: Vec<Primitive>,
}

#[derive(Deserialize)]
struct Primitive {
    attributes: FxHashMap<String, usize>,
    indices: Option<usize>,
    material: Option<usize>,
    #[serde(default = "triangles")]
    mode: u32,
}

fn triangles() -> u32 {
    4
}

/// A mesh with its looks, in glTF's axes.
#[derive(Default)]
pub(super) struct MeshRead {
    pub mesh: TriangleMesh,
    /// The paint of its triangles, as far as the file gives it.
    pub paint: Vec<Painted>,
    /// The picture of its box mapping.
    pub texture: Option<Arc<[u8]>>,
    /// The index of the building of each corner, where the file says it of all corners.
    buildings: Vec<f64>,
}

impl MeshRead {
    /// The triangles of each building, in the order of their indices; none where the corners do not say theirs.
    pub(super) fn by_building(&self) -> Vec<(usize, TriangleMesh)> {
        if self.buildings.len() != self.mesh.positions.len() || !self.paint.is_empty() {
            return Vec::new();
        }
        // A negative number is no index of any.
        let building = |t: &[u32; 3]| match self.buildings[t[0] as usize] {
            b if b >= 0.0 => b as usize,
            _ => usize::MAX,
        };
        let mut parts: BTreeMap<usize, Vec<[u32; 3]>> = BTreeMap::new();
        for t in &self.mesh.triangles {
            parts.entry(building(t)).or_default().push(*t);
        }
        let part = |triangles: Vec<[u32; 3]>| {
            let mut place = FxHashMap::default();
            let mut out = TriangleMesh::default();
            out.triangles = triangles
                .into_iter()
                .map(|t| {
                    t.map(|i| {
                        *place.entry(i).or_insert_with(|| {
                            out.positions.push(self.mesh.positions[i as usize]);
                            out.positions.len() as u32 - 1
                        })
                    })
                })
                .collect();
            out
        };
        parts.into_iter().map(|(b, t)| (b, part(t))).collect()
    }
}

/// The meshes of a file.
pub(super) struct Meshes<'a> {
    meshes: &'a [Mesh],
    /// The look of each material; empty for a file without textures.
    looks: Vec<Option<Looks>>,
    pub buffers: &'a Buffers<'a>,
    read: FxHashMap<usize, MeshRead>,
}

impl<'a> Meshes<'a> {
    pub(super) fn new(
        meshes: &'a [Mesh],
        looks: Vec<Option<Looks>>,
        buffers: &'a Buffers<'a>,
    ) -> Self {
        Self {
            meshes,
            looks,
            buffers,
            read: FxHashMap::default(),
        }
    }

    /// A mesh, read when it is first asked for.
    ///
    /// # Errors
    /// The element that is wrong, and why.
    pub(super) fn mesh(&mut self, index: usize) -> Result<&MeshRead, (String, CityError)> {
        let read = match self.read.remove(&index) {
            Some(known) => known,
            None => self.all_of(index)?,
        };
        Ok(self.read.entry(index).or_insert(read))
    }

    fn all_of(&self, index: usize) -> Result<MeshRead, (String, CityError)> {
        let place = || format!("meshes[{index}]");
        let mesh = self.meshes.get(index);
        let mesh = mesh.ok_or_else(|| (place(), CityError::Format("does not exist".into())))?;
        let mut all = MeshRead::default();
        let mut starts = FxHashMap::default();
        for (i, primitive) in mesh.primitives.iter().enumerate() {
            let read = self.primitive(primitive, &mut all, &mut starts);
            read.map_err(|e| (format!("meshes[{index}].primitives[{i}]"), e))?;
        }
        Ok(all)
    }

    /// Adds a primitive to its mesh. `starts` is where the positions of an accessor begin in it: primitives may share them.
    fn primitive(
        &self,
        primitive: &Primitive,
        all: &mut MeshRead,
        starts: &mut FxHashMap<usize, (usize, usize)>,
    ) -> Result<(), CityError> {
        let Some(&accessor) = primitive.attributes.get("POSITION") else {
            return Ok(());
        };
        let (first, count) = match starts.get(&accessor) {
            Some(&known) => known,
            None => {
                let numbers = self.buffers.floats(accessor, 3)?;
                let positions = numbers.chunks_exact(3).map(|p| [p[0], p[1], p[2]]);
                let first = all.mesh.positions.len();
                all.mesh.positions.extend(positions);
                if let Some(&accessor) = primitive.attributes.get("_BUILDING") {
                    all.buildings.extend(self.buffers.floats(accessor, 1)?);
                }
                *starts
                    .entry(accessor)
                    .or_insert((first, all.mesh.positions.len() - first))
            }
        };
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
        let triangles: Vec<[u32; 3]> = match primitive.mode {
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
        let material = primitive.material.and_then(|m| self.looks.get(m)?.as_ref());
        if let Some(looks) = material {
            let positions = &all.mesh.positions[first..];
            all.paint
                .extend(self.painted(primitive, looks, positions, &triangles)?);
            if let (true, Surface::Texture(texture)) = (looks.box_mapped, &*looks.surface) {
                all.texture = Some(texture.file.clone());
            }
        }
        let own = triangles.iter().map(|t| t.map(|i| i + first as u32));
        all.mesh.triangles.extend(own);
        Ok(())
    }

    /// The paint of the triangles of a primitive.
    fn painted(
        &self,
        primitive: &Primitive,
        looks: &Looks,
        positions: &[[f64; 3]],
        triangles: &[[u32; 3]],
    ) -> Result<Vec<Painted>, CityError> {
        let set = format!("TEXCOORD_{}", looks.coordinates);
        let uv = match (primitive.attributes.get(&set), &*looks.surface) {
            (Some(&accessor), _) => self.buffers.floats(accessor, 2)?,
            (None, Surface::Plain(_)) => Vec::new(),
            (None, Surface::Texture(_)) => return Ok(Vec::new()),
        };
        let place = |i: u32| {
            let at = 2 * i as usize;
            let uv = uv
                .get(at)
                .zip(uv.get(at + 1))
                .map_or([0.0; 2], |(u, v)| [*u, *v]);
            let [u, v] = looks.transform.map_or(uv, |t| t.applied(uv));
            [u, 1.0 - v]
        };
        let one = |t: &[u32; 3]| Painted {
            corners: t.map(|i| positions[i as usize]),
            uv: t.map(place),
            surface: looks.surface.clone(),
        };
        Ok(triangles.iter().map(one).collect())
    }
}
