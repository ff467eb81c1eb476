//! Readings of the algorithm where the text leaves it open, as far as they can be set.

use serde::{Deserialize, Serialize};

/// The reading of Wu et al. 2014 for each passage that can be read in several ways. The default values are the
/// readings that the parent module's list gives reasons for; the report's `readings` compares them with others.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Readings {
    /// The time at which important regions are drawn (Sec. 4.7).
    pub protection: Protect,
    /// The rules that exploitation chooses from (Eq. 4, Sec. 4.5).
    pub exploitation: Exploit,
    /// Probability of exploring in the last iteration; the first has 0.9 (Sec. 4.2).
    pub last_epsilon: f64,
}

/// The time at which the protected regions are drawn, those that walks keep whole.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Protect {
    /// Nothing is protected.
    Never,
    /// Anew for each walk, in up to so many draws.
    Walk {
        /// Maximum number of draws, for each walk.
        draws: usize,
    },
    /// Once for all walks, until no other region fits between those drawn: against the text, but nearer
    /// to its numbers. Methods that learn nothing from walk to walk draw for each walk, in up to
    /// [`Protect::DRAWS`] draws.
    Run,
}

/// The set of rules over which Eq. 4 minimizes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Exploit {
    /// All reasonable rules that cut no protected region.
    AllRules,
    /// Of the cheapest rules that earlier walks tried, at most so many for each region type, those that
    /// cut no protected region.
    Remembered(usize),
}

impl Default for Readings {
    fn default() -> Self {
        Self {
            protection: Protect::Walk {
                draws: Protect::DRAWS,
            },
            exploitation: Exploit::AllRules,
            last_epsilon: 0.1,
        }
    }
}

impl Protect {
    /// Draws for a walk whose regions are its own.
    pub const DRAWS: usize = 8;

    /// The same for methods that learn nothing from walk to walk.
    pub(crate) fn anew(self) -> Self {
        match self {
            Protect::Run => Protect::Walk { draws: Self::DRAWS },
            other => other,
        }
    }
}
