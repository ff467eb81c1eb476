//! Helpers that the tests of several files share.

use super::{Facade, Rect, Region};

/// A square facade of regions `(x, y, width, height)`, all with one label.
pub(crate) fn facade(size: f64, rects: &[(f64, f64, f64, f64)]) -> Facade {
    let regions = rects
        .iter()
        .map(|&(x, y, w, h)| Region {
            label: "a".into(),
            rect: Rect::new(x, y, w, h),
        })
        .collect();
    Facade::new("f", "px", size, size, regions).unwrap()
}
