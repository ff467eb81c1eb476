//! `edifice building attributes`.

use super::data::Input;
use crate::model::data::csv_lines;
use crate::print;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    #[command(flatten)]
    input: Input,
}

/// Runs the command.
pub fn run(args: &Args) -> edifice_base::Result<()> {
    print::line(&csv_lines(&args.input.read()?.table).join("\n"))
}
