//! Operations that CGA has no word for, written out below one of our comments.

use chumsky::span::SimpleSpan;

use super::super::error::Fault;
use super::super::syntax::{Entry, Part, Target};
use super::Builder;
use edifice_grammar::{Operation, Size};
use edifice_shape::Axis;

impl Builder<'_> {
    /// A mirrored split, written out.
    pub(super) fn sym_split(
        &mut self,
        axis: Axis,
        entries: &[Entry<'_>],
        symbol: &str,
        at: SimpleSpan,
    ) -> Result<Operation, Fault> {
        let asymmetric = || {
            Fault::new(
                at,
                "the split below is not the same from both ends; correct it or remove the comment",
            )
        };
        let parts = plain(entries).ok_or_else(asymmetric)?;
        let mut all = self.successors(parts, symbol)?;
        let mirrored = all.iter().eq(all.iter().rev());
        if !mirrored {
            return Err(asymmetric());
        }
        let center = all.len() % 2 == 1;
        all.truncate(all.len().div_ceil(2));
        Ok(Operation::SymSplit {
            axis,
            successors: all,
            center,
        })
    }

    /// A grid, written out.
    pub(super) fn grid_split(
        &mut self,
        entries: &[Entry<'_>],
        at: SimpleSpan,
    ) -> Result<Operation, Fault> {
        let no_grid = || {
            Fault::new(
                at,
                "the splits below are not one grid of symbols; correct them or remove the comment",
            )
        };
        let mut columns: Option<Vec<Size>> = None;
        let (mut rows, mut cells) = (Vec::new(), Vec::new());
        for part in plain(entries).ok_or_else(no_grid)? {
            rows.push(self.size(part)?);
            let Target::Split(Axis::X, inner) = &part.target.0 else {
                return Err(no_grid());
            };
            let inner = plain(inner).ok_or_else(no_grid)?;
            let mut row = Vec::new();
            let mut sizes = Vec::new();
            for part in inner {
                let Target::Symbol(name) = &part.target.0 else {
                    return Err(no_grid());
                };
                row.push(self.symbol(name));
                sizes.push(self.size(part)?);
            }
            if *columns.get_or_insert_with(|| sizes.clone()) != sizes {
                return Err(no_grid());
            }
            cells.push(row);
        }
        Ok(Operation::GridSplit {
            columns: columns.unwrap_or_default(),
            rows,
            cells,
        })
    }
}

/// The parts, when no entry is a repeat.
fn plain<'p, 'a>(entries: &'p [Entry<'a>]) -> Option<Vec<&'p Part<'a>>> {
    let part = |entry: &'p Entry<'a>| match entry {
        Entry::Part(part) => Some(part),
        Entry::Repeat(..) => None,
    };
    entries.iter().map(part).collect()
}
