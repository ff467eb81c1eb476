//! `edifice city show`.

use std::path::PathBuf;

use edifice_base::{Error, Result};
use edifice_grammar::instance::{Begins, InstanceGrammar, InstanceRule, Placement};
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
    let tree = Tree::of(&grammar);
    if args.json {
        let summary = serde_json::json!({
            "buildings": derivation.count(), "instances": derivation.instances.len(),
            "terminals": grammar.templates.len(), "non_terminals": grammar.non_terminals(),
            "rules": grammar.rules.len(), "depth": derivation.depth, "template_triangles": triangles,
            "escapes": grammar.escapes(), "residuals": grammar.residuals(),
            "districts": tree.districts, "blocks": tree.blocks, "rows": tree.rows.len(), "in_rows": tree.in_rows(),
        });
        return print::line(&summary.to_string());
    }
    print::line(&format!(
        "{}: {} buildings, {} placed templates\n{} terminals ({triangles} triangles), {} non-terminals, {} rules, depth {}",
        grammar.name,
        derivation.count(),
        derivation.instances.len(),
        grammar.templates.len(),
        grammar.non_terminals(),
        grammar.rules.len(),
        derivation.depth
    ))?;
    tree.tell(derivation.count())?;
    let uses = Uses::new(&grammar.flat(None));
    let (types, rest): (Vec<&InstanceRule>, Vec<&InstanceRule>) = (grammar.rules.iter())
        .filter(|r| r.symbol != grammar.axiom)
        .partition(|r| r.levels > 0);
    let (rows, rest): (Vec<&InstanceRule>, Vec<&InstanceRule>) =
        rest.into_iter().partition(|r| r.row);
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
    tell("rows of buildings", rows, row)?;
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
    let members = |r: &InstanceRule| if r.row { r.successors.len() } else { 0 };
    rules.sort_by(|a, b| (b.weight.total_cmp(&a.weight)).then(members(b).cmp(&members(a))));
    for rule in rules.iter().take(TOLD) {
        print::line(&format!("  {}", text(rule)))?;
    }
    match rules.len().checked_sub(TOLD).filter(|n| *n > 0) {
        Some(more) => print::line(&format!("  and {more} more")),
        None => Ok(()),
    }
}

/// The districts, blocks and rows between the axiom and the buildings.
struct Tree {
    districts: usize,
    blocks: usize,
    /// Buildings of each row.
    rows: Vec<usize>,
}

impl Tree {
    fn of(grammar: &InstanceGrammar) -> Self {
        let begins = grammar.beginnings();
        let count = |least: Begins| begins.iter().filter(|b| **b >= least).count();
        let rows = grammar.rules.iter().filter(|r| r.row);
        Self {
            districts: count(Begins::District),
            blocks: count(Begins::Block),
            rows: rows.map(|r| r.successors.len()).collect(),
        }
    }

    fn in_rows(&self) -> usize {
        self.rows.iter().sum()
    }

    fn tell(&self, buildings: usize) -> Result<()> {
        if self.blocks == self.districts && self.rows.is_empty() {
            return Ok(());
        }
        let (in_rows, rows) = (self.in_rows(), self.rows.len());
        let rows = match rows {
            0 => "no rows".to_owned(),
            _ => format!(
                "{in_rows} of them in {rows} rows of {:.1}",
                ratio(in_rows, rows)
            ),
        };
        print::line(&format!(
            "{} districts of {:.1} blocks; {} blocks of {:.1} buildings; {rows}",
            self.districts,
            ratio(self.blocks, self.districts),
            self.blocks,
            ratio(buildings, self.blocks),
        ))
    }
}

fn ratio(a: usize, b: usize) -> f64 {
    a as f64 / b.max(1) as f64
}

/// The instances of rules with parameters.
struct Uses {
    numbers: FxHashMap<String, Vec<Vec<f64>>>,
}

impl Uses {
    fn new(flat: &InstanceGrammar) -> Self {
        let mut numbers: FxHashMap<String, Vec<Vec<f64>>> = FxHashMap::default();
        let axiom = flat.rules.iter().filter(|r| r.symbol == flat.axiom);
        for placed in axiom.flat_map(|r| &r.successors) {
            let own = numbers.entry(placed.symbol.clone()).or_default();
            own.push(placed.numbers.clone());
        }
        Self { numbers }
    }

    fn count(&self, rule: &InstanceRule) -> usize {
        self.numbers.get(&rule.symbol).map_or(0, Vec::len)
    }

    /// A rule with the medians of its parameters, and what it puts down.
    fn text(&self, rule: &InstanceRule) -> String {
        let mut names = vec!["w".to_owned(), "d".to_owned()];
        names.extend((1..=rule.levels).map(|k| format!("h{k}")));
        let own = self.numbers.get(&rule.symbol);
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

/// A row: its buildings one after the other, with the gaps and steps between them.
fn row(rule: &InstanceRule) -> String {
    let one = |s: &Placement| {
        let [gap, step, _] = s.at;
        let plan = s.numbers.iter().take(2).map(|v| format!("{v:.1}"));
        let plan: Vec<String> = plan.collect();
        format!(
            "{}({}) {gap:+.1} {step:+.1}{}",
            s.symbol,
            plan.join(", "),
            turned(s)
        )
    };
    format!("{} -> {}", rule.symbol, parts(rule, one))
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
