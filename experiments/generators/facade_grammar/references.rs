//! Reference grammars of several kinds: one layout, written as people with different habits would write it.
//!
//! Wu et al. 2014, Table 4 compares inferred grammars with grammars that people made. How alike two grammars are (the
//! non-terminal regions that both have) can depend on the order in which the reference splits, so one kind of reference is
//! not enough. Here every layout has five references, which all derive the same terminals:
//!
//! | kind | the facade, from the whole to the tiles | model |
//! | --- | --- | --- |
//! | [`Kind::FloorsFirst`] | plinth, floors, cornice; each floor into tiles | the textbook grammar of Müller et al. 2006: facade, floor, tile |
//! | [`Kind::ColumnsFirst`] | plinth, body, cornice; the body into bays from bottom to top; each bay into tiles | facades of vertical bays |
//! | [`Kind::Interleaved`] | plinth, ground floor, upper floors, cornice; the upper floors into sections side by side; each section into storeys; each storey into tiles | a shop floor below, several stairwells or party walls above |
//! | [`Kind::Symmetric`] | plinth, body, cornice; the body into wing, centre, wing; each into floors; each floor into tiles | a projecting centre between equal wings |
//! | [`Kind::Nested`] | base (plinth and ground floor), main part, top (last floor and cornice); the main part into storeys; each storey into sections; each section into tiles | classical tripartition, with sections along the floor |
//!
//! A *tile* is a window or a door with the wall around it; inside it, all kinds agree: wall, column, wall; the column
//! into wall, sill, window, lintel, wall; the window into its frame and panes. As in the shipped layouts' grammars, equal
//! neighbours are one repeat, and so are pairs that alternate. Regions of equal contents share a symbol.
//!
//! Each kind also has layouts *of its own*, on which that order is the natural one: floors that each have a rhythm; bays
//! that each have a rhythm from floor to floor; sections that differ from each other; wings that mirror themselves about a
//! centre; a section that repeats, between another ground floor and another top floor. A tile may break the rhythm.
//! So that every kind can be written for every layout, tiles stand in rows and columns, and nothing runs across several of
//! them but plinth and cornice. Sizes are whole centimetres.
//!
//! Nothing here looks at a method or a cost.

mod kind;
mod plan;
mod write;

use edifice_base::rng::stream;
use edifice_grammar::{Grammar, GrammarError, derive};
use edifice_shape::Facade;

pub use kind::Kind;
use plan::TilePlan;

/// A made layout with a grammar of each kind.
#[derive(Debug, Clone)]
pub struct Referenced {
    /// The layout.
    pub facade: Facade,
    /// The kind that it was designed for.
    pub own: Kind,
    /// A grammar of each kind, in the order of [`Kind::ALL`]; each derives the layout.
    pub grammars: [Grammar; 5],
}

/// `each` layouts of every kind, kind by kind, named `<kind>_<number>` from 1.
///
/// # Errors
/// [`GrammarError`] if a grammar did not derive, which the tests exclude.
pub fn referenced(seed: u64, each: usize) -> Result<Vec<Referenced>, GrammarError> {
    let designs = Kind::ALL
        .into_iter()
        .flat_map(|kind| (1..=each).map(move |number| (kind, number)));
    let made = designs.map(|(own, number)| {
        let name = format!("{}_{number}", own.name());
        let plan = TilePlan::draw(&mut stream(seed, &name, 0), own);
        let grammars = Kind::ALL.map(|kind| plan.grammar(&name, kind));
        let facade = derive(&grammars[0], 0)?;
        Ok(Referenced {
            facade,
            own,
            grammars,
        })
    });
    made.collect()
}

#[cfg(test)]
mod tests;
