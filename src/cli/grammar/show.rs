//! `edifice grammar show`.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use edifice_base::{Error, Result};
use edifice_grammar::{Costs, Grammar, check, derive, listing};
use edifice_io::read_grammar;

use crate::print;

/// Options of `edifice grammar show`.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  edifice grammar show facade.cga
  edifice grammar show fig9.grammar.json --sizes --json

The cost of a rule is that of its operation plus the number of symbols written in it; the cost of a
grammar is the sum over its rules.")]
pub(crate) struct Args {
    /// Grammar or library to read: .grammar.json, .cga or .library.json, also as .gz
    grammar: PathBuf,
    /// Write the sizes into the rules; ~ marks relative ones
    #[arg(long)]
    sizes: bool,
    /// Cost of split, and of symsplit and gridsplit
    #[arg(long, value_name = "COST", value_parser = super::cost, default_value_t = Costs::default().split)]
    split_cost: f64,
    /// Cost of a repeat, and of a repeat of the form ABABA
    #[arg(long, value_name = "COST", value_parser = super::cost, default_value_t = Costs::default().repeat)]
    repeat_cost: f64,
    /// End with one line of JSON
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    let path = &args.grammar;
    let costs = Costs::of(args.split_cost, args.repeat_cost);
    let bytes = edifice_io::read_bytes(path)?;
    if edifice_io::grammar_library_json::is_library(&bytes) {
        return super::library::show(path, &bytes, &costs, args.json);
    }
    let grammar = read_grammar(path)?;
    for warning in check(&grammar).map_err(|e| Error::content(path, e))? {
        print::message(&format!("warning: {}: {warning}", path.display()));
    }
    for line in listing(&grammar, args.sizes) {
        print::line(&line)?;
    }
    if !grammar.rules.is_empty() {
        print::line("")?;
    }
    let summary = Summary::new(&grammar, &costs).map_err(|e| Error::content(path, e))?;
    for line in summary.lines(&grammar) {
        print::line(&line)?;
    }
    match args.json {
        true => print::line(&summary.json(&grammar)),
        false => Ok(()),
    }
}

/// The summary of a grammar.
struct Summary<'g> {
    cost: f64,
    operations: BTreeMap<&'static str, usize>,
    non_terminals: usize,
    terminal_symbols: BTreeSet<&'g str>,
    /// Terminal regions of each start; none for a stochastic grammar.
    terminals: Option<Vec<usize>>,
}

impl<'g> Summary<'g> {
    fn new(
        grammar: &'g Grammar,
        costs: &Costs,
    ) -> std::result::Result<Self, edifice_grammar::GrammarError> {
        let defined: BTreeSet<&str> = grammar.rules.iter().map(|r| r.symbol.as_str()).collect();
        let written = grammar.rules.iter().flat_map(|r| r.operation.symbols());
        let starts = grammar.starts.iter().map(|s| s.symbol.as_str());
        let mut operations: BTreeMap<&'static str, usize> = BTreeMap::new();
        for rule in &grammar.rules {
            *operations.entry(rule.operation.name()).or_default() += 1;
        }
        let stochastic = defined.len() < grammar.rules.len();
        let count = |index| derive(grammar, index).map(|f| f.regions.len());
        let terminals = match stochastic {
            true => None,
            false => Some(
                (0..grammar.starts.len())
                    .map(count)
                    .collect::<std::result::Result<_, _>>()?,
            ),
        };
        Ok(Self {
            cost: costs.grammar(grammar),
            operations,
            non_terminals: defined.len(),
            terminal_symbols: written
                .chain(starts)
                .filter(|s| !defined.contains(s))
                .collect(),
            terminals,
        })
    }

    fn lines(&self, grammar: &Grammar) -> Vec<String> {
        let operations: Vec<String> = self
            .operations
            .iter()
            .map(|(name, n)| format!("{n} {name}"))
            .collect();
        let mut lines = vec![format!(
            "cost {}, {} rules ({}), {} non-terminals, {} terminal symbols",
            tidy(self.cost),
            grammar.rules.len(),
            operations.join(", "),
            self.non_terminals,
            self.terminal_symbols.len()
        )];
        for (index, start) in grammar.starts.iter().enumerate() {
            let regions = match &self.terminals {
                Some(counts) => format!("{} terminal regions", counts[index]),
                None => "stochastic".to_owned(),
            };
            lines.push(format!(
                "{} from {}: {} x {} {}, {regions}",
                start.name, start.symbol, start.width, start.height, grammar.unit
            ));
        }
        lines
    }

    fn json(&self, grammar: &Grammar) -> String {
        let total = self
            .terminals
            .as_ref()
            .map(|counts| counts.iter().sum::<usize>());
        serde_json::json!({
            "cost": tidy(self.cost),
            "rules": grammar.rules.len(),
            "terminals": total,
            "terminal_symbols": self.terminal_symbols.len(),
            "non_terminals": self.non_terminals,
            "operations": self.operations,
            "facades": grammar.starts.len(),
        })
        .to_string()
    }
}

/// The cost, rounded to nine decimals: sums of tenths without their errors.
fn tidy(cost: f64) -> f64 {
    (cost * 1e9).round() / 1e9
}
