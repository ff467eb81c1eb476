//! Numbers of a glTF file: accessors of views of buffers, each checked against the bytes there are.

use std::path::{Component, Path};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use rustc_hash::FxHashMap;
use serde::Deserialize;
use serde_json::Value;

use super::CityError;
use super::meshopt_views::Compressed;
use edifice_base::{Error, Result};
use edifice_io::read_bytes;

/// Bytes.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Buffer {
    pub byte_length: usize,
    pub uri: Option<String>,
    #[serde(default)]
    extensions: BufferExtensions,
}

#[derive(Default, Deserialize)]
struct BufferExtensions {
    #[serde(rename = "EXT_meshopt_compression", alias = "KHR_meshopt_compression")]
    meshopt: Option<Fallback>,
}

#[derive(Deserialize)]
struct Fallback {
    #[serde(default)]
    fallback: bool,
}

impl Buffer {
    /// True if nothing but compressed views refers to it, so that it need not be there.
    pub(super) fn is_fallback(&self) -> bool {
        let meshopt = self.extensions.meshopt.as_ref();
        meshopt.is_some_and(|m| m.fallback) && self.uri.is_none()
    }
}

/// A part of a buffer.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct View {
    buffer: usize,
    #[serde(default)]
    byte_offset: usize,
    byte_length: usize,
    byte_stride: Option<usize>,
    #[serde(default)]
    extensions: ViewExtensions,
}

#[derive(Default, Deserialize)]
struct ViewExtensions {
    #[serde(rename = "EXT_meshopt_compression", alias = "KHR_meshopt_compression")]
    meshopt: Option<Compressed>,
}

/// Numbers in a view.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Accessor {
    buffer_view: Option<usize>,
    #[serde(default)]
    byte_offset: usize,
    component_type: u32,
    #[serde(default)]
    normalized: bool,
    count: usize,
    #[serde(rename = "type")]
    kind: String,
    sparse: Option<Value>,
}

/// All bytes of a file.
pub(super) struct Buffers<'a> {
    data: Vec<Vec<u8>>,
    /// The bytes of views that were compressed, by index.
    decoded: FxHashMap<usize, Vec<u8>>,
    views: &'a [View],
    accessors: &'a [Accessor],
}

fn wrong(index: usize, problem: &str) -> CityError {
    CityError::Format(format!("accessors[{index}] {problem}"))
}

impl<'a> Buffers<'a> {
    /// All bytes of a file: its buffers, and its compressed views.
    ///
    /// # Errors
    /// The element that is wrong, and why.
    pub(super) fn new(
        data: Vec<Vec<u8>>,
        views: &'a [View],
        accessors: &'a [Accessor],
    ) -> std::result::Result<Self, (String, CityError)> {
        let mut decoded = FxHashMap::default();
        for (i, view) in views.iter().enumerate() {
            let Some(compressed) = &view.extensions.meshopt else {
                continue;
            };
            let fault = |text: String| (format!("bufferViews[{i}]"), CityError::Format(text));
            let bytes = part(
                &data,
                compressed.buffer,
                compressed.byte_offset,
                compressed.byte_length,
            );
            let bytes = bytes.ok_or_else(|| fault("lies outside its buffer".into()))?;
            let bytes = compressed.decoded(bytes).map_err(fault)?;
            if bytes.len() != view.byte_length {
                let text = format!("{} bytes, not {}", bytes.len(), view.byte_length);
                return Err(fault(text));
            }
            decoded.insert(i, bytes);
        }
        Ok(Self {
            data,
            decoded,
            views,
            accessors,
        })
    }

    /// All numbers of an accessor of vectors of `width` components.
    pub(super) fn floats(
        &self,
        index: usize,
        width: usize,
    ) -> std::result::Result<Vec<f64>, CityError> {
        let (accessor, elements) = self.elements(index, width)?;
        let number = reader(accessor.component_type, accessor.normalized);
        let number = number.ok_or_else(|| wrong(index, "has an unknown type"))?;
        let size = size_of(accessor.component_type);
        let mut numbers = Vec::with_capacity(elements.len() * width);
        for element in elements {
            numbers.extend(element.chunks_exact(size).map(number));
        }
        Ok(numbers)
    }

    /// All numbers of an accessor of indices.
    pub(super) fn indices(&self, index: usize) -> std::result::Result<Vec<u32>, CityError> {
        let (accessor, elements) = self.elements(index, 1)?;
        if !matches!(accessor.component_type, 5121 | 5123 | 5125) {
            return Err(wrong(index, "has no unsigned integers"));
        }
        let little = |bytes: &[u8]| bytes.iter().rev().fold(0, |n, &b| n << 8 | u32::from(b));
        Ok(elements.into_iter().map(little).collect())
    }

    /// The bytes of a view, if it and its buffer have them.
    pub(super) fn view(&self, index: usize) -> Option<&[u8]> {
        if let Some(decoded) = self.decoded.get(&index) {
            return Some(decoded);
        }
        let view = self.views.get(index)?;
        part(&self.data, view.buffer, view.byte_offset, view.byte_length)
    }

    /// The bytes of each element.
    fn elements(
        &self,
        index: usize,
        width: usize,
    ) -> std::result::Result<(&Accessor, Vec<&[u8]>), CityError> {
        let wrong = |problem: &str| wrong(index, problem);
        let accessor = self
            .accessors
            .get(index)
            .ok_or_else(|| wrong("does not exist"))?;
        if accessor.sparse.is_some() {
            return Err(wrong("is sparse, which is not read"));
        }
        let components = match accessor.kind.as_str() {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 0,
        };
        if components != width {
            return Err(wrong(&format!("is of type {:?}", accessor.kind)));
        }
        let view = accessor
            .buffer_view
            .and_then(|v| Some((v, self.views.get(v)?)));
        let (at, view) = view.ok_or_else(|| wrong("has no view"))?;
        let bytes = self
            .view(at)
            .ok_or_else(|| wrong("lies outside its buffer"))?;
        let size = size_of(accessor.component_type) * width;
        let stride = view.byte_stride.unwrap_or(size).max(size);
        let needed = match accessor.count.checked_sub(1) {
            Some(last) => last.checked_mul(stride).and_then(|n| n.checked_add(size)),
            None => Some(0),
        };
        let end = needed.and_then(|n| n.checked_add(accessor.byte_offset));
        if size == 0 || end.is_none_or(|end| end > bytes.len()) {
            return Err(wrong("lies outside its view"));
        }
        let element = |i: usize| &bytes[accessor.byte_offset + i * stride..][..size];
        Ok((accessor, (0..accessor.count).map(element).collect()))
    }
}

/// So many bytes of a buffer, if it has them.
fn part(data: &[Vec<u8>], buffer: usize, from: usize, count: usize) -> Option<&[u8]> {
    data.get(buffer)?.get(from..from.checked_add(count)?)
}

fn size_of(component: u32) -> usize {
    match component {
        5120 | 5121 => 1,
        5122 | 5123 => 2,
        5125 | 5126 => 4,
        _ => 0,
    }
}

/// The reader of a component type; integers that are normalized stand for -1 to 1 or 0 to 1.
fn reader(component: u32, normalized: bool) -> Option<fn(&[u8]) -> f64> {
    let i8s = |b: &[u8]| f64::from(b[0] as i8);
    let i16s = |b: &[u8]| f64::from(i16::from_le_bytes([b[0], b[1]]));
    let u16s = |b: &[u8]| f64::from(u16::from_le_bytes([b[0], b[1]]));
    match (component, normalized) {
        (5126, _) => Some(|b| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]))),
        (5125, false) => Some(|b| f64::from(u32::from_le_bytes([b[0], b[1], b[2], b[3]]))),
        (5120, false) => Some(i8s),
        (5120, true) => Some(|b| (f64::from(b[0] as i8) / 127.0).max(-1.0)),
        (5121, false) => Some(|b| f64::from(b[0])),
        (5121, true) => Some(|b| f64::from(b[0]) / 255.0),
        (5122, false) => Some(i16s),
        (5122, true) => Some(|b| (f64::from(i16::from_le_bytes([b[0], b[1]])) / 32767.0).max(-1.0)),
        (5123, false) => Some(u16s),
        (5123, true) => Some(|b| f64::from(u16::from_le_bytes([b[0], b[1]])) / 65535.0),
        _ => None,
    }
}

/// The bytes of a buffer: of the file itself, or of its URI.
pub(super) fn buffer(buffer: &Buffer, binary: Option<&[u8]>, path: &Path) -> Result<Vec<u8>> {
    let wrong = |text: String| Error::input(path, "buffers", CityError::Format(text));
    if buffer.is_fallback() {
        return Ok(Vec::new());
    }
    match &buffer.uri {
        Some(uri) => load(uri, path),
        None => {
            let missing = || wrong("a buffer has neither bytes nor a name".into());
            Ok(binary.ok_or_else(missing)?.to_vec())
        }
    }
}

/// The bytes of a data URI, or of a file beside `path`.
pub(super) fn load(uri: &str, path: &Path) -> Result<Vec<u8>> {
    let wrong = |text: String| Error::input(path, "uri", CityError::Format(text));
    if let Some(inline) = uri.strip_prefix("data:") {
        let encoded = inline.split_once(";base64,").map(|(_, text)| text);
        let encoded = encoded.ok_or_else(|| wrong("data that is not base64".into()))?;
        return STANDARD.decode(encoded).map_err(|e| wrong(e.to_string()));
    }
    let name = Path::new(uri);
    let plain = |c: Component| matches!(c, Component::Normal(_) | Component::CurDir);
    if !name.components().all(plain) {
        return Err(wrong(format!(
            "{uri:?} lies outside the folder of the file"
        )));
    }
    read_bytes(&path.parent().unwrap_or(Path::new("")).join(name))
}
