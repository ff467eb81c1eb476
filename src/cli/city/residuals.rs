//! The option `--residuals`.

use clap::ValueEnum;

/// The treatment of residuals.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Residuals {
    /// They are kept, and carried along by edits.
    Keep,
    /// They are left out: parts stand where the rules put them.
    Drop,
}
