//! The size of a grammar that states none.

use rustc_hash::{FxHashMap, FxHashSet};

use edifice_grammar::{Operation, Rule, Size};
use edifice_shape::Axis;

/// Extent of a symbol along `wanted`, where absolute sizes alone say it.
pub(super) fn natural_extent(rules: &[Rule], symbol: &str, wanted: Axis) -> Option<f64> {
    let mut by_symbol: FxHashMap<&str, &Operation> = FxHashMap::default();
    for rule in rules {
        by_symbol.entry(&rule.symbol).or_insert(&rule.operation);
    }
    let sum = |sizes: Vec<Size>| {
        sizes.into_iter().try_fold(0.0, |sum, size| match size {
            Size::Absolute(v) => Some(sum + v),
            Size::Relative(_) => None,
        })
    };
    let mut todo = vec![symbol];
    let mut seen: FxHashSet<&str> = FxHashSet::default();
    while let Some(symbol) = todo.pop() {
        let Some(operation) = by_symbol.get(symbol).filter(|_| seen.insert(symbol)) else {
            continue;
        };
        let found = match operation {
            Operation::Split { axis, successors } if *axis == wanted => {
                sum(successors.iter().map(|s| s.size).collect())
            }
            Operation::SymSplit {
                axis,
                successors,
                center,
            } if *axis == wanted => {
                let half = sum(successors.iter().map(|s| s.size).collect());
                let middle = successors.last().filter(|_| *center);
                half.map(|h| 2.0 * h - middle.map_or(0.0, |s| s.size.value()))
            }
            Operation::Repeat { axis, .. } | Operation::RepeatAba { axis, .. }
                if *axis == wanted =>
            {
                None
            }
            Operation::GridSplit { columns, rows, .. } => match wanted {
                Axis::X => sum(columns.clone()),
                Axis::Y => sum(rows.clone()),
            },
            across => {
                // Every part shares the extent across the split.
                todo.extend(across.symbols());
                None
            }
        };
        if found.is_some() {
            return found;
        }
    }
    None
}
