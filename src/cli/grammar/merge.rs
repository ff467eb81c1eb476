//! `edifice grammar merge`.

use std::path::PathBuf;

use edifice_base::{Error, Result};
use edifice_editing::facade_grammar::merge;
use edifice_editing::work::Work;
use edifice_grammar::Costs;
use edifice_io::{read_facade, read_grammar, write_grammar};
use edifice_shape::Facade;

use crate::print::Json;

/// Options of `edifice grammar merge`.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  edifice grammar merge joint.grammar.json datasets/facade_grammar/layouts/cottage_1.facade.json -o more.grammar.json

The facades of the grammar are derived at their own sizes; of them and the further ones one grammar is inferred, in which
the rules that they share are written once. `grammar derive --facade NAME` derives one of them.")]
pub(crate) struct Args {
    /// Grammar to begin with: .grammar.json or .cga, also as .gz
    grammar: PathBuf,
    /// Further facades, whole ones
    #[arg(required = true, value_name = "FACADE")]
    facades: Vec<PathBuf>,
    /// Grammar to write: .grammar.json or .cga
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    #[command(flatten)]
    json: Json,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    let grammar = read_grammar(&args.grammar)?;
    let checked = |path: &PathBuf| {
        let facade = read_facade(path, &Default::default())?;
        facade.check_tiling().map_err(|e| Error::content(path, e))?;
        Ok(facade)
    };
    let further: Vec<Facade> = args.facades.iter().map(checked).collect::<Result<_>>()?;
    let found = merge(&grammar, &further, &Work::default())?;
    write_grammar(&found.grammar, &args.output)?;
    let cost = (Costs::default().grammar(&found.grammar) * 1e9).round() / 1e9;
    let (facades, rules) = (found.grammar.starts.len(), found.grammar.rules.len());
    let file = args.output.display();
    let value = serde_json::json!({
        "file": args.output, "facades": facades, "rules": rules, "cost": cost,
    });
    let text = format!("{file}: {facades} facades, {rules} rules, cost {cost}");
    args.json.after(&text, &value)
}
