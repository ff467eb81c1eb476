//! Identifiers of buildings in property tables of `EXT_structural_metadata`.

use serde_json::Value;

use super::gltf_data::Buffers;

/// The name of the extension.
pub(super) const EXTENSION: &str = "EXT_structural_metadata";
/// The class whose table has the buildings of this program's files, and its property.
pub(super) const CLASS: &str = "building";
pub(super) const PROPERTY: &str = "id";

/// The identifiers in a file's extension; `None` if it has no table of buildings as this program writes it.
pub(super) fn identifiers(extension: &Value, buffers: &Buffers) -> Option<Vec<String>> {
    let tables = extension["propertyTables"].as_array()?;
    let table = tables.iter().find(|t| t["class"] == CLASS)?;
    let property = &table["properties"][PROPERTY];
    let view = |key: &str| {
        let index = property[key].as_u64()?;
        buffers.view(usize::try_from(index).ok()?)
    };
    let (values, offsets) = (view("values")?, view("stringOffsets")?);
    let count = usize::try_from(table["count"].as_u64()?).ok()?;
    let words = offsets.chunks_exact(4).take(count.checked_add(1)?);
    let offsets: Vec<usize> = words
        .map(|w| u32::from_le_bytes([w[0], w[1], w[2], w[3]]) as usize)
        .collect();
    if offsets.len() != count + 1 {
        return None;
    }
    let text = |pair: &[usize]| {
        let bytes = values.get(pair[0]..pair[1])?;
        String::from_utf8(bytes.to_vec()).ok()
    };
    offsets.windows(2).map(text).collect()
}
