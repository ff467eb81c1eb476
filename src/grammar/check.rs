//! Is it a grammar? Every promise of the format, at the door.

use rustc_hash::FxHashSet;

use super::limits::{REGION_LIMIT, TOLERANCE};
use super::place::{Fit, place};
use super::table::Table;
use super::{Grammar, GrammarError, Operation, Rule, Size, Successor, Warning};
use edifice_shape::Rect;

/// Regions of different sizes tried per check; grammars whose relative sizes make more, or which
/// split these into more than [`REGION_LIMIT`] parts, are checked further when they are derived.
const SIZES_TRIED: usize = 200_000;

/// Checks a grammar: symbols, numbers, one rule per non-terminal (or weights), no cycle, and sizes
/// that fill the regions they split, from every start at its own size.
///
/// A terminal label may be any string, so a successor without a rule is a terminal and never an
/// error; an undefined symbol shows only as a start without a rule in a grammar that has rules
/// (in a joint grammar, when no start has one: a facade of one region starts from a terminal). A
/// rule that is never used is a [`Warning`].
///
/// # Errors
/// The first way in which the grammar is wrong, in the order above.
///
/// # Complexity
/// Linear in the written grammar, times the number of different sizes a symbol is used at.
pub fn check(grammar: &Grammar) -> Result<Vec<Warning>, GrammarError> {
    let table = check_structure(grammar)?;
    check_sizes(grammar, &table)?;
    Ok(warnings(&table))
}

/// Every check that needs no sizes of regions.
pub(super) fn check_structure(grammar: &Grammar) -> Result<Table<'_>, GrammarError> {
    check_starts(grammar)?;
    for (index, rule) in grammar.rules.iter().enumerate() {
        check_rule(index, rule)?;
    }
    let table = Table::new(grammar);
    for (symbol, rules) in table.rules_of.iter().enumerate() {
        if rules.len() > 1
            && let Some(i) = rules
                .iter()
                .position(|&r| grammar.rules[r].weight.is_none())
        {
            let other = if i == 0 { 1 } else { i - 1 };
            return Err(GrammarError::DuplicateRule {
                symbol: table.names[symbol].to_owned(),
                first: rules[i.min(other)],
                second: rules[i.max(other)],
            });
        }
    }
    let undefined = |&s: &usize| table.rules_of[s].is_empty();
    if !grammar.rules.is_empty() && table.starts.iter().all(undefined) {
        return Err(GrammarError::UndefinedStart {
            symbol: grammar.starts[0].symbol.clone(),
        });
    }
    match table.cycle() {
        Some(symbols) => Err(GrammarError::Cycle { symbols }),
        None => Ok(table),
    }
}

fn check_starts(grammar: &Grammar) -> Result<(), GrammarError> {
    if grammar.starts.is_empty() {
        return Err(GrammarError::NoStart);
    }
    for (index, start) in grammar.starts.iter().enumerate() {
        if start.symbol.is_empty() {
            return Err(GrammarError::EmptySymbol {
                place: format!("symbol of start {index}"),
            });
        }
        for (dimension, value) in [("width", start.width), ("height", start.height)] {
            if !positive(value) {
                return Err(GrammarError::StartSize {
                    index,
                    symbol: start.symbol.clone(),
                    dimension,
                    value,
                });
            }
        }
    }
    Ok(())
}

fn check_rule(index: usize, rule: &Rule) -> Result<(), GrammarError> {
    let symbol = || rule.symbol.clone();
    let named = |name: &str, field: String| match name {
        "" => Err(GrammarError::EmptySymbol {
            place: format!("rules[{index}].{field}"),
        }),
        _ => Ok(()),
    };
    let size = |size: Size, field: String| match positive(size.value()) {
        true => Ok(()),
        false => Err(GrammarError::SizeNumber {
            rule: index,
            symbol: symbol(),
            field,
            value: size.value(),
        }),
    };
    let successor = |i: usize, s: &Successor| {
        named(&s.symbol, format!("successors[{i}].symbol"))?;
        size(s.size, format!("successors[{i}].size"))
    };
    named(&rule.symbol, "symbol".to_owned())?;
    match rule.weight {
        Some(value) if !positive(value) => {
            return Err(GrammarError::Weight {
                rule: index,
                symbol: symbol(),
                value,
            });
        }
        _ => {}
    }
    if rule.operation.successor_count() == 0 {
        return Err(GrammarError::NoSuccessors {
            rule: index,
            symbol: symbol(),
        });
    }
    match &rule.operation {
        Operation::Split { successors, .. }
        | Operation::Repeat { successors, .. }
        | Operation::SymSplit { successors, .. } => {
            for (i, s) in successors.iter().enumerate() {
                successor(i, s)?;
            }
        }
        Operation::RepeatAba { a, b, .. } => {
            successor(0, a)?;
            successor(1, b)?;
        }
        Operation::GridSplit {
            columns,
            rows,
            cells,
        } => {
            let shape = |place: String, found: usize, expected: usize, what| {
                (found == expected)
                    .then_some(())
                    .ok_or(GrammarError::GridShape {
                        rule: index,
                        symbol: symbol(),
                        place,
                        found,
                        expected,
                        what,
                    })
            };
            shape("cells".to_owned(), cells.len(), rows.len(), "rows")?;
            for (j, row) in cells.iter().enumerate() {
                shape(format!("cells[{j}]"), row.len(), columns.len(), "columns")?;
                for (i, name) in row.iter().enumerate() {
                    named(name, format!("cells[{j}][{i}]"))?;
                }
            }
            for (i, &s) in columns.iter().enumerate() {
                size(s, format!("columns[{i}]"))?;
            }
            for (i, &s) in rows.iter().enumerate() {
                size(s, format!("rows[{i}]"))?;
            }
        }
    }
    Ok(())
}

/// Lays out every rule once in every size of region that the starts lead to.
fn check_sizes(grammar: &Grammar, table: &Table<'_>) -> Result<(), GrammarError> {
    let mut seen: FxHashSet<(usize, u64, u64)> = FxHashSet::default();
    let mut visited = 0;
    for (start, &symbol) in grammar.starts.iter().zip(&table.starts) {
        let tolerance = TOLERANCE * start.width.max(start.height);
        let mut stack = Vec::new();
        let mut new = |symbol: usize, width: f64, height: f64| {
            seen.len() < SIZES_TRIED && seen.insert((symbol, width.to_bits(), height.to_bits()))
        };
        if new(symbol, start.width, start.height) {
            stack.push((symbol, start.width, start.height));
        }
        while visited <= REGION_LIMIT
            && let Some((symbol, width, height)) = stack.pop()
        {
            for &rule in &table.rules_of[symbol] {
                let rect = Rect::new(0.0, 0.0, width, height);
                let written = &grammar.rules[rule];
                place(rule, written, rect, tolerance, Fit::AsWritten, |i, part| {
                    visited += 1;
                    let child = table.right[rule][i];
                    if !table.rules_of[child].is_empty() && new(child, part.width, part.height) {
                        stack.push((child, part.width, part.height));
                    }
                })?;
            }
        }
    }
    Ok(())
}

fn warnings(table: &Table<'_>) -> Vec<Warning> {
    let reachable = table.reachable();
    let unreachable = table.left.iter().enumerate();
    unreachable
        .filter(|(_, left)| !reachable[**left])
        .map(|(rule, &left)| Warning::Unreachable {
            rule,
            symbol: table.names[left].to_owned(),
        })
        .collect()
}

fn positive(value: f64) -> bool {
    value.is_finite() && value > 0.0
}
