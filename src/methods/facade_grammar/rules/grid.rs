//! Grid splits: a region cut along both axes at once (Sec. 4.7).
//!
//! With the rows given, the best columns are a shortest path over the cut positions along x, where a
//! strip costs what its cells cost, and the other way round. [`cheapest`] alternates the two, from the
//! finest grid, and from every grid of two rows or two columns, until nothing changes. Grids of one row or one column
//! are single shortest paths.

use super::candidate::{Arrangement, RuleCandidate};
use super::trace::trace;
use crate::regions::{Cells, TypeId};
use edifice_grammar::Costs;

/// The rule that cuts at `columns` and `rows`, indices into the cuts along x and y, ends included;
/// its successors stand row by row, bottom to top.
pub(crate) fn between(cells: &Cells, columns: Vec<u16>, rows: Vec<u16>) -> RuleCandidate {
    let successors = rows
        .windows(2)
        .flat_map(|row| columns.windows(2).map(move |column| (column, row)))
        .map(|(x, y)| cells.cell((x[0], x[1]), (y[0], y[1])))
        .collect();
    RuleCandidate {
        arrangement: Arrangement::Grid,
        lines: columns,
        rows,
        successors,
    }
}

/// The cheapest grid found, if it costs less than `bound`. A local optimum: no other columns are
/// cheaper with its rows, nor other rows with its columns.
pub(crate) fn cheapest(
    cells: &Cells,
    costs: &Costs,
    bound: f64,
    price: &impl Fn(TypeId) -> f64,
) -> Option<(f64, RuleCandidate)> {
    let (across, up) = cells.intervals();
    let cell = |x, y| costs.successor + price(cells.cell(x, y));
    let best_columns = |rows: &[u16]| {
        shortest(across, |a, b| {
            rows.windows(2).map(|y| cell((a, b), (y[0], y[1]))).sum()
        })
    };
    let best_rows = |columns: &[u16]| {
        shortest(up, |a, b| {
            columns.windows(2).map(|x| cell((x[0], x[1]), (a, b))).sum()
        })
    };
    let starts = std::iter::once((0..=up).collect())
        .chain((1..up).map(|line| vec![0, line, up]))
        .map(|rows: Vec<u16>| best_columns(&rows))
        .chain((1..across).map(|line| Some((f64::INFINITY, vec![0, line, across]))))
        .flatten();
    // Noise of additions must not decide between rules of equal cost.
    let mut limit = bound - costs.grid_split - 1e-9;
    let mut found = None;
    for (_, mut columns) in starts {
        let mut cost = f64::INFINITY;
        while let Some((sum, rows)) = best_rows(&columns)
            && sum < cost - 1e-9
        {
            cost = sum;
            if cost < limit {
                limit = cost - 1e-9;
                found = Some((cost + costs.grid_split, columns.clone(), rows.clone()));
            }
            match best_columns(&rows) {
                Some((sum, better)) if sum < cost - 1e-9 => columns = better,
                _ => break,
            }
        }
    }
    // One row or one column, which costs less than a split where the operation does.
    let row = shortest(across, |a, b| cell((a, b), (0, up)));
    let column = shortest(up, |a, b| cell((0, across), (a, b)));
    let row = row.map(|(cost, columns)| (cost, columns, vec![0, up]));
    let column = column.map(|(cost, rows)| (cost, vec![0, across], rows));
    for (cost, columns, rows) in [row, column].into_iter().flatten() {
        if cost < limit {
            limit = cost - 1e-9;
            found = Some((cost + costs.grid_split, columns, rows));
        }
    }
    found.map(|(cost, columns, rows)| (cost, between(cells, columns, rows)))
}

/// The cheapest lines from 0 to `end` with at least one between; `None` when every path has an infinite cost.
fn shortest(end: u16, cost: impl Fn(u16, u16) -> f64) -> Option<(f64, Vec<u16>)> {
    let mut distance = vec![f64::INFINITY; usize::from(end) + 1];
    let mut previous = vec![0; usize::from(end) + 1];
    distance[0] = 0.0;
    for b in 1..=end {
        // The whole length is no strip of a grid.
        for a in u16::from(b == end)..b {
            let sum = distance[usize::from(a)] + cost(a, b);
            if sum < distance[usize::from(b)] {
                distance[usize::from(b)] = sum;
                previous[usize::from(b)] = a;
            }
        }
    }
    let total = distance[usize::from(end)];
    total
        .is_finite()
        .then(|| (total, trace(&previous, end.into())))
}
