//! The distance that windows keep: new ones do not stand closer to another window than half of the least gap seen.
//!
//! A gap along an axis is that of two windows which share at least half of the smaller one's extent along the other axis.
//! Fewer than three gaps tell nothing. Without a mask, where windows may be seen one by one, a gap may hold a hidden one. A gap with a
//! seen column or row in it is left out; any other that has room for a window may hide one on a line of which no window is seen. Where a share q of the windows is seen, all n
//! gaps as small as the least one do so with probability at most `(1 - q)^n`; the least gap tells nothing where that is above [`CHANCE`].

use super::observation::{Observation, SCATTERED, of};
use crate::layout::Class;
use edifice_shape::{Axis, Rect};

/// Share of the least gap that is kept.
const KEPT: f64 = 0.5;
/// Least number of gaps that tell a distance.
const LEAST: usize = 3;
/// Gaps of up to this multiple of the least one are as small.
const ALIKE: f64 = 1.2;
/// Greatest probability with which gaps that are taken as free hide windows.
const CHANCE: f64 = 0.1;

/// Least gaps along x and y; 0 where any distance will do.
#[derive(Debug, Clone, Copy)]
pub(super) struct Apart([f64; 2]);

impl Apart {
    /// The gaps of the observed windows.
    pub(super) fn new(observation: &Observation) -> Self {
        let seen: Vec<Rect> = of(&observation.elements, Class::Window)
            .map(|e| e.rect)
            .collect();
        let scattered = observation.partial.unknown.is_none() && observation.seen <= SCATTERED;
        let is_cell_between = |a: &Rect, b: &Rect, axis: Axis| {
            let centre = |r: &Rect| r.start(axis) + r.extent(axis) / 2.0;
            let (from, to) = (centre(a).min(centre(b)), centre(a).max(centre(b)));
            let reach = observation.extent(axis) / 2.0;
            let mut lines = observation.lines(axis).iter();
            lines.any(|line| from + reach < line.at && line.at < to - reach)
        };
        Self(Axis::BOTH.map(|axis| {
            let pairs =
                (seen.iter().enumerate()).flat_map(|(k, a)| seen[..k].iter().map(move |b| [a, b]));
            let free = |[a, b]: &[&Rect; 2]| !scattered || !is_cell_between(a, b, axis);
            let gaps: Vec<f64> = pairs
                .filter(free)
                .filter_map(|[a, b]| gap(a, b, axis))
                .collect();
            let least = gaps.iter().copied().fold(f64::INFINITY, f64::min).max(0.0);
            let hides = scattered && least >= observation.extent(axis);
            let alike = gaps.iter().filter(|gap| **gap <= ALIKE * least).count();
            let chance = (1.0 - observation.seen).max(0.0).powi(alike as i32);
            match gaps.len() >= LEAST && !(hides && chance > CHANCE) {
                true => KEPT * least,
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

    /// The distances that windows at these places keep, without a mask.
    fn of(rects: &[Rect]) -> Apart {
        let elements = rects.iter().map(|r| Element::new(Class::Window, *r));
        let observed: Vec<Element> = elements.collect();
        let partial = PartialLayout {
            width: 150.0,
            height: 100.0,
            observed: observed.clone(),
            unknown: None,
            forbidden: Vec::new(),
        };
        Apart::new(&Observation::new(&partial, observed, (12.0, 20.0)))
    }

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

    #[test]
    fn gaps_that_may_hold_hidden_windows_tell_no_distance() {
        // Columns 20 apart, windows 12 wide: a gap of 28 has room for another window and 4 on both sides.
        let row = |y: f64, xs: &[f64]| -> Vec<Rect> {
            xs.iter().map(|x| Rect::new(*x, y, 12.0, 20.0)).collect()
        };
        let between = Rect::new(20.0, 0.0, 12.0, 20.0);
        let too_close = |rects: &[Rect]| of(rects).too_close(&rects[0], &between);
        // Two rows, each seen in every other column: the columns of the one lie in the gaps of the other.
        let (low, high) = (
            row(0.0, &[0.0, 40.0, 80.0]),
            row(30.0, &[20.0, 60.0, 100.0]),
        );
        assert!(!too_close(&[low.clone(), high].concat()));
        // The same columns, and few of their cells: three gaps may be chance.
        let high = row(30.0, &[0.0, 40.0]);
        let other = [row(60.0, &[0.0]), row(90.0, &[0.0]), row(120.0, &[0.0])].concat();
        assert!(!too_close(&[low.clone(), high.clone(), other].concat()));
        // Five of six cells: there is nothing between.
        assert!(too_close(&[low, high].concat()));
    }
}
