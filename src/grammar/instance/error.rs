//! Why an instance grammar cannot be derived.

use super::limits::{DEEPEST, INSTANCE_LIMIT};

/// Why a grammar cannot be derived.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InstanceGrammarError {
    /// A symbol is neither template nor non-terminal.
    #[error("rules[{rule}].successors[{successor}]: unknown symbol {symbol:?}")]
    UnknownSymbol {
        /// Index of the rule.
        rule: usize,
        /// Index of the successor.
        successor: usize,
        /// The symbol.
        symbol: String,
    },
    /// A symbol names two things.
    #[error("{0:?} names two templates, or a template and a non-terminal")]
    Ambiguous(String),
    /// The axiom has no rule.
    #[error("the axiom {0:?} has no rule")]
    NoAxiom(String),
    /// A non-terminal contains itself.
    #[error("{0:?} contains itself")]
    Cyclic(String),
    /// Rules nest too deeply.
    #[error("rules nest more than {DEEPEST} deep at {0:?}")]
    TooDeep(String),
    /// A number is not usable.
    #[error("{place}: {value} is not a usable {what}")]
    Number {
        /// Place of the number in the grammar.
        place: String,
        /// Meaning of the number.
        what: &'static str,
        /// The value.
        value: f64,
    },
    /// A template's triangle names a position that it does not have.
    #[error("templates[{template}].triangles: index {index} of {count} positions")]
    Dangling {
        /// Index of the template.
        template: usize,
        /// The index.
        index: u32,
        /// Number of positions.
        count: usize,
    },
    /// Parts do not follow the rule.
    #[error("an instance of {symbol:?} has {found} parts where its rule has {expected}")]
    Parts {
        /// The non-terminal.
        symbol: String,
        /// Parts given.
        found: usize,
        /// Successors of its rule.
        expected: usize,
    },
    /// A part is neither what its rule names, nor another template in the place of a template.
    #[error("a part {part:?} cannot stand for {expected:?}")]
    Part {
        /// The part's symbol.
        part: String,
        /// The rule's.
        expected: String,
    },
    /// An instance states more or fewer numbers than its rule has parameters.
    #[error(
        "an instance of {symbol:?} states {found} numbers where its rule has {expected} parameters"
    )]
    Numbers {
        /// The symbol.
        symbol: String,
        /// Numbers given.
        found: usize,
        /// Parameters of its rule.
        expected: usize,
    },
    /// A rule with parameters, or with factors, whose successors are not all templates.
    #[error(
        "rules[{rule}]: a rule with parameters or factors puts down templates only, not {symbol:?}"
    )]
    NoTemplate {
        /// Index of the rule.
        rule: usize,
        /// The successor's symbol.
        symbol: String,
    },
    /// A row of something that has neither width nor depth.
    #[error("rules[{rule}]: {symbol:?} has no length, and cannot stand in a row")]
    NoLength {
        /// Index of the rule.
        rule: usize,
        /// The successor's symbol.
        symbol: String,
    },
    /// A part is of no known symbol.
    #[error("a part of unknown symbol {0:?}")]
    UnknownPart(String),
    /// A derivation is too large.
    #[error("the derivation has more than {INSTANCE_LIMIT} instances")]
    TooLarge,
}
