//! Wu et al. 2014, *Inverse Procedural Modeling of Facade Layouts*: every table and figure.

pub mod data;
mod figure_10;
use super::picture;

use super::{Artefact, Experiment};

/// The paper's tables and figures.
pub const EXPERIMENT: Experiment = Experiment {
    slug: "facade_grammar",
    paper: "Wu, Yan, Dong, Zhang, Wonka 2014: Inverse Procedural Modeling of Facade Layouts",
    artefacts: ARTEFACTS,
};

const ARTEFACTS: &[Artefact] = &[Artefact {
    name: "figure_10",
    title: "the facades used for performance testing",
    run: figure_10::run,
}];
