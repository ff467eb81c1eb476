//! The result of a task.

use super::study::Outcome;

/// The result of a task.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Index of the arm.
    pub arm: usize,
    /// Index of the instance.
    pub instance: usize,
    /// Seed as the file counts it.
    pub seed: u64,
    /// Its outcome; `None` if it failed or is missing.
    pub outcome: Option<Outcome>,
    /// Why there is none.
    pub failure: Option<String>,
    /// True if the task has not run: then it has not failed.
    pub missing: bool,
    /// Processor seconds.
    pub seconds: f64,
}
