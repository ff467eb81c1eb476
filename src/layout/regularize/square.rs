//! Areas that are rectangles but for small nicks become rectangles.

use edifice_shape::{LabelGrid, Span, components, is_background};

/// The result of squaring.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Nicks {
    /// Areas that became rectangles.
    pub count: usize,
    /// Depth of the deepest nick that was filled.
    pub deepest: f64,
}

/// Fills the nicks of every area that is not background: where its smallest rectangle shows
/// background not deeper than `tolerance` from a side. Areas with deeper nicks, or with other elements
/// in them, stay as they are.
pub(super) fn square(grid: &LabelGrid, tolerance: f64) -> (LabelGrid, Nicks) {
    let mut grid = grid.merged();
    let columns = grid.columns();
    let whole = Span {
        left: 0,
        right: columns,
        bottom: 0,
        top: grid.rows(),
    };
    let mut area_of = vec![0; grid.cells.len()];
    let areas = components(&grid, whole, &mut area_of);
    let background: Vec<bool> = grid.labels.iter().map(|l| is_background(l)).collect();
    let mut nicks = Nicks::default();
    for (number, area) in areas.iter().enumerate() {
        if area.is_rectangle() || background[usize::from(area.label)] {
            continue;
        }
        let b = area.bounds;
        let (left, right) = (grid.xs[b.left], grid.xs[b.right]);
        let (bottom, top) = (grid.ys[b.bottom], grid.ys[b.top]);
        let (mut deepest, mut missing) = (0.0f64, Vec::new());
        for j in b.bottom..b.top {
            for i in b.left..b.right {
                let cell = j * columns + i;
                if area_of[cell] as usize == number {
                    continue;
                }
                let free = background[usize::from(grid.cells[cell])];
                let depths = [
                    grid.xs[i + 1] - left,
                    right - grid.xs[i],
                    grid.ys[j + 1] - bottom,
                    top - grid.ys[j],
                ];
                let depth = depths.into_iter().fold(f64::INFINITY, f64::min);
                deepest = deepest.max(if free { depth } else { f64::INFINITY });
                missing.push(cell);
            }
        }
        // Filled nicks must not touch another area of the label.
        let touches = |&cell: &usize| {
            let (i, j) = (cell % columns, cell / columns);
            let other = |i: usize, j: usize| {
                let cell = j * columns + i;
                grid.cells[cell] == area.label && area_of[cell] as usize != number
            };
            i > 0 && other(i - 1, j)
                || j > 0 && other(i, j - 1)
                || i + 1 < columns && other(i + 1, j)
                || j + 1 < grid.rows() && other(i, j + 1)
        };
        if deepest <= tolerance && !missing.iter().any(touches) {
            for cell in missing {
                grid.cells[cell] = area.label;
            }
            nicks.count += 1;
            nicks.deepest = nicks.deepest.max(deepest);
        }
    }
    (grid.merged(), nicks)
}
