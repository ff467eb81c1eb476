//! Importance sampling (Sec. 6.1): the cheapest of many walks that always explore.
//!
//! The walks are weighted draws as well ([`weighted_walks`](super::weighted_walks)), at twice the time of a walk; here only their costs are
//! kept, which is all that their effective number takes.

use edifice_optim::adp::{Adp, Approximation, Epsilon};
use edifice_optim::tell;

use crate::adp::search::Setup;
use crate::adp::walk::{Derivation, Inference};
use crate::rules::AddRule;
use crate::settings::InferError;

/// The approximation of importance sampling: it learns nothing, so that every step explores.
pub(crate) struct NothingKnown;

impl Approximation<Inference> for NothingKnown {
    fn best(&mut self, _: &mut Inference, _: &Derivation) -> Option<AddRule> {
        None
    }

    fn learn(&mut self, _: &mut Inference, _: &[AddRule], _: &[f64]) {}
}

impl Setup<'_> {
    /// The cheapest of many walks by the splitting heuristic, and their effective number when each is weighted by `exp(-cost)`.
    pub(crate) fn importance(&self) -> Result<(Vec<AddRule>, f64), InferError> {
        let (iterations, seed) = (self.settings.iterations, self.settings.seed);
        let explore = self.explore(self.settings.readings.protection.anew());
        let always = Epsilon::ALWAYS_EXPLORE;
        let adp = Adp::new(explore, NothingKnown, always, iterations, seed);
        let watch = self.watch("walks", 0);
        let run = adp.run(&mut self.process(), tell(&watch, None))?;
        let costs: Vec<f64> = run.trace.iter().map(|step| step.cost).collect();
        Ok((run.best, effective(&costs)))
    }
}

/// `(Σ w)² / Σ w²` of the weights `w = exp(-cost)`.
fn effective(costs: &[f64]) -> f64 {
    let least = costs.iter().copied().fold(f64::INFINITY, f64::min);
    let weights = costs.iter().map(|cost| (least - cost).exp());
    let (sum, squares) = weights.fold((0.0, 0.0), |(s, q), w| (s + w, q + w * w));
    sum * sum / squares
}
