//! Instances of a glTF file (`EXT_mesh_gpu_instancing`).

use serde_json::Value;

use super::CityError;
use super::gltf_data::Buffers;
use super::gltf_transform::{Matrix, composed};

/// Transforms of a node's instances, and the building of each.
pub(super) fn drawn(
    buffers: &Buffers,
    attributes: &Value,
) -> Result<Vec<(Matrix, Option<usize>)>, CityError> {
    let accessor = |name: &str| -> Result<Option<usize>, CityError> {
        let wrong = || CityError::Format(format!("{name} is no accessor"));
        let value = attributes.get(name);
        let index = value.map(|v| v.as_u64().and_then(|i| usize::try_from(i).ok()));
        index.map(|i| i.ok_or_else(wrong)).transpose()
    };
    let read = |name: &str, width: usize| match accessor(name)? {
        Some(accessor) => buffers.floats(accessor, width).map(Some),
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
    let vector =
        |v: &Option<Vec<f64>>, i: usize| v.as_ref().map(|v| [v[3 * i], v[3 * i + 1], v[3 * i + 2]]);
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
