//! Rules for region types: the cheapest one, grids, and the grammar that a set of rules makes.

mod candidate;
pub(super) mod extract;
pub(super) mod grid;
mod pricer;
mod trace;

pub(super) use candidate::{AddRule, Arrangement, RuleCandidate, operation_cost};
pub(super) use pricer::RulePricer;
