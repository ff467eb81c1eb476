//! Ways for a grammar to be wrong.

use edifice_shape::Axis;

/// Why a grammar is not valid, or cannot be derived. Rules are named by their index in
/// [`Grammar::rules`](super::Grammar::rules), as in the path `rules[3]` of a grammar file.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GrammarError {
    /// The grammar has no facade to start from.
    #[error("the grammar has no start")]
    NoStart,
    /// A start that does not exist was asked for.
    #[error("start {index} was asked for, the grammar has {count}")]
    StartIndex {
        /// The index asked for.
        index: usize,
        /// Number of starts.
        count: usize,
    },
    /// Width or height of a start is not a positive number.
    #[error("{dimension} of start {index} ({symbol}) is {value}, expected a positive number")]
    StartSize {
        /// Index of the start.
        index: usize,
        /// Its symbol.
        symbol: String,
        /// `width` or `height`.
        dimension: &'static str,
        /// The value found.
        value: f64,
    },
    /// A start symbol has no rule, although the grammar has rules.
    #[error(
        "start symbol {symbol} is undefined: the grammar has rules, but none for it or any other start"
    )]
    UndefinedStart {
        /// The symbol.
        symbol: String,
    },
    /// A start symbol, a left-hand side or a successor is the empty string.
    #[error("{place} is empty, expected a symbol")]
    EmptySymbol {
        /// Its place, for example `rules[3].successors[0].symbol`.
        place: String,
    },
    /// A rule writes no successor.
    #[error("rules[{rule}] ({symbol}) has no successors")]
    NoSuccessors {
        /// Index of the rule.
        rule: usize,
        /// Its left-hand side.
        symbol: String,
    },
    /// A size is not finite or not above zero.
    #[error("rules[{rule}].{field} ({symbol}) is {value}, expected a positive number")]
    SizeNumber {
        /// Index of the rule.
        rule: usize,
        /// Its left-hand side.
        symbol: String,
        /// Its place in the rule, for example `successors[2].size`.
        field: String,
        /// The value found.
        value: f64,
    },
    /// A weight is not finite or not above zero.
    #[error("rules[{rule}].weight ({symbol}) is {value}, expected a positive number")]
    Weight {
        /// Index of the rule.
        rule: usize,
        /// Its left-hand side.
        symbol: String,
        /// The value found.
        value: f64,
    },
    /// Two rules without weights have the same left-hand side.
    #[error(
        "rules[{first}] and rules[{second}] both define {symbol}; several rules of a symbol need weights"
    )]
    DuplicateRule {
        /// The left-hand side.
        symbol: String,
        /// Index of one rule.
        first: usize,
        /// Index of the other.
        second: usize,
    },
    /// A grid split whose cells do not match its columns and rows.
    #[error("rules[{rule}] ({symbol}): {place} has {found} entries, expected {expected} ({what})")]
    GridShape {
        /// Index of the rule.
        rule: usize,
        /// Its left-hand side.
        symbol: String,
        /// The list, for example `cells[2]`.
        place: String,
        /// Entries found.
        found: usize,
        /// Entries expected.
        expected: usize,
        /// `columns` or `rows`.
        what: &'static str,
    },
    /// A symbol leads back to itself, so that derivation would not end.
    #[error("the rules form a cycle: {}", symbols.join(" -> "))]
    Cycle {
        /// The symbols on the cycle, the first repeated at the end.
        symbols: Vec<String>,
    },
    /// Absolute sizes do not fill the region they split.
    #[error(
        "rules[{rule}] ({symbol}): sizes along {} add up to {sum}, the region has {extent}", axis.name()
    )]
    SizesDoNotAddUp {
        /// Index of the rule.
        rule: usize,
        /// Its left-hand side.
        symbol: String,
        /// Direction.
        axis: Axis,
        /// Sum of the sizes.
        sum: f64,
        /// Extent of the region.
        extent: f64,
    },
    /// A period of absolute sizes does not fit a whole number of times.
    #[error(
        "rules[{rule}] ({symbol}): a period of {period} along {} fits {times} times into {extent}, expected a whole number of at least {least}", axis.name()
    )]
    RepeatDoesNotFit {
        /// Index of the rule.
        rule: usize,
        /// Its left-hand side.
        symbol: String,
        /// Direction.
        axis: Axis,
        /// Sum of the sizes of one period.
        period: f64,
        /// Extent of the region that the periods must fill.
        extent: f64,
        /// `extent / period`.
        times: f64,
        /// The least number of periods.
        least: u32,
    },
    /// Absolute sizes leave nothing for the relative ones.
    #[error(
        "rules[{rule}] ({symbol}): absolute sizes need {needed} along {}, the region has only {extent}", axis.name()
    )]
    TooSmall {
        /// Index of the rule.
        rule: usize,
        /// Its left-hand side.
        symbol: String,
        /// Direction.
        axis: Axis,
        /// Sum of the absolute sizes.
        needed: f64,
        /// Extent of the region.
        extent: f64,
    },
    /// Grammars of different units were to be combined.
    #[error("grammars in {first} and in {second} cannot be combined")]
    Units {
        /// Unit of one grammar.
        first: String,
        /// Unit of another.
        second: String,
    },
    /// The size asked for is not a positive number.
    #[error("{dimension} asked for is {value}, expected a positive number")]
    AskedSize {
        /// `width` or `height`.
        dimension: &'static str,
        /// The value.
        value: f64,
    },
    /// Derivation would make an unreasonable number of regions.
    #[error("derivation makes more than {limit} regions")]
    TooManyRegions {
        /// The limit.
        limit: usize,
    },
    /// A stochastic grammar was to be derived without chance.
    #[error(
        "{symbol} has {count} weighted rules: the grammar is stochastic, derive it with a seed"
    )]
    Stochastic {
        /// The symbol.
        symbol: String,
        /// Number of its rules.
        count: usize,
    },
}

impl GrammarError {
    /// Index of the rule that is wrong, where the error is about one.
    pub fn rule(&self) -> Option<usize> {
        match self {
            Self::NoSuccessors { rule, .. }
            | Self::SizeNumber { rule, .. }
            | Self::Weight { rule, .. }
            | Self::DuplicateRule { second: rule, .. }
            | Self::GridShape { rule, .. }
            | Self::SizesDoNotAddUp { rule, .. }
            | Self::RepeatDoesNotFit { rule, .. }
            | Self::TooSmall { rule, .. } => Some(*rule),
            Self::NoStart
            | Self::StartIndex { .. }
            | Self::StartSize { .. }
            | Self::UndefinedStart { .. }
            | Self::EmptySymbol { .. }
            | Self::Cycle { .. }
            | Self::Units { .. }
            | Self::AskedSize { .. }
            | Self::TooManyRegions { .. }
            | Self::Stochastic { .. } => None,
        }
    }

    /// True if the grammar may be right at another size of its facade.
    pub fn depends_on_size(&self) -> bool {
        matches!(
            self,
            Self::SizesDoNotAddUp { .. }
                | Self::RepeatDoesNotFit { .. }
                | Self::TooSmall { .. }
                | Self::TooManyRegions { .. }
        )
    }
}

/// Something in a valid grammar that its author may not have meant.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Warning {
    /// No derivation reaches the rule.
    #[error("rules[{rule}] ({symbol}) is never used")]
    Unreachable {
        /// Index of the rule.
        rule: usize,
        /// Its left-hand side.
        symbol: String,
    },
}
