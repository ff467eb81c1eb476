//! A label picture from boxes.

use super::boxes::Box4;
use crate::LabelGrid;

/// A grid of the boxes, later ones over earlier ones.
pub(super) fn paint(grid: &LabelGrid, painted: &[(usize, Box4)]) -> LabelGrid {
    let cuts = |side: fn(&Box4) -> [f64; 2], end: f64| {
        let mut cuts: Vec<f64> = painted
            .iter()
            .flat_map(|(_, b)| side(b))
            .chain([0.0, end])
            .collect();
        cuts.retain(|cut| (0.0..=end).contains(cut));
        cuts.sort_by(f64::total_cmp);
        cuts.dedup();
        cuts
    };
    let xs = cuts(|b| b.x, grid.xs[grid.columns()]);
    let ys = cuts(|b| b.y, grid.ys[grid.rows()]);
    let columns = xs.len() - 1;
    let mut cells = vec![0; columns * (ys.len() - 1)];
    for (label, b) in painted {
        let place = |cuts: &[f64], value: f64| cuts.partition_point(|&cut| cut < value);
        for j in place(&ys, b.y[0])..place(&ys, b.y[1]) {
            for i in place(&xs, b.x[0])..place(&xs, b.x[1]) {
                cells[j * columns + i] = *label as u16;
            }
        }
    }
    LabelGrid {
        xs,
        ys,
        cells,
        ..grid.clone()
    }
    .merged()
}
