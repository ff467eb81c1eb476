//! The studies of this paper, for sweeps.

use super::trial::Inference;
use edifice_sweep::{Better, Study};

/// Grammar inference on one facade.
pub fn infer() -> Study {
    const METRICS: &[(&str, Better)] = &[
        ("cost", Better::Lower),
        ("rules", Better::Lower),
        ("precision", Better::Higher),
        ("recall", Better::Higher),
        ("f_score", Better::Higher),
    ];
    let about = "grammar inference on facade layouts (Wu et al. 2014); precision, recall and F where a grammar `NAME.grammar.json` or `NAME.cga` lies beside the facade";
    Study::trial::<Inference>("facade_grammar/infer", about, "facade_grammar", METRICS)
        .made_of(&["edifice-facade-grammar", "edifice-io"], "facade_grammar")
        .asking(&["ops", "split_cost", "repeat_cost", "successor_cost"])
}
