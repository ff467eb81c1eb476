//! `edifice sweep verify`.

use std::path::PathBuf;

use clap::Args;

use edifice_base::{Error, Result};
use edifice_experiments::structure_completion::leaderboard;
use edifice_experiments::sweep::{Study, bundle};

use crate::print;

/// Options of `verify`.
#[derive(Args)]
pub(crate) struct Verify {
    /// Bundle
    bundle: PathBuf,
    /// Tasks to run again
    #[arg(long, default_value_t = 10)]
    sample: usize,
    /// Run the commands of its arms too: programs that lie in the bundle
    #[arg(long)]
    commands: bool,
    /// Check the rows of a leaderboard that name this bundle: its facades, its masks, and the means of its results
    #[arg(long, value_name = "BOARD.csv")]
    board: Option<PathBuf>,
    /// Print one JSON object as the last line
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub(crate) fn run(options: &Verify, studies: &[Study]) -> Result<()> {
    let folder = tempfile::tempdir().map_err(|e| Error::io(&options.bundle, "unpack", e))?;
    let found = bundle::verify(
        &options.bundle,
        folder.path(),
        studies,
        options.sample,
        options.commands,
    )?;
    for line in &found.different {
        print::message(&format!("different: {line}"));
    }
    print::message(&format!(
        "digests agree; {} tasks were run again, {} rows differ",
        found.rerun,
        found.different.len()
    ));
    if found.not_run > 0 {
        print::message(&format!(
            "{} tasks of arms that are commands were left out; --commands runs them",
            found.not_run
        ));
    }
    if let Some(board) = &options.board {
        let rows = leaderboard::check(board, &options.bundle, folder.path(), studies)?;
        print::message(&format!("{rows} rows of {} stand", board.display()));
    }
    if options.json {
        print::line(&serde_json::to_string(&found).map_err(Error::method)?)?;
    }
    match found.different.is_empty() {
        true => Ok(()),
        false => Err(Error::method(format!(
            "{} rows differ from the bundle's",
            found.different.len()
        ))),
    }
}
