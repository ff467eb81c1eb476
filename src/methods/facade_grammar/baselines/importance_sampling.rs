//! Importance sampling: the cheapest of many walks that always explore.

use crate::adp::search::Setup;
use crate::adp::walk::{Derivation, Inference};
use crate::rules::AddRule;
use crate::settings::InferError;
use edifice_optim::adp::{Approximation, Epsilon};

/// The approximation of importance sampling: it learns nothing, so that every step explores.
pub(crate) struct NothingKnown;

impl Approximation<Inference> for NothingKnown {
    fn best(&mut self, _: &mut Inference, _: &Derivation) -> Option<AddRule> {
        None
    }

    fn learn(&mut self, _: &mut Inference, _: &[AddRule], _: &[f64]) {}
}

impl Setup<'_> {
    /// The cheapest of many walks by the splitting heuristic.
    pub(crate) fn importance(&self) -> Result<Vec<AddRule>, InferError> {
        let iterations = self.settings.iterations;
        let explore = self.explore(self.settings.readings.protection.anew());
        let always = Epsilon::ALWAYS_EXPLORE;
        let (rules, _) = self.walks(explore, NothingKnown, always, iterations, 0)?;
        Ok(rules)
    }
}
