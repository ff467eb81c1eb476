//! Identifiers of buildings as a property table of `EXT_structural_metadata`, whose views are compressed, too.
//!
//! The codec looks for bytes that are like those one element before. Identifiers of one length, and of equal beginnings, are so with
//! elements of their length, or of twice it; all lengths that the codec takes are tried, and the smallest is kept.

use meshopt::encode_vertex_buffer_level;
use serde_json::json;

use super::super::glb::GlbError;
use super::super::gltf_properties::{CLASS, PROPERTY};
use super::views::{LEVEL, PROPERTIES, VERSION, Views};

/// Bytes in a row, as elements of so many words of four bytes.
const WORDS: usize = 16;

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
    let mut best: Option<(usize, usize, Vec<u8>)> = None;
    for words in 1..=WORDS {
        let (count, bytes) = elements(&values, words)?;
        if best.as_ref().is_none_or(|b| bytes.len() < b.2.len()) {
            best = Some((words, count, bytes));
        }
    }
    let Some((words, count, bytes)) = best else {
        return Ok(());
    };
    let [texts, ends] = [out.file.view_to_come(), out.file.view_to_come()];
    out.write(texts, count, 4 * words, &bytes, PROPERTIES);
    let bytes = encode_vertex_buffer_level(&offsets, LEVEL, VERSION)?;
    out.write(ends, offsets.len(), 4, &bytes, PROPERTIES);
    out.file.properties = Some(json!({
        "schema": { "id": "edifice", "classes": { CLASS: { "properties": { PROPERTY: { "type": "STRING", "required": true } } } } },
        "propertyTables": [{ "class": CLASS, "count": ids.len(),
            "properties": { PROPERTY: { "values": texts, "stringOffsets": ends } } }],
    }));
    Ok(())
}

/// Bytes as elements of `words` words, filled up with zeros, encoded.
fn elements(bytes: &[u8], words: usize) -> Result<(usize, Vec<u8>), GlbError> {
    fn of<const N: usize>(bytes: &[u8]) -> Result<(usize, Vec<u8>), GlbError> {
        let mut elements = vec![[[0u8; 4]; N]; bytes.len().div_ceil(4 * N)];
        let all = elements.as_flattened_mut().as_flattened_mut();
        all[..bytes.len()].copy_from_slice(bytes);
        let encoded = encode_vertex_buffer_level(&elements, LEVEL, VERSION)?;
        Ok((elements.len(), encoded))
    }
    match words {
        1 => of::<1>(bytes),
        2 => of::<2>(bytes),
        3 => of::<3>(bytes),
        4 => of::<4>(bytes),
        5 => of::<5>(bytes),
        6 => of::<6>(bytes),
        7 => of::<7>(bytes),
        8 => of::<8>(bytes),
        9 => of::<9>(bytes),
        10 => of::<10>(bytes),
        11 => of::<11>(bytes),
        12 => of::<12>(bytes),
        13 => of::<13>(bytes),
        14 => of::<14>(bytes),
        15 => of::<15>(bytes),
        _ => of::<WORDS>(bytes),
    }
}
