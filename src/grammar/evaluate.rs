//! The independent evaluator: no method marks its own work.

use rustc_hash::FxHashMap;

use super::limits::TOLERANCE;
use super::tiling::{Difference, tiling_difference};
use super::{Costs, Grammar, GrammarError, derivation};
use edifice_shape::Facade;

/// The cost of a grammar that explains its input.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evaluation {
    /// Eq. 1: sum of the costs of the rules.
    pub cost: f64,
    /// Number of rules.
    pub rules: usize,
    /// Number of terminal regions over all facades (`#T` of Wu et al. 2014, Table 1).
    pub terminals: usize,
}

/// Why a grammar does not explain the facades given.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EvaluateError {
    /// The grammar itself is wrong.
    #[error(transparent)]
    Grammar(#[from] GrammarError),
    /// The grammar has another number of starts.
    #[error("the grammar derives {starts} facades, {facades} were given")]
    Count {
        /// Starts of the grammar.
        starts: usize,
        /// Facades given.
        facades: usize,
    },
    /// A derived facade is not the one given.
    #[error(
        "facade {index} ({name}) is not what the grammar derives (first: derived, second: given): {difference}"
    )]
    Different {
        /// Index of the facade.
        index: usize,
        /// Its name.
        name: String,
        /// The first difference.
        difference: Difference,
    },
    /// A non-terminal stands for regions of different contents.
    #[error("{symbol} stands for regions of different contents: {} x {} and {} x {}", .first.0, .first.1, .second.0, .second.1)]
    Contents {
        /// The symbol.
        symbol: String,
        /// Width and height of one region.
        first: (f64, f64),
        /// Width and height of another.
        second: (f64, f64),
    },
}

/// Verifies that a deterministic grammar derives exactly to `facades` (start by start) and that
/// regions with equal symbols have equal contents, and returns its cost.
///
/// Derivation is a function of symbol and size, so contents are equal when sizes are.
///
/// # Errors
/// [`EvaluateError`] when the grammar is invalid, derives something else, or uses a symbol for
/// regions of different sizes.
pub fn evaluate(
    grammar: &Grammar,
    facades: &[Facade],
    costs: &Costs,
) -> Result<Evaluation, EvaluateError> {
    if grammar.starts.len() != facades.len() {
        return Err(EvaluateError::Count {
            starts: grammar.starts.len(),
            facades: facades.len(),
        });
    }
    let mut sizes: FxHashMap<usize, (f64, f64)> = FxHashMap::default();
    let mut terminals = 0;
    for (index, facade) in facades.iter().enumerate() {
        let derived = derivation(grammar, index)?;
        if let Some(difference) = tiling_difference(&derived.facade, facade) {
            return Err(EvaluateError::Different {
                index,
                name: facade.name.clone(),
                difference,
            });
        }
        let tolerance = TOLERANCE * facade.width.max(facade.height);
        for region in derived.non_terminals {
            let second = (region.rect.width, region.rect.height);
            let first = *sizes.entry(region.rule).or_insert(second);
            if (first.0 - second.0).abs() > tolerance || (first.1 - second.1).abs() > tolerance {
                return Err(EvaluateError::Contents {
                    symbol: grammar.rules[region.rule].symbol.clone(),
                    first,
                    second,
                });
            }
        }
        terminals += facade.regions.len();
    }
    Ok(Evaluation {
        cost: costs.grammar(grammar),
        rules: grammar.rules.len(),
        terminals,
    })
}
