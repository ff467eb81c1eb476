//! Failures of programs and engines.

use crate::ModelError;

/// One variant per way in which a program cannot be run or an engine cannot serve it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ProgramError {
    /// Two choices of one run at one address.
    #[error("two choices are made at the address `{at}`")]
    Duplicate {
        /// The address.
        at: String,
    },
    /// A density or a value that is not a number, or an infinite weight: a parameter is out of its range.
    #[error(
        "at `{at}`: the density or the value is not a number (a parameter is out of its range)"
    )]
    NotANumber {
        /// The address, or which observation.
        at: String,
    },
    /// A choice with infinitely many values where all are to be tried.
    #[error("the choice at `{at}` has infinitely many values: exact inference needs finitely many")]
    NotFinite {
        /// The address.
        at: String,
    },
    /// A choice of whole numbers where derivatives are needed.
    #[error("the choice at `{at}` is of whole numbers: this engine needs real ones")]
    NotReal {
        /// The address.
        at: String,
    },
    /// Other choices in one run than in another, where they must be the same.
    #[error(
        "the choice at `{at}` is not made in every run, or has other values: this engine needs the same choices in all runs"
    )]
    Changing {
        /// The address.
        at: String,
    },
    /// More ways through the program than may be tried.
    #[error("the program has more than {most} ways through: compile it to a network, or sample")]
    TooMany {
        /// The number allowed.
        most: usize,
    },
    /// No way through the program with a positive weight.
    #[error("no run has a positive weight, {tried} were tried")]
    Impossible {
        /// Number of runs.
        tried: usize,
    },
    /// A setting out of its range.
    #[error("`{name}` must be {must}")]
    Setting {
        /// The setting.
        name: &'static str,
        /// Its range, in words.
        must: &'static str,
    },
    /// The sampler's own failure.
    #[error("the sampler failed: {0}")]
    Engine(String),
    /// A table or JSON could not be written.
    #[error("the draws cannot be written: {0}")]
    Write(String),
    /// The network refuses.
    #[error(transparent)]
    Model(#[from] ModelError),
}
