//! Fan, Musialski, Liu, Wonka 2014, *Structure Completion for Facade Layouts*: the benchmark that the paper lacks, and
//! its figures.

mod completion;
pub mod data;
mod figure_12;
mod figure_19;
mod figure_9;
mod folds;
mod optimality;
mod picture;
mod plausibility;
mod results;
mod timing;

use super::{Artefact, Experiment};
use crate::report::Row;

/// The benchmark, and the paper's figures and numbers.
pub const EXPERIMENT: Experiment = Experiment {
    slug: "structure_completion",
    paper: "Fan, Musialski, Liu, Wonka 2014: Structure Completion for Facade Layouts",
    artefacts: ARTEFACTS,
};

const ARTEFACTS: &[Artefact] = &[
    Artefact {
        name: "completion",
        title: "parts of whole facades hidden and completed: five tasks, all methods, cross-validated",
        run: completion::run,
    },
    Artefact {
        name: "timing",
        title: "seconds of a completion and of learning (Sec. 6, Timing)",
        run: timing::run,
    },
    Artefact {
        name: "optimality",
        title: "the chain over grid lines against enumeration and annealing",
        run: optimality::run,
    },
    Artefact {
        name: "figure_9",
        title: "pairs of truth and completion",
        run: figure_9::run,
    },
    Artefact {
        name: "figure_12",
        title: "several completions of one facade",
        run: figure_12::run,
    },
    Artefact {
        name: "figure_19",
        title: "low-rank completion and ours",
        run: figure_19::run,
    },
];

/// A row of an artefact's CSV.
fn row(
    dataset: &str,
    method: &str,
    instance: String,
    seed: Option<u64>,
    metric: &str,
    value: f64,
) -> Row {
    Row {
        dataset: dataset.into(),
        method: method.into(),
        instance,
        seed,
        metric: metric.into(),
        value,
        unit: if metric == "seconds" { "s" } else { "" }.into(),
        ..Row::default()
    }
}
