//! Settings of inference, and why it fails.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::adp::readings::Readings;
use super::operations::Operations;
use edifice_grammar::{CostError, Costs};
use edifice_model::program::ProgramError;
use edifice_optim::adp::AdpError;
use edifice_optim::annealing::AnnealingError;
use edifice_shape::LayoutError;

/// The method of inference.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// The Lagrangian bound with branching, which is exact where it proves a grammar optimal; elsewhere also approximate dynamic
    /// programming, then annealing over the set of non-terminal types. Stored as `adp_best`.
    #[serde(rename = "adp_best")]
    Lagrangian,
    /// Approximate dynamic programming as the text describes it.
    AdpPaper,
    /// Only the splitting heuristic, the best of many walks.
    Importance,
    /// Always the best rule by the splitting heuristic.
    Greedy,
    /// Initial step of Martinovic and Van Gool 2013.
    Bayesian,
    /// Splitting heuristic of Zhang et al. 2013.
    Symmetry,
}

/// Settings of [`infer`](super::infer).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// The method of inference.
    pub method: Method,
    /// Walks, of the methods that repeat them. Of [`Method::Lagrangian`] a measure of the work that it may do (see
    /// [`super`]): it stops once its grammar is proven optimal.
    pub iterations: u64,
    /// Seed of all randomness.
    pub seed: u64,
    /// Costs of operations and successors (Eq. 2).
    pub costs: Costs,
    /// Operations that rules may use.
    pub operations: Operations,
    /// `lambda_1` of Eq. 5.
    pub lambda_rule: f64,
    /// `lambda_2` of Eq. 5.
    pub lambda_lines: f64,
    /// Readings of the passages that the text leaves open.
    pub readings: Readings,
}

impl Settings {
    /// Steps that a watch is told of at most: the iterations, and of [`Method::Lagrangian`] what comes before and after.
    pub fn steps(&self) -> u64 {
        match self.method {
            Method::Lagrangian => self.iterations + further_steps(self.iterations),
            Method::AdpPaper | Method::Importance => self.iterations,
            Method::Greedy | Method::Bayesian | Method::Symmetry => 1,
        }
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            method: Method::Lagrangian,
            iterations: 10_000,
            seed: 0,
            costs: Costs::default(),
            operations: Operations::default(),
            lambda_rule: 1.0,
            lambda_lines: 1.0,
            readings: Readings::default(),
        }
    }
}

/// Why no grammar was found.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum InferError {
    /// No facade was given.
    #[error("there is no facade to explain")]
    NoFacade,
    /// A facade is no tiling.
    #[error("facade `{name}` is not a tiling: {source}")]
    NotATiling {
        /// Name of the facade.
        name: String,
        /// The gap, overlap or other fault that stands in its way.
        source: LayoutError,
    },
    /// A part of a facade cannot be split by full lines (Sec. 6.3).
    #[error("facade `{name}` cannot be split by full lines: {source}")]
    Unsplittable {
        /// Name of the facade.
        name: String,
        /// The part that cannot be split.
        source: LayoutError,
    },
    /// A facade has too many distinct edge coordinates.
    #[error("facade `{name}` has edges on a grid of {columns} x {rows}, too many to search")]
    TooLarge {
        /// Name of the facade.
        name: String,
        /// Columns of the grid of edges.
        columns: usize,
        /// Rows of the grid of edges.
        rows: usize,
    },
    /// A cost is out of range.
    #[error(transparent)]
    Cost(#[from] CostError),
    /// Approximate dynamic programming failed.
    #[error(transparent)]
    Adp(#[from] AdpError),
    /// Weighted draws failed.
    #[error(transparent)]
    Program(#[from] ProgramError),
    /// Annealing failed.
    #[error(transparent)]
    Annealing(#[from] AnnealingError),
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Method::Lagrangian => "lagrangian",
            Method::AdpPaper => "adp-paper",
            Method::Importance => "importance",
            Method::Greedy => "greedy",
            Method::Bayesian => "bayesian",
            Method::Symmetry => "symmetry",
        })
    }
}

/// A method's name that is none.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("unknown method `{name}`")]
pub struct UnknownMethod {
    /// The name that was given.
    pub name: String,
}

impl FromStr for Method {
    type Err = UnknownMethod;

    fn from_str(name: &str) -> Result<Self, UnknownMethod> {
        Ok(match name {
            "lagrangian" | "adp" => Method::Lagrangian,
            "adp-paper" => Method::AdpPaper,
            "importance" => Method::Importance,
            "greedy" => Method::Greedy,
            "bayesian" => Method::Bayesian,
            "symmetry" => Method::Symmetry,
            _ => {
                return Err(UnknownMethod {
                    name: name.to_owned(),
                });
            }
        })
    }
}

/// The second stage of [`Method::Lagrangian`] has one walk and one round of annealing for so many iterations.
const SECOND_STAGE_SHARE: u64 = 8;

/// Walks by shortest paths, and as many rounds of annealing, in the second stage of [`Method::Lagrangian`].
pub(super) fn second_stage_steps(iterations: u64) -> u64 {
    (iterations / SECOND_STAGE_SHARE).max(1)
}

/// Maximum steps beyond `iterations`: the Lagrangian bound counts as one, then come the walks and rounds of the
/// second stage.
fn further_steps(iterations: u64) -> u64 {
    1 + 2 * second_stage_steps(iterations)
}
