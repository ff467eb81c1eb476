//! Wu et al. 2014, *Inverse Procedural Modeling of Facade Layouts*: every table and figure.

use super::{Artefact, Experiment};

/// The paper's tables and figures.
pub const EXPERIMENT: Experiment = Experiment {
    slug: "facade_grammar",
    paper: "Wu, Yan, Dong, Zhang, Wonka 2014: Inverse Procedural Modeling of Facade Layouts",
    artefacts: ARTEFACTS,
};

const ARTEFACTS: &[Artefact] = &[];
