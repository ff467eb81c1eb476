//! Global features of a facade (Sec. 4.3): coverage, symmetry, door position.

use std::sync::Arc;

use super::grid::Grid;
use crate::layout::Class;

/// Area of the union of the grids' bounding boxes over the area of the facade.
pub(super) fn coverage(grids: &[Arc<Grid>], facade: [f64; 2]) -> f64 {
    let mut xs: Vec<f64> = grids.iter().flat_map(|g| [g.low[0], g.high[0]]).collect();
    xs.sort_unstable_by(f64::total_cmp);
    let mut by_y: Vec<&Grid> = grids.iter().map(Arc::as_ref).collect();
    by_y.sort_by(|a, b| a.low[1].total_cmp(&b.low[1]));
    let mut area = 0.0;
    for strip in xs.windows(2).filter(|s| s[1] > s[0]) {
        let (mut length, mut reached) = (0.0, f64::NEG_INFINITY);
        for g in &by_y {
            if g.low[0] <= strip[0] && g.high[0] >= strip[1] {
                length += (g.high[1] - g.low[1].max(reached)).max(0.0);
                reached = reached.max(g.high[1]);
            }
        }
        area += length * (strip[1] - strip[0]);
    }
    area / (facade[0] * facade[1])
}

/// Share of the elements' area that has a mirror image, and the mean position of the doors from left (0)
/// to right (1), none without a door (Eq. 11).
pub(super) fn symmetry(grids: &[Arc<Grid>], facade: [f64; 2]) -> (f64, Option<f64>) {
    let area: f64 = grids.iter().map(|g| g.area).sum();
    let symmetric: f64 = grids.iter().map(|g| g.symmetric).sum();
    let doors = grids.iter().filter(|g| g.class == Class::Door);
    let (mut sum, mut count) = (0.0, 0.0);
    for grid in doors {
        let n = grid.members.len() as f64;
        sum += n * grid.lines[0].iter().sum::<f64>() / grid.lines[0].len() as f64;
        count += n;
    }
    let position = (count > 0.0).then(|| sum / count / facade[0]);
    (symmetric / area, position)
}
