//! Edits of the rules of a split grammar, as text and as values.

use super::error::{GrammarEditError, known};
use super::floors;
use super::place::Place;
use super::rule_axis::{RuleAxis, unfit};
use edifice_grammar::{Grammar, Operation, Successor, check, size_independent};

/// One edit. Rules are counted from 0 in the order of the file; PART is a [`Place`] in one: a part, or a column or row of a grid.
#[derive(Debug, Clone, PartialEq)]
pub enum GrammarEdit {
    /// `resize RULE.PART=SIZE`: in a split and a grid the others give way in proportion.
    Resize(usize, Place, f64),
    /// `border RULE.PART=SHIFT`: moves the border between this one and the next.
    Border(usize, Place, f64),
    /// `symbol RULE.PART=NAME`: another symbol in the place of a part or a cell.
    Symbol(usize, Place, String),
    /// `insert RULE.PART=NAME:SIZE`: a new one before this, of a grid with that symbol in all its cells; `insert RULE.PART=SIZE`:
    /// a copy of this one before it. In a split and a grid the others give way in proportion.
    Insert(usize, Place, Option<String>, f64),
    /// `remove RULE.PART`: in a split and a grid the others take its place in proportion.
    Remove(usize, Place),
    /// `grow RULE.PART`: a copy of this one before it, or a period of a repeat, a floor or a column; the facade grows by its length.
    Grow(usize, Place),
    /// `shrink RULE.PART`: this one goes, or a period of a repeat, and the facade shrinks by its length.
    Shrink(usize, Place),
    /// `repeat RULE`: a split of equal periods becomes a repeat.
    Repeat(usize),
    /// `weight RULE=W`: weight among the rules of its symbol.
    Weight(usize, f64),
    /// `outline W,H`: the facade's own size.
    Outline([f64; 2]),
}

/// The grammar after edits, made in turn. Its sizes are made relative first, as for a derivation at another size, so that
/// what is inside an edited region follows it.
///
/// # Errors
/// [`GrammarEditError`]; the edited grammar is checked whole.
pub fn edit(grammar: &Grammar, edits: &[GrammarEdit]) -> Result<Grammar, GrammarEditError> {
    check(grammar)?;
    let mut out = size_independent(grammar);
    for edit in edits {
        apply(&mut out, edit)?;
    }
    check(&out)?;
    Ok(out)
}

fn apply(grammar: &mut Grammar, edit: &GrammarEdit) -> Result<(), GrammarEditError> {
    match edit {
        GrammarEdit::Outline([w, h]) => {
            for start in &mut grammar.starts {
                (start.width, start.height) = (*w, *h);
            }
        }
        GrammarEdit::Weight(rule, weight) => {
            known(grammar, *rule)?;
            grammar.rules[*rule].weight = Some(*weight);
        }
        GrammarEdit::Grow(rule, part) => floors::change(grammar, *rule, *part, true)?,
        GrammarEdit::Shrink(rule, part) => floors::change(grammar, *rule, *part, false)?,
        GrammarEdit::Repeat(rule) => {
            known(grammar, *rule)?;
            let operation = &mut grammar.rules[*rule].operation;
            *operation = repeated(operation).ok_or(GrammarEditError::NoPeriod { rule: *rule })?;
        }
        GrammarEdit::Symbol(rule, part, name) => {
            *symbol(grammar, *rule, *part)? = name.clone();
        }
        GrammarEdit::Resize(rule, part, size) => {
            let mut axis = RuleAxis::of(grammar, *rule, *part)?;
            let k = part.index();
            let old = axis.sizes()[k];
            // A part that stands twice takes from the others twice.
            axis.set(k, *size)?;
            let more = axis.times(k) * (old - size);
            axis.give_way(Some(k), more)?;
        }
        GrammarEdit::Border(rule, part, shift) => {
            let k = part.index();
            let mut axis = RuleAxis::of(grammar, *rule, part.at(k.saturating_add(1)))?;
            let (a, b) = (axis.sizes()[k], axis.sizes()[k + 1]);
            if a + shift <= 0.0 || b - shift <= 0.0 {
                return Err(axis.error(k, a + shift, a + b));
            }
            axis.change(k, |v| v + shift);
            axis.change(k + 1, |v| v - shift);
        }
        GrammarEdit::Insert(rule, part, name, size) => {
            let k = part.index();
            // A new one may stand behind the last; a copy is of one that is there.
            let near = name.as_ref().map_or(k, |_| k.saturating_sub(1));
            let mut axis = RuleAxis::of(grammar, *rule, part.at(near))?;
            let before = axis.total();
            axis.insert(k, name.as_deref(), *size)?;
            axis.set(k, *size)?;
            axis.give_way(Some(k), before - axis.total())?;
        }
        GrammarEdit::Remove(rule, part) => {
            let mut axis = RuleAxis::of(grammar, *rule, *part)?;
            let k = part.index();
            let before = axis.total();
            axis.remove(k)?;
            axis.give_way(None, before - axis.total())?;
        }
    }
    Ok(())
}

fn symbol(
    grammar: &mut Grammar,
    rule: usize,
    part: Place,
) -> Result<&mut String, GrammarEditError> {
    known(grammar, rule)?;
    let operation = &mut grammar.rules[rule].operation;
    let Place::Part(index) = part else {
        let hint = "symbols are of parts and of cells, which are named by a number";
        return Err(unfit(rule, operation, hint));
    };
    let count = operation.successor_count();
    let found = match operation {
        Operation::Split { successors, .. }
        | Operation::Repeat { successors, .. }
        | Operation::SymSplit { successors, .. } => {
            successors.get_mut(index).map(|s| &mut s.symbol)
        }
        Operation::RepeatAba { a, b, .. } => [&mut a.symbol, &mut b.symbol].into_iter().nth(index),
        Operation::GridSplit { cells, .. } => cells.iter_mut().flatten().nth(index),
    };
    found.ok_or(GrammarEditError::NoPart { rule, part, count })
}

/// A split of equal periods as a repeat of the shortest one.
fn repeated(operation: &Operation) -> Option<Operation> {
    let Operation::Split { axis, successors } = operation else {
        return None;
    };
    let n = successors.len();
    let total: f64 = successors.iter().map(|s| s.size.value()).sum();
    let same = |a: &Successor, b: &Successor| {
        let close = (a.size.value() - b.size.value()).abs() <= 1e-6 * total;
        a.symbol == b.symbol && close
    };
    let repeats =
        |p: &usize| n % p == 0 && (*p..n).all(|k| same(&successors[k], &successors[k % p]));
    let period = (1..=n / 2).find(repeats)?;
    Some(Operation::Repeat {
        axis: *axis,
        successors: successors[..period].to_vec(),
    })
}
