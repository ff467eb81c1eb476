//! Storeys, and the relation of parts to their whole.

use edifice_shape::DetailedBuilding;
use serde_json::Value;

use super::shapes::Frame;
use super::step::{Id, Step, exact, global_id, list};

/// Most storeys that are written; a building that says it had more gets so many.
const MOST_STOREYS: u64 = 200;

/// A storey, and the products on it.
pub(super) struct Storey {
    pub(super) id: Id,
    /// Height of its floor above that of the first (m).
    pub(super) elevation: f64,
    pub(super) frame: Frame,
    pub(super) elements: Vec<Id>,
    /// Planes of roofs that begin in it.
    pub(super) roofs: Vec<Id>,
}

/// The storeys of a building, at least one.
pub(super) fn storeys(step: &mut Step, building: &DetailedBuilding, frame: &Frame) -> Vec<Storey> {
    let attribute = |name: &str| building.attributes.get(name);
    let height = attribute("floorHeight").and_then(Value::as_f64);
    let count = attribute("storeysAboveGround").and_then(Value::as_u64);
    let (height, count) = match (height, count) {
        (Some(height), Some(count)) if height > 0.0 => (height, count.clamp(1, MOST_STOREYS)),
        _ => (0.0, 1),
    };
    let storey = |k: u64| {
        let elevation = k as f64 * height;
        let frame = Frame::new(step, Some(frame), [0.0, 0.0, elevation], [1.0, 0.0]);
        let number = (k + 1).to_string();
        let id = global_id(&[&building.name, "storey", &number]);
        let id = step.add(format_args!(
            "IFCBUILDINGSTOREY({id},$,'Storey {number}',$,$,{},$,$,.ELEMENT.,{})",
            frame.id,
            exact(elevation)
        ));
        Storey {
            id,
            elevation,
            frame,
            elements: Vec::new(),
            roofs: Vec::new(),
        }
    };
    (0..count).map(storey).collect()
}

/// Relates parts to their whole; no parts, no relation.
pub(super) fn aggregate(step: &mut Step, id: &str, whole: Id, parts: &[Id]) {
    if !parts.is_empty() {
        step.add(format_args!(
            "IFCRELAGGREGATES({id},$,$,$,{whole},{})",
            list(parts)
        ));
    }
}
