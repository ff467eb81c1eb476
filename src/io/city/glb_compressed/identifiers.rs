//! Identifiers of buildings as a property table of `EXT_structural_metadata`, whose views are compressed, too.
//!
//! The codec looks for bytes that are like those one element before. Identifiers of one length, and of equal beginnings, are so with
//! elements of their length, or of twice it; all lengths that the codec takes are tried, and the smallest is kept.

use meshopt::encode_vertex_buffer_level;
use serde_json::json;

use super::super::glb::GlbError;
use super::super::gltf_properties::{CLASS, PROPERTY};
use super::views::{LEVEL, PROPERTIES, VERSION, Views};

/// Adds identifiers to a file.
pub(super) fn write(out: &mut Views, ids: &[&str]) -> Result<(), GlbError> {
    if ids.is_empty() {
        return Ok(());
    }
    let mut offsets = vec![0u32];
    let mut values = Vec::new();
    for id in ids {
        values.extend_from_slice(id.as_bytes());
        let end = u32::try_from(values.len());
        offsets.push(end.map_err(|_| GlbError::Codec("identifiers of over 4 GB".into()))?);
    }
    let mut best = elements::<1>(&values)?;
    for encode in LONGER {
        let found = encode(&values)?;
        if found.bytes.len() < best.bytes.len() {
            best = found;
        }
    }
    let [texts, ends] = [out.file.view_to_come(), out.file.view_to_come()];
    out.write(texts, best.count, best.stride, &best.bytes, PROPERTIES);
    let bytes = encode_vertex_buffer_level(&offsets, LEVEL, VERSION)?;
    out.write(ends, offsets.len(), 4, &bytes, PROPERTIES);
    out.file.properties = Some(json!({
        "schema": { "id": "edifice", "classes": { CLASS: { "properties": { PROPERTY: { "type": "STRING", "required": true } } } } },
        "propertyTables": [{ "class": CLASS, "count": ids.len(),
            "properties": { PROPERTY: { "values": texts, "stringOffsets": ends } } }],
    }));
    Ok(())
}

/// Bytes, encoded as elements of a length.
struct Encoded {
    count: usize,
    /// Bytes of an element.
    stride: usize,
    bytes: Vec<u8>,
}

type Encode = fn(&[u8]) -> Result<Encoded, GlbError>;

/// The lengths of two to sixteen words: those that readers of this program take.
const LONGER: [Encode; 15] = [
    elements::<2>,
    elements::<3>,
    elements::<4>,
    elements::<5>,
    elements::<6>,
    elements::<7>,
    elements::<8>,
    elements::<9>,
    elements::<10>,
    elements::<11>,
    elements::<12>,
    elements::<13>,
    elements::<14>,
    elements::<15>,
    elements::<16>,
];

/// Bytes as elements of `N` words of four bytes, filled up with zeros, encoded.
fn elements<const N: usize>(bytes: &[u8]) -> Result<Encoded, GlbError> {
    // No view is empty, even if all identifiers are.
    let mut elements = vec![[[0u8; 4]; N]; bytes.len().div_ceil(4 * N).max(1)];
    let all = elements.as_flattened_mut().as_flattened_mut();
    all[..bytes.len()].copy_from_slice(bytes);
    Ok(Encoded {
        count: elements.len(),
        stride: 4 * N,
        bytes: encode_vertex_buffer_level(&elements, LEVEL, VERSION)?,
    })
}
