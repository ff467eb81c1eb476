//! Regularization of layouts by quadratic programming (Wu et al. 2014, Sec. 3.3).
//!
//! Annotations are off by pixels, but a grammar can only share what is *equal*. Regularization moves
//! edges so that repeated elements get equal sizes and nearly aligned edges get aligned.
//!
//! ```text
//! minimise    sum_k w_k (v_k - x_k)^2             x_k: cut coordinates, w_k: length of edge on them
//! subject to  |v_k - x_k| <= tolerance            no edge moves further
//!             v_0 = 0, v_n = W                    the total size is kept
//!             v_(k+1) - v_k >= gap_k > 0          lines that do not merge keep their order
//!             v_i = v_j                           nearly aligned edges, one line each
//!             v_r - v_l = s_c                     nearly equal sizes of one label, one size each
//! ```
//! once along x and once along y, which nothing connects. Which equalities hold is chosen first:
//! neighbouring cut lines are merged, nearest first, when no edge moves further than the tolerance and
//! nothing is lost between them but slivers no wider than the tolerance: of wall, and of elements that
//! are no rectangles, beside the largest part of them that is one. So where a sill lies three pixels
//! below one window and touches another, it comes to touch both; elements of one label never come to
//! touch. Then sizes of one label that lie within twice the tolerance (a size has two ends) form a
//! cluster, elements before walls, which is split into as large parts as can be when no placement can
//! give it one size. Sizes and positions are whole numbers of a quantum (pixels when the input is in
//! whole pixels): the program gives real sizes, which are rounded where that stays feasible; with sizes
//! fixed, what remains are constraints on differences with whole right-hand sides, for which rounding a
//! solution keeps every one of them. So equal sizes are equal exactly.
//!
//! # Deviations and readings
//! - The paper only says that quadratic programming is used. The choice of equalities is ours.
//! - Areas of a label picture that are rectangles but for nicks not deeper than the tolerance become
//!   rectangles first.
//! - The weights w_k are ours: one misdrawn window should move to the others, not they to it.

mod areas;
mod axis;
mod differences;
mod resized;
mod sizes;
mod square;

use std::collections::BTreeMap;

use crate::optim::qp::QpError;
use crate::shape::{Facade, GridError, LabelGrid, LayoutError, Rect, Region};

use areas::{Areas, Freedom};

/// Why a layout cannot be regularized.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RegularizeError {
    /// The tolerance is not a positive number.
    #[error("the tolerance is {0}, expected a positive number")]
    Tolerance(f64),
    /// The label grid is not valid.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// Not every region has a kind.
    #[error("{found} kinds are given for {expected} regions")]
    Kinds {
        /// Number of kinds.
        found: usize,
        /// Number of regions.
        expected: usize,
    },
    /// The layout is not a tiling.
    #[error(transparent)]
    Layout(#[from] LayoutError),
    /// The quadratic program failed.
    #[error(transparent)]
    Qp(#[from] QpError),
}

/// What regularization did.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Report {
    /// Longest way that any edge moved, in the unit of the layout.
    pub largest_move: f64,
    /// Areas with nicks that became rectangles.
    pub squared: usize,
    /// Cut lines before and after, both axes together.
    pub lines: (usize, usize),
    /// Distinct sizes (width and height) of the areas of each label, before and after.
    pub sizes: BTreeMap<String, (usize, usize)>,
}

/// Regularizes a label picture. `tolerance` is the longest way that an edge may move, in the unit of
/// the grid.
///
/// # Errors
/// [`RegularizeError`] for a grid that is not [valid](LabelGrid::check) or a tolerance that is not a
/// positive number.
pub fn regularize_grid(
    grid: &LabelGrid,
    tolerance: f64,
) -> Result<(LabelGrid, Report), RegularizeError> {
    check_tolerance(tolerance)?;
    grid.check()?;
    let (squared, nicks) = square::square(grid, tolerance);
    let areas = Areas::of_grid(&squared);
    let (xs, ys) = areas.solve(Freedom::Noise { tolerance })?;
    let result = moved_grid(&squared, &xs, &ys).merged();
    let before = areas::sizes(&grid.merged());
    let report = Report {
        largest_move: largest(&squared, &xs, &ys).max(nicks.deepest),
        squared: nicks.count,
        lines: (lines(&grid.merged()), lines(&result)),
        sizes: paired(before, areas::sizes(&result)),
    };
    Ok((result, report))
}

/// Regularizes a tiling: every region keeps its place in the list and its neighbours, walls included, so
/// that slivers of wall stay.
///
/// # Errors
/// [`RegularizeError`] for a layout that is not a tiling or a tolerance that is not a positive number.
pub fn regularize_facade(
    facade: &Facade,
    tolerance: f64,
) -> Result<(Facade, Report), RegularizeError> {
    check_tolerance(tolerance)?;
    move_lines(facade, |areas| areas.solve(Freedom::Noise { tolerance }))
}

/// Aligns a resized layout (Wu et al. 2014, Sec. 5, "advanced grammar derivation", Fig. 12): elements
/// of one kind get one size, then edges within `tolerance` of each other become one line, as far as
/// the sizes allow. `kinds[i]` is the kind of region `i`; regions of the background keep no size.
///
/// Sizes come first; for them edges move by up to `reach`. Equal sizes are equal up to the
/// precision of the solver. Where no placement gives every kind its one size, as many kinds as
/// possible get it.
///
/// # Errors
/// [`RegularizeError`] for a layout that is not a tiling, a `reach` or `tolerance` that is not a
/// positive number, or a number of kinds that is not that of the regions.
pub fn align_resized(
    facade: &Facade,
    kinds: &[u16],
    reach: f64,
    tolerance: f64,
) -> Result<(Facade, Report), RegularizeError> {
    check_tolerance(reach)?;
    check_tolerance(tolerance)?;
    if kinds.len() != facade.regions.len() {
        return Err(RegularizeError::Kinds {
            found: kinds.len(),
            expected: facade.regions.len(),
        });
    }
    let freedom = Freedom::Resized { reach, tolerance };
    move_lines(facade, |areas| areas.with_kinds(kinds).solve(freedom))
}

/// A tiling with its cut lines where `solve` puts them.
fn move_lines(
    facade: &Facade,
    solve: impl FnOnce(Areas) -> Result<(Vec<f64>, Vec<f64>), RegularizeError>,
) -> Result<(Facade, Report), RegularizeError> {
    let grid = LabelGrid::from_facade(facade, None)?;
    let layout = facade.indexed()?;
    let (xs, ys) = solve(Areas::of_facade(facade, &layout, &grid))?;
    let regions = facade.regions.iter().zip(&layout.spans).map(|(region, s)| {
        let (x, y) = (xs[s.left], ys[s.bottom]);
        Region {
            label: region.label.clone(),
            rect: Rect::new(x, y, xs[s.right] - x, ys[s.top] - y),
        }
    });
    let (width, height) = (xs[xs.len() - 1], ys[ys.len() - 1]);
    let regions = regions.collect();
    let result = Facade::new(
        facade.name.clone(),
        facade.unit.clone(),
        width,
        height,
        regions,
    )?;
    let after = LabelGrid::from_facade(&result, None)?;
    let report = Report {
        largest_move: largest(&grid, &xs, &ys),
        squared: 0,
        lines: (lines(&grid), lines(&after)),
        sizes: paired(areas::region_sizes(facade), areas::region_sizes(&result)),
    };
    Ok((result, report))
}

fn check_tolerance(tolerance: f64) -> Result<(), RegularizeError> {
    if tolerance.is_finite() && tolerance > 0.0 {
        Ok(())
    } else {
        Err(RegularizeError::Tolerance(tolerance))
    }
}

/// The cells between moved cut lines, without those that have vanished.
fn moved_grid(grid: &LabelGrid, xs: &[f64], ys: &[f64]) -> LabelGrid {
    let kept = |cuts: &[f64]| -> Vec<usize> {
        (0..cuts.len() - 1)
            .filter(|&k| cuts[k + 1] > cuts[k])
            .collect()
    };
    let (columns, rows) = (kept(xs), kept(ys));
    let boundaries = |kept: &[usize], cuts: &[f64]| {
        kept.iter()
            .map(|&k| cuts[k])
            .chain([cuts[cuts.len() - 1]])
            .collect()
    };
    let cells = rows
        .iter()
        .flat_map(|&j| columns.iter().map(move |&i| grid.at(i, j)));
    LabelGrid {
        xs: boundaries(&columns, xs),
        ys: boundaries(&rows, ys),
        cells: cells.collect(),
        name: grid.name.clone(),
        unit: grid.unit.clone(),
        labels: grid.labels.clone(),
    }
}

fn largest(grid: &LabelGrid, xs: &[f64], ys: &[f64]) -> f64 {
    let old = grid.xs.iter().chain(&grid.ys);
    let moves = old.zip(xs.iter().chain(ys)).map(|(a, b)| (a - b).abs());
    moves.fold(0.0, f64::max)
}

fn lines(grid: &LabelGrid) -> usize {
    grid.xs.len() + grid.ys.len()
}

fn paired(
    before: BTreeMap<String, usize>,
    mut after: BTreeMap<String, usize>,
) -> BTreeMap<String, (usize, usize)> {
    let pair = |(label, count): (String, usize)| {
        let after = after.remove(&label).unwrap_or(0);
        (label, (count, after))
    };
    before.into_iter().map(pair).collect()
}

#[cfg(test)]
mod tests;
