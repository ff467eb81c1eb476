//! The studies of this paper, for sweeps.

use super::trial::Completion;
use edifice_sweep::{Better, Study};

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
        .asking(&["task", "frozen"])
}
