//! Why a grammar cannot be edited so.

use super::place::Place;
use edifice_grammar::{Grammar, GrammarError};

/// Why a grammar cannot be edited so.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GrammarEditError {
    /// There is no such rule.
    #[error("there is no rules[{rule}]: the grammar has {count}")]
    NoRule {
        /// Its index.
        rule: usize,
        /// Rules of the grammar.
        count: usize,
    },
    /// There is no such part.
    #[error("rules[{rule}] has no {part}: it has {count}")]
    NoPart {
        /// Index of the rule.
        rule: usize,
        /// The part.
        part: Place,
        /// Number of such parts.
        count: usize,
    },
    /// The rule's operation has nothing of this kind.
    #[error("rules[{rule}] ({operation}) cannot be edited so: {hint}")]
    Operation {
        /// Index of the rule.
        rule: usize,
        /// Name of its operation.
        operation: &'static str,
        /// The edits that are possible.
        hint: &'static str,
    },
    /// A size leaves nothing for the part itself or for the others.
    #[error("size {size} for {part} of rules[{rule}]: what is beside it has {room}")]
    Size {
        /// Index of the rule.
        rule: usize,
        /// The part.
        part: Place,
        /// The size asked for.
        size: f64,
        /// The length that is there.
        room: f64,
    },
    /// The regions of a rule are as long in every facade.
    #[error("the regions of rules[{rule}] have a fixed length: no floor or column fits in")]
    Fixed {
        /// Index of the rule.
        rule: usize,
    },
    /// A split is no sequence of equal periods.
    #[error("rules[{rule}] does not repeat itself")]
    NoPeriod {
        /// Index of the rule.
        rule: usize,
    },
    /// The edited grammar is none.
    #[error(transparent)]
    Grammar(#[from] GrammarError),
}

/// Refuses a rule that is not there.
pub(super) fn known(grammar: &Grammar, rule: usize) -> Result<(), GrammarEditError> {
    let count = grammar.rules.len();
    match rule < count {
        true => Ok(()),
        false => Err(GrammarEditError::NoRule { rule, count }),
    }
}
