//! `edifice city show`.

use std::path::PathBuf;

use edifice_base::{Error, Result};

use super::data;
use crate::print;

/// Rules told in words.
const TOLD: usize = 5;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// The grammar.
    grammar: PathBuf,
    /// Print a line of JSON instead of text.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    let grammar = data::grammar(&args.grammar)?;
    let derivation = grammar
        .derive()
        .map_err(|e| Error::content(&args.grammar, e))?;
    let triangles: usize = grammar
        .templates
        .iter()
        .map(|t| t.mesh.triangles.len())
        .sum();
    if args.json {
        let summary = serde_json::json!({
            "buildings": derivation.buildings.len(), "instances": derivation.instances.len(),
            "terminals": grammar.templates.len(), "non_terminals": grammar.non_terminals(),
            "rules": grammar.rules.len(), "depth": derivation.depth, "template_triangles": triangles,
        });
        return print::line(&summary.to_string());
    }
    print::line(&format!(
        "{}: {} buildings, {} instances\n{} terminals ({triangles} triangles), {} non-terminals, {} rules, depth {}",
        grammar.name,
        derivation.buildings.len(),
        derivation.instances.len(),
        grammar.templates.len(),
        grammar.non_terminals(),
        grammar.rules.len(),
        derivation.depth
    ))?;
    let mut rules: Vec<_> = grammar
        .rules
        .iter()
        .filter(|r| r.symbol != grammar.axiom)
        .collect();
    rules.sort_by(|a, b| {
        let size =
            |r: &edifice_grammar::instance::InstanceRule| r.weight * r.successors.len() as f64;
        size(b).total_cmp(&size(a)).then(a.symbol.cmp(&b.symbol))
    });
    for rule in rules.into_iter().take(TOLD) {
        let parts = rule.successors.iter().map(|s| {
            let [w, d, h] = s.size;
            let [x, y, z] = s.at;
            format!(
                "{} of {w} x {d} x {h} at ({x}, {y}, {z}) turned {}",
                s.symbol, s.turn
            )
        });
        let parts: Vec<String> = parts.collect();
        print::line(&format!(
            "{} ({} times): {}",
            rule.symbol,
            rule.weight,
            parts.join("; ")
        ))?;
    }
    Ok(())
}
