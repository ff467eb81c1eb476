//! The columns that a wide element spans: a shop or a balcony before several windows is made of them, a door is not.

use super::apply::Band;
use super::in_line::{Piece, is_wall};

/// For each row of a facade the elements that stand in it, from start to end along the axis; those without background between them
/// are one (panes of one window).
pub(super) struct Runs {
    rows: Vec<Vec<(f64, f64)>>,
    noise: f64,
}

impl Runs {
    /// The runs of a facade with these pieces in these cells, by column and row; lengths that differ by at most `noise` are equal.
    pub(super) fn new(pieces: &[Piece], cells: &[Vec<usize>], noise: f64) -> Self {
        let row = |row: usize| {
            let mut runs: Vec<(f64, f64)> = Vec::new();
            for column in cells {
                let piece = &pieces[column[row]];
                let (start, end) = piece.along;
                match runs.last_mut() {
                    _ if is_wall(piece.label) => {}
                    Some(last) if start <= last.1 + noise => last.1 = last.1.max(end),
                    _ => runs.push((start, end)),
                }
            }
            runs
        };
        let count = cells.first().map_or(0, Vec::len);
        Self {
            rows: (0..count).map(row).collect(),
            noise,
        }
    }

    /// True if in some row at least two runs lie within a piece, not all of which start in these bands: what is left of
    /// the piece when they are taken away still spans one.
    pub(super) fn remain(&self, piece: &Piece, bands: &[Band]) -> bool {
        let (start, end) = (piece.along.0 - self.noise, piece.along.1 + self.noise);
        let in_band = |at: f64| bands.iter().any(|&(a, b)| (a..b).contains(&at));
        self.rows.iter().any(|runs| {
            let first = runs.partition_point(|run| run.0 < start);
            let within = runs[first..].iter().take_while(|run| run.1 <= end);
            let (mut count, mut left) = (0, 0);
            for run in within {
                count += 1;
                left += usize::from(!in_band(run.0));
            }
            count >= 2 && left >= 1
        })
    }
}
