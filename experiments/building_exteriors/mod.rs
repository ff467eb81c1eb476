//! Fan and Wonka 2016, *A Probabilistic Model for Exteriors of Residential Buildings*: how houses
//! look, on a database with a known truth and on two sets of real houses.

mod data;
mod design_figures;
mod facade_figures;
mod figure_10;
mod figure_11;
mod figure_12;
mod figure_14;
mod generation;
mod generation_figures;
mod generation_speed;
mod held_out;
mod hidden_openings;
mod learning;
mod likeness;
mod mixture_figures;
mod openings;
mod photographs;
mod real_sets;
mod reasons;
mod speed;
pub mod study;
mod views;

use edifice_frame::{Artefact, Context, Experiment, Pictured};
use edifice_model::hierarchy::{Constant, Settings, Sweep};

/// The paper's tables and figures.
pub const EXPERIMENT: Experiment = Experiment {
    slug: "building_exteriors",
    paper: "Fan, Wonka 2016: A Probabilistic Model for Exteriors of Residential Buildings",
    artefacts: ARTEFACTS,
    documents,
};

/// The made houses that a figure shows.
fn documents(artefact: &str) -> Vec<Pictured> {
    let lines = match artefact {
        "figure_8" | "figure_9" => vec![facade_figures::HOUSE],
        "figure_16" => held_out::first_held_out(),
        "figure_19" => held_out::first_without_garage(),
        _ => Vec::new(),
    };
    let line = |line| Pictured::Line(data::HOUSES.to_owned(), line);
    lines.into_iter().map(line).collect()
}

const ARTEFACTS: &[Artefact] = &[
    Artefact {
        name: "figure_6",
        title: "energy of mass models against iterations",
        run: generation_figures::figure_6,
    },
    Artefact {
        name: "figure_7",
        title: "energy of facades against generations",
        run: facade_figures::figure_7,
    },
    Artefact {
        name: "figure_8",
        title: "a house made again from its attributes",
        run: facade_figures::figure_8,
    },
    Artefact {
        name: "figure_9",
        title: "what each attribute does",
        run: facade_figures::figure_9,
    },
    Artefact {
        name: "figure_13",
        title: "houses of the means of a Gaussian mixture",
        run: mixture_figures::figure_13,
    },
    Artefact {
        name: "figure_14_houses",
        title: "houses of a Gaussian mixture and of ours, bounding box and garage given",
        run: mixture_figures::figure_14,
    },
    Artefact {
        name: "figure_15",
        title: "six synthesized houses",
        run: generation_figures::figure_15,
    },
    Artefact {
        name: "figure_16",
        title: "completions of houses seen from the street, beside the truth",
        run: design_figures::figure_16,
    },
    Artefact {
        name: "figure_17",
        title: "three houses of marked facades and footprints",
        run: photographs::figure_17,
    },
    Artefact {
        name: "figure_18",
        title: "several completions of one house",
        run: design_figures::figure_18,
    },
    Artefact {
        name: "figure_19",
        title: "an editing sequence",
        run: design_figures::figure_19,
    },
    Artefact {
        name: "generation_speed",
        title: "seconds of mass models, roofs, facades and whole houses",
        run: generation_speed::run,
    },
    Artefact {
        name: "generation",
        title: "how near houses come to their attributes, by method",
        run: generation::run,
    },
    Artefact {
        name: "figure_10",
        title: "the styles found, and what sets them apart",
        run: figure_10::run,
    },
    Artefact {
        name: "figure_10_real",
        title: "the styles found in real houses",
        run: real_sets::styles,
    },
    Artefact {
        name: "figure_11_left",
        title: "lateral edges, beside those of the generator",
        run: figure_11::left,
    },
    Artefact {
        name: "figure_11_real",
        title: "lateral edges found in real houses",
        run: real_sets::edges,
    },
    Artefact {
        name: "figure_11_right",
        title: "training houses that contribute to a sample",
        run: figure_11::right,
    },
    Artefact {
        name: "figure_12_left",
        title: "held-out negative log-likelihood of five models",
        run: figure_12::left,
    },
    Artefact {
        name: "figure_12_right",
        title: "held-out negative log-likelihood by training houses",
        run: figure_12::right,
    },
    Artefact {
        name: "likeness",
        title: "drawn houses told from real ones that no model has seen",
        run: likeness::run,
    },
    Artefact {
        name: "figure_14",
        title: "garage and front porch on top of each other (also Fig. 13)",
        run: figure_14::run,
    },
    Artefact {
        name: "learning",
        title: "seconds of the whole structure search",
        run: learning::run,
    },
    Artefact {
        name: "openings",
        title: "windows and doors given back to the closed walls of city models",
        run: openings::run,
    },
    Artefact {
        name: "speed",
        title: "seconds and memory of one run of EM by houses",
        run: speed::run,
    },
];

/// Settings of every model: cardinalities as in the paper at the paper's budget, up to 12 styles by
/// default, each searched in full on all rows. Columns that are constant among the training houses stay.
fn settings(ctx: &mut Context) -> Settings {
    let most = ctx.budget().choose(3, 12, 25);
    ctx.setting("most_styles", most);
    Settings {
        styles: 2..=most,
        most_states: ctx.budget().choose(4, 25, 25),
        restarts: ctx.budget().choose(1, 4, 4),
        constant: Constant::Keep,
        sweep: Sweep::All,
        searched: usize::MAX,
        ..Settings::default()
    }
}
