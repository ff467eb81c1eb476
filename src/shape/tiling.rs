//! Is a layout a tiling: no gaps, no overlaps?
//!
//! Regions are visited from the bottom up while a *skyline* (for each x, how high the facade is
//! covered) grows. A region must stand exactly on the skyline: above it there is a gap that no later
//! region can fill, below it there is an overlap. O(n log n) for n regions.

use std::collections::BTreeMap;

use super::cuts::Cuts;
use super::{Facade, LayoutError, Rect};

/// Differences up to this fraction of the facade's longer side count as none.
pub const RELATIVE_TOLERANCE: f64 = 1e-6;

/// A region as spans of cut indices, half open: columns `left..right`, rows `bottom..top`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Span {
    /// First column.
    pub left: usize,
    /// One past the last column.
    pub right: usize,
    /// First row.
    pub bottom: usize,
    /// One past the last row.
    pub top: usize,
}

/// A layout on the irregular grid of its own cut coordinates.
#[derive(Debug, Clone)]
pub struct IndexedLayout {
    /// Cut coordinates along x, the facade's sides included.
    pub xs: Cuts,
    /// Cut coordinates along y.
    pub ys: Cuts,
    /// Span of each region, in the order of the facade.
    pub spans: Vec<Span>,
}

/// Part of the skyline: from its key to `right`, covered up to row `top` by region `owner`.
#[derive(Clone, Copy)]
struct SkylineSegment {
    right: usize,
    top: usize,
    owner: Option<usize>,
}

impl Facade {
    /// Longest difference that counts as none, in the facade's unit.
    pub fn tolerance(&self) -> f64 {
        RELATIVE_TOLERANCE * self.width.max(self.height)
    }

    /// The layout on the grid of its cut coordinates, nearly equal ones taken as one.
    ///
    /// # Errors
    /// [`LayoutError::TooThin`] for a region that is thinner than the tolerance.
    pub fn indexed(&self) -> Result<IndexedLayout, LayoutError> {
        let tolerance = self.tolerance();
        let rects = || self.regions.iter().map(|region| region.rect);
        let xs = Cuts::new(
            rects()
                .flat_map(|r| [r.x, r.right()])
                .chain([0.0, self.width]),
            tolerance,
        );
        let ys = Cuts::new(
            rects()
                .flat_map(|r| [r.y, r.top()])
                .chain([0.0, self.height]),
            tolerance,
        );
        let span = |(index, r): (usize, Rect)| {
            let span = Span {
                left: xs.index(r.x),
                right: xs.index(r.right()),
                bottom: ys.index(r.y),
                top: ys.index(r.top()),
            };
            if span.left == span.right || span.bottom == span.top {
                return Err(LayoutError::TooThin {
                    index,
                    label: self.regions[index].label.clone(),
                    tolerance,
                });
            }
            Ok(span)
        };
        let spans = rects().enumerate().map(span).collect::<Result<_, _>>()?;
        Ok(IndexedLayout { xs, ys, spans })
    }

    /// Checks that the regions cover the facade without gaps or overlaps, up to one millionth of
    /// its longer side. O(n log n).
    ///
    /// # Errors
    /// [`LayoutError::Gap`] with an uncovered place, [`LayoutError::Overlap`] with two regions and a
    /// point in both, [`LayoutError::TooThin`], or [`LayoutError::Empty`].
    pub fn check_tiling(&self) -> Result<(), LayoutError> {
        if self.regions.is_empty() {
            return Err(LayoutError::Empty);
        }
        let layout = self.indexed()?;
        let (xs, ys) = (layout.xs.values(), layout.ys.values());
        let columns = xs.len() - 1;
        let rows = ys.len() - 1;
        let gap = |left: usize, right: usize, bottom: usize, top: usize| LayoutError::Gap {
            x: xs[left],
            y: ys[bottom],
            right: xs[right],
            top: ys[top],
        };

        let mut order: Vec<usize> = (0..layout.spans.len()).collect();
        order.sort_unstable_by_key(|&i| (layout.spans[i].bottom, layout.spans[i].left, i));
        let ground = SkylineSegment {
            right: columns,
            top: 0,
            owner: None,
        };
        let mut skyline = BTreeMap::from([(0, ground)]);
        for index in order {
            let span = layout.spans[index];
            let (&first, _) = skyline
                .range(..=span.left)
                .next_back()
                .unwrap_or((&0, &ground));
            let covered: Vec<(usize, SkylineSegment)> = skyline
                .range(first..span.right)
                .map(|(&left, &step)| (left, step))
                .collect();
            for &(left, step) in &covered {
                let (from, to) = (left.max(span.left), step.right.min(span.right));
                match step.owner {
                    Some(owner) if step.top > span.bottom => {
                        return Err(self.overlap(&layout, owner, index));
                    }
                    _ if step.top < span.bottom => {
                        return Err(gap(from, to, step.top, span.bottom));
                    }
                    _ => {}
                }
            }
            for &(left, step) in &covered {
                skyline.remove(&left);
                if left < span.left {
                    let right = span.left;
                    skyline.insert(left, SkylineSegment { right, ..step });
                }
                if step.right > span.right {
                    skyline.insert(span.right, step);
                }
            }
            let step = SkylineSegment {
                right: span.right,
                top: span.top,
                owner: Some(index),
            };
            skyline.insert(span.left, step);
        }
        match skyline.iter().find(|(_, step)| step.top < rows) {
            Some((&left, step)) => Err(gap(left, step.right, step.top, rows)),
            None => Ok(()),
        }
    }

    /// The error for two regions known to overlap, with the middle of what they share.
    fn overlap(&self, layout: &IndexedLayout, a: usize, b: usize) -> LayoutError {
        let (first, second) = (a.min(b), a.max(b));
        let (s, t) = (layout.spans[first], layout.spans[second]);
        let middle =
            |cuts: &Cuts, from: usize, to: usize| 0.5 * (cuts.values()[from] + cuts.values()[to]);
        LayoutError::Overlap {
            first,
            first_label: self.regions[first].label.clone(),
            second,
            second_label: self.regions[second].label.clone(),
            x: middle(&layout.xs, s.left.max(t.left), s.right.min(t.right)),
            y: middle(&layout.ys, s.bottom.max(t.bottom), s.top.min(t.top)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::facade;
    use proptest::prelude::*;

    /// Oracle: paints every unit cell.
    fn covered_once(facade: &Facade) -> bool {
        let n = facade.width as usize;
        let mut count = vec![0; n * n];
        for region in &facade.regions {
            let r = region.rect;
            for y in r.y as usize..r.top() as usize {
                for x in r.x as usize..r.right() as usize {
                    count[y * n + x] += 1;
                }
            }
        }
        count.iter().all(|&c| c == 1)
    }

    #[test]
    fn gaps_and_overlaps_are_named() {
        let left = (0.0, 0.0, 1.0, 2.0);
        assert_eq!(
            facade(2.0, &[left, (1.0, 0.0, 1.0, 2.0)]).check_tiling(),
            Ok(())
        );
        let hole = facade(2.0, &[left, (1.0, 0.5, 1.0, 1.5)]).check_tiling();
        let expected = LayoutError::Gap {
            x: 1.0,
            y: 0.0,
            right: 2.0,
            top: 0.5,
        };
        assert_eq!(hole, Err(expected));
        let message = facade(2.0, &[left, (1.0, 0.0, 1.0, 1.0)]).check_tiling();
        let expected = LayoutError::Gap {
            x: 1.0,
            y: 1.0,
            right: 2.0,
            top: 2.0,
        };
        assert_eq!(message, Err(expected));
        let both = facade(2.0, &[left, (0.5, 0.0, 1.5, 2.0)]).check_tiling();
        let text = both.unwrap_err().to_string();
        assert!(
            text.contains("regions[0] (a) and regions[1] (a) overlap at (0.75, 1)"),
            "{text}"
        );
        assert_eq!(facade(2.0, &[]).check_tiling(), Err(LayoutError::Empty));
    }

    #[test]
    fn a_millionth_is_no_gap_but_a_thousandth_is() {
        let with = |gap: f64| facade(1.0, &[(0.0, 0.0, 0.5 - gap, 1.0), (0.5, 0.0, 0.5, 1.0)]);
        assert!(with(1e-7).check_tiling().is_ok());
        assert!(matches!(
            with(1e-3).check_tiling(),
            Err(LayoutError::Gap { .. })
        ));
        let thin = facade(1.0, &[(0.0, 0.0, 1e-9, 1.0)]).check_tiling();
        assert!(matches!(thin, Err(LayoutError::TooThin { index: 0, .. })));
    }

    #[test]
    fn twenty_thousand_regions_take_no_time() {
        let mut rects = Vec::new();
        for i in 0..200 {
            for j in 0..100 {
                rects.push((f64::from(i), 2.0 * f64::from(j), 1.0, 2.0));
            }
        }
        let start = std::time::Instant::now();
        assert_eq!(facade(200.0, &rects).check_tiling(), Ok(()));
        assert!(start.elapsed().as_secs_f64() < 5.0);
    }

    proptest! {
        #[test]
        fn agrees_with_painting(rects in prop::collection::vec((0u8..4, 0u8..4, 1u8..5, 1u8..5), 1..7)) {
            let rects: Vec<_> = rects
                .into_iter()
                .map(|(x, y, w, h)| (x, y, w.min(4 - x), h.min(4 - y)))
                .map(|(x, y, w, h)| (x.into(), y.into(), w.into(), h.into()))
                .collect();
            let facade = facade(4.0, &rects);
            prop_assert_eq!(facade.check_tiling().is_ok(), covered_once(&facade));
        }
    }
}
