//! Facades as rules without sizes, whichever method found the rules.

use edifice_grammar::parametric::{Parse, Rules};

/// Facades that a method learnt from, and others that it parsed then.
pub struct Parsed {
    /// The rules of the facades that the method learnt from.
    pub rules: Rules,
    /// Those facades.
    pub learnt: Vec<Parse>,
    /// The others, each with the rules above and its own after them.
    pub others: Vec<(Parse, Rules)>,
}
