//! `edifice grammar edit`.

use std::path::PathBuf;

use edifice_base::{Error, Result};
use edifice_editing::CommandError;
use edifice_editing::split_grammar::{GrammarEdit, edit};
use edifice_grammar::{Costs, check};
use edifice_io::{read_grammar, write_grammar};

use crate::print::{self, Json};

/// Options of `edifice grammar edit`.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  edifice grammar edit fig9.grammar.json 'border 2.0=0.5' -o edited.grammar.json
  edifice grammar edit fig9.grammar.json 'symbol 3.1=Door' 'insert 0.2=Cornice:4' -o edited.grammar.json
  edifice grammar edit datasets/examples/grid.grammar.json 'border 0.c1=0.3' 'insert 0.r2=3' 'shrink 0.c0' -o edited.grammar.json

Edits, made in turn: resize RULE.PART=SIZE; border RULE.PART=SHIFT (between this part and the next); symbol RULE.PART=NAME;
insert RULE.PART=NAME:SIZE (before this part) or RULE.PART=SIZE (a copy of it); remove RULE.PART; grow RULE.PART (a copy of the part
before it, as a floor or a column, or one more period of a repeat: the facade grows by its length); shrink RULE.PART (the part
or a period goes, the facade shrinks); repeat RULE (a split of equal periods); weight RULE=W; outline W,H. Rules and parts are
counted from 0, as in the file; of a repeat A B A, A is part 0 and B part 1. The columns of a grid are RULE.c0, RULE.c1, ... from the left, its
rows RULE.r0, ... from the bottom, and its cells RULE.0, ... row by row, for symbol. Sizes are made relative first, so that what is inside an
edited region follows it.")]
pub(crate) struct Args {
    /// Grammar to read: .grammar.json or .cga, also as .gz
    grammar: PathBuf,
    /// Edits
    #[arg(required = true, value_name = "EDIT", value_parser = parse)]
    edits: Vec<GrammarEdit>,
    /// Grammar to write: .grammar.json or .cga
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    #[command(flatten)]
    json: Json,
}

fn parse(text: &str) -> std::result::Result<GrammarEdit, String> {
    text.parse().map_err(|e: CommandError| e.to_string())
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    let path = &args.grammar;
    let grammar = read_grammar(path)?;
    let edited = edit(&grammar, &args.edits).map_err(|e| Error::content(path, e))?;
    for warning in check(&edited).map_err(|e| Error::content(path, e))? {
        print::message(&format!("warning: {}: {warning}", path.display()));
    }
    write_grammar(&edited, &args.output)?;
    let cost = (Costs::default().grammar(&edited) * 1e9).round() / 1e9;
    let rules = edited.rules.len();
    let text = format!("{}: {rules} rules, cost {cost}", args.output.display());
    let value = serde_json::json!({ "file": args.output, "rules": rules, "cost": cost });
    args.json.after(&text, &value)
}
