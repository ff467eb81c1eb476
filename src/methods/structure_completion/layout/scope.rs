//! The scope of the benchmark: facades with a lattice of windows.

use super::lines::lines;
use super::{Class, Layout};
use edifice_shape::{Axis, Rect};

/// True if a layout has at least 8 windows, occupies at least half of the cells of its lattice, and at
/// least 70 % of its windows have another one in their row and in their column.
pub fn in_scope(layout: &Layout) -> bool {
    let windows: Vec<Rect> = layout.of(Class::Window).map(|e| e.rect).collect();
    if windows.len() < 8 {
        return false;
    }
    let (columns, column) = lines(&windows, Axis::X);
    let (rows, row) = lines(&windows, Axis::Y);
    let occupancy = windows.len() as f64 / (columns.len() * rows.len()) as f64;
    let partnered = (0..windows.len())
        .filter(|&i| columns[column[i]].count > 1 && rows[row[i]].count > 1)
        .count();
    occupancy >= 0.5 && partnered as f64 >= 0.7 * windows.len() as f64
}
