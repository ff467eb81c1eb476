//! The order of placements: along Hilbert's curve, so that those that follow each other stand near each other; and buildings of rules
//! with parameters along rows, so that each is told best by the one before it.

use rustc_hash::FxHashMap;

use super::Steps;
use super::rows::{Footprint, bits};
use edifice_grammar::instance::Placement;

/// Halvings of the square.
const LEVELS: u32 = 20;

/// Sorts placements along Hilbert's curve over their plan; those of one cell by all their numbers, then by symbols and
/// identifiers. Numbers are compared as they are written, in steps.
pub(super) fn along_curve(placed: &mut [Placement], steps: &Steps) {
    let whole = |v: f64, steps: i64| (v * steps as f64).round() as i64;
    let plan = |p: &Placement| [0, 1].map(|k| whole(p.at[k], steps.length));
    let low = |k: usize| placed.iter().map(|p| plan(p)[k]).min().unwrap_or(0);
    let (x, y) = (low(0), low(1));
    placed.sort_by_cached_key(|p| {
        let [u, v] = plan(p);
        let lengths = p.at.iter().chain(&p.size);
        let mut numbers: Vec<i64> = lengths.map(|&v| whole(v, steps.length)).collect();
        numbers.push(whole(p.turn, steps.turn));
        numbers.extend(p.numbers.iter().map(|&v| whole(v, steps.length)));
        let cell = hilbert(u.abs_diff(x), v.abs_diff(y));
        (cell, numbers, p.symbol.clone(), p.id.clone())
    });
}

/// Most buildings of a cell that are looked at as neighbours.
const MOST: usize = 64;

/// Sorts placements along the curve, then, where they state widths and depths, row by row: after each comes, of those near it that
/// are left, the one that is told in fewest bits ([`Footprint::told`]); where none is near, the next along the curve.
pub(super) fn along_rows(placed: &mut Vec<Placement>, steps: &Steps) {
    along_curve(placed, steps);
    let whole = |v: f64, steps: i64| (v * steps as f64).round() as i64;
    let full = steps.turn * 360;
    let print = |p: &Placement| Footprint {
        at: [0, 1].map(|k| whole(p.at[k], steps.length)),
        turn: whole(p.turn, steps.turn).rem_euclid(full),
        size: [0, 1].map(|k| p.numbers.get(k).map_or(0, |&v| whole(v, steps.length))),
    };
    let prints: Vec<Footprint> = placed.iter().map(print).collect();
    if prints.iter().all(|p| p.size == [0; 2]) {
        return;
    }
    let mut from: Vec<Option<Placement>> = std::mem::take(placed).into_iter().map(Some).collect();
    placed.extend(
        rows(&prints, full)
            .into_iter()
            .filter_map(|i| from[i].take()),
    );
}

/// The order of footprints row by row.
fn rows(prints: &[Footprint], full: i64) -> Vec<usize> {
    let far = |w: &[Footprint]| [0, 1].map(|k| w[0].at[k].abs_diff(w[1].at[k]));
    let mut steps: Vec<u64> = prints
        .windows(2)
        .map(|w| far(w).into_iter().fold(1, u64::max))
        .collect();
    steps.sort_unstable();
    let side = steps
        .get(steps.len() / 2)
        .map_or(1, |&s| s.saturating_mul(2)) as i64;
    let cell = |p: &Footprint| p.at.map(|v| v.div_euclid(side));
    let mut cells: FxHashMap<[i64; 2], Vec<usize>> = FxHashMap::default();
    for (i, p) in prints.iter().enumerate() {
        cells.entry(cell(p)).or_default().push(i);
    }
    let mut left = vec![true; prints.len()];
    let mut next = 0;
    let mut order = Vec::with_capacity(prints.len());
    let mut last: Option<usize> = None;
    while order.len() < prints.len() {
        let near = last.and_then(|l| {
            let [x, y] = cell(&prints[l]);
            let around = (-1..=1).flat_map(|i| (-1..=1).map(move |k| [x + i, y + k]));
            let found = around.filter_map(|c| cells.get(&c));
            let found = found.flat_map(|list| list.iter().take(MOST).copied());
            found.min_by_key(|&i| {
                let (place, rest) = prints[l].told(&prints[i], full);
                (bits(rest) + place / 4, i)
            })
        });
        let chosen = near.unwrap_or_else(|| {
            while !left[next] {
                next += 1;
            }
            next
        });
        left[chosen] = false;
        if let Some(list) = cells.get_mut(&cell(&prints[chosen])) {
            list.retain(|&i| i != chosen);
        }
        order.push(chosen);
        last = Some(chosen);
    }
    order
}

/// The distance along the curve of a cell of a square of 2^20 cells a side, in which larger coordinates wrap.
fn hilbert(x: u64, y: u64) -> u64 {
    let side = 1_u64 << LEVELS;
    let (mut x, mut y) = (x % side, y % side);
    let mut far = 0;
    let mut half = side / 2;
    while half > 0 {
        let (right, up) = (u64::from(x & half > 0), u64::from(y & half > 0));
        far += half * half * ((3 * right) ^ up);
        if up == 0 {
            if right == 1 {
                x = side - 1 - x;
                y = side - 1 - y;
            }
            std::mem::swap(&mut x, &mut y);
        }
        half /= 2;
    }
    far
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_goes_through_all_cells_of_a_square_by_single_steps() {
        for (x0, y0) in [(0, 0), (64, 128), ((1 << LEVELS) - 32, 32)] {
            let cells = (0..32).flat_map(|x| (0..32).map(move |y| (x0 + x, y0 + y)));
            let mut along: Vec<(u64, (u64, u64))> =
                cells.map(|(x, y)| (hilbert(x, y), (x, y))).collect();
            along.sort_unstable();
            for pair in along.windows(2) {
                let ((far, a), (next, b)) = (pair[0], pair[1]);
                assert_eq!(next, far + 1);
                assert_eq!(a.0.abs_diff(b.0) + a.1.abs_diff(b.1), 1, "{a:?} {b:?}");
            }
        }
    }
}
