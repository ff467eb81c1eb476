//! What the text leaves open in its own algorithm, as far as it can be set.

use serde::{Deserialize, Serialize};

/// Numbers that Wu et al. 2014 do not print. The default values are the readings that the parent
/// module's list gives reasons for; the report's `readings` sets others beside them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Readings {
    /// Draws of protected regions at the start of a walk, at most; 0 protects nothing (Sec. 4.7).
    pub protected_draws: usize,
    /// Rules remembered for each region type, among which exploitation chooses (Eq. 4, Sec. 4.5).
    pub remembered_rules: usize,
    /// Probability of exploring in the last iteration; the first has 0.9 (Sec. 4.2).
    pub last_epsilon: f64,
}

impl Default for Readings {
    fn default() -> Self {
        Self {
            protected_draws: 8,
            remembered_rules: 64,
            last_epsilon: 0.1,
        }
    }
}
