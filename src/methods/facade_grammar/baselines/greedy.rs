//! Greedy: always the best rule by the splitting heuristic (Eq. 5).

use super::top_down;
use crate::adp::exploration::Exploration;
use crate::regions::Types;
use crate::rules::AddRule;

/// Always the best rule by the splitting heuristic.
pub(crate) fn greedy(types: &mut Types, exploration: &mut Exploration) -> Vec<AddRule> {
    top_down(types, |types, id| exploration.best(types, id))
}
