//! Elements that stand beside each other along an axis, and how far apart.

use std::collections::BTreeMap;

use super::in_line::{Piece, is_wall};

/// New gaps are at least so many times as long as the least of their kind.
const CLOSEST: f64 = 0.95;

/// Label of the edges of a facade.
const EDGE: &str = "";

/// The elements before and after each cell of each row, and for two labels that follow each other with background between the
/// least length of that background.
pub(super) struct Contacts<'a> {
    before: Vec<Vec<(&'a str, f64)>>,
    after: Vec<Vec<(&'a str, f64)>>,
    least: BTreeMap<(&'a str, &'a str), f64>,
}

impl<'a> Contacts<'a> {
    /// Of pieces by columns of cuts and rows, on a facade of length `side`.
    pub(super) fn new(pieces: &[Piece<'a>], cells: &[Vec<usize>], side: f64) -> Self {
        let rows = cells.first().map_or(0, Vec::len);
        let mut out = Self {
            before: vec![Vec::with_capacity(cells.len()); rows],
            after: vec![Vec::with_capacity(cells.len()); rows],
            least: BTreeMap::new(),
        };
        for row in 0..rows {
            let elements = |column: usize| {
                let piece = &pieces[cells[column][row]];
                (!is_wall(piece.label)).then_some(piece)
            };
            let mut last = (EDGE, 0.0);
            for column in 0..cells.len() {
                out.before[row].push(last);
                if let Some(piece) = elements(column) {
                    last = (piece.label, piece.along.1);
                }
            }
            let mut next = (EDGE, side);
            for column in (0..cells.len()).rev() {
                out.after[row].push(next);
                match elements(column) {
                    Some(piece) => next = (piece.label, piece.along.0),
                    None => {
                        let (label, end) = out.before[row][column];
                        let least = out.least.entry((label, next.0)).or_insert(f64::INFINITY);
                        *least = least.min(next.1 - end);
                    }
                }
            }
            out.after[row].reverse();
        }
        out
    }

    /// True if, where the background that `first` (a column and a place in it) crosses is joined to that of `second`, two labels
    /// come beside each other that do so already, and no closer; also where the row has no element on either side.
    pub(super) fn known(&self, row: usize, first: (usize, f64), second: (usize, f64)) -> bool {
        let (before, end) = self.before[row][first.0];
        let (after, start) = self.after[row][second.0];
        if before == EDGE && after == EDGE {
            return true;
        }
        let gap = (first.1 - end) + (start - second.1);
        let least = self.least.get(&(before, after));
        least.is_some_and(|least| gap >= CLOSEST * least)
    }
}
