//! Floors and window columns read off a label picture, where no hand annotation comes with it.
//!
//! The rule, on a picture with the classes `window`, `door` and `shop` (its *openings*):
//! - a *floor* is a maximal band of pixel rows that are opening over at least a fifth of the
//!   width, so that a stair window between two floors, or a tower beside them, makes no floor of its
//!   own; ground floor and a floor in the roof count;
//! - *window columns*: along each row of a floor without shops the connected openings are counted;
//!   the floor has the count that most of its height shows, and the facade the count that most of
//!   the height of such floors has, the larger one of equals.
//!
//! Doors and running balconies then come from the labels as for the real sets
//! ([`Architecture::new`]), the upper edges of the floors taking the place of annotated floor lines.

use std::collections::BTreeMap;

use super::gold::{Architecture, runs};
use edifice_shape::LabelGrid;

/// Labels of openings.
const OPENINGS: [&str; 3] = ["window", "door", "shop"];

/// Share of the width that openings must cover for a row to belong to a floor.
const COVERED: f64 = 0.2;

/// The architecture of a label picture, from its labels alone.
pub fn architecture(grid: &LabelGrid) -> Architecture {
    let (width, height) = (grid.xs[grid.columns()], grid.ys[grid.rows()]);
    let label = |i: usize, j: usize| grid.labels[usize::from(grid.at(i, j))].as_str();
    let openings = |j: usize| -> Vec<(f64, f64)> {
        let runs = runs(grid.columns(), |i| OPENINGS.contains(&label(i, j)));
        let sides = runs.into_iter();
        sides
            .map(|(from, to)| (grid.xs[from] / width, grid.xs[to] / width))
            .collect()
    };
    let rows: Vec<Vec<(f64, f64)>> = (0..grid.rows()).map(openings).collect();
    let covered = |j: usize| {
        rows[j]
            .iter()
            .map(|(left, right)| right - left)
            .sum::<f64>()
    };
    let tall = |j: usize| grid.ys[j + 1] - grid.ys[j];
    let floors = runs(grid.rows(), |j| covered(j) >= COVERED);
    let has_shop = |j: usize| (0..grid.columns()).any(|i| label(i, j) == "shop");
    let counts = floors.iter().filter_map(|&(from, to)| {
        let rows_of = from..to;
        let count = most_common(rows_of.clone().map(|j| (rows[j].len(), tall(j))));
        let shops = rows_of.clone().any(has_shop);
        (!shops).then(|| (count, rows_of.map(tall).sum()))
    });
    let columns = most_common(counts);
    // Where the columns stand is read off the lowest row that shows them all.
    let row = rows.iter().find(|row| row.len() == columns);
    let lines: Vec<f64> = floors
        .iter()
        .map(|&(_, to)| 1.0 - grid.ys[to] / height)
        .collect();
    Architecture::new(grid, &lines, row.map_or(&[], Vec::as_slice))
}

/// The value of most weight, the larger one of equals; 0 of none.
fn most_common(values: impl Iterator<Item = (usize, f64)>) -> usize {
    let mut weights = BTreeMap::new();
    for (value, weight) in values {
        *weights.entry(value).or_insert(0.0) += weight;
    }
    let heaviest = weights
        .into_iter()
        .max_by(|a, b| f64::total_cmp(&a.1, &b.1));
    heaviest.map_or(0, |(value, _)| value)
}
