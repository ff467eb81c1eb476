//! Methods that find a grammar of facades and are compared with those of Wu et al. 2014: the lists that both sides know, so
//! that neither names the other.

use edifice_base::{Error, Result};
use edifice_grammar::Grammar;
use edifice_shape::Facade;

use edifice_frame::Parsed;

/// Finds a grammar of one facade.
type Infer = fn(&Facade) -> Result<Grammar>;

/// By name.
#[rustfmt::skip]
const GRAMMARS: &[(&str, Infer)] = &[
    ("procedural_logic", edifice_experiments_procedural_logic::grammar), // one line each
    ("procedural_logic_picture", edifice_experiments_procedural_logic::picture_grammar),
];

/// Learns from some facades and parses them and others; lengths are multiples of a step.
type ParseAll = fn(learnt: &[Facade], others: &[Facade], step: f64) -> Result<Parsed>;

/// By name.
#[rustfmt::skip]
const PARSERS: &[(&str, ParseAll)] = &[
    ("procedural_logic", edifice_experiments_procedural_logic::parsed), // one line each
];

/// Facades as rules of a method, which learns from the first of them alone.
///
/// # Errors
/// Those of the method, and when no method has this name.
pub fn parsed(method: &str, learnt: &[Facade], others: &[Facade], step: f64) -> Result<Parsed> {
    match PARSERS.iter().find(|(name, _)| *name == method) {
        Some((_, parse)) => parse(learnt, others, step),
        None => Err(Error::method(format!("there is no method {method}"))),
    }
}

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
