//! The buffer views of a small file: one of each kind, which many accessors share.

use meshopt::{
    EncodeExpMode, encode_filter_exp, encode_filter_oct, encode_filter_quat, encode_index_buffer,
    encode_vertex_buffer_level,
};
use serde_json::{Value, json};

use super::super::glb::{FLOAT, Glb, GlbError, UNSIGNED_INT, turned};
use super::super::meshopt_views::EXTENSION;
use super::identifiers;
use super::shape::Shape;
use super::views::{EXPONENTIAL, LEVEL, OCTAHEDRAL, QUATERNION, TRIANGLES, VERSION, VERTEX, Views};

/// Component types of the standard.
const BYTE: u32 = 5120;
const SHORT: u32 = 5122;
const UNSIGNED_SHORT: u32 = 5123;
/// Places and sizes of instances are within so many metres of what they are.
const WITHIN: f64 = 0.0125;
/// Bits of each number of a quaternion.
const TURN_BITS: i32 = 14;
/// Bits of each number of a normal.
const NORMAL_BITS: i32 = 8;

/// Numbers of a kind, and the view that holds them once there are some.
struct Stream<T> {
    view: Option<usize>,
    items: Vec<T>,
}

impl<T> Default for Stream<T> {
    fn default() -> Self {
        Self {
            view: None,
            items: Vec::new(),
        }
    }
}

impl<T> Stream<T> {
    /// An accessor of more numbers of that kind, of so many bytes each as they are written.
    fn add(
        &mut self,
        file: &mut Glb,
        items: impl IntoIterator<Item = T>,
        stride: usize,
        component: u32,
        kind: &str,
    ) -> Value {
        let view = *self.view.get_or_insert_with(|| file.view_to_come());
        let first = self.items.len();
        self.items.extend(items);
        json!({ "bufferView": view, "byteOffset": first * stride, "componentType": component,
            "count": self.items.len() - first, "type": kind })
    }
}

/// All views of a file.
#[derive(Default)]
pub(super) struct Streams {
    /// The fourth number fills up to a multiple of four bytes.
    corners: Stream<[u16; 4]>,
    /// Four bytes each as they are written.
    normals: Stream<[f32; 4]>,
    indices: Stream<u32>,
    places: Stream<[f32; 3]>,
    turns: Stream<[f32; 4]>,
    sizes: Stream<[f32; 3]>,
    buildings: Stream<f32>,
    /// The largest side of an instance, in metres.
    largest: f64,
}

impl Streams {
    /// A primitive of the plain material.
    pub(super) fn primitive(
        &mut self,
        file: &mut Glb,
        corners: &[[u16; 3]],
        shape: &Shape,
    ) -> Value {
        let items = corners.iter().map(|&[x, y, z]| [x, y, z, 0]);
        let mut positions = self.corners.add(file, items, 8, UNSIGNED_SHORT, "VEC3");
        let bound = |pick: fn(u16, u16) -> u16, start: u16| -> [u16; 3] {
            std::array::from_fn(|k| corners.iter().map(|p| p[k]).fold(start, pick))
        };
        positions["min"] = json!(bound(u16::min, u16::MAX));
        positions["max"] = json!(bound(u16::max, 0));
        let positions = file.accessor(positions);
        let items = shape.mesh.triangles.iter().flatten().copied();
        let indices = self.indices.add(file, items, 4, UNSIGNED_INT, "SCALAR");
        let indices = file.accessor(indices);
        let mut attributes = json!({ "POSITION": positions });
        if !shape.normals.is_empty() {
            let items = shape.normals.iter().map(|&n| {
                let [x, y, z] = turned(n);
                [x, y, z, 0.0]
            });
            let mut normals = self.normals.add(file, items, 4, BYTE, "VEC3");
            normals["normalized"] = json!(true);
            attributes["NORMAL"] = json!(file.accessor(normals));
        }
        json!({ "attributes": attributes, "indices": indices, "material": 0 })
    }

    pub(super) fn places(
        &mut self,
        file: &mut Glb,
        items: impl Iterator<Item = [f32; 3]>,
    ) -> usize {
        let accessor = self.places.add(file, items, 12, FLOAT, "VEC3");
        file.accessor(accessor)
    }

    pub(super) fn turns(&mut self, file: &mut Glb, items: impl Iterator<Item = [f32; 4]>) -> usize {
        let mut accessor = self.turns.add(file, items, 8, SHORT, "VEC4");
        accessor["normalized"] = json!(true);
        file.accessor(accessor)
    }

    /// `largest`: the largest side of an instance, in metres.
    pub(super) fn sizes(
        &mut self,
        file: &mut Glb,
        items: impl Iterator<Item = [f32; 3]>,
        largest: f64,
    ) -> usize {
        self.largest = self.largest.max(largest);
        let accessor = self.sizes.add(file, items, 12, FLOAT, "VEC3");
        file.accessor(accessor)
    }

    /// An accessor of indices of buildings; -1 where there is none.
    pub(super) fn buildings(
        &mut self,
        file: &mut Glb,
        items: impl Iterator<Item = Option<usize>>,
    ) -> usize {
        let items = items.map(|b| b.map_or(-1.0, |b| b as f32));
        let accessor = self.buildings.add(file, items, 4, FLOAT, "SCALAR");
        file.accessor(accessor)
    }

    /// Writes the views and identifiers of buildings, compressed, and the buffer that they would be without compression.
    pub(super) fn write(self, file: &mut Glb, ids: &[&str]) -> Result<(), GlbError> {
        let mut out = Views::new(file);
        if let Some(view) = self.corners.view {
            let bytes = encode_vertex_buffer_level(&self.corners.items, LEVEL, VERSION)?;
            out.write(view, self.corners.items.len(), 8, &bytes, VERTEX);
        }
        if let Some(view) = self.normals.view {
            let items: Vec<[i8; 4]> = encode_filter_oct(&self.normals.items, NORMAL_BITS);
            let bytes = encode_vertex_buffer_level(&items, LEVEL, VERSION)?;
            out.write(view, items.len(), 4, &bytes, OCTAHEDRAL);
        }
        if let Some(view) = self.indices.view {
            let corners = self
                .indices
                .items
                .iter()
                .max()
                .map_or(0, |m| *m as usize + 1);
            let bytes = encode_index_buffer(&self.indices.items, corners)?;
            out.write(view, self.indices.items.len(), 4, &bytes, TRIANGLES);
        }
        if let Some(view) = self.places.view {
            let largest = self
                .places
                .items
                .iter()
                .flatten()
                .fold(0.0_f32, |m, v| m.max(v.abs()));
            let bits = bits(f64::from(largest));
            let items = encode_filter_exp(&self.places.items, bits, EncodeExpMode::SharedComponent);
            let bytes = encode_vertex_buffer_level(&items, LEVEL, VERSION)?;
            out.write(view, items.len(), 12, &bytes, EXPONENTIAL);
        }
        if let Some(view) = self.turns.view {
            let items = encode_filter_quat(&self.turns.items, TURN_BITS);
            let bytes = encode_vertex_buffer_level(&items, LEVEL, VERSION)?;
            out.write(view, items.len(), 8, &bytes, QUATERNION);
        }
        if let Some(view) = self.sizes.view {
            let bits = bits(self.largest);
            let items = encode_filter_exp(&self.sizes.items, bits, EncodeExpMode::Separate);
            let bytes = encode_vertex_buffer_level(&items, LEVEL, VERSION)?;
            out.write(view, items.len(), 12, &bytes, EXPONENTIAL);
        }
        if let Some(view) = self.buildings.view {
            let bytes = encode_vertex_buffer_level(&self.buildings.items, LEVEL, VERSION)?;
            out.write(view, self.buildings.items.len(), 4, &bytes, VERTEX);
        }
        identifiers::write(&mut out, ids)?;
        let fallback = out.fallback();
        file.more_buffers.push(
            json!({ "byteLength": fallback, "extensions": { EXTENSION: { "fallback": true } } }),
        );
        Ok(())
    }
}

/// Bits of numbers up to `largest` that are to be within [`WITHIN`].
fn bits(largest: f64) -> i32 {
    (1.0 + (largest / WITHIN).max(1.0).log2().ceil()).clamp(8.0, 24.0) as i32
}
