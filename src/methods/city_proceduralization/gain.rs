//! Candidates in the order of what they gain.

use std::cmp::Ordering;

/// The cost that a candidate would remove, per cost of its own; of equals, the first candidate is greatest.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Gain {
    pub(super) value: f64,
    pub(super) candidate: usize,
}

impl Eq for Gain {}

impl Ord for Gain {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_value = self.value.total_cmp(&other.value);
        by_value.then(other.candidate.cmp(&self.candidate))
    }
}

impl PartialOrd for Gain {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
