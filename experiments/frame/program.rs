//! The program around the experiments, which alone knows them all.

use super::{Experiment, Sources};

/// A program that runs experiments: which ones it has, and the sources that it was built from.
pub struct Program {
    /// Every paper's experiment, in the order of the report.
    pub experiments: &'static [&'static Experiment],
    /// The sources that it was built from.
    pub sources: Sources,
}
