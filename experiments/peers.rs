//! Methods that find a grammar of one facade and are compared with those of Wu et al. 2014: the list that both sides know, so
//! that neither names the other.

use edifice_base::{Error, Result};
use edifice_grammar::Grammar;
use edifice_shape::Facade;

/// Finds a grammar of one facade.
type Infer = fn(&Facade) -> Result<Grammar>;

/// By name.
#[rustfmt::skip]
const GRAMMARS: &[(&str, Infer)] = &[
    ("procedural_logic", super::procedural_logic::grammar), // one line each
    ("procedural_logic_picture", super::procedural_logic::picture_grammar),
];

/// The grammar that a method finds of a facade.
///
/// # Errors
/// Those of the method, and when no method has this name.
pub fn grammar(method: &str, facade: &Facade) -> Result<Grammar> {
    match GRAMMARS.iter().find(|(name, _)| *name == method) {
        Some((_, infer)) => infer(facade),
        None => Err(Error::method(format!("there is no method {method}"))),
    }
}
