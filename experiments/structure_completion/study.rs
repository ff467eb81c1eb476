//! The studies of this paper, for sweeps.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::trial::Completion;
use crate::sweep::{Better, Study};
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
            left_out: Vec::new(),
            population: Budget::PAPER.population,
            generations: Budget::PAPER.generations,
            draws: Budget::PAPER.draws,
        }
    }
}

/// Completion of one facade by a model learnt from others.
pub fn complete() -> Study {
    const METRICS: &[(&str, Better)] = &[
        ("f1", Better::Higher),
        ("iou", Better::Higher),
        ("count_error", Better::Lower),
    ];
    let about = "completion of facade layouts (Fan et al. 2014): part of a facade is hidden, and completed by what others teach";
    let (name, data) = ("structure_completion/complete", "facade_grammar");
    Study::trial::<Completion>(name, about, data, METRICS)
        .learning()
        .made_of(
            &["edifice-structure-completion", "edifice-io"],
            "structure_completion",
        )
        .asking(&["task"])
}
