//! `edifice city show`.

use std::path::PathBuf;

use edifice_base::{Error, Result};
use edifice_grammar::instance::{InstanceGrammar, InstanceRule, Placement};
use rustc_hash::FxHashMap;

use super::data;
use crate::print;

/// Rules of each kind that are told.
const TOLD: usize = 25;
/// Parts of a rule that are told.
const PARTS: usize = 6;

/// Options.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The grammar.
    grammar: PathBuf,
    /// Print a line of JSON instead of text.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
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
            "escapes": grammar.escapes(), "residuals": grammar.residuals(),
        });
        return print::line(&summary.to_string());
    }
    print::line(&format!(
        "{}: {} buildings, {} placed templates\n{} terminals ({triangles} triangles), {} non-terminals, {} rules, depth {}",
        grammar.name,
        derivation.buildings.len(),
        derivation.instances.len(),
        grammar.templates.len(),
        grammar.non_terminals(),
        grammar.rules.len(),
        derivation.depth
    ))?;
    let uses = Uses::new(&grammar);
    let (types, rest): (Vec<&InstanceRule>, Vec<&InstanceRule>) = (grammar.rules.iter())
        .filter(|r| r.symbol != grammar.axiom)
        .partition(|r| r.levels > 0);
    let (escapes, types): (Vec<&InstanceRule>, Vec<&InstanceRule>) =
        types.into_iter().partition(|r| uses.count(r) == 1);
    print::line(&format!(
        "{} instances keep residuals: their parts stand where they do, not where the rules put them",
        grammar.residuals()
    ))?;
    tell("types of buildings", types, |r| uses.text(r))?;
    tell("escapes, buildings that no type explains", escapes, |r| {
        uses.text(r)
    })?;
    tell("other rules", rest, fixed)
}

/// Prints the first rules of a kind, those of most instances first.
fn tell(
    what: &str,
    mut rules: Vec<&InstanceRule>,
    text: impl Fn(&InstanceRule) -> String,
) -> Result<()> {
    if rules.is_empty() {
        return Ok(());
    }
    print::line(&format!("\n{}: {what}", rules.len()))?;
    rules.sort_by(|a, b| b.weight.total_cmp(&a.weight));
    for rule in rules.iter().take(TOLD) {
        print::line(&format!("  {}", text(rule)))?;
    }
    match rules.len().checked_sub(TOLD).filter(|n| *n > 0) {
        Some(more) => print::line(&format!("  and {more} more")),
        None => Ok(()),
    }
}

/// The instances of rules with parameters.
struct Uses<'g> {
    numbers: FxHashMap<&'g str, Vec<&'g [f64]>>,
}

impl<'g> Uses<'g> {
    fn new(grammar: &'g InstanceGrammar) -> Self {
        let mut numbers: FxHashMap<&str, Vec<&[f64]>> = FxHashMap::default();
        let axiom = grammar.rules.iter().filter(|r| r.symbol == grammar.axiom);
        for placed in axiom.flat_map(|r| &r.successors) {
            let own = numbers.entry(placed.symbol.as_str()).or_default();
            own.push(&placed.numbers);
        }
        Self { numbers }
    }

    fn count(&self, rule: &InstanceRule) -> usize {
        self.numbers.get(rule.symbol.as_str()).map_or(0, Vec::len)
    }

    /// A rule with the medians of its parameters, and what it puts down.
    fn text(&self, rule: &InstanceRule) -> String {
        let mut names = vec!["w".to_owned(), "d".to_owned()];
        names.extend((1..=rule.levels).map(|k| format!("h{k}")));
        let own = self.numbers.get(rule.symbol.as_str());
        let median = |k: usize| {
            let mut all: Vec<f64> = own.into_iter().flatten().map(|n| n[k]).collect();
            all.sort_by(f64::total_cmp);
            all.get(all.len() / 2).copied().unwrap_or(0.0)
        };
        let few = names.len().min(PARTS);
        let medians = (0..few).map(|k| format!("{} {:.1}", names[k], median(k)));
        let medians: Vec<String> = medians.collect();
        let scale = match rule.is_unscaled() {
            true => String::new(),
            false => format!(", scaled {:?}", rule.scale),
        };
        format!(
            "{}({}) x {}, medians {}{scale} -> {}",
            rule.symbol,
            shortened(&names, ", "),
            self.count(rule),
            medians.join(", "),
            parts(rule, |s| format!(
                "{} @ level {}: {:.2} w x {:.2} d{}",
                s.symbol,
                s.at[2],
                s.size[0],
                s.size[1],
                turned(s)
            ))
        )
    }
}

fn fixed(rule: &InstanceRule) -> String {
    let one = |s: &Placement| {
        let [x, y, z] = s.at;
        let numbers = s.numbers.iter().map(|v| format!("{v:.1}"));
        let numbers: Vec<String> = numbers.collect();
        let given = match numbers.is_empty() {
            true => String::new(),
            false => format!("({})", shortened(&numbers, ", ")),
        };
        format!(
            "{}{given} at ({x:.1}, {y:.1}, {z:.1}){}",
            s.symbol,
            turned(s)
        )
    };
    format!("{} x {} -> {}", rule.symbol, rule.weight, parts(rule, one))
}

fn turned(placed: &Placement) -> String {
    match placed.turn == 0.0 {
        true => String::new(),
        false => format!(" turned {}", placed.turn),
    }
}

fn parts(rule: &InstanceRule, text: impl Fn(&Placement) -> String) -> String {
    let all: Vec<String> = rule.successors.iter().map(text).collect();
    shortened(&all, " | ")
}

/// The first of a list, and how many more there are.
fn shortened(list: &[String], between: &str) -> String {
    let shown = list[..list.len().min(PARTS)].join(between);
    match list.len().checked_sub(PARTS).filter(|n| *n > 0) {
        Some(more) => format!("{shown}{between}{more} more"),
        None => shown,
    }
}
