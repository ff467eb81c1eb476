//! Votes of like rows and like columns for a cell.
//!
//! With `M(r, c)` 1 where a window is seen, the weight of a row `q` for a row `r` is their containment times their Jaccard
//! index, `|r & q| / |r| * |r & q| / |r | q|`; the vote of the rows for a cell is the weighted mean of `M(q, c)` over the
//! other rows. The same holds for columns. (A vote of rows and columns completes lattices that lose cells at random
//! better than the closure of their rows and columns.)

use super::observation::{Observation, of};
use crate::layout::Class;
use crate::layout::lines::LatticeLine;

/// A cell is on a line when it is nearer than this share of the typical extent.
const ON_LINE: f64 = 0.35;

/// Votes of all cells of the seen lattice.
#[derive(Debug, Clone)]
pub(super) struct Votes {
    columns: Vec<f64>,
    rows: Vec<f64>,
    reach: [f64; 2],
    /// Votes of the rows and of the columns, row by row.
    votes: Vec<[f64; 2]>,
}

/// The line nearest to a position, within reach.
fn nearest(lines: &[f64], at: f64, reach: f64) -> Option<usize> {
    let distance = |k: &usize| (lines[*k] - at).abs();
    let near = (0..lines.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
    near.filter(|k| distance(k) < reach)
}

/// The weighted mean of what the other lines have, for each line and place along it.
fn voted(lines: &[Vec<bool>]) -> Vec<Vec<f64>> {
    let count = |line: &[bool]| line.iter().filter(|x| **x).count() as f64;
    let vote = |own: usize| -> Vec<f64> {
        let mut sums = vec![0.0; lines[own].len()];
        let mut total = 0.0;
        for (_, other) in lines.iter().enumerate().filter(|(k, _)| *k != own) {
            let pairs = lines[own].iter().zip(other);
            let both = pairs.filter(|(a, b)| **a && **b).count() as f64;
            let either = count(&lines[own]) + count(other) - both;
            let weight = both * both / (count(&lines[own]) * either).max(1.0);
            total += weight;
            for (sum, has) in sums.iter_mut().zip(other) {
                *sum += weight * f64::from(u8::from(*has));
            }
        }
        sums.iter()
            .map(|s| if total > 0.0 { s / total } else { 0.0 })
            .collect()
    };
    (0..lines.len()).map(vote).collect()
}

impl Votes {
    /// The votes of an observation; O(rows² columns + columns² rows).
    pub(super) fn new(observation: &Observation) -> Self {
        let at = |lines: &[LatticeLine]| lines.iter().map(|l| l.at).collect::<Vec<f64>>();
        let (columns, rows) = (at(&observation.columns), at(&observation.rows));
        let reach = [ON_LINE * observation.size.0, ON_LINE * observation.size.1];
        let mut seen = vec![vec![false; columns.len()]; rows.len()];
        for window in of(&observation.elements, Class::Window) {
            let (x, y) = window.rect.centre();
            let cell = (nearest(&rows, y, reach[1]), nearest(&columns, x, reach[0]));
            if let (Some(r), Some(c)) = cell {
                seen[r][c] = true;
            }
        }
        let column = |c: usize| seen.iter().map(|row| row[c]).collect();
        let turned: Vec<Vec<bool>> = (0..columns.len()).map(column).collect();
        let (of_rows, of_columns) = (voted(&seen), voted(&turned));
        let cells = (0..rows.len()).flat_map(|r| (0..columns.len()).map(move |c| (r, c)));
        let votes = cells
            .map(|(r, c)| [of_rows[r][c], of_columns[c][r]])
            .collect();
        Self {
            columns,
            rows,
            reach,
            votes,
        }
    }

    /// Votes of the rows and of the columns for the cell at a place; -1 off the seen lattice.
    pub(super) fn at(&self, x: f64, y: f64) -> [f64; 2] {
        let row = nearest(&self.rows, y, self.reach[1]);
        let column = nearest(&self.columns, x, self.reach[0]);
        match (row, column) {
            (Some(r), Some(c)) => self.votes[r * self.columns.len() + c],
            _ => [-1.0; 2],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn votes_by_hand() {
        let rows = [
            vec![true, true, false],
            vec![true, true, true],
            vec![false, false, true],
        ];
        let votes = voted(&rows);
        // Only the second row is like the first one.
        assert_eq!(votes[0], [1.0, 1.0, 1.0]);
        // Of the second row: the first with 2/3 * 2/3, the third with 1/3 * 1/3.
        let expected = (4.0 / 9.0) / (4.0 / 9.0 + 1.0 / 9.0);
        assert!((votes[1][0] - expected).abs() < 1e-12);
    }
}
