//! Wu et al. 2014, *Inverse Procedural Modeling of Facade Layouts*: every table and figure.
//!
//! Settings stand here; each artefact is a file of its own. Seeds and facades for each budget are in
//! `facade_grammar/compare.rs`.

mod city;
mod compare;
mod costs;
pub mod data;
mod figure_10;
mod figure_12;
mod figure_13;
mod figure_14;
mod figure_9;
mod held_out;
mod joint_real;
mod judge;
mod library;
mod likeness;
mod optimality;
mod procedural_logic;
mod projection;
mod published;
mod ratios;
mod readings;
mod references;
mod regularization;
mod room;
mod runs;
mod settings;
mod speed;
pub mod study;
mod table_1;
mod table_2;
mod table_3;
mod table_4;
mod table_5;
mod told_apart;
mod tolerance;
mod trial;

use edifice_facade_grammar::Method;
use edifice_frame::{Artefact, Budget, Experiment, Pictured, picture};

/// This project's configuration of approximate dynamic programming.
const BEST: Method = Method::Lagrangian;
/// The paper's, as far as its text says.
const PAPER: Method = Method::AdpPaper;

/// The two numbers of iterations of Table 1.
fn iterations(budget: Budget) -> (u64, u64) {
    budget.choose((20, 100), (2_000, 10_000), (2_000, 10_000))
}

/// The paper's tables and figures.
pub const EXPERIMENT: Experiment = Experiment {
    slug: "facade_grammar",
    paper: "Wu, Yan, Dong, Zhang, Wonka 2014: Inverse Procedural Modeling of Facade Layouts",
    artefacts: ARTEFACTS,
    documents,
};

/// The shipped facades that a figure shows or begins from.
fn documents(artefact: &str) -> Vec<Pictured> {
    let made = |names: &[&str]| {
        let place = |name: &&str| format!("facade_grammar/layouts/{name}.facade.json");
        names.iter().map(place).map(Pictured::File).collect()
    };
    let example =
        |ending: &str| Pictured::File(format!("facade_grammar/{}{ending}", data::FIGURE_9));
    match artefact {
        // The grammar that the paper prints.
        "figure_9" => vec![example(".cga")],
        "figure_10" => {
            let layouts = edifice_datasets::files().into_iter().map(|(path, _)| path);
            let layouts = layouts.filter(|p| {
                p.starts_with("facade_grammar/layouts/") && p.ends_with(".facade.json")
            });
            let all = [example(".facade.json")].into_iter();
            all.chain(layouts.map(Pictured::File)).collect()
        }
        "figure_11" => vec![example(".facade.json")],
        "figure_12" => made(&[figure_12::FACADE]),
        "figure_13" => made(&figure_13::FACADES),
        "figure_14" => made(&figure_14::FACADES),
        "figure_15" => made(&city::LOW_RISE.concat()),
        "figure_16" => made(&city::HIGH_RISE.concat()),
        _ => Vec::new(),
    }
}

const ARTEFACTS: &[Artefact] = &[
    Artefact {
        name: "table_1",
        title: "cost, rules and time of ADP, importance sampling and greedy",
        run: table_1::run,
    },
    Artefact {
        name: "table_2",
        title: "cost of the automatic methods, split rule only",
        run: table_2::run,
    },
    procedural_logic::RANGES,
    Artefact {
        name: "table_3",
        title: "scores that people gave",
        run: table_3::run,
    },
    Artefact {
        name: "table_4",
        title: "precision and recall of non-terminal regions, by kind of reference",
        run: table_4::run,
    },
    Artefact {
        name: "table_5",
        title: "costs of the rules and what they do to precision and recall",
        run: table_5::run,
    },
    Artefact {
        name: "figure_9",
        title: "the grammar of the example",
        run: figure_9::figure_9,
    },
    Artefact {
        name: "figure_10",
        title: "the facades used for performance testing",
        run: figure_10::run,
    },
    Artefact {
        name: "figure_11",
        title: "the example with repeatABA and symsplit",
        run: figure_9::figure_11,
    },
    Artefact {
        name: "figure_12",
        title: "a facade resized by its grammar, windows aligned",
        run: figure_12::run,
    },
    Artefact {
        name: "figure_13",
        title: "joint extraction from four facades",
        run: figure_13::run,
    },
    Artefact {
        name: "library",
        title: "one parametric library for many real facades",
        run: library::run,
    },
    Artefact {
        name: "tolerance",
        title: "cost against the share of the area that may become wrong",
        run: tolerance::run,
    },
    Artefact {
        name: "figure_14",
        title: "cost and time against iterations",
        run: figure_14::run,
    },
    Artefact {
        name: "figure_15",
        title: "a low-rise town of stochastic variations",
        run: city::figure_15,
    },
    Artefact {
        name: "figure_16",
        title: "high-rise buildings of stochastic variations",
        run: city::figure_16,
    },
    Artefact {
        name: "regularization",
        title: "regularization of annotations by quadratic programming (Sec. 3.3)",
        run: regularization::run,
    },
    Artefact {
        name: "readings",
        title: "what the text leaves open, and what it does to the costs",
        run: readings::run,
    },
    Artefact {
        name: "optimality",
        title: "lower bounds and proofs of optimality for small facades",
        run: optimality::run,
    },
    Artefact {
        name: "costs",
        title: "costs and proven bounds of every facade",
        run: costs::run,
    },
    Artefact {
        name: "speed",
        title: "cost per iteration against terminals",
        run: speed::run,
    },
];
