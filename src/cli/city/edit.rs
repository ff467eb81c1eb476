//! `edifice city edit`.

use std::path::PathBuf;

use edifice_base::{Error, Result};
use edifice_editing::CommandError;
use edifice_editing::city_proceduralization::{CityEdit, edit};
use edifice_io_city::grammar_file;

use super::data;
use super::residuals::Residuals;
use crate::print::Json;

/// Options.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The grammar.
    grammar: PathBuf,
    /// Edits.
    #[arg(required = true, value_name = "EDIT", value_parser = parse)]
    edits: Vec<CityEdit>,
    /// Treatment of residuals, which tell where the parts of single instances stand, of types that are edited.
    #[arg(long, value_enum, default_value = "keep")]
    residuals: Residuals,
    /// The grammar to write (`*.city-grammar.json`, also with `.gz`, or `*.city-grammar.bin`).
    #[arg(short, long)]
    output: PathBuf,
    #[command(flatten)]
    json: Json,
}

fn parse(text: &str) -> std::result::Result<CityEdit, String> {
    text.parse().map_err(|e: CommandError| e.to_string())
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    let grammar = data::grammar(&args.grammar)?;
    let carry = args.residuals == Residuals::Keep;
    let edited =
        edit(&grammar, &args.edits, carry).map_err(|e| Error::content(&args.grammar, e))?;
    grammar_file::write(&edited, &args.output)?;
    let rules = edited.rules.len();
    let text = format!("{}: {rules} rules", args.output.display());
    let value = serde_json::json!({ "file": args.output, "rules": rules });
    args.json.after(&text, &value)
}
