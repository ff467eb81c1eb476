//! `edifice building attributes`.

use super::data::Input;
use crate::cli::model::data::csv_lines;
use crate::cli::print;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    #[command(flatten)]
    input: Input,
}

/// Runs the command.
pub fn run(args: &Args) -> edifice::Result<()> {
    print::line(&csv_lines(&args.input.read()?.table).join("\n"))
}
