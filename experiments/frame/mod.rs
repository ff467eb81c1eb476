//! The frame that all papers' experiments share: options, resumable units, artefacts, the report.

pub mod averages;
mod context;
mod document;
mod documents;
mod estimate;
mod index;
mod journal;
pub mod layouts;
pub mod lock;
pub mod memory;
mod options;
mod own;
mod parsed;
pub mod picture;
pub mod place;
mod program;
mod progress;
pub mod provenance;
pub mod roc;
mod run;
mod sources;
mod times;
mod verify;

pub use context::Context;
pub use documents::{Pictured, ReportDocument, Shown, documents, shown};
pub use index::{SWEEPS, write_index};
pub use journal::Journal;
pub use options::{Args, Budget, Options};
pub use own::Own;
pub use parsed::Parsed;
pub use program::Program;
pub use progress::{Progress, silence};
pub use run::{Report, main, run, run_to_end};
pub use sources::Sources;

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
