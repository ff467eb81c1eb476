//! The frame that all papers' experiments share: options, resumable units, artefacts, the report.

mod context;
mod document;
mod documents;
mod estimate;
mod index;
mod journal;
pub(super) mod lock;
pub(super) mod memory;
mod options;
mod own;
mod progress;
pub(super) mod provenance;
mod run;
mod times;
mod verify;

pub use context::Context;
pub use documents::{Pictured, ReportDocument, Shown, documents, shown};
pub(super) use index::{SWEEPS, write_index};
pub use journal::Journal;
pub use options::{Args, Budget, Options};
pub use own::Own;
pub(crate) use progress::Progress;
pub use progress::silence;
pub(crate) use run::main;
pub use run::{Report, run, run_to_end};

/// One table or figure of a paper.
pub struct Artefact {
    /// Name of its files: `table_1`, `figure_14`.
    pub name: &'static str,
    /// Its subject, in a line.
    pub title: &'static str,
    /// Makes it.
    pub run: fn(&mut Context) -> edifice_base::Result<()>,
}

/// One paper's experiments.
pub struct Experiment {
    /// The paper's slug, which names its folder under the report.
    pub slug: &'static str,
    /// Authors, year and title.
    pub paper: &'static str,
    /// Its tables and figures, in the order of the report.
    pub artefacts: &'static [Artefact],
    /// The shipped documents that the picture of an artefact shows, by the artefact's name; none for most.
    pub documents: fn(&str) -> Vec<Pictured>,
}

#[cfg(test)]
mod tests;
