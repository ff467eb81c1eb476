//! Cleaning of label images: what a segmentation gives, made rectangular again.
//!
//! Segmented facades differ from exact ones by specks and by edges that waver by a few pixels. Given a
//! `tolerance` `t`, the largest displacement of an edge that is noise,
//! 1. [`absorb_specks`] gives connected areas smaller than `(2t)^2` the label that surrounds them;
//! 2. [`straighten`] chooses few horizontal and few vertical lines, and labels each cell between them by
//!    the majority inside it.
//!
//! Both axes are segmented independently. For horizontal lines `0 = y_0 < ... < y_n = H`, let `m(a, b)` be
//! the area of the strip between `a` and `b` that differs from the most frequent label of its column of
//! pixels. The lines minimize
//! ```text
//! sum_k m(y_k + t, y_{k+1} - t) + w m(y_k, y_{k+1}) + c n
//! ```
//! by dynamic programming over candidate lines. The first term forgives what lies within `t` of a
//! line (the borders of the image are exact), so that no line pays for the noise of an edge; the second,
//! with a small weight `w`, puts a line at the median of the edges that belong to it; `c = (6t)^2` is the
//! area that a line has to explain. A strip is wider than `2t`, since it has to have an inside.

mod lattice;
mod lines;
mod specks;

use super::{Axis, LabelGrid};

pub use lattice::{DoorPlace, Lattice, on_lattice};
pub use specks::absorb_specks;

/// The label image without specks and with straight edges; a `tolerance` of 0 changes nothing.
///
/// `tolerance` is the largest displacement of an edge that is noise, in the unit of the grid. The result
/// has the same extent; its labels are sorted, unused ones dropped.
///
/// Complexity: that of [`absorb_specks`] and [`straighten`].
///
/// # Errors
/// [`ToleranceError`] for a tolerance that is negative or not finite.
///
/// # Examples
/// ```
/// use edifice_shape::{LabelGrid, clean};
/// let cuts: Vec<f64> = (0..=20).map(f64::from).collect();
/// let mut cells = vec![0; 400];
/// cells[210] = 1; // one pixel of another label
/// let labels = vec!["wall".to_string(), "door".to_string()];
/// let grid = LabelGrid { name: "g".into(), unit: "px".into(), xs: cuts.clone(), ys: cuts, labels, cells };
/// assert_eq!(clean(&grid, 1.0)?.labels, ["wall"]);
/// # Ok::<(), edifice_shape::ToleranceError>(())
/// ```
pub fn clean(grid: &LabelGrid, tolerance: f64) -> Result<LabelGrid, ToleranceError> {
    if !(tolerance.is_finite() && tolerance >= 0.0) {
        return Err(ToleranceError { value: tolerance });
    }
    if tolerance == 0.0 {
        return Ok(grid.clone());
    }
    let smallest = (2.0 * tolerance).powi(2);
    Ok(straighten(&absorb_specks(grid, smallest), tolerance))
}

/// A tolerance that is no length.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("the tolerance of cleaning is {value}, expected a number from 0")]
pub struct ToleranceError {
    /// The value found.
    pub value: f64,
}

/// The label image on few straight lines, edges moved by about `tolerance` at most (see the module's
/// first page).
///
/// Complexity: `O(k^2 w l)` per axis for `k <= 120` candidate lines, `w` merged cells across and `l`
/// labels.
pub fn straighten(grid: &LabelGrid, tolerance: f64) -> LabelGrid {
    let fine = grid.merged();
    let [xs, ys] = Axis::BOTH.map(|axis| lines::choose(&fine, axis, tolerance));
    let cells = majority(&fine, &xs, &ys, tolerance);
    LabelGrid {
        xs,
        ys,
        cells,
        ..fine
    }
    .merged()
}

/// The label of most area inside each cell between the lines, `tolerance` away from them where the
/// cell has such an inside.
fn majority(fine: &LabelGrid, xs: &[f64], ys: &[f64], tolerance: f64) -> Vec<u16> {
    let columns = overlaps(&fine.xs, xs, tolerance);
    let rows = overlaps(&fine.ys, ys, tolerance);
    let mut cells = Vec::with_capacity(columns.len() * rows.len());
    let mut area = vec![0.0; fine.labels.len()];
    for row in &rows {
        for column in &columns {
            area.fill(0.0);
            for &(j, height) in row {
                for &(i, width) in column {
                    area[usize::from(fine.at(i, j))] += width * height;
                }
            }
            let largest = (1..area.len()).fold(0, |a, b| if area[b] > area[a] { b } else { a });
            cells.push(largest as u16);
        }
    }
    cells
}

/// For each strip between neighbouring `lines`, the fine cells that its inside meets and how far.
fn overlaps(cuts: &[f64], lines: &[f64], tolerance: f64) -> Vec<Vec<(usize, f64)>> {
    let last = lines.len() - 2;
    let inside = |k: usize| {
        let from = lines[k] + if k == 0 { 0.0 } else { tolerance };
        let to = lines[k + 1] - if k == last { 0.0 } else { tolerance };
        if from < to {
            (from, to)
        } else {
            (lines[k], lines[k + 1])
        }
    };
    let strips = (0..=last).map(inside);
    strips
        .map(|(from, to)| {
            let first = cuts.partition_point(|&cut| cut <= from).saturating_sub(1);
            (first..cuts.len() - 1)
                .take_while(|&i| cuts[i] < to)
                .map(|i| (i, cuts[i + 1].min(to) - cuts[i].max(from)))
                .filter(|overlap| overlap.1 > 0.0)
                .collect()
        })
        .collect()
}

#[cfg(test)]
mod tests;
