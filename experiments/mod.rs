//! The experiments: settings on one page per paper, one function per artefact. Each paper is a crate of its own, all on `edifice-frame` (options,
//! units, artefacts, the report) and `edifice-sweep`; this one lists them and knows what the program was built from.
//!
//! # How to add a paper
//! 1. Write the crate `experiments/<slug>/` with a `pub const EXPERIMENT: Experiment` that lists its artefacts: the name of a
//!    table or figure (`table_1`, `figure_14`), a title, and a function `fn(&mut Context) -> Result<()>`.
//! 2. Name it in the root's manifest and in `experiments/Cargo.toml` as its neighbours are, add `pub use edifice_experiments_<slug> as <slug>;` and
//!    `&<slug>::EXPERIMENT` to [`ALL`] below.
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

use std::path::Path;
use std::process::ExitCode;

use edifice_base::Result;

pub use edifice_experiments_building_exteriors as building_exteriors;
pub use edifice_experiments_city_proceduralization as city_proceduralization;
pub use edifice_experiments_facade_grammar as facade_grammar;
pub use edifice_experiments_generic as generic;
pub use edifice_experiments_procedural_logic as procedural_logic;
pub use edifice_experiments_structure_completion as structure_completion;
pub use edifice_frame::{
    Args, Artefact, Budget, Context, Experiment, Journal, Options, Own, Pictured, Program, Report,
    ReportDocument, Shown, Sources, layouts, silence,
};
pub use edifice_peers as peers;
pub use edifice_sweep as sweep;

use sweep::Study;

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

/// This program: all experiments, and what it was built from.
pub static PROGRAM: Program = Program {
    experiments: ALL,
    sources: include!(concat!(env!("OUT_DIR"), "/sources.rs")),
};

/// Every method that sweeps can run.
pub fn studies() -> Vec<Study> {
    STUDIES.iter().map(|study| study().of(&PROGRAM)).collect()
}

/// The `main` of a paper's own binary: parses the options, runs, prints the summary.
pub fn main(experiment: &'static Experiment) -> ExitCode {
    edifice_frame::main(&PROGRAM, experiment)
}

/// Runs experiments and writes the report.
///
/// # Errors
/// As [`edifice_frame::run`].
pub fn run(experiments: &[&'static Experiment], options: &Options) -> Result<Report> {
    edifice_frame::run(&PROGRAM, experiments, options)
}

/// Runs with Ctrl-C caught, and prints the summary to standard error.
///
/// # Errors
/// As [`edifice_frame::run_to_end`].
pub fn run_to_end(experiments: &[&'static Experiment], args: Args) -> Result<()> {
    edifice_frame::run_to_end(&PROGRAM, experiments, args)
}

/// All documents that pictures of a report show, by paper and artefact. Shipped ones need no report.
pub fn shown(report: &Path) -> Vec<Shown> {
    edifice_frame::shown(&PROGRAM, report)
}

/// The documents named `[PAPER/]ARTEFACT[/DOCUMENT]` of a report.
///
/// # Errors
/// As [`edifice_frame::documents`].
pub fn documents(wanted: &str, report: &Path) -> Result<Vec<ReportDocument>> {
    edifice_frame::documents(&PROGRAM, wanted, report)
}
