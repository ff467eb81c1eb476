//! The 3D Tiles of a tile, as the tileset over all of them needs to know them.

use serde_json::Value;

use edifice_io_city::earth;
use edifice_io_city::region::Region;

/// A tile's scene, as its tileset tells of it.
pub(super) struct Scene {
    pub(super) origin: [f64; 3],
    system: Option<String>,
    /// Centre and half axes.
    pub(super) cube: [f64; 12],
    pub(super) error: f64,
}

impl Scene {
    /// `None` if this program has not written it.
    pub(super) fn new(tileset: &Value) -> Option<Self> {
        let about = &tileset["asset"]["extras"];
        let root = &tileset["root"];
        let numbers = |value: &Value| serde_json::from_value(value.clone()).ok();
        let mut cube: [f64; 12] = numbers(&root["boundingVolume"]["box"])?;
        // A tileset of one tile moves it to its place.
        let moved = root["transform"].as_array().into_iter().flatten();
        for (v, moved) in cube.iter_mut().zip(moved.skip(12).take(3)) {
            *v += moved.as_f64()?;
        }
        Some(Self {
            origin: serde_json::from_value(about["origin"].clone()).ok()?,
            system: about["reference_system"].as_str().map(str::to_owned),
            cube,
            error: tileset["geometricError"].as_f64()?,
        })
    }

    /// The matrix, column by column, that puts it on the earth, if its reference system is known.
    pub(super) fn on_the_earth(&self) -> Option<[f64; 16]> {
        let middle = [self.cube[0], self.cube[1], 0.0];
        earth::place(self.system.as_deref()?, self.origin, middle)
    }

    /// The region of its volume, which `place` puts on the earth.
    pub(super) fn region(&self, place: &[f64; 16]) -> Region {
        // Its axes are those of the coordinates.
        let half = |k: usize| self.cube[3 + 4 * k].abs();
        let [low, high] = [-1.0, 1.0].map(|side| [0, 1, 2].map(|k| self.cube[k] + side * half(k)));
        Region::around(place, low, high)
    }

    /// The corners of its volume.
    pub(super) fn corners(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        (0..8).map(|corner| {
            [0, 1, 2].map(|k| {
                let along = |axis: usize| {
                    let half = self.cube[3 + 3 * axis + k];
                    if corner >> axis & 1 == 1 { half } else { -half }
                };
                self.cube[k] + (0..3).map(along).sum::<f64>()
            })
        })
    }
}
