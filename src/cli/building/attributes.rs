//! `edifice building attributes`.

use super::data::Input;
use crate::model::data::print_table;
use crate::print::Json;

/// Options.
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    input: Input,
    #[command(flatten)]
    json: Json,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> edifice_base::Result<()> {
    print_table(&args.input.read()?.table, args.json)
}
