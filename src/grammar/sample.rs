//! Derivation at any size, of stochastic grammars too (Wu et al. 2014, Sec. 5).

use rand::Rng;
use rustc_hash::FxHashMap;

use super::check::check_structure;
use super::derive::{Fit, walk};
use super::table::Table;
use super::{Derivation, Grammar, GrammarError, Operation, summable};
use edifice_base::rng::categorical;

/// Derives a grammar in a region of `width` x `height`, in the grammar's unit.
///
/// In a stochastic grammar `rng` picks one rule for each symbol, with probability proportional to
/// the weights, at the first region of that symbol; the same rule then serves all its regions, so
/// that equal symbols stay equal within one facade (an inconsistent choice is what makes variations
/// look wrong: Wu et al. 2014, Sec. 1). A deterministic grammar takes nothing from `rng`.
///
/// Relative sizes give way before absolute ones. Where absolute sizes leave too little for the
/// relative ones ([`LEAST_SHARE`](super::LEAST_SHARE)) they shrink too, all in proportion, and
/// [`Derivation::shrunk`] says which rules do so. A deterministic grammar at its own size is derived as
/// it is written, or not at all.
///
/// # Errors
/// [`GrammarError`] for an invalid grammar, a size that is not positive, or absolute sizes that do not
/// fill a region; [`size_independent`](super::size_independent) makes a grammar without such rules.
pub fn derive_at<R: Rng>(
    grammar: &Grammar,
    start_index: usize,
    width: f64,
    height: f64,
    rng: &mut R,
) -> Result<Derivation, GrammarError> {
    let sampler = Sampler::new(grammar)?;
    sampler.derive(start_index, width, height, rng)
}

/// A grammar checked once, to be derived many times.
pub struct Sampler<'g> {
    grammar: &'g Grammar,
    table: Table<'g>,
}

impl<'g> Sampler<'g> {
    /// Checks the grammar, except that sizes fit, which depends on the size asked for.
    ///
    /// # Errors
    /// [`GrammarError`] for an invalid grammar.
    pub fn new(grammar: &'g Grammar) -> Result<Self, GrammarError> {
        let table = check_structure(grammar)?;
        Ok(Self { grammar, table })
    }

    /// As [`derive_at`].
    ///
    /// # Errors
    /// As [`derive_at`].
    pub fn derive<R: Rng>(
        &self,
        start_index: usize,
        width: f64,
        height: f64,
        rng: &mut R,
    ) -> Result<Derivation, GrammarError> {
        let count = self.grammar.starts.len();
        if start_index >= count {
            return Err(GrammarError::StartIndex {
                index: start_index,
                count,
            });
        }
        for (dimension, value) in [("width", width), ("height", height)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(GrammarError::AskedSize { dimension, value });
            }
        }
        let mut chosen: FxHashMap<usize, usize> = FxHashMap::default();
        let choose = |symbol: usize, rules: &[usize]| match rules {
            &[only] => only,
            _ => *chosen
                .entry(symbol)
                .or_insert_with(|| self.pick(rules, rng)),
        };
        let own = &self.grammar.starts[start_index];
        let stochastic = self.table.rules_of.iter().any(|rules| rules.len() > 1);
        let fit = match stochastic || (width, height) != (own.width, own.height) {
            true => Fit::Shrink,
            false => Fit::AsWritten,
        };
        walk(
            self.grammar,
            &self.table,
            start_index,
            (width, height),
            fit,
            choose,
        )
    }

    /// The largest factor between the sizes of parts in the splits of a derivation and the sizes that the grammar
    /// writes for them, at least 1. Repeats fill any extent with parts of about their own size; but rules drawn for two
    /// floors, in the space of three, stretch their windows by 1.5.
    pub fn stretch(&self, derivation: &Derivation) -> f64 {
        let factors = derivation.non_terminals.iter().filter_map(|region| {
            let rule = &self.grammar.rules[region.rule];
            let Operation::Split { axis, successors } = &rule.operation else {
                return None;
            };
            let written: f64 = successors.iter().map(|s| s.size.value()).sum();
            let factor = region.rect.extent(*axis) / written;
            Some(factor.max(1.0 / factor))
        });
        factors.fold(1.0, f64::max)
    }

    /// One of the rules, with probability proportional to its weight.
    fn pick<R: Rng>(&self, rules: &[usize], rng: &mut R) -> usize {
        let weights: Vec<f64> = rules
            .iter()
            .map(|&rule| self.grammar.rules[rule].weight.unwrap_or(1.0))
            .collect();
        rules[categorical(&summable(&weights), rng)]
    }
}
