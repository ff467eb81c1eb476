//! Small connected areas take the label around them.

use crate::{LabelGrid, Span, components};

/// Gives every connected area smaller than `smallest` (in squares of the grid's unit) the label with which
/// it shares the longest border, the smaller areas first, until none is left or one label is all there is.
///
/// Complexity: linear in the cells per round; a round at least halves the areas that are too small.
pub fn absorb_specks(grid: &LabelGrid, smallest: f64) -> LabelGrid {
    let mut clean = grid.clone();
    let (columns, rows) = (grid.columns(), grid.rows());
    let whole = Span {
        left: 0,
        right: columns,
        bottom: 0,
        top: rows,
    };
    let mut of_cell = vec![0; clean.cells.len()];
    loop {
        let found = components(&clean, whole, &mut of_cell);
        let mut area = vec![0.0; found.len()];
        for (cell, &component) in of_cell.iter().enumerate() {
            let (i, j) = (cell % columns, cell / columns);
            area[component as usize] +=
                (grid.xs[i + 1] - grid.xs[i]) * (grid.ys[j + 1] - grid.ys[j]);
        }
        let heirs = heirs(&clean, &of_cell, &area, smallest);
        if heirs.iter().all(Option::is_none) {
            return clean;
        }
        for (cell, &component) in clean.cells.iter_mut().zip(&of_cell) {
            if let Some(heir) = heirs[component as usize] {
                *cell = found[heir as usize].label;
            }
        }
    }
}

/// For each area that is too small, the neighbouring area of the longest common border among those
/// that are larger (of equal ones, those that come first): neighbours thus never swap their labels.
fn heirs(grid: &LabelGrid, of_cell: &[u32], area: &[f64], smallest: f64) -> Vec<Option<u32>> {
    let (columns, rows) = (grid.columns(), grid.rows());
    let mut borders: Vec<Vec<(u32, f64)>> = vec![Vec::new(); area.len()];
    let mut meet = |a: u32, b: u32, length: f64| {
        for (own, other) in [(a, b), (b, a)] {
            let larger = (area[other as usize], own) > (area[own as usize], other);
            if a == b || area[own as usize] >= smallest || !larger {
                continue;
            }
            let known = &mut borders[own as usize];
            match known.iter_mut().find(|border| border.0 == other) {
                Some(border) => border.1 += length,
                None => known.push((other, length)),
            }
        }
    };
    for j in 0..rows {
        for i in 0..columns {
            let cell = j * columns + i;
            if i > 0 {
                meet(
                    of_cell[cell - 1],
                    of_cell[cell],
                    grid.ys[j + 1] - grid.ys[j],
                );
            }
            if j > 0 {
                meet(
                    of_cell[cell - columns],
                    of_cell[cell],
                    grid.xs[i + 1] - grid.xs[i],
                );
            }
        }
    }
    let longest = |known: &Vec<(u32, f64)>| {
        let first = known.first()?;
        let best = known[1..]
            .iter()
            .fold(first, |a, b| if b.1 > a.1 { b } else { a });
        Some(best.0)
    };
    borders.iter().map(longest).collect()
}
