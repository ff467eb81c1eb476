//! Horizontal bands behind the elements of a facade: sky, roof, wall, shop.

use crate::LabelGrid;

/// Thinner bands are given to their neighbour, as a share of the height.
const THIN: f64 = 0.02;

/// The labels behind the elements with their lower and upper ends, from the bottom up.
pub(super) fn bands(grid: &LabelGrid, elements: &[Option<usize>]) -> Vec<(usize, [f64; 2])> {
    let mut bands: Vec<(usize, [f64; 2])> = Vec::new();
    for j in 0..grid.rows() {
        let mut lengths = vec![0.0; grid.labels.len()];
        for i in 0..grid.columns() {
            let label = usize::from(grid.at(i, j));
            if !elements.contains(&Some(label)) {
                lengths[label] += grid.xs[i + 1] - grid.xs[i];
            }
        }
        let largest =
            (0..lengths.len()).fold(0, |a, b| if lengths[b] > lengths[a] { b } else { a });
        let label = match (lengths[largest] > 0.0, bands.last()) {
            (true, _) => Some(largest),
            (false, Some(last)) => Some(last.0),
            (false, None) => None,
        };
        let ends = [grid.ys[j], grid.ys[j + 1]];
        match (label, bands.last_mut()) {
            (Some(label), Some(last)) if last.0 == label => last.1[1] = ends[1],
            (Some(label), Some(_)) => bands.push((label, ends)),
            // Rows without a background below the first one that has one belong to it.
            (Some(label), None) => bands.push((label, [0.0, ends[1]])),
            (None, _) => {}
        }
    }
    if bands.is_empty() {
        let wall = grid
            .labels
            .iter()
            .position(|l| l.eq_ignore_ascii_case("wall"))
            .unwrap_or(0);
        return vec![(wall, [0.0, grid.ys[grid.rows()]])];
    }
    // The thinnest band goes to the wider one of its neighbours, until none is thin.
    let thin = THIN * grid.ys[grid.rows()];
    while bands.len() > 1 {
        let size = |k: usize| bands[k].1[1] - bands[k].1[0];
        let least = (0..bands.len()).fold(0, |a, b| if size(b) < size(a) { b } else { a });
        if size(least) >= thin {
            break;
        }
        let below = least.checked_sub(1);
        let above = (least + 1 < bands.len()).then_some(least + 1);
        let heir = match (below, above) {
            (Some(a), Some(b)) => {
                if size(a) >= size(b) {
                    a
                } else {
                    b
                }
            }
            (Some(a), None) => a,
            (None, Some(b)) => b,
            (None, None) => break,
        };
        let gone = bands[least].1;
        bands[heir].1 = [bands[heir].1[0].min(gone[0]), bands[heir].1[1].max(gone[1])];
        bands.remove(least);
        let mut joined: Vec<(usize, [f64; 2])> = Vec::new();
        for band in bands {
            match joined.last_mut() {
                Some(last) if last.0 == band.0 => last.1[1] = band.1[1],
                _ => joined.push(band),
            }
        }
        bands = joined;
    }
    bands
}
