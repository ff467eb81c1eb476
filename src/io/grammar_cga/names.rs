//! Identifiers of symbols and names of sizes.

use rustc_hash::{FxHashMap, FxHashSet};

use edifice_grammar::{Grammar, Operation, Size, Successor};
use edifice_shape::Axis;

/// A size that is written more than once for the same symbol and axis has a name.
pub(super) type SizeKey<'g> = (&'g str, Axis, u64);

/// The symbols of a grammar, each once.
pub(super) fn symbols(grammar: &Grammar) -> impl Iterator<Item = &str> {
    let starts = grammar.starts.iter().map(|s| s.symbol.as_str());
    let written = grammar.rules.iter().flat_map(|rule| {
        let symbols = rule.operation.symbols();
        std::iter::once(rule.symbol.as_str()).chain(symbols)
    });
    starts.chain(written)
}

/// An identifier for each symbol, and the list of those that are not spelt like their symbol.
#[allow(clippy::type_complexity)] // a map and a list of pairs
pub(super) fn identifiers<'g>(
    symbols: impl Iterator<Item = &'g str>,
    taken: &mut FxHashSet<String>,
) -> (FxHashMap<&'g str, String>, Vec<(String, &'g str)>) {
    let mut seen = FxHashSet::default();
    let symbols: Vec<&str> = symbols.filter(|s| seen.insert(*s)).collect();
    let plain = |symbol: &str| {
        let head = symbol.starts_with(|c: char| c.is_ascii_alphabetic());
        head && symbol
            .chars()
            .all(|c| c.is_ascii_alphanumeric() || c == '_')
    };
    let mut identifiers = FxHashMap::default();
    // Symbols that are identifiers keep their names; the others get what is left.
    let (same, others): (Vec<&str>, Vec<&str>) = symbols
        .into_iter()
        .partition(|s| plain(s) && !taken.contains(*s));
    for symbol in same {
        taken.insert(symbol.to_owned());
        identifiers.insert(symbol, symbol.to_owned());
    }
    let mut renamed = Vec::new();
    for symbol in others {
        let identifier = identifier(symbol, taken);
        renamed.push((identifier.clone(), symbol));
        identifiers.insert(symbol, identifier);
    }
    (identifiers, renamed)
}

/// A free identifier that is like a symbol; it is taken from then on.
pub fn identifier(symbol: &str, taken: &mut FxHashSet<String>) -> String {
    let letters = symbol
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() { c } else { '_' });
    let base: String = letters.collect();
    let head = base.starts_with(|c: char| c.is_ascii_alphabetic());
    free(if head { base } else { format!("S{base}") }, taken)
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
pub(super) fn constants<'g>(
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

#[cfg(test)]
mod tests {
    use super::*;
    use edifice_grammar::Rule;

    #[test]
    fn a_size_that_is_written_twice_has_a_name() {
        let part = |symbol: &str, size| Successor::new(symbol, size);
        let rule = |symbol: &str, axis, successors| Rule {
            symbol: symbol.to_owned(),
            weight: None,
            operation: Operation::Split { axis, successors },
        };
        let grammar = Grammar {
            rules: vec![
                rule(
                    "A",
                    Axis::X,
                    vec![part("w", 2.0), part("v", 3.0), part("w", 2.0)],
                ),
                rule("B", Axis::X, vec![part("v", 3.5), part("w", 2.0)]),
                // The same along the other axis, once.
                rule("C", Axis::Y, vec![part("v", 3.0), part("w", 2.0)]),
            ],
            unit: "metre".to_owned(),
            starts: Vec::new(),
        };
        let names = FxHashMap::from_iter([("w", "window".to_owned()), ("v", "wall".to_owned())]);
        let found = constants(&grammar, &names, &mut FxHashSet::default());
        let found: Vec<_> = found
            .iter()
            .map(|(key, name, value)| (key.0, key.1, name.as_str(), *value))
            .collect();
        assert_eq!(found, [("w", Axis::X, "window_width", 2.0)]);
    }
}
