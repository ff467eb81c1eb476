//! Numbers of a glTF file: accessors of views of buffers, each checked against the bytes there are.

use std::path::{Component, Path};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Deserialize;
use serde_json::Value;

use super::CityError;
use crate::read_bytes;
use edifice_base::{Error, Result};

/// Bytes.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Buffer {
    pub byte_length: usize,
    pub uri: Option<String>,
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
    pub data: Vec<Vec<u8>>,
    pub views: &'a [View],
    pub accessors: &'a [Accessor],
}

fn wrong(index: usize, problem: &str) -> CityError {
    CityError::Format(format!("accessors[{index}] {problem}"))
}

impl Buffers<'_> {
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
        let view = self.views.get(index)?;
        let end = view.byte_offset.checked_add(view.byte_length)?;
        self.data.get(view.buffer)?.get(view.byte_offset..end)
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
