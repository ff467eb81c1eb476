//! Fan, Musialski, Liu, Wonka 2014, *Structure Completion for Facade Layouts*: the benchmark that the paper lacks, and
//! its figures.

mod benchmark;
mod completion;
pub mod data;
mod figure_12;
mod figure_19;
mod figure_9;
mod figures;
mod folds;
mod lattices;
pub mod leaderboard;
mod optimality;
mod picture;
mod plausibility;
mod published;
mod results;
mod settings;
pub mod study;
mod timing;
mod trial;
mod weights;

use edifice_frame::{Artefact, Experiment};
use edifice_report::Row;

/// The benchmark, and the paper's figures and numbers.
pub const EXPERIMENT: Experiment = Experiment {
    slug: "structure_completion",
    paper: "Fan, Musialski, Liu, Wonka 2014: Structure Completion for Facade Layouts",
    artefacts: ARTEFACTS,
    documents: |_| Vec::new(),
};

const ARTEFACTS: &[Artefact] = &[
    Artefact {
        name: "benchmark",
        title: "made grids, then parts of facades hidden and completed: agreement, coherence, doors, counts, calibration, draws",
        run: benchmark::run,
    },
    Artefact {
        name: "completion",
        title: "parts of whole facades hidden and completed: five tasks, all methods, cross-validated",
        run: completion::run,
    },
    Artefact {
        name: "lattices",
        title: "published lattices of windows in cells (Hensel et al. 2021), completed by the default model",
        run: lattices::run,
    },
    Artefact {
        name: "timing",
        title: "seconds of a completion and of learning (Sec. 6, Timing)",
        run: timing::run,
    },
    Artefact {
        name: "weights",
        title: "known weights recovered from drawn layouts (Sec. 4.4), by an unbiased update and by Eq. 20",
        run: weights::run,
    },
    Artefact {
        name: "optimality",
        title: "the chain over grid lines against enumeration and annealing",
        run: optimality::run,
    },
    Artefact {
        name: "figure_8",
        title: "optimized policies against a fixed one",
        run: figures::figure_8::run,
    },
    Artefact {
        name: "figure_9",
        title: "pairs of truth and completion",
        run: figure_9::run,
    },
    Artefact {
        name: "figure_10",
        title: "ever fewer observed elements",
        run: figures::figure_10::run,
    },
    Artefact {
        name: "figure_11",
        title: "observed elements in two regions apart",
        run: figures::figure_11::run,
    },
    Artefact {
        name: "figure_12",
        title: "several completions of one facade",
        run: figure_12::run,
    },
    Artefact {
        name: "figure_13",
        title: "limits: irregular facades",
        run: figures::figure_13::run,
    },
    Artefact {
        name: "figure_14",
        title: "simulated annealing on the score",
        run: figures::figure_14::run,
    },
    Artefact {
        name: "figure_15",
        title: "a sketched facade, edited and completed by commands",
        run: figures::figure_15::run,
    },
    Artefact {
        name: "figure_16",
        title: "the weights against the size of the training set",
        run: figures::figure_16::run,
    },
    Artefact {
        name: "figure_17",
        title: "completions without the symmetry term",
        run: figures::figure_18::figure_17,
    },
    Artefact {
        name: "figure_18",
        title: "completions with each scoring function left out",
        run: figures::figure_18::figure_18,
    },
    Artefact {
        name: "figure_19",
        title: "low-rank completion and ours",
        run: figure_19::run,
    },
    Artefact {
        name: "figure_20",
        title: "a completed facade on a box (with Fig. 1 and 21)",
        run: figures::figure_20::run,
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
