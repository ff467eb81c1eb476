//! Weights of the alternatives of a stochastic rule.

use super::super::error::Fault;
use super::super::note::Note;
use super::super::syntax::{CgaRule, Chance};
use super::Builder;

/// Two percentages are the same when they differ by at most this much.
const PERCENT_SLACK: f64 = 1e-6;

impl Builder<'_> {
    /// The weight of each alternative: its percentage, or what a comment says that it was.
    pub(super) fn weights(&self, rule: &CgaRule<'_>) -> Result<Vec<Option<f64>>, Fault> {
        let mut shares = Vec::new();
        for alternative in &rule.alternatives {
            let rest = || 100.0 - shares.iter().flatten().sum::<f64>();
            let share = match &alternative.chance {
                Chance::Always => None,
                Chance::Percent(value) => Some(self.value(value)?),
                Chance::Else => Some(rest()).map(|r| if r.abs() < PERCENT_SLACK { 0.0 } else { r }),
            };
            shares.push(share);
        }
        for &(text, span) in &rule.notes {
            let Note::Weights(weights) = Note::parse(text, span)? else {
                return Err(Fault::new(span, "this comment belongs below the arrow"));
            };
            let most = weights.iter().fold(0.0_f64, |a, &b| a.max(b));
            let total: f64 = weights.iter().map(|w| w / most).sum();
            let explains = |(weight, share): (&f64, &Option<f64>)| {
                share.is_some_and(|s| (100.0 * (weight / most / total) - s).abs() <= PERCENT_SLACK)
            };
            // A closing `else : NIL` of nothing has no weight.
            let extra = shares.len() - weights.len().min(shares.len());
            let rest_is_nothing =
                shares[weights.len().min(shares.len())..] == vec![Some(0.0); extra];
            if weights.len() > shares.len()
                || !rest_is_nothing
                || !weights.iter().zip(&shares).all(explains)
            {
                let message = "these weights do not match the percentages below; correct or remove the comment";
                return Err(Fault::new(span, message));
            }
            for (share, weight) in shares.iter_mut().zip(weights) {
                *share = Some(weight);
            }
        }
        Ok(shares)
    }
}
