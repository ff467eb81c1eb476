//! Are two layouts the same, up to the order of their regions?

use rustc_hash::FxHashMap;

use super::limits::TOLERANCE;
use edifice_shape::{Facade, Rect, Region};

/// The first difference of two layouts.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Difference {
    /// The facades have different sizes.
    #[error("sizes differ: {} x {} and {} x {}", .first.0, .first.1, .second.0, .second.1)]
    Size {
        /// Width and height of the first.
        first: (f64, f64),
        /// Width and height of the second.
        second: (f64, f64),
    },
    /// A region has no counterpart in the other layout, or fewer than it should.
    #[error("{label} at ({}, {}) of {} x {} is only in the {} layout", rect.x, rect.y, rect.width, rect.height, if *.in_first { "first" } else { "second" })]
    Region {
        /// Its label.
        label: String,
        /// Its rectangle.
        rect: Rect,
        /// True if the first layout has it, false if the second.
        in_first: bool,
    },
}

/// True if two layouts have the same size and the same regions, in any order, with coordinates equal up to
/// [`TOLERANCE`] of the larger side. Names and units are not compared.
pub fn same_tiling(first: &Facade, second: &Facade) -> bool {
    tiling_difference(first, second).is_none()
}

/// As [`same_tiling`], with the first difference found.
///
/// # Complexity
/// `O(n log n)` for `n` regions.
pub fn tiling_difference(first: &Facade, second: &Facade) -> Option<Difference> {
    let tolerance = TOLERANCE * first.width.max(first.height);
    let close = |a: f64, b: f64| (a - b).abs() <= tolerance;
    if !close(first.width, second.width) || !close(first.height, second.height) {
        return Some(Difference::Size {
            first: (first.width, first.height),
            second: (second.width, second.height),
        });
    }
    // Equal coordinates get equal numbers, so that regions compare as integers.
    let all = || first.regions.iter().chain(&second.regions);
    let xs = Levels::new(all().flat_map(|r| [r.rect.x, r.rect.right()]), tolerance);
    let ys = Levels::new(all().flat_map(|r| [r.rect.y, r.rect.top()]), tolerance);
    let key = |region: &Region| {
        let r = region.rect;
        [xs.of(r.x), xs.of(r.right()), ys.of(r.y), ys.of(r.top())]
    };
    let mut balance: FxHashMap<(&str, [usize; 4]), i64> = FxHashMap::default();
    for region in &first.regions {
        *balance.entry((&region.label, key(region))).or_default() += 1;
    }
    for region in &second.regions {
        *balance.entry((&region.label, key(region))).or_default() -= 1;
    }
    let left_over = |region: &&Region, sign: i64| {
        balance[&(region.label.as_str(), key(region))].signum() == sign
    };
    let lone = |facade: &Facade, sign| {
        let region = facade.regions.iter().find(|r| left_over(r, sign))?;
        Some(Difference::Region {
            label: region.label.clone(),
            rect: region.rect,
            in_first: sign > 0,
        })
    };
    lone(first, 1).or_else(|| lone(second, -1))
}

/// Sorted coordinates, those closer than a tolerance counted as one.
struct Levels {
    /// The lowest coordinate of each level.
    from: Vec<f64>,
}

impl Levels {
    fn new(values: impl Iterator<Item = f64>, tolerance: f64) -> Self {
        let mut sorted: Vec<f64> = values.collect();
        sorted.sort_by(f64::total_cmp);
        let mut from: Vec<f64> = Vec::new();
        for value in sorted {
            if from.last().is_none_or(|&low| value - low > tolerance) {
                from.push(value);
            }
        }
        Self { from }
    }

    /// Number of the level of one of the values.
    fn of(&self, value: f64) -> usize {
        self.from.partition_point(|&low| low <= value)
    }
}
