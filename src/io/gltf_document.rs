//! A document of glTF 2.0 and its binary part while they are written: numbers in a few streams, each a buffer view, then images.

use std::collections::BTreeMap;

use gltf_json as json;
use json::accessor::{ComponentType, GenericComponentType, Type};
use json::buffer::{Stride, Target, View};
use json::mesh::{Primitive, Semantic};
use json::validation::Checked::{self, Valid};
use json::validation::USize64;
use json::{Index, Root};

use super::glb_container::{TooLong, glb_container};
use super::gltf_error::GltfError;

/// The kind of a stream: its target, and for vectors the bytes from one to the next, since several accessors share the view.
pub(crate) type Kind = (Target, Option<usize>);
/// Positions or normals.
pub(crate) const VERTICES: Kind = (Target::ArrayBuffer, Some(12));
/// Texture coordinates.
pub(crate) const COORDINATES: Kind = (Target::ArrayBuffer, Some(8));
/// Tangents with their handedness.
pub(crate) const TANGENTS: Kind = (Target::ArrayBuffer, Some(16));
/// Indices of corners.
pub(crate) const INDICES: Kind = (Target::ElementArrayBuffer, None);

/// The document and its binary part.
pub(crate) struct Document {
    pub(crate) root: Root,
    streams: Vec<(Kind, Vec<u8>)>,
    images: Vec<Vec<u8>>,
}

impl Document {
    /// An empty document with streams of these kinds.
    pub(crate) fn new(kinds: &[Kind]) -> Self {
        Self {
            root: Root::default(),
            streams: kinds.iter().map(|&kind| (kind, Vec::new())).collect(),
            images: Vec::new(),
        }
    }

    /// Vectors of two to four numbers; their bounds are said where `is_bounded`.
    pub(crate) fn vectors<const N: usize>(
        &mut self,
        stream: usize,
        values: &[[f32; N]],
        is_bounded: bool,
    ) -> Index<json::Accessor> {
        let bytes = &mut self.streams[stream].1;
        let offset = bytes.len();
        let (mut low, mut high) = ([f32::INFINITY; N], [f32::NEG_INFINITY; N]);
        for p in values {
            for i in 0..N {
                low[i] = low[i].min(p[i]);
                high[i] = high[i].max(p[i]);
                bytes.extend(p[i].to_le_bytes());
            }
        }
        let kind = match N {
            2 => Type::Vec2,
            3 => Type::Vec3,
            _ => Type::Vec4,
        };
        let mut own = accessor(stream, offset, values.len(), ComponentType::F32, kind);
        if is_bounded {
            own.min = Some(serde_json::json!(low.as_slice()));
            own.max = Some(serde_json::json!(high.as_slice()));
        }
        self.root.push(own)
    }

    /// Indices of `corners` corners.
    pub(crate) fn indices(
        &mut self,
        stream: usize,
        indices: &[u32],
        corners: usize,
    ) -> Index<json::Accessor> {
        // The largest 16-bit number is not allowed as an index.
        let short = corners < usize::from(u16::MAX);
        let bytes = &mut self.streams[stream].1;
        let offset = bytes.len();
        for &index in indices {
            match short {
                true => bytes.extend((index as u16).to_le_bytes()),
                false => bytes.extend(index.to_le_bytes()),
            }
        }
        bytes.resize(bytes.len().next_multiple_of(4), 0);
        let component = match short {
            true => ComponentType::U16,
            false => ComponentType::U32,
        };
        let own = accessor(stream, offset, indices.len(), component, Type::Scalar);
        self.root.push(own)
    }

    /// A mesh of the document.
    pub(crate) fn mesh(&mut self, name: &str, primitives: Vec<Primitive>) -> Index<json::Mesh> {
        self.root.push(json::Mesh {
            name: Some(name.to_owned()),
            primitives,
            weights: None,
            extensions: None,
            extras: Default::default(),
        })
    }

    /// An image inside the file, a PNG.
    pub(crate) fn image(&mut self, name: String, png: Vec<u8>) -> Index<json::Image> {
        let view = self.streams.len() + self.images.len();
        self.images.push(png);
        self.root.push(json::Image {
            buffer_view: Some(Index::new(view as u32)),
            mime_type: Some(json::image::MimeType("image/png".into())),
            name: Some(name),
            uri: None,
            extensions: None,
            extras: Default::default(),
        })
    }

    /// The bytes of a file whose scene has these nodes.
    pub(crate) fn glb(mut self, nodes: Vec<Index<json::Node>>) -> Result<Vec<u8>, GltfError> {
        let binary = self.binary();
        self.root.scenes.push(json::Scene {
            name: None,
            nodes,
            extensions: None,
            extras: Default::default(),
        });
        self.root.scene = Some(Index::new(0));
        self.root.asset.generator = Some(format!("edifice {}", env!("CARGO_PKG_VERSION")));
        let text = self.root.to_vec();
        let text = text.map_err(|e| GltfError::Json(e.to_string()))?;
        glb_container(text, binary).map_err(|TooLong(bytes)| GltfError::TooLarge { bytes })
    }

    /// The binary part, its buffer and views now in the document; none for a document without numbers.
    fn binary(&mut self) -> Vec<u8> {
        let mut binary = Vec::new();
        let streams = std::mem::take(&mut self.streams).into_iter();
        let streams = streams.map(|((target, stride), bytes)| (Some(target), stride, bytes));
        let images = std::mem::take(&mut self.images).into_iter();
        let all: Vec<_> = streams.chain(images.map(|i| (None, None, i))).collect();
        if all.iter().all(|(_, _, bytes)| bytes.is_empty()) {
            return binary;
        }
        // A view has at least one byte: what refers to later ones moves up over those that are left out.
        let mut views: Vec<Index<View>> = Vec::new();
        for (target, stride, bytes) in all {
            views.push(Index::new(self.root.buffer_views.len() as u32));
            if bytes.is_empty() {
                continue;
            }
            binary.resize(binary.len().next_multiple_of(4), 0);
            self.root.push(View {
                buffer: Index::new(0),
                byte_length: USize64::from(bytes.len()),
                byte_offset: Some(USize64::from(binary.len())),
                byte_stride: stride.map(Stride),
                name: None,
                target: target.map(Valid),
                extensions: None,
                extras: Default::default(),
            });
            binary.extend(bytes);
        }
        let accessors = self.root.accessors.iter_mut().map(|a| &mut a.buffer_view);
        let images = self.root.images.iter_mut().map(|i| &mut i.buffer_view);
        for view in accessors.chain(images).flatten() {
            *view = views[view.value()];
        }
        self.root.push(json::Buffer {
            byte_length: USize64::from(binary.len()),
            name: None,
            uri: None,
            extensions: None,
            extras: Default::default(),
        });
        binary
    }
}

fn accessor(
    stream: usize,
    offset: usize,
    count: usize,
    component: ComponentType,
    kind: Type,
) -> json::Accessor {
    json::Accessor {
        buffer_view: Some(Index::new(stream as u32)),
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

/// The attributes of the corners of a primitive.
pub(crate) type Attributes = BTreeMap<Checked<Semantic>, Index<json::Accessor>>;

/// Triangles of one material.
pub(crate) fn primitive(
    attributes: Attributes,
    indices: Index<json::Accessor>,
    material: Index<json::Material>,
) -> Primitive {
    Primitive {
        attributes,
        indices: Some(indices),
        material: Some(material),
        mode: Valid(json::mesh::Mode::Triangles),
        targets: None,
        extensions: None,
        extras: Default::default(),
    }
}

/// A colour from sRGB to linear, as glTF takes it.
pub(crate) fn linear(colour: [u8; 3]) -> [f32; 3] {
    colour.map(|c| {
        let c = f32::from(c) / 255.0;
        match c <= 0.04045 {
            true => c / 12.92,
            false => ((c + 0.055) / 1.055).powf(2.4),
        }
    })
}
