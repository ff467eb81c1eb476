//! `edifice building evaluate`.

use super::data::Input;
use crate::model::evaluate::Splits;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    #[command(flatten)]
    input: Input,
    #[command(flatten)]
    splits: Splits,
}

/// Runs the command.
pub fn run(args: &Args) -> edifice_base::Result<()> {
    let data = args.input.read()?;
    args.splits.evaluate(&data, &args.input.input)
}
