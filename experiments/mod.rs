//! The experiments: settings on one page per paper, one function per artefact.
//!
//! # How to add a paper
//! 1. Write `experiments/<slug>.rs` with a `pub const EXPERIMENT: Experiment` that lists its artefacts: the name of a
//!    table or figure (`table_1`, `figure_14`), a title, and a function `fn(&mut Context) -> Result<()>`.
//! 2. Add `pub mod <slug>;` and `&<slug>::EXPERIMENT` to [`ALL`] below.
//! 3. Write `experiments/bin/<slug>.rs` and its `[[bin]]` in `experiments/Cargo.toml`: `fn main() -> std::process::ExitCode { edifice_experiments::main(&edifice_experiments::<slug>::EXPERIMENT) }`.
//!
//! # What an artefact's function does
//! ```ignore
//! fn table_1(ctx: &mut Context) -> Result<()> {
//!     let seeds = ctx.budget().choose(1, 3, 10);                       // smoke, default, paper
//!     ctx.setting("seeds", seeds);                                     // goes to run.json and keys the journal
//!     let path = ctx.shipped("facade_grammar/published.csv")?;         // a file or folder of datasets/, digest recorded
//!     let units: Vec<_> = /* (facade, method, seed) */;
//!     let results: Vec<Answer> = ctx.units(&units, |u| u.key(), |u| run(u))?;   // parallel, in order, resumable
//!     for (unit, answer) in units.iter().zip(&results) {
//!         ctx.observe(Row { dataset: "shipped".into(), method: unit.method.to_string(), .. });   // -> table_1.csv
//!     }
//!     ctx.table(&table);                                               // -> table_1.md
//!     ctx.figure("table_1", &figure)?;                                 // -> table_1.svg, table_1.png
//!     ctx.compare("mean cost of ADP", "109.4", format!("{mean:.1}"));  // beside the paper, in table_1.md
//!     ctx.note("Needs ...");
//!     Ok(())
//! }
//! ```
//! Results of a unit (`Answer`) are `Serialize + DeserializeOwned`: they go to the journal, and a run that was killed
//! takes them from there. Time a unit inside its function (it runs on one thread), never around [`Context::units`].

mod averages;
mod frame;
mod generic;
pub mod layouts;
mod parsed;
pub mod peers;
mod picture;
mod roc;
pub mod sweep;

pub mod building_exteriors;
pub mod city_proceduralization;
pub mod facade_grammar;
pub mod procedural_logic;
pub mod structure_completion;

use std::process::ExitCode;

use sweep::Study;

pub use frame::{
    Args, Artefact, Budget, Context, Experiment, Journal, Options, Own, Pictured, Report,
    ReportDocument, Shown, documents, run, run_to_end, shown, silence,
};

/// Every paper's experiment, in the order of the report.
pub const ALL: &[&Experiment] = &[
    &building_exteriors::EXPERIMENT,
    &city_proceduralization::EXPERIMENT,
    &facade_grammar::EXPERIMENT,
    &procedural_logic::EXPERIMENT,
    &structure_completion::EXPERIMENT,
];

/// Every method that sweeps can run.
const STUDIES: &[fn() -> Study] = &[
    // One line each.
    building_exteriors::study::generate,
    building_exteriors::study::learn,
    city_proceduralization::study::proceduralize,
    facade_grammar::study::infer,
    generic::annealing::study,
    generic::genetic::study,
    generic::gmm::study,
    generic::network::study,
    procedural_logic::study::retrieval,
    structure_completion::study::complete,
];

/// Every method that sweeps can run.
pub fn studies() -> Vec<Study> {
    STUDIES.iter().map(|study| study()).collect()
}

/// The `main` of a paper's own binary: parses the options, runs, prints the summary.
pub fn main(experiment: &'static Experiment) -> ExitCode {
    frame::main(experiment)
}
