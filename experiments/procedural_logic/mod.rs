//! Weissenberg et al. 2013, *Is there a Procedural Logic to Architecture?*: every figure and every
//! number of the text.

mod compression;
pub mod corruption;
pub mod data;
mod figure_3;
mod figure_4;
mod figure_5;
mod figure_6;
mod frequent_rules;
pub mod gold;
mod lossless;
pub mod noise;
pub mod outline;
mod parsed;
mod readings;
mod retrieval_search;
mod segmentation;
mod settings;
pub mod shipped;
pub mod study;
pub mod trial;
pub mod trivial;
pub mod words;

pub use parsed::parsed;

use edifice_base::{Error, Result};
use edifice_frame::{Artefact, Experiment};
use edifice_grammar::Grammar;
use edifice_procedural_logic::{Extent, Parameters, baseline_grammar};
use edifice_report::{Align, Row, Table};
use edifice_shape::{Facade, LabelGrid};

/// The paper's figures and the numbers of its text.
pub const EXPERIMENT: Experiment = Experiment {
    slug: "procedural_logic",
    paper: "Weissenberg, Riemenschneider, Prasad, Van Gool 2013: Is there a Procedural Logic to Architecture?",
    artefacts: ARTEFACTS,
    documents: |_| Vec::new(),
};

/// The grammar of one facade with the parameters for compression, for comparisons with other papers.
///
/// # Errors
/// Those of the method.
pub fn grammar(facade: &Facade) -> Result<Grammar> {
    baseline_grammar(facade, &Parameters::COMPRESSION).map_err(Error::method)
}

/// The grammar of the picture of one facade: areas of one label, Eq. 3 divided by the size of the facade as it is written,
/// the parameters for compression. It derives the picture, not the tiling.
///
/// # Errors
/// Those of the method.
pub fn picture_grammar(facade: &Facade) -> Result<Grammar> {
    let grid = LabelGrid::from_facade(facade, None).map_err(Error::method)?;
    let parameters = Parameters {
        extent: Extent::Facade,
        ..Parameters::COMPRESSION
    };
    edifice_procedural_logic::picture_grammar(&grid, &parameters).map_err(Error::method)
}

const ARTEFACTS: &[Artefact] = &[
    Artefact {
        name: "lossless",
        title: "every facade from its rules, pixel by pixel (Sec. 5.2)",
        run: lossless::run,
    },
    Artefact {
        name: "compression",
        title: "number of rules over alpha, b_p and b_h (Sec. 5.3, Eq. 12)",
        run: compression::run,
    },
    Artefact {
        name: "figure_3",
        title: "distance matrices in the order of the dendrogram",
        run: figure_3::run,
    },
    Artefact {
        name: "figure_4",
        title: "cumulative match characteristics of facade retrieval",
        run: figure_4::run,
    },
    Artefact {
        name: "retrieval_search",
        title: "parameters searched for retrieval (Sec. 5.4)",
        run: retrieval_search::run,
    },
    Artefact {
        name: "figure_5",
        title: "time and number of rules against the number of facades",
        run: figure_5::run,
    },
    Artefact {
        name: "figure_6",
        title: "virtual facades: starting rules by sigma",
        run: figure_6::run,
    },
    Artefact {
        name: "frequent_rules",
        title: "the most frequent rules, in words (Sec. 5.5)",
        run: frequent_rules::run,
    },
    Artefact {
        name: "segmentation",
        title: "inexact labels of the same facades, as given and cleaned",
        run: segmentation::run,
    },
    Artefact {
        name: "noise",
        title: "labels as a segmentation gives them: rules and retrieval against faults",
        run: noise::run,
    },
    Artefact {
        name: "readings",
        title: "what the text leaves open: rules and retrieval under each reading",
        run: readings::run,
    },
];

/// Ranks of Fig. 4.
const RANKS: usize = 20;

/// A table with the data set in its first column, then words, then numbers.
fn data_table(title: impl Into<String>, words: &[&str], numbers: &[&str]) -> Table {
    let named = std::iter::once(&"data").chain(words);
    let table = named.fold(Table::new(title), |t, &name| t.column(name, Align::Left));
    table.numbers(numbers.iter().copied())
}

/// A row of an artefact's CSV.
fn row(dataset: &str, method: &str, instance: impl Into<String>, metric: &str, value: f64) -> Row {
    Row {
        dataset: dataset.into(),
        method: method.into(),
        instance: instance.into(),
        metric: metric.into(),
        value,
        ..Row::default()
    }
}
