//! Split grammars as CGA text: `*.cga`, the syntax of CityEngine (Müller et al. 2006).
//!
//! ```text
//! version "2019.0"
//! //@ unit "px"
//! //@ facade Facade 400 x 608
//! //@ sizes absolute
//!
//! const Floor_height = 30
//!
//! @StartRule
//! Facade --> split(y) { ~8 : wall | { ~Floor_height : Floor }* }
//!
//! Floor --> split(x) { { ~50 : Bay }* }
//!
//! Bay -->
//!     70% : split(x) { ~15 : wall | ~20 : window | ~15 : wall }
//!     else : split(x) { ~19 : wall | ~12 : door | ~19 : wall }
//!
//! wall --> color("#ffff00")
//! ```
//!
//! # What CityEngine asks for
//! The rules of its reference that text keeps to. Pages are below
//! <https://esri.github.io/cityengine-sdk/html/cgaref/cgareference/> unless said otherwise;
//! `tests/generic/grammar/cga_reference.rs` and, for sizes, `cga_sizes.rs` beside it have a test for each row.
//!
//! | page | it says | written | read |
//! | --- | --- | --- | --- |
//! | `version.html` | the statement is the first line of code; without it the version is 2009.1 | `version "2019.0"` | skipped |
//! | `cga_annotations.html` | `@StartRule` marks a rule for the start rule chooser | on the rule of every start | the first one marked, else the first rule, is the axiom; other annotations are skipped |
//! | `cgaindex.html` | names of operations, attributes, functions, keywords; declared names may not end in a dot ([changelog] of 2022.0) | a symbol that is one of them, or no ASCII identifier, gets another name and a comment `//@ symbol` | the comment gives the symbol back |
//! | [standard rule] | a symbol without a rule is a leaf, with a warning unless a dot follows its name | a rule for each leaf | a dot after a name is no part of it |
//! | `op_color.html` | `color("#rrggbb")` sets the colour of a shape | leaves have the colour of [`Palette`](crate::palette::Palette) | a rule of such operations alone (also `i(...)`, `extrude(...)`, ...) makes its symbol a terminal; before a symbol or a split they are skipped |
//! | `op_split.html` | a size without prefix is exact, and what the sizes leave stays empty; `~` sizes share the rest in proportion | `~` before every size but those of thin structures, in every rule | [`Size::Absolute`] and [`Size::Relative`] |
//! | | `'` sizes are fractions of the whole | never | as weights: `'0.2 \| ~1 \| ~3` is `~0.2 \| ~0.2 \| ~0.6`. Beside an absolute size, and with a gap, an error |
//! | | `{ ... }*` repeats as often as fits best; `~` sizes then fill the space | [`Repeat`](edifice_grammar::Operation::Repeat) with `~`; `A \| { B \| A }*` for [`RepeatAba`](edifice_grammar::Operation::RepeatAba) | also as `split(x) { ... }*` and among other parts, where it becomes a helper symbol (`Floor_1`) |
//! | | blocks may be nested to any depth | `//@ grid_split` only | a block without `*` is its parts; a repeat in a repeat, and several beside each other, are helper symbols of one floating period each; 64 levels |
//! | `func_rand.html` | `rand(min, max)`, `rand(max)` and `rand()` are numbers of a range | never | in a rule: five equally likely rules, each with the middle of a fifth of the range, so that `rand(2, 4)` is 2.2, 2.6, 3.0, 3.4 or 3.8; several ranges of a rule take their fifths in different orders |
//! | `const.html`, `attr.html` | evaluated once, before any rule | sizes that a symbol is given more than once | a range stands for its middle |
//! | [stochastic rule] | percentages add up to at most 100, and `else` ends the list | so | so |
//! | `op_nil.html` | `NIL` deletes the shape | after a single rule with a weight, for the `else` that never comes | as a terminal of that name |
//!
//! [changelog]: https://doc.arcgis.com/en/cityengine/latest/cga/cga-changelog.htm
//! [standard rule]: http://cehelp.esri.com/help/topic/com.procedural.cityengine.help/html/manual/cga/writing_rules/cga_wr_standard_rule.html
//! [stochastic rule]: https://doc.arcgis.com/en/cityengine/latest/help/help-stochastic-rule.htm
//! [`Size::Absolute`]: edifice_grammar::Size::Absolute
//! [`Size::Relative`]: edifice_grammar::Size::Relative
//!
//! **Which sizes float.** An inferred grammar has absolute sizes; written so, CityEngine would leave gaps
//! on a larger lot and cut parts off on a smaller one. The text has the sizes of
//! [`size_independent`](edifice_grammar::size_independent), which `edifice grammar derive` uses at another
//! size too: thin structures are exact, all others share the rest, and repeats fit as many periods as
//! there is room for. At the facade's own size that gives the absolute sizes. A rule in which some size is
//! a weight already fills its space and is written as it is.
//!
//! # What CGA has no word for
//! It stands in comments that CityEngine skips, so that reading back what was written gives the same
//! value, bit by bit:
//! - `//@ unit`; without it the unit is `m`.
//! - `//@ facade`, one for each start: symbol, size and, unless it is the symbol, the name. Without it the
//!   size of the axiom must follow from absolute sizes.
//! - `//@ symbol`: an identifier and the symbol that it stands for.
//! - `//@ sizes absolute`: sizes after `~` are absolute, but in rules below `//@ relative`.
//! - `//@ sym_split` and `//@ grid_split`: the operation below is written out.
//! - `//@ weights`: what the percentages below were rounded from.
//!
//! Text of others may also name sizes with `attr`, compute them with `+ - * / ( )`, and have comments
//! `//`, `/* */` and `#`. A rule may take numbers, `Floor(columns)`: each list of numbers
//! that it is called with, `Floor(4)`, is a symbol of its own. Conditions (`case`) and operations that change shapes are errors.
//!
//! Parametric libraries, and single facades of them, are written with attributes, counts as parameters and a stochastic
//! start ([`write_named`]).
//!
//! Text of rules that make solids, as of cities, is read by [`solids`].
//!
//! Errors name line, column and the offending text, with the line printed below.

mod error;
mod lower;
mod named;
mod names;
mod note;
mod parse;
mod reserved;
pub mod solids;
mod syntax;
mod token;
mod write;

use std::path::Path;

pub use error::CgaError;
pub use names::identifier;
pub use reserved::words as reserved_words;

use super::{read_bytes, write_atomic};
use edifice_base::{Error, Result};
use edifice_grammar::Grammar;
use edifice_grammar::parametric::Named;
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

/// Writes rules with named sizes and counts to a file, whole or not at all: of a library as stochastic rules, or of one
/// facade. [`read`] gives their grammar, with a symbol for each list of counts that a rule is called with.
///
/// # Errors
/// [`Error::Io`] when the file cannot be written.
pub fn write_named(named: &Named, path: &Path) -> Result<()> {
    write_atomic(path, named_to_string(named).as_bytes())
}

/// The text of rules with named sizes and counts.
pub fn named_to_string(named: &Named) -> String {
    named::to_string(named)
}

fn grammar(text: &str) -> std::result::Result<Grammar, Fault> {
    let (header, tokens) = note::split_header(token::tokens(text)?)?;
    let items = parse::items(tokens, text.len())?;
    lower::lower(&header, &items, (text.len()..text.len()).into())
}
