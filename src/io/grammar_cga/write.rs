//! From a grammar to text.

use std::fmt::Write;

use rustc_hash::{FxHashMap, FxHashSet};

use crate::grammar::{Grammar, Operation, Rule, Size, Successor, summable};
use crate::io::facade_json::quoted;
use crate::shape::Axis;

/// Words with a meaning of their own in CGA.
const RESERVED: [&str; 16] = [
    "attr",
    "const",
    "version",
    "else",
    "split",
    "case",
    "NIL",
    "x",
    "y",
    "import",
    "style",
    "true",
    "false",
    "with",
    "extension",
    "inline",
];

/// A size that is written more than once for the same symbol and axis has a name.
type SizeKey<'g> = (&'g str, Axis, u64);

/// The text of a grammar. Reading it gives back the same value, bit by bit, with the rules of each
/// symbol of a stochastic grammar brought together.
pub(super) fn to_string(grammar: &Grammar) -> String {
    let mut taken: FxHashSet<String> = RESERVED.iter().map(|s| (*s).to_owned()).collect();
    let (identifiers, renamed) = identifiers(grammar, &mut taken);
    let constants = constants(grammar, &identifiers, &mut taken);
    let text = Text {
        identifiers,
        constants: constants
            .iter()
            .map(|(key, name, _)| (*key, name.clone()))
            .collect(),
    };

    let mut out =
        String::from("// Split grammar in CGA (CityEngine) syntax, written by Edifice.\n");
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
    for (identifier, symbol) in renamed {
        line(format!("//@ symbol {identifier} {}", quoted(symbol)));
    }
    if !constants.is_empty() {
        line(String::new());
    }
    for (_, name, value) in &constants {
        line(format!("const {name} = {value}"));
    }
    let mut written: FxHashSet<&str> = FxHashSet::default();
    for rule in &grammar.rules {
        if written.insert(&rule.symbol) {
            line(String::new());
            line(text.rules(grammar, &rule.symbol));
        }
    }
    out
}

/// An identifier for each symbol, and the list of those that are not spelt like their symbol.
#[allow(clippy::type_complexity)] // a map and a list of pairs
fn identifiers<'g>(
    grammar: &'g Grammar,
    taken: &mut FxHashSet<String>,
) -> (FxHashMap<&'g str, String>, Vec<(String, &'g str)>) {
    let starts = grammar.starts.iter().map(|s| s.symbol.as_str());
    let written = grammar.rules.iter().flat_map(|rule| {
        let symbols = rule.operation.symbols();
        std::iter::once(rule.symbol.as_str()).chain(symbols)
    });
    let mut seen = FxHashSet::default();
    let symbols: Vec<&str> = starts.chain(written).filter(|s| seen.insert(*s)).collect();
    let plain = |symbol: &str| {
        let head = symbol.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
        head && symbol
            .chars()
            .all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '.')
    };
    let mut identifiers = FxHashMap::default();
    // Symbols that are identifiers keep their names; the others get what is left.
    let (same, others): (Vec<&str>, Vec<&str>) = symbols
        .into_iter()
        .partition(|s| plain(s) && !RESERVED.contains(s));
    for symbol in same {
        taken.insert(symbol.to_owned());
        identifiers.insert(symbol, symbol.to_owned());
    }
    let mut renamed = Vec::new();
    for symbol in others {
        let letters = symbol
            .chars()
            .map(|c| if c.is_ascii_alphanumeric() { c } else { '_' });
        let base: String = letters.collect();
        let head = base.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
        let identifier = free(if head { base } else { format!("S{base}") }, taken);
        renamed.push((identifier.clone(), symbol));
        identifiers.insert(symbol, identifier);
    }
    (identifiers, renamed)
}

/// `base`, or the first of `base_2`, `base_3`, ... that is not taken.
fn free(base: String, taken: &mut FxHashSet<String>) -> String {
    let numbered = (2..).map(|n| format!("{base}_{n}"));
    let free = std::iter::once(base.clone())
        .chain(numbered)
        .find(|name| !taken.contains(name))
        .unwrap_or(base);
    taken.insert(free.clone());
    free
}

/// Absolute sizes that are written at least twice for a symbol along an axis, in order.
fn constants<'g>(
    grammar: &'g Grammar,
    identifiers: &FxHashMap<&str, String>,
    taken: &mut FxHashSet<String>,
) -> Vec<(SizeKey<'g>, String, f64)> {
    let mut counts: FxHashMap<SizeKey<'g>, usize> = FxHashMap::default();
    let mut order = Vec::new();
    for rule in &grammar.rules {
        let (axis, successors): (Axis, Vec<&Successor>) = match &rule.operation {
            Operation::Split { axis, successors }
            | Operation::Repeat { axis, successors }
            | Operation::SymSplit {
                axis, successors, ..
            } => (*axis, successors.iter().collect()),
            Operation::RepeatAba { axis, a, b } => (*axis, vec![a, b]),
            Operation::GridSplit { .. } => continue,
        };
        for successor in successors {
            if let Size::Absolute(value) = successor.size {
                let key = (successor.symbol.as_str(), axis, value.to_bits());
                let count = counts.entry(key).or_default();
                *count += 1;
                if *count == 2 {
                    order.push((key, value));
                }
            }
        }
    }
    let named = order.into_iter().map(|(key, value)| {
        let what = match key.1 {
            Axis::X => "width",
            Axis::Y => "height",
        };
        let name = free(format!("{}_{what}", identifiers[key.0]), taken);
        (key, name, value)
    });
    named.collect()
}

struct Text<'g> {
    identifiers: FxHashMap<&'g str, String>,
    constants: FxHashMap<SizeKey<'g>, String>,
}

impl Text<'_> {
    fn symbol<'s>(&'s self, symbol: &'s str) -> &'s str {
        self.identifiers.get(symbol).map_or(symbol, String::as_str)
    }

    /// The rule, or rules with percentages, of a symbol.
    fn rules(&self, grammar: &Grammar, symbol: &str) -> String {
        let rules: Vec<&Rule> = grammar
            .rules
            .iter()
            .filter(|r| r.symbol == symbol)
            .collect();
        let name = self.symbol(symbol);
        if let [rule] = rules[..]
            && rule.weight.is_none()
        {
            let (note, body) = self.operation(&rule.operation);
            return match note {
                None => format!("{name} --> {body}"),
                Some(note) => format!("{name} -->\n    {note}\n    {body}"),
            };
        }
        let weights: Vec<f64> = rules.iter().map(|r| r.weight.unwrap_or(1.0)).collect();
        let (percentages, exact) = percentages(&weights);
        let mut out = String::new();
        if !exact {
            let texts: Vec<String> = weights.iter().map(ToString::to_string).collect();
            out += &format!("//@ weights {}\n", texts.join(" "));
        }
        out += &format!("{name} -->");
        for (i, rule) in rules.iter().enumerate() {
            let (note, body) = self.operation(&rule.operation);
            let chance = match i + 1 == rules.len() && i > 0 {
                true => "else".to_owned(),
                false => format!("{}%", percentages[i]),
            };
            if let Some(note) = note {
                out += &format!("\n    {note}");
            }
            out += &format!("\n    {chance} : {body}");
        }
        if rules.len() == 1 {
            out += "\n    else : NIL";
        }
        out
    }

    /// A comment that restores the operation, where CGA has no word for it, and its text.
    fn operation(&self, operation: &Operation) -> (Option<&'static str>, String) {
        let parts = |axis: Axis, successors: &mut dyn Iterator<Item = &Successor>| {
            let texts: Vec<String> = successors.map(|s| self.part(s, axis)).collect();
            texts.join(" | ")
        };
        match operation {
            Operation::Split { axis, successors } => {
                let parts = parts(*axis, &mut successors.iter());
                (None, format!("split({}) {{ {parts} }}", axis.name()))
            }
            Operation::Repeat { axis, successors } => {
                let parts = parts(*axis, &mut successors.iter());
                (None, format!("split({}) {{ {{ {parts} }}* }}", axis.name()))
            }
            Operation::RepeatAba { axis, a, b } => {
                let (axis, a, b) = (axis.name(), self.part(a, *axis), self.part(b, *axis));
                (None, format!("split({axis}) {{ {a} | {{ {b} | {a} }}* }}"))
            }
            Operation::SymSplit {
                axis,
                successors,
                center,
            } => {
                let mirrored = successors.len() - usize::from(*center);
                let mirror = successors[..mirrored].iter().rev();
                let parts = parts(*axis, &mut successors.iter().chain(mirror));
                let text = format!("split({}) {{ {parts} }}", axis.name());
                (Some("//@ sym_split"), text)
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
                (Some("//@ grid_split"), out + " }")
            }
        }
    }

    fn part(&self, successor: &Successor, axis: Axis) -> String {
        let constant = match successor.size {
            Size::Absolute(v) => {
                self.constants
                    .get(&(successor.symbol.as_str(), axis, v.to_bits()))
            }
            Size::Relative(_) => None,
        };
        let size = constant.cloned().unwrap_or_else(|| size(successor.size));
        format!("{size} : {}", self.symbol(&successor.symbol))
    }
}

fn size(size: Size) -> String {
    match size {
        Size::Absolute(v) => v.to_string(),
        Size::Relative(v) => format!("~{v}"),
    }
}

/// Percentages for weights, and whether reading them gives back exactly the weights.
fn percentages(weights: &[f64]) -> (Vec<f64>, bool) {
    // As the reader does: the last one is what the others leave of 100.
    let others: f64 = weights[..weights.len() - 1].iter().sum();
    if weights.len() > 1 && 100.0 - others == weights[weights.len() - 1] {
        return (weights.to_vec(), true);
    }
    if weights == [100.0] {
        return (weights.to_vec(), true);
    }
    let weights = summable(weights);
    let total: f64 = weights.iter().sum();
    let percentages = weights.iter().map(|w| 100.0 * w / total).collect();
    (percentages, false)
}
