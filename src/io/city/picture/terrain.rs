//! The ground of a city: as high as its buildings stand.
//!
//! The plan is cut into square cells. A cell in which buildings stand is as high as the lowest of their bases; others are filled from
//! coarser grids, of half as many cells a side each, whose cells are means of what is known (push and pull).

/// Cells along the longer side.
const CELLS: usize = 128;

/// Heights on a grid of corners: `columns` x `rows`, row after row from low y.
pub(super) struct Terrain {
    /// Lower left corner.
    pub(super) corner: [f64; 2],
    /// Side of a cell.
    pub(super) side: f64,
    /// Corners along x and y.
    pub(super) size: [usize; 2],
    /// Heights.
    pub(super) heights: Vec<f64>,
}

impl Terrain {
    /// The ground under bases: middles in the plan, and heights. `low` and `high`: what it covers.
    pub(super) fn under(bases: &[([f64; 2], f64)], low: [f64; 2], high: [f64; 2]) -> Self {
        let extent = (high[0] - low[0]).max(high[1] - low[1]).max(1.0);
        let side = extent / CELLS as f64;
        let size = [0, 1].map(|k| ((high[k] - low[k]) / side).ceil() as usize + 1);
        let mut known: Vec<Option<f64>> = vec![None; size[0] * size[1]];
        for (at, z) in bases {
            let [i, j] = [0, 1].map(|k| {
                let cell = ((at[k] - low[k]) / side).round().max(0.0) as usize;
                cell.min(size[k] - 1)
            });
            let cell = &mut known[j * size[0] + i];
            *cell = Some(cell.map_or(*z, |v: f64| v.min(*z)));
        }
        Self {
            corner: low,
            side,
            size,
            heights: filled(&known, size),
        }
    }
}

/// All heights of a grid of which some are known; 0 where none is.
fn filled(known: &[Option<f64>], size: [usize; 2]) -> Vec<f64> {
    if known.iter().all(Option::is_some) || size == [1, 1] {
        return known.iter().map(|v| v.unwrap_or(0.0)).collect();
    }
    let half = size.map(|n| n.div_ceil(2));
    let mut sums = vec![(0.0, 0.0); half[0] * half[1]];
    for (at, v) in known.iter().enumerate() {
        if let Some(v) = v {
            let cell = at / size[0] / 2 * half[0] + at % size[0] / 2;
            sums[cell].0 += v;
            sums[cell].1 += 1.0;
        }
    }
    let means: Vec<Option<f64>> = (sums.iter())
        .map(|(sum, n)| (*n > 0.0).then(|| sum / n))
        .collect();
    let coarse = filled(&means, half);
    let own = known.iter().enumerate().map(|(at, v)| {
        v.unwrap_or_else(|| {
            let corner = |n: usize, last: usize| {
                let x = (n as f64 - 0.5) / 2.0;
                let low = x.floor().clamp(0.0, last as f64);
                (low as usize, (low as usize + 1).min(last), (x - low).clamp(0.0, 1.0))
            };
            let (i, k, u) = corner(at % size[0], half[0] - 1);
            let (j, l, v) = corner(at / size[0], half[1] - 1);
            let height = |i: usize, j: usize| coarse[j * half[0] + i];
            let low = height(i, j) * (1.0 - u) + height(k, j) * u;
            let high = height(i, l) * (1.0 - u) + height(k, l) * u;
            low * (1.0 - v) + high * v
        })
    });
    own.collect()
}
