//! Regularization of layouts by quadratic programming (Wu et al. 2014, Sec. 3.3).
//!
//! Annotations are off by pixels, but a grammar can only share what is *equal*. Regularization moves
//! edges so that nearly equal elements get equal sizes and nearly aligned edges get aligned. It is a projection:
//!
//! - What is equal stays equal. Areas of one label with equal widths and heights have one variable along each
//!   axis, so that equal blocks stay equal; edges on one line stay on one line.
//! - Applied twice it changes nothing more, to the bit, whatever the tolerance; `projection` proves it. Layouts that are
//!   regular but for a tenth are left alone.
//! - No label, no element and no region of a tiling is lost, and there are no more sizes in all than before.
//! - Tolerance 0 is the identity. No edge moves further than the tolerance; the total size stays.
//! - It does not depend on the unit: coordinates are counted in steps of the coarsest lattice that
//!   they all lie on, and move by whole steps of it. Where there is none, they are real numbers.
//!   Coordinates that differ by 1e-7 of the longer side are equal.
//!
//! # One step
//! Along x and along y, which nothing connects, positions solve the quadratic program
//!
//! ```text
//! minimise    sum_k w_k (v_k - x_k)^2             x_k: cut coordinates, w_k: length of edge on them
//! subject to  |v_k - x_k| <= reach                no edge moves further
//!             v_0 = 0, v_n = W                    the total size is kept
//!             v_(k+1) - v_k >= gap_k > 0          lines that do not merge keep their order
//!             v_i = v_j                           nearly aligned edges, one line each
//!             v_r - v_l = s_c                     equal and nearly equal sizes, one size each
//! ```
//! Which equalities hold is chosen first, by clustering. *Leaders* are the lines (and then the sizes of one label)
//! with most edge within reach of them; the others within reach follow, as long as the program stays
//! feasible: lines within the reach, sizes, which have two ends, within twice of it. Nothing is lost between lines that
//! merge but slivers no wider than the reach: of wall, and of elements that are no rectangles, beside the
//! largest part of them that is one. In whole units, sizes are whole numbers, and what remains with sizes
//! fixed are constraints on differences with whole right-hand sides, for which rounding a solution keeps
//! every one of them. So equal sizes are equal exactly.
//!
//! # Deviations and readings
//! - The paper only says that quadratic programming is used. The choice of equalities is ours.
//! - Whether an equality is feasible is told by a repair of the sizes (`differences`), which may miss a
//!   solution: then two sizes stay apart that could have been one.
//! - Areas of a label picture that are rectangles but for nicks not deeper than the reach become
//!   rectangles first.
//! - The weights w_k are ours: one misdrawn window should move to the others, not they to it.

mod areas;
mod axis;
mod classes;
mod counts;
mod differences;
mod equal;
mod error;
mod groups;
mod lattice;
mod layouts;
mod meeting;
mod projection;
mod resized;
mod square;
mod strips;

use std::collections::BTreeMap;

use edifice_shape::{Facade, LabelGrid};

use areas::Areas;
pub use error::RegularizeError;
use layouts::{Picture, Tiling};
use projection::project;

/// The changes that regularization made.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Report {
    /// Longest way that any edge moved, in the unit of the layout.
    pub largest_move: f64,
    /// Areas with nicks that became rectangles.
    pub squared: usize,
    /// Cut lines before and after, both axes together.
    pub lines: (usize, usize),
    /// Distinct sizes (width and height) of the areas of each label, before and after; of the background,
    /// those of its pieces in the tiling.
    pub sizes: BTreeMap<String, (usize, usize)>,
}

/// Regularizes a label picture. `tolerance` is the longest way that an edge may move, in the unit of
/// the grid.
///
/// # Errors
/// [`RegularizeError`] for a grid that is not [valid](LabelGrid::check) or a tolerance that is negative
/// or not a number.
pub fn regularize_grid(
    grid: &LabelGrid,
    tolerance: f64,
) -> Result<(LabelGrid, Report), RegularizeError> {
    check_tolerance(tolerance)?;
    grid.check()?;
    let picture = Picture::new(grid)?;
    let before = &picture.sizes;
    let Some(made) = project(&picture, tolerance)? else {
        let lines = layouts::lines(&picture.grid);
        return Ok((grid.clone(), Report::unchanged(lines, before)));
    };
    let report = Report {
        largest_move: made.largest_move,
        squared: made.squared,
        lines: (
            layouts::lines(&picture.grid),
            layouts::lines(&made.layout.grid),
        ),
        sizes: paired(before, &made.layout.sizes),
    };
    Ok((made.layout.grid, report))
}

/// Regularizes a tiling: every region keeps its place in the list and its neighbours, walls included, so
/// that slivers of wall stay.
///
/// # Errors
/// [`RegularizeError`] for a layout that is not a tiling or a tolerance that is negative or not a number.
pub fn regularize_facade(
    facade: &Facade,
    tolerance: f64,
) -> Result<(Facade, Report), RegularizeError> {
    check_tolerance(tolerance)?;
    let tiling = Tiling::new(facade.clone())?;
    let Some(made) = project(&tiling, tolerance)? else {
        let lines = layouts::lines(&tiling.grid);
        return Ok((facade.clone(), Report::unchanged(lines, &tiling.sizes)));
    };
    let report = Report {
        largest_move: made.largest_move,
        squared: 0,
        lines: (
            layouts::lines(&tiling.grid),
            layouts::lines(&made.layout.grid),
        ),
        sizes: paired(&tiling.sizes, &made.layout.sizes),
    };
    Ok((made.layout.facade, report))
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
    check_positive(reach)?;
    check_positive(tolerance)?;
    if kinds.len() != facade.regions.len() {
        return Err(RegularizeError::Kinds {
            found: kinds.len(),
            expected: facade.regions.len(),
        });
    }
    let tiling = Tiling::new(facade.clone())?;
    let areas = Areas::of_facade(facade, &tiling.layout, &tiling.grid);
    let (xs, ys) = areas.with_kinds(kinds).align(reach, tolerance)?;
    let aligned = Tiling::new(tiling.moved(&xs, &ys)?)?;
    let report = Report {
        largest_move: layouts::largest(&tiling.grid, &xs, &ys),
        squared: 0,
        lines: (layouts::lines(&tiling.grid), layouts::lines(&aligned.grid)),
        sizes: paired(&tiling.sizes, &aligned.sizes),
    };
    Ok((aligned.facade, report))
}

impl Report {
    fn unchanged(lines: usize, sizes: &BTreeMap<String, usize>) -> Self {
        Self {
            largest_move: 0.0,
            squared: 0,
            lines: (lines, lines),
            sizes: paired(sizes, sizes),
        }
    }
}

fn check_tolerance(tolerance: f64) -> Result<(), RegularizeError> {
    if tolerance.is_finite() && tolerance >= 0.0 {
        Ok(())
    } else {
        Err(RegularizeError::Tolerance(tolerance))
    }
}

fn check_positive(tolerance: f64) -> Result<(), RegularizeError> {
    if tolerance > 0.0 {
        check_tolerance(tolerance)
    } else {
        Err(RegularizeError::NotPositive(tolerance))
    }
}

fn paired(
    before: &BTreeMap<String, usize>,
    after: &BTreeMap<String, usize>,
) -> BTreeMap<String, (usize, usize)> {
    let pair = |(label, &count): (&String, &usize)| {
        let after = after.get(label).copied().unwrap_or(0);
        (label.clone(), (count, after))
    };
    before.iter().map(pair).collect()
}

#[cfg(test)]
mod tests;
