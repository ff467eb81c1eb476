//! The studies of this paper, for sweeps.

use super::trial::Ranking;
use edifice_sweep::{Better, Study};

/// Retrieval of facades without architectural change among all facades of the sweep.
pub fn retrieval() -> Study {
    const METRICS: &[(&str, Better)] = &[
        ("rank_1", Better::Higher),
        ("rank_2", Better::Higher),
        ("rank_5", Better::Higher),
        ("rank_20", Better::Higher),
        ("queries", Better::Higher),
        ("rules", Better::Lower),
    ];
    let about = "retrieval of facades of equal architecture (Weissenberg et al. 2013, Fig. 4): the facade is the query";
    let (name, data) = ("procedural_logic/retrieval", "facade_grammar");
    Study::trial::<Ranking>(name, about, data, METRICS)
        .learning()
        .made_of(
            &["edifice-procedural-logic", "edifice-io"],
            "procedural_logic",
        )
        .asking(&["sizes"])
}
