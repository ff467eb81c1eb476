//! Settings of the studies of this paper.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use edifice_structure_completion::method::Method;
use edifice_structure_completion::policy::Budget;
use edifice_structure_completion::score::Term;
use edifice_structure_completion::task::Task;

/// Settings of completion.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Complete {
    /// Method of completion.
    pub method: Method,
    /// Part that is hidden.
    pub task: Task,
    /// Hide by the frozen mask of the facade, which its content alone decides, and not by the seed.
    pub frozen: bool,
    /// Scoring functions whose weight is set to 0, of `paper`.
    pub left_out: Vec<Term>,
    /// Policies of a generation, of `paper`.
    pub population: usize,
    /// Generations after the first, of `paper`.
    pub generations: u64,
    /// Candidates of each policy, of `paper`.
    pub draws: usize,
}

impl Default for Complete {
    fn default() -> Self {
        Self {
            method: Method::Best,
            task: Task::Side50,
            frozen: false,
            left_out: Vec::new(),
            population: Budget::PAPER.population,
            generations: Budget::PAPER.generations,
            draws: Budget::PAPER.draws,
        }
    }
}
