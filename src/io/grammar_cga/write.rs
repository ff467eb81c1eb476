//! From a grammar to text.

use std::fmt::Write;

use rustc_hash::{FxHashMap, FxHashSet};

use super::names::{SizeKey, constants, identifiers, symbols};
use super::reserved;
use crate::json::quoted;
use crate::palette::Palette;
use edifice_grammar::{Grammar, Operation, Rule, Size, Successor, size_independent};
use edifice_shape::Axis;

/// The version of CGA that the text keeps to: every word of it is known since then.
pub(super) const VERSION: &str = "2019.0";

/// The text of a grammar. Reading it gives back the same value, bit by bit, with the rules of each
/// symbol of a stochastic grammar brought together.
pub(super) fn to_string(grammar: &Grammar) -> String {
    let mut taken: FxHashSet<String> = reserved::words().map(str::to_owned).collect();
    let (identifiers, renamed) = identifiers(symbols(grammar), &mut taken);
    let constants = constants(grammar, &identifiers, &mut taken);
    let text = Text {
        identifiers,
        constants: constants
            .iter()
            .map(|(key, name, _)| (*key, name.clone()))
            .collect(),
        shown: shown(grammar),
    };
    let floating = grammar
        .rules
        .iter()
        .any(|rule| !has_weights(&rule.operation));

    let mut out = format!(
        "// Split grammar in CGA (CityEngine) syntax, written by Edifice.\nversion \"{VERSION}\"\n"
    );
    let mut line = |text: String| {
        out.push_str(&text);
        out.push('\n');
    };
    line(format!("//@ unit {}", quoted(&grammar.unit)));
    for start in &grammar.starts {
        let name = match start.name == start.symbol {
            true => String::new(),
            false => format!(" {}", quoted(&start.name)),
        };
        let symbol = text.symbol(&start.symbol);
        line(format!(
            "//@ facade {symbol} {} x {}{name}",
            start.width, start.height
        ));
    }
    if floating {
        line("//@ sizes absolute".to_owned());
    }
    for (identifier, symbol) in renamed {
        line(format!("//@ symbol {identifier} {}", quoted(symbol)));
    }
    if !constants.is_empty() {
        line(String::new());
    }
    for (_, name, value) in &constants {
        line(format!("const {name} = {value}"));
    }
    let starts: FxHashSet<&str> = grammar.starts.iter().map(|s| s.symbol.as_str()).collect();
    let mark = |symbol: &str| match starts.contains(symbol) {
        true => "@StartRule\n",
        false => "",
    };
    let mut written: FxHashSet<&str> = FxHashSet::default();
    for rule in &grammar.rules {
        if written.insert(&rule.symbol) {
            let rules = text.rules(grammar, &rule.symbol, floating);
            line(format!("\n{}{rules}", mark(&rule.symbol)));
        }
    }
    let leaves: Vec<&str> = leaves(grammar, &written);
    if !leaves.is_empty() {
        line(String::new());
    }
    let palette = Palette::new(leaves.iter().copied());
    for leaf in leaves {
        let [r, g, b] = palette.color(leaf);
        let (mark, name) = (mark(leaf), text.symbol(leaf));
        line(format!(
            "{mark}{name} --> color(\"#{r:02x}{g:02x}{b:02x}\")"
        ));
    }
    out
}

/// The symbols without rules, in the order in which they are written.
fn leaves<'g>(grammar: &'g Grammar, defined: &FxHashSet<&str>) -> Vec<&'g str> {
    let starts = grammar.starts.iter().map(|s| s.symbol.as_str());
    let written = grammar.rules.iter().flat_map(|r| r.operation.symbols());
    let mut seen = FxHashSet::default();
    let mut leaves = Vec::new();
    for symbol in starts.chain(written) {
        if !defined.contains(symbol) && seen.insert(symbol) {
            leaves.push(symbol);
        }
    }
    leaves
}

/// True if some size of an operation is a weight, so that it fills any space.
fn has_weights(operation: &Operation) -> bool {
    let weight = |size: &Size| matches!(size, Size::Relative(_));
    match operation {
        Operation::Split { successors, .. }
        | Operation::Repeat { successors, .. }
        | Operation::SymSplit { successors, .. } => successors.iter().any(|s| weight(&s.size)),
        Operation::RepeatAba { a, b, .. } => weight(&a.size) || weight(&b.size),
        Operation::GridSplit { columns, rows, .. } => columns.iter().chain(rows).any(weight),
    }
}

/// The operations as they are written: where all sizes are absolute, all but thin structures float, so
/// that CityEngine fills other lots as `edifice grammar derive` does.
fn shown(grammar: &Grammar) -> Vec<Operation> {
    let floating = size_independent(grammar).rules;
    let pairs = grammar.rules.iter().zip(floating);
    let pick = |(rule, floating): (&Rule, Rule)| match has_weights(&rule.operation) {
        true => rule.operation.clone(),
        false => floating.operation,
    };
    pairs.map(pick).collect()
}

struct Text<'g> {
    identifiers: FxHashMap<&'g str, String>,
    constants: FxHashMap<SizeKey<'g>, String>,
    /// The operation of each rule, as it is written.
    shown: Vec<Operation>,
}

impl Text<'_> {
    fn symbol<'s>(&'s self, symbol: &'s str) -> &'s str {
        self.identifiers.get(symbol).map_or(symbol, String::as_str)
    }

    /// The rule, or rules with percentages, of a symbol.
    fn rules(&self, grammar: &Grammar, symbol: &str, floating: bool) -> String {
        let rules: Vec<(&Rule, &Operation)> = grammar
            .rules
            .iter()
            .zip(&self.shown)
            .filter(|(r, _)| r.symbol == symbol)
            .collect();
        let notes = |rule: &Rule| -> Vec<&str> {
            let relative = floating && has_weights(&rule.operation);
            let written_out = match rule.operation {
                Operation::SymSplit { .. } => Some("//@ sym_split"),
                Operation::GridSplit { .. } => Some("//@ grid_split"),
                _ => None,
            };
            let relative = relative.then_some("//@ relative");
            relative.into_iter().chain(written_out).collect()
        };
        let name = self.symbol(symbol);
        if let [(rule, shown)] = rules[..]
            && rule.weight.is_none()
        {
            let body = self.operation(shown);
            let notes = notes(rule);
            return match notes.is_empty() {
                true => format!("{name} --> {body}"),
                false => format!("{name} -->\n    {}\n    {body}", notes.join("\n    ")),
            };
        }
        let weights: Vec<f64> = rules.iter().map(|(r, _)| r.weight.unwrap_or(1.0)).collect();
        let (percentages, exact) = percentages(&weights);
        let mut out = String::new();
        if !exact {
            let texts: Vec<String> = weights.iter().map(ToString::to_string).collect();
            out += &format!("//@ weights {}\n", texts.join(" "));
        }
        out += &format!("{name} -->");
        for (i, (rule, shown)) in rules.iter().enumerate() {
            let body = self.operation(shown);
            let chance = match i + 1 == rules.len() && i > 0 {
                true => "else".to_owned(),
                false => format!("{}%", percentages[i]),
            };
            for note in notes(rule) {
                out += &format!("\n    {note}");
            }
            out += &format!("\n    {chance} : {body}");
        }
        if rules.len() == 1 {
            out += "\n    else : NIL";
        }
        out
    }

    /// The text of an operation, written out where CGA has no word for it.
    fn operation(&self, operation: &Operation) -> String {
        let parts = |axis: Axis, successors: &mut dyn Iterator<Item = &Successor>| {
            let texts: Vec<String> = successors.map(|s| self.part(s, axis)).collect();
            texts.join(" | ")
        };
        match operation {
            Operation::Split { axis, successors } => {
                let parts = parts(*axis, &mut successors.iter());
                format!("split({}) {{ {parts} }}", axis.name())
            }
            Operation::Repeat { axis, successors } => {
                let parts = parts(*axis, &mut successors.iter());
                format!("split({}) {{ {{ {parts} }}* }}", axis.name())
            }
            Operation::RepeatAba { axis, a, b } => {
                let (axis, a, b) = (axis.name(), self.part(a, *axis), self.part(b, *axis));
                format!("split({axis}) {{ {a} | {{ {b} | {a} }}* }}")
            }
            Operation::SymSplit {
                axis,
                successors,
                center,
            } => {
                let mirrored = successors.len() - usize::from(*center);
                let mirror = successors[..mirrored].iter().rev();
                let parts = parts(*axis, &mut successors.iter().chain(mirror));
                format!("split({}) {{ {parts} }}", axis.name())
            }
            Operation::GridSplit {
                columns,
                rows,
                cells,
            } => {
                let mut out = String::from("split(y) {");
                for (j, (row, height)) in cells.iter().zip(rows).enumerate() {
                    let parts = row.iter().zip(columns).map(|(symbol, width)| {
                        format!("{} : {}", size(*width), self.symbol(symbol))
                    });
                    let parts: Vec<String> = parts.collect();
                    let bar = if j == 0 { "" } else { " |" };
                    // Writing to a String cannot fail.
                    let _ = write!(
                        out,
                        "{bar}\n        {} : split(x) {{ {} }}",
                        size(*height),
                        parts.join(" | ")
                    );
                }
                out + " }"
            }
        }
    }

    fn part(&self, successor: &Successor, axis: Axis) -> String {
        let value = successor.size.value();
        let key = (successor.symbol.as_str(), axis, value.to_bits());
        let value = match self.constants.get(&key) {
            Some(name) => name.clone(),
            None => value.to_string(),
        };
        let tilde = match successor.size {
            Size::Absolute(_) => "",
            Size::Relative(_) => "~",
        };
        format!("{tilde}{value} : {}", self.symbol(&successor.symbol))
    }
}

fn size(size: Size) -> String {
    match size {
        Size::Absolute(v) => v.to_string(),
        Size::Relative(v) => format!("~{v}"),
    }
}

/// Percentages for weights, and whether reading them gives back exactly the weights.
pub(super) fn percentages(weights: &[f64]) -> (Vec<f64>, bool) {
    // As the reader does: the last one is what the others leave of 100.
    let others: f64 = weights[..weights.len() - 1].iter().sum();
    if weights.len() > 1 && 100.0 - others == weights[weights.len() - 1] {
        return (weights.to_vec(), true);
    }
    if weights == [100.0] {
        return (weights.to_vec(), true);
    }
    // Divided first, so that the sum of the largest numbers is one.
    let most = weights.iter().fold(0.0_f64, |a, &b| a.max(b));
    let total: f64 = weights.iter().map(|w| w / most).sum();
    let percentages = weights.iter().map(|w| 100.0 * (w / most / total)).collect();
    (percentages, false)
}
