//! `edifice building evaluate`.

use std::time::Instant;

use edifice_model::tables::compare::Contender;

use super::data::Input;
use crate::model::evaluate::Splits;

/// Options.
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    input: Input,
    #[command(flatten)]
    splits: Splits,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> edifice_base::Result<()> {
    let begun = Instant::now();
    let data = args.input.known()?;
    // The rows are those of the model as published.
    args.splits
        .evaluate(&data, &args.input.input, Contender::Ours, begun)
}
