//! Demir, Aliaga and Benes 2014, *Proceduralization of Buildings at City Scale*: cities as grammars of
//! instances, on a made city with a known grammar and on real ones.

mod clustering;
mod communities;
pub mod country;
mod data;
mod exhibits;
mod figure_10;
mod figure_3;
mod figure_4;
mod figure_5;
mod figure_6;
mod figure_7;
mod figure_8;
mod figure_9;
mod ingolstadt;
mod judge;
mod new_squares;
mod photographs;
mod recovery;
mod scaling;
pub mod study;
mod table_1;
mod town_plan;

use edifice_frame::{Artefact, Experiment};

/// The paper's tables and figures, and what goes beyond them.
pub const EXPERIMENT: Experiment = Experiment {
    slug: "city_proceduralization",
    paper: "Demir, Aliaga, Benes 2014: Proceduralization of Buildings at City Scale",
    artefacts: ARTEFACTS,
    documents: |_| Vec::new(),
};

const ARTEFACTS: &[Artefact] = &[
    Artefact {
        name: "table_1",
        title: "sizes of four levels, both modes",
        run: table_1::run,
    },
    Artefact {
        name: "figure_3",
        title: "buildings taken apart",
        run: figure_3::run,
    },
    Artefact {
        name: "figure_4",
        title: "types of buildings, weights of features",
        run: figure_4::run,
    },
    Artefact {
        name: "figure_5",
        title: "a rule and what it derives to",
        run: figure_5::run,
    },
    Artefact {
        name: "figure_6",
        title: "communities, level by level",
        run: figure_6::run,
    },
    Artefact {
        name: "figure_7",
        title: "quality against compression",
        run: figure_7::run,
    },
    Artefact {
        name: "figure_8",
        title: "a city beside its grammar's",
        run: figure_8::run,
    },
    Artefact {
        name: "figure_9",
        title: "a new city in a drawn shape",
        run: figure_9::run,
    },
    Artefact {
        name: "new_squares",
        title: "squares of new cities beside those of the old",
        run: new_squares::run,
    },
    Artefact {
        name: "town_plan",
        title: "districts, blocks and rows of a city's grammar",
        run: town_plan::run,
    },
    Artefact {
        name: "figure_10",
        title: "where a view was taken",
        run: figure_10::run,
    },
    Artefact {
        name: "recovery",
        title: "cuts, types and motifs of a known grammar",
        run: recovery::run,
    },
    Artefact {
        name: "clustering",
        title: "Ward's hierarchy against k-means",
        run: clustering::run,
    },
    Artefact {
        name: "communities",
        title: "Girvan-Newman against Louvain",
        run: communities::run,
    },
    Artefact {
        name: "scaling",
        title: "seconds by buildings",
        run: scaling::run,
    },
];
