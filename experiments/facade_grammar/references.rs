//! Facades with grammars that people made, or could have made: what Tables 4 and 5 compare with.

use super::data::{self, FIGURE_9};
use edifice_base::{Error, Result};
use edifice_frame::Context;
use edifice_generators_facade_grammar::references::{Kind, referenced};
use edifice_grammar::Grammar;
use edifice_io::grammar_cga;
use edifice_shape::Facade;

/// The grammars that the shipped layouts were derived from.
pub(crate) const SHIPPED: &str = "shipped";
/// The grammar printed for facade (i), which the paper's own method found.
pub(crate) const PRINTED: &str = "printed";

/// A facade with the grammars that it is judged by.
#[derive(Debug, Clone)]
pub(crate) struct Judged {
    /// The facade.
    pub facade: Facade,
    /// The kind of reference that the facade was designed for.
    pub own: &'static str,
    /// Grammars that derive it, each with its kind.
    pub references: Vec<(&'static str, Grammar)>,
}

/// The kinds of references, in the order of the tables.
pub(crate) fn kinds() -> Vec<&'static str> {
    let made = Kind::ALL.map(Kind::name);
    [SHIPPED, PRINTED].into_iter().chain(made).collect()
}

/// The facades: each `every`-th shipped one, facade (i), and layouts made for each kind, which have references of all these kinds.
///
/// # Errors
/// Those of the readers, or of a made grammar that does not derive.
pub(crate) fn judged(ctx: &mut Context, every: usize) -> Result<Vec<Judged>> {
    let mut all: Vec<Judged> = data::known(ctx)?
        .into_iter()
        .step_by(every)
        .map(|(facade, grammar)| Judged {
            facade,
            own: SHIPPED,
            references: vec![(SHIPPED, grammar)],
        })
        .collect();
    let printed = grammar_cga::read(&data::folder(ctx)?.join(format!("{FIGURE_9}.cga")))?;
    all.push(Judged {
        facade: data::figure_9(ctx)?,
        own: PRINTED,
        references: vec![(PRINTED, printed)],
    });
    let each = ctx.budget().choose(1, 3, 6);
    ctx.setting("layouts_of_each_kind", each);
    for made in referenced(data::LAYOUT_SEED, each as usize).map_err(Error::method)? {
        let kinds = Kind::ALL.map(Kind::name);
        all.push(Judged {
            facade: made.facade,
            own: made.own.name(),
            references: kinds.into_iter().zip(made.grammars).collect(),
        });
    }
    Ok(all)
}

/// The paragraph on the references for the pages.
pub(crate) const NOTE: &str = "**References.** The paper compares with grammars of four experts and three other people. Without people, the \
    references are of several kinds, none of which any method sees. *shipped*: the grammars that the 34 shipped layouts were \
    derived from, mostly all floors of a wing at once and then all elements of a floor at once. *printed*: the grammar that the paper \
    prints for facade (i) (Sec. 4.6); its own method found it. *floors_first*, *columns_first*, *interleaved*, *symmetric*, *nested*: \
    grammars as people with these habits write them (module `edifice_generators_facade_grammar::references`), in which a window or door with \
    the wall around it is a tile. Each of these five has layouts made for it, and for each of these layouts there is a grammar of all five \
    kinds that derives the same terminals. All non-terminal regions count, the whole facade included. A repeat has no region for its period \
    unless the period is one non-terminal.";
