//! A grammar as the paper prints one (Wu et al. 2014, Sec. 4.6 and 4.7).

use super::{Grammar, Operation, Size, Successor, summable};
use edifice_shape::Axis;

/// One line a rule: `NT1 → split(y){Wall1 | NT2 | Wall1}`; with `sizes`, `8: Wall1 | ...`, a weight
/// marked by `~`. A mirrored split without a middle part is written `symsplit(x, even)`.
pub fn listing(grammar: &Grammar, sizes: bool) -> Vec<String> {
    let width = grammar.rules.iter().map(|r| r.symbol.chars().count()).max();
    let width = width.unwrap_or(0);
    let line = |(index, rule): (usize, &super::Rule)| {
        let weight = match rule.weight {
            Some(weight) => format!("[{}] ", share(grammar, index, weight)),
            None => String::new(),
        };
        let symbol = &rule.symbol;
        format!("{symbol:width$} → {weight}{}", body(&rule.operation, sizes))
    };
    grammar.rules.iter().enumerate().map(line).collect()
}

/// A weight as a percentage of those of its symbol.
fn share(grammar: &Grammar, index: usize, weight: f64) -> String {
    let symbol = &grammar.rules[index].symbol;
    let rules = grammar.rules.iter().filter(|r| r.symbol == *symbol);
    let all = std::iter::once(weight).chain(rules.filter_map(|r| r.weight));
    let weights = summable(&all.collect::<Vec<_>>());
    let total: f64 = weights[1..].iter().sum();
    format!("{:.4}%", 100.0 * weights[0] / total).replace(".0000%", "%")
}

fn body(operation: &Operation, sizes: bool) -> String {
    let part = |s: &Successor| sized(s.size, &s.symbol, sizes);
    let parts = |successors: &[Successor]| successors.iter().map(part).collect::<Vec<_>>();
    let line = |name: &str, axis: Axis, parts: Vec<String>| {
        format!("{name}({}){{{}}}", axis.name(), parts.join(" | "))
    };
    match operation {
        Operation::Split { axis, successors } => line("split", *axis, parts(successors)),
        Operation::Repeat { axis, successors } => line("repeat", *axis, parts(successors)),
        Operation::RepeatAba { axis, a, b } => line("repeatABA", *axis, vec![part(a), part(b)]),
        Operation::SymSplit {
            axis,
            successors,
            center,
        } => {
            let text = line("symsplit", *axis, parts(successors));
            match center {
                true => text,
                false => text.replacen(')', ", even)", 1),
            }
        }
        Operation::GridSplit {
            columns,
            rows,
            cells,
        } => {
            let row = |(row, height): (&Vec<String>, &Size)| {
                let cells = row.iter().zip(columns);
                let cells: Vec<String> = cells.map(|(s, w)| sized(*w, s, sizes)).collect();
                sized(*height, &format!("{{{}}}", cells.join(" | ")), sizes)
            };
            let rows: Vec<String> = cells.iter().zip(rows).map(row).collect();
            format!("gridsplit{{{}}}", rows.join(" | "))
        }
    }
}

fn sized(size: Size, symbol: &str, sizes: bool) -> String {
    match (size, sizes) {
        (_, false) => symbol.to_owned(),
        (Size::Absolute(v), true) => format!("{v}: {symbol}"),
        (Size::Relative(v), true) => format!("~{v}: {symbol}"),
    }
}
