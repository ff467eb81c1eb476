//! The distance that windows keep: new ones do not stand closer to another window than half of the least gap seen.
//!
//! A gap along an axis is that of two windows which share at least half of the smaller one's extent along the other axis.
//! Fewer than three gaps tell nothing, nor, without a mask, do windows that are seen one by one: those between them
//! may be hidden.

use super::observation::{Observation, SCATTERED, of};
use crate::layout::Class;
use edifice_shape::{Axis, Rect};

/// Share of the least gap that is kept.
const KEPT: f64 = 0.5;
/// Least number of gaps that tell a distance.
const LEAST: usize = 3;

/// Least gaps along x and y; 0 where any distance will do.
#[derive(Debug, Clone, Copy)]
pub(super) struct Apart([f64; 2]);

impl Apart {
    /// The gaps of the observed windows.
    pub(super) fn new(observation: &Observation) -> Self {
        if observation.partial.unknown.is_none() && observation.seen <= SCATTERED {
            return Self([0.0; 2]);
        }
        let seen: Vec<Rect> = of(&observation.elements, Class::Window)
            .map(|e| e.rect)
            .collect();
        Self(Axis::BOTH.map(|axis| {
            let (mut count, mut least) = (0, f64::INFINITY);
            for (k, a) in seen.iter().enumerate() {
                for gap in seen[..k].iter().filter_map(|b| gap(a, b, axis)) {
                    count += 1;
                    least = least.min(gap);
                }
            }
            match count >= LEAST {
                true => KEPT * least.max(0.0),
                false => 0.0,
            }
        }))
    }

    /// The rectangle that all windows too close to this one meet.
    pub(super) fn around(&self, window: &Rect) -> Rect {
        let [x, y] = self.0;
        let (width, height) = (window.width + 2.0 * x, window.height + 2.0 * y);
        Rect::new(window.x - x, window.y - y, width, height)
    }

    /// True if two windows stand too close.
    pub(super) fn too_close(&self, a: &Rect, b: &Rect) -> bool {
        Axis::BOTH
            .into_iter()
            .any(|axis| gap(a, b, axis).is_some_and(|gap| gap < self.0[axis as usize]))
    }
}

/// The gap of two rectangles along an axis, negative where they overlap; `None` where they do not stand beside each other.
fn gap(a: &Rect, b: &Rect, axis: Axis) -> Option<f64> {
    let end = |r: &Rect, axis: Axis| r.start(axis) + r.extent(axis);
    let distance = |axis: Axis| a.start(axis).max(b.start(axis)) - end(a, axis).min(end(b, axis));
    let across = axis.other();
    let beside = -distance(across) >= 0.5 * a.extent(across).min(b.extent(across));
    beside.then(|| distance(axis))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::Element;
    use crate::partial::PartialLayout;

    #[test]
    fn half_of_the_least_gap_is_kept() {
        // Gaps of 8 and 18 along x, 10 along y.
        let at = [
            (0.0, 0.0),
            (20.0, 0.0),
            (50.0, 0.0),
            (0.0, 30.0),
            (20.0, 30.0),
        ];
        let rects = at.map(|(x, y)| Rect::new(x, y, 12.0, 20.0));
        let of = |rects: &[Rect]| {
            let elements = rects.iter().map(|r| Element::new(Class::Window, *r));
            let observed: Vec<Element> = elements.collect();
            let partial = PartialLayout {
                width: 100.0,
                height: 100.0,
                observed: observed.clone(),
                unknown: None,
                forbidden: Vec::new(),
            };
            Apart::new(&Observation::new(&partial, observed, (12.0, 20.0)))
        };
        let few = of(&rects[..2]);
        let apart = of(&rects);
        let beside = |gap: f64| Rect::new(62.0 + gap, 0.0, 12.0, 20.0);
        assert!(apart.too_close(&rects[2], &beside(3.9)));
        assert!(!apart.too_close(&rects[2], &beside(4.1)));
        assert!(!few.too_close(&rects[2], &beside(0.1)));
        // Two gaps along y tell nothing; nor do windows that stand askew.
        assert!(!apart.too_close(&rects[2], &Rect::new(50.0, 21.0, 12.0, 20.0)));
        assert!(!apart.too_close(&rects[2], &Rect::new(63.0, 15.0, 12.0, 20.0)));
    }
}
