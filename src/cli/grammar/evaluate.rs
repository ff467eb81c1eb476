//! `edifice grammar evaluate`.

use std::path::PathBuf;

use edifice_base::{Error, Result, unwatched};
use edifice_facade_grammar::{BoundLimits, Operations, Settings, lower_bound};
use edifice_grammar::{Costs, Grammar, derive, evaluate};
use edifice_io::read_grammar;
use edifice_shape::Facade;

use crate::print;
use crate::reading::{self, Reading};

/// Options of `edifice grammar evaluate`.
#[derive(clap::Args)]
#[command(after_help = "Example:
  edifice grammar evaluate fig9.grammar.json datasets/facade_grammar/wu2014_fig9.facade.json --bound --json

Exit code 1 when the grammar does not derive exactly the facades; the cost and the pixel error are told first.")]
pub(crate) struct Args {
    /// Grammar to judge: .grammar.json or .cga, also as .gz
    grammar: PathBuf,
    /// Facades that it should derive, in the order of its starts
    #[arg(required = true)]
    facades: Vec<PathBuf>,
    /// Also prove a bound on the cost of any grammar of the facade, with the operations that this one uses
    #[arg(long)]
    bound: bool,
    /// Cost of split, and of symsplit and gridsplit
    #[arg(long, value_name = "COST", value_parser = super::cost, default_value_t = Costs::default().split)]
    split_cost: f64,
    /// Cost of a repeat, and of a repeat of the form ABABA
    #[arg(long, value_name = "COST", value_parser = super::cost, default_value_t = Costs::default().repeat)]
    repeat_cost: f64,
    #[command(flatten)]
    reading: Reading,
    /// End with one line of JSON
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    let grammar = read_grammar(&args.grammar)?;
    let options = args.reading.options()?;
    let facades: Result<Vec<Facade>> = (args.facades.iter())
        .map(|path| reading::source(path, &options)?.facade(path))
        .collect();
    let facades = facades?;
    let costs = Costs::of(args.split_cost, args.repeat_cost);
    let judged = evaluate(&grammar, &facades, &costs);
    let errors: Vec<Option<f64>> = (facades.iter().enumerate())
        .map(|(index, facade)| Some(derive(&grammar, index).ok()?.label_difference(facade)))
        .collect();
    let bound = match (args.bound, facades.as_slice()) {
        (false, _) => None,
        (true, [facade]) => Some(bound(&grammar, facade, costs)?),
        (true, _) => {
            let message = "bounds are of one facade";
            return Err(Error::option("--bound", message));
        }
    };
    let cost = costs.grammar(&grammar);
    print::line(&format!("cost {cost}, {} rules", grammar.rules.len()))?;
    for (facade, error) in facades.iter().zip(&errors) {
        let told = error.map_or("is not derived".to_owned(), |error| {
            format!("{:.4} % of its area is derived otherwise", 100.0 * error)
        });
        print::line(&format!("{}: {told}", facade.name))?;
    }
    if let Some((lower, proven)) = bound {
        let gap = 100.0 * (cost / lower - 1.0);
        let word = if proven {
            "is the least cost"
        } else {
            "is a bound"
        };
        print::line(&format!("{lower} {word}; this grammar is {gap:.2} % above"))?;
    }
    let reason = judged.as_ref().err().map(ToString::to_string);
    if let Some(reason) = &reason {
        print::line(&format!("does not derive the facades exactly: {reason}"))?;
    }
    if args.json {
        let about = serde_json::json!({
            "derives_back": judged.is_ok(), "reason": reason, "cost": cost,
            "rules": grammar.rules.len(), "terminals": judged.as_ref().ok().map(|e| e.terminals),
            "pixel_error": errors, "bound": bound.map(|b| b.0), "proven_optimal_cost": bound.map(|b| b.1),
        });
        print::line(&about.to_string())?;
    }
    judged.map(|_| ()).map_err(Error::method)
}

/// A bound on the cost of every grammar of a facade that uses no other operations, and whether a grammar of that cost is known.
fn bound(grammar: &Grammar, facade: &Facade, costs: Costs) -> Result<(f64, bool)> {
    let uses = |name: &str| grammar.rules.iter().any(|r| r.operation.name() == name);
    let settings = Settings {
        costs,
        operations: Operations {
            repeat: uses("repeat") || Operations::default().repeat,
            repeat_aba: uses("repeat_aba"),
            sym_split: uses("sym_split"),
            grid_split: uses("grid_split"),
        },
        ..Settings::default()
    };
    let found = lower_bound(facade, &settings, &BoundLimits::default(), &unwatched)
        .map_err(Error::method)?;
    Ok((found.lower, found.proven))
}
