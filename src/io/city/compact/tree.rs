//! Districts, blocks and rows as what each building begins.

use super::error::CompactError;
use edifice_grammar::instance::{Begins, Grid, InstanceGrammar};

/// Grids that are tried: those of the precisions in which grammars are made.
const GRIDS: [Grid; 3] = [
    Grid {
        length: 10.0,
        turn: 2.0,
    },
    Grid {
        length: 100.0,
        turn: 100.0,
    },
    Grid {
        length: 1000.0,
        turn: 10_000.0,
    },
];

/// A grammar of districts, blocks and rows, taken apart.
pub(super) struct Tree {
    pub(super) flat: InstanceGrammar,
    pub(super) begins: Vec<Begins>,
    pub(super) grid: Grid,
}

impl Tree {
    /// `None` for a grammar that is flat, and for one that its flat grammar would not become again.
    pub(super) fn of(grammar: &InstanceGrammar) -> Option<Self> {
        let begins = grammar.beginnings();
        if begins.iter().all(|b| *b == Begins::District) {
            return None;
        }
        let tree = |grid: Grid| Self {
            flat: grammar.flat(Some(&grid)),
            begins: begins.clone(),
            grid,
        };
        let again =
            |tree: &Self| tree.flat.arranged(&tree.begins, &tree.grid).rules == grammar.rules;
        GRIDS.into_iter().map(tree).find(again)
    }
}

/// The grid that a file gives.
pub(super) fn grid([length, turn]: [f64; 2]) -> Result<Grid, CompactError> {
    let usable = |v: f64| (1.0..=65_535.0).contains(&v);
    match usable(length) && usable(turn) {
        true => Ok(Grid { length, turn }),
        false => Err(CompactError::Index("grid")),
    }
}
