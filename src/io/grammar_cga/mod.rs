//! Split grammars as CGA text: `*.cga`, the syntax of CityEngine (Müller et al. 2006).
//!
//! ```text
//! //@ unit "px"
//! //@ facade Facade 400 x 608
//! const Floor_height = 30
//!
//! Facade --> split(y) { 8 : wall | { Floor_height : Floor }* }
//! Floor --> split(x) { { 50 : Bay }* }
//! Bay -->
//!     70% : split(x) { ~1 : wall | 20 : window | ~1 : wall }
//!     else : split(x) { ~1 : wall | 12 : door | ~1 : wall }
//! ```
//! - `split(axis) { size : symbol | ... }`; `{ ... }*` repeats, alone or after `split(axis) { ... }`.
//!   `{ 8 : A | { 12 : B | 8 : A }* }` is `repeat_aba`. Any other mixture of parts with one repeat,
//!   and a `split` written in the place of a symbol, become helper symbols (`Floor_1`, ...).
//! - `~` before a size makes it a weight ([`Size::Relative`](crate::grammar::Size)).
//! - `attr` and `const` name a size; sizes may be computed with `+ - * / ( )`. The writer names the
//!   absolute sizes that a symbol is given more than once.
//! - Percentages make a rule stochastic; `else` takes the rest of 100.
//! - Comments `//`, `/* */` and `#`. CityEngine's `version` and `@StartRule` are understood.
//!
//! What CGA has no word for stands in comments that CityEngine skips, so that reading back what was
//! written gives the same value, bit by bit: `//@ unit`, `//@ facade` (one for each start: symbol,
//! size and, unless it is the symbol, the name), `//@ symbol` (an identifier for a symbol that is
//! not one), `//@ sym_split` and `//@ grid_split` (before an operation that is written out), and
//! `//@ weights` (before a rule whose percentages are rounded). Without `//@ facade` the marked or
//! first rule is the axiom, and its size must follow from absolute sizes; without `//@ unit` the
//! unit is `m`.
//!
//! Errors name line, column and the offending text, with the line printed below.

mod error;
mod lower;
mod names;
mod note;
mod parse;
mod reserved;
mod syntax;
mod token;
mod write;

use std::path::Path;

pub use error::CgaError;

use super::{read_bytes, write_atomic};
use crate::grammar::Grammar;
use crate::{Error, Result};
use error::Fault;

/// Reads a grammar from a file.
///
/// # Errors
/// Names the file, line and column of what is wrong.
pub fn read(path: &Path) -> Result<Grammar> {
    parse(&read_bytes(path)?, path)
}

/// Writes a grammar to a file, whole or not at all.
///
/// # Errors
/// [`Error::Io`] when the file cannot be written.
pub fn write(grammar: &Grammar, path: &Path) -> Result<()> {
    write_atomic(path, to_string(grammar).as_bytes())
}

/// Parses the bytes of a CGA file; `path` only names the file in errors.
///
/// # Errors
/// As [`read`].
pub fn parse(bytes: &[u8], path: &Path) -> Result<Grammar> {
    let text = std::str::from_utf8(bytes).map_err(|e| {
        let line = bytes[..e.valid_up_to()]
            .iter()
            .filter(|&&b| b == b'\n')
            .count()
            + 1;
        Error::input(path, format!("line {line}"), e)
    })?;
    from_str(text).map_err(|e| {
        let place = format!("line {}, column {}", e.line, e.column);
        Error::input(path, place, e)
    })
}

/// Reads a grammar from text.
///
/// # Errors
/// [`CgaError`] for text that is no CGA, uses what is not supported, or is no valid grammar.
pub fn from_str(text: &str) -> std::result::Result<Grammar, CgaError> {
    grammar(text).map_err(|fault| CgaError::new(fault, text))
}

/// The text of a grammar.
pub fn to_string(grammar: &Grammar) -> String {
    write::to_string(grammar)
}

fn grammar(text: &str) -> std::result::Result<Grammar, Fault> {
    let (header, tokens) = note::split_header(token::tokens(text)?)?;
    let items = parse::items(tokens, text.len())?;
    lower::lower(&header, &items, (text.len()..text.len()).into())
}
