//! The input of a task.

use std::path::{Path, PathBuf};

use edifice_base::Watched;

/// The input of a task beside its settings.
#[derive(Debug, Clone, Copy)]
pub struct Given<'a> {
    /// File of the instance. Files beside it that have its name up to the first dot belong to it.
    pub path: &'a Path,
    /// Files to learn from, in order of name, of studies that [learn](super::Study::learning): those that the sweep names, or else its
    /// other instances. The instance is not among them.
    pub database: &'a [PathBuf],
    /// Seed of all chance.
    pub seed: u64,
    /// Asked by long tasks whether to go on. The outcome of a task that was stopped is not kept.
    pub watched: &'a Watched<'a>,
}
