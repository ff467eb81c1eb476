//! `edifice logic evaluate`.

use std::path::PathBuf;

use edifice_base::Result;
use edifice_experiments::procedural_logic::trial::evaluate;

use super::input::Facades;
use crate::print;

/// Options of `logic evaluate`.
#[derive(clap::Args)]
#[command(after_help = "Example:
  edifice logic evaluate datasets/examples/ranking.csv datasets/facade_grammar/layouts/cottage_*.facade.json datasets/facade_grammar/layouts/terrace_[ab].facade.json --json

RANKING is a CSV file with the columns query, facade and distance: from every query to every other facade of the folder. Facades
are called as their files up to the first dot. Found is any facade of the same architecture (floors, window columns, doors,
running balconies, read off the labels); facades at equal distance come in random order, and the rates are exact
expectations over it; facades that no other equals are no queries.")]
pub(crate) struct Args {
    /// Distances to judge
    #[arg(value_name = "RANKING")]
    ranking: PathBuf,
    #[command(flatten)]
    facades: Facades,
    /// Print one JSON object as the last line
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    let found = evaluate(args.facades.read()?, &args.ranking)?;
    for (name, value) in &found {
        print::line(&format!("{name} {value}"))?;
    }
    match args.json {
        true => print::line(&serde_json::json!(found).to_string()),
        false => Ok(()),
    }
}
