//! Edits of the rules of a split grammar, as text and as values.

use super::super::{CommandError, numbers};
use super::floors;
use crate::grammar::{Grammar, GrammarError, Operation, Size, Successor, check, size_independent};

/// One edit. Rules are counted from 0 in the order of the file, parts from 0 in the order written.
#[derive(Debug, Clone, PartialEq)]
pub enum GrammarEdit {
    /// `resize RULE.PART=SIZE`: in a split the other parts give way in proportion.
    Resize(usize, usize, f64),
    /// `border RULE.PART=SHIFT`: moves the border between this part and the next one.
    Border(usize, usize, f64),
    /// `symbol RULE.PART=NAME`: another symbol in its place.
    Symbol(usize, usize, String),
    /// `insert RULE.PART=NAME:SIZE`: a new part before this one; in a split the others give way in proportion.
    Insert(usize, usize, String, f64),
    /// `remove RULE.PART`: in a split the others take its place in proportion.
    Remove(usize, usize),
    /// `grow RULE.PART`: a copy of this part before it, a floor or a column; the facade grows by its length.
    Grow(usize, usize),
    /// `shrink RULE.PART`: this part goes, and the facade shrinks by its length.
    Shrink(usize, usize),
    /// `repeat RULE`: a split of equal periods becomes a repeat.
    Repeat(usize),
    /// `weight RULE=W`: weight among the rules of its symbol.
    Weight(usize, f64),
    /// `outline W,H`: the facade's own size.
    Outline([f64; 2]),
}

/// Why a grammar cannot be edited so.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GrammarEditError {
    /// There is no such rule.
    #[error("there is no rules[{rule}]: the grammar has {count}")]
    NoRule {
        /// Its index.
        rule: usize,
        /// Rules of the grammar.
        count: usize,
    },
    /// There is no such part.
    #[error("rules[{rule}] has no part {part}: it has {count}")]
    NoPart {
        /// Index of the rule.
        rule: usize,
        /// Index of the part.
        part: usize,
        /// Parts of the rule.
        count: usize,
    },
    /// The parts of the rule's operation are no list with sizes.
    #[error("the parts of rules[{rule}] ({operation}) cannot be edited so")]
    Operation {
        /// Index of the rule.
        rule: usize,
        /// Name of its operation.
        operation: &'static str,
    },
    /// A size leaves nothing for the part itself or for the others.
    #[error("size {size} for part {part} of rules[{rule}]: the parts beside it have {room}")]
    Size {
        /// Index of the rule.
        rule: usize,
        /// Index of the part.
        part: usize,
        /// The size asked for.
        size: f64,
        /// What there is.
        room: f64,
    },
    /// The regions of a rule are as long in every facade.
    #[error("the regions of rules[{rule}] have a fixed length: no floor or column fits in")]
    Fixed {
        /// Index of the rule.
        rule: usize,
    },
    /// A split is no sequence of equal periods.
    #[error("rules[{rule}] does not repeat itself")]
    NoPeriod {
        /// Index of the rule.
        rule: usize,
    },
    /// The edited grammar is none.
    #[error(transparent)]
    Grammar(#[from] GrammarError),
}

impl std::str::FromStr for GrammarEdit {
    type Err = CommandError;

    fn from_str(text: &str) -> Result<Self, CommandError> {
        read(text).map_err(|message| CommandError::Edit {
            edit: text.to_owned(),
            message,
        })
    }
}

fn read(text: &str) -> Result<GrammarEdit, String> {
    let (verb, rest) = text.split_once(' ').unwrap_or((text, ""));
    let index = |t: &str| t.parse::<usize>().map_err(|_| format!("{t:?} is no index"));
    let place = |t: &str| {
        let (rule, part) = t.split_once('.').ok_or("expected RULE.PART")?;
        Ok::<_, String>((index(rule)?, index(part)?))
    };
    let value = || {
        rest.split_once('=')
            .ok_or("expected a value after =".to_owned())
    };
    let number = |t: &str| numbers::<1>(t).map(|[v]| v);
    Ok(match verb {
        "resize" | "border" => {
            let (at, size) = value()?;
            let ((rule, part), size) = (place(at)?, number(size)?);
            match verb {
                "resize" => GrammarEdit::Resize(rule, part, size),
                _ => GrammarEdit::Border(rule, part, size),
            }
        }
        "symbol" => {
            let (at, name) = value()?;
            let (rule, part) = place(at)?;
            GrammarEdit::Symbol(rule, part, name.to_owned())
        }
        "insert" => {
            let (at, what) = value()?;
            let (rule, part) = place(at)?;
            let (name, size) = what.rsplit_once(':').ok_or("expected NAME:SIZE")?;
            GrammarEdit::Insert(rule, part, name.to_owned(), number(size)?)
        }
        "remove" => place(rest).map(|(rule, part)| GrammarEdit::Remove(rule, part))?,
        "grow" => place(rest).map(|(rule, part)| GrammarEdit::Grow(rule, part))?,
        "shrink" => place(rest).map(|(rule, part)| GrammarEdit::Shrink(rule, part))?,
        "repeat" => GrammarEdit::Repeat(index(rest)?),
        "weight" => {
            let (rule, weight) = value()?;
            GrammarEdit::Weight(index(rule)?, number(weight)?)
        }
        "outline" => GrammarEdit::Outline(numbers(rest)?),
        _ => {
            return Err(
                "expected resize, border, symbol, insert, remove, grow, shrink, repeat, weight or outline".into(),
            );
        }
    })
}

/// The grammar after edits, made in turn. Its sizes are made relative first, as for a derivation at another size, so that
/// what is inside an edited region follows it.
///
/// # Errors
/// [`GrammarEditError`]; the edited grammar is checked whole.
pub fn edit(grammar: &Grammar, edits: &[GrammarEdit]) -> Result<Grammar, GrammarEditError> {
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
            let mut list = parts(grammar, *rule, *part)?;
            let old = list.sizes()[*part];
            // A part that stands twice takes from the others twice.
            list.set(*part, *size)?;
            let times = list.times(*part);
            list.give_way(Some(*part), times * (old - size))?;
        }
        GrammarEdit::Border(rule, part, shift) => {
            let list = parts(grammar, *rule, part + 1)?;
            let (a, b) = (list.sizes()[*part], list.sizes()[part + 1]);
            let room = a + b;
            if a + shift <= 0.0 || b - shift <= 0.0 {
                return Err(list.error(*part, a + shift, room));
            }
            list.successors[*part].size = with(list.successors[*part].size, a + shift);
            list.successors[part + 1].size = with(list.successors[part + 1].size, b - shift);
        }
        GrammarEdit::Insert(rule, part, name, size) => {
            let mut list = parts(grammar, *rule, part.saturating_sub(1))?;
            let size_of = Size::Relative(*size);
            list.successors.insert(
                *part,
                Successor {
                    symbol: name.clone(),
                    size: size_of,
                },
            );
            list.set(*part, *size)?;
            let times = list.times(*part);
            list.give_way(Some(*part), -times * size)?;
        }
        GrammarEdit::Remove(rule, part) => {
            let mut list = parts(grammar, *rule, *part)?;
            if list.successors.len() == 1 {
                return Err(list.error(*part, 0.0, 0.0));
            }
            let freed = list.times(*part) * list.sizes()[*part];
            list.successors.remove(*part);
            list.give_way(None, freed)?;
        }
    }
    Ok(())
}

fn known(grammar: &Grammar, rule: usize) -> Result<(), GrammarEditError> {
    let count = grammar.rules.len();
    match rule < count {
        true => Ok(()),
        false => Err(GrammarEditError::NoRule { rule, count }),
    }
}

fn symbol(
    grammar: &mut Grammar,
    rule: usize,
    part: usize,
) -> Result<&mut String, GrammarEditError> {
    known(grammar, rule)?;
    let operation = &mut grammar.rules[rule].operation;
    let count = operation.successor_count();
    let found = match operation {
        Operation::Split { successors, .. }
        | Operation::Repeat { successors, .. }
        | Operation::SymSplit { successors, .. } => successors.get_mut(part).map(|s| &mut s.symbol),
        Operation::RepeatAba { a, b, .. } => [&mut a.symbol, &mut b.symbol].into_iter().nth(part),
        Operation::GridSplit { cells, .. } => cells.iter_mut().flatten().nth(part),
    };
    found.ok_or(GrammarEditError::NoPart { rule, part, count })
}

/// The parts of a rule whose sizes are edited.
pub(super) struct Parts<'g> {
    rule: usize,
    pub(super) successors: &'g mut Vec<Successor>,
    /// Whether the parts fill the region once, so that others give way.
    fills: bool,
    /// Of a mirrored split: whether its last part stands once in the middle.
    center: Option<bool>,
}

pub(super) fn parts(
    grammar: &mut Grammar,
    rule: usize,
    last: usize,
) -> Result<Parts<'_>, GrammarEditError> {
    known(grammar, rule)?;
    let operation = &mut grammar.rules[rule].operation;
    let name = operation.name();
    let (successors, fills, center) = match operation {
        Operation::Split { successors, .. } => (successors, true, None),
        Operation::Repeat { successors, .. } => (successors, false, None),
        Operation::SymSplit {
            successors, center, ..
        } => (successors, true, Some(*center)),
        _ => {
            return Err(GrammarEditError::Operation {
                rule,
                operation: name,
            });
        }
    };
    let count = successors.len();
    match last < count {
        true => Ok(Parts {
            rule,
            successors,
            fills,
            center,
        }),
        false => Err(GrammarEditError::NoPart {
            rule,
            part: last,
            count,
        }),
    }
}

impl Parts<'_> {
    pub(super) fn sizes(&self) -> Vec<f64> {
        self.successors.iter().map(|s| s.size.value()).collect()
    }

    /// How often a part stands in the region.
    pub(super) fn times(&self, part: usize) -> f64 {
        match self.center {
            None => 1.0,
            Some(true) if part + 1 == self.successors.len() => 1.0,
            Some(_) => 2.0,
        }
    }

    pub(super) fn error(&self, part: usize, size: f64, room: f64) -> GrammarEditError {
        let rule = self.rule;
        GrammarEditError::Size {
            rule,
            part,
            size,
            room,
        }
    }

    fn set(&mut self, part: usize, size: f64) -> Result<(), GrammarEditError> {
        if !(size.is_finite() && size > 0.0) {
            return Err(self.error(part, size, self.sizes().iter().sum()));
        }
        let own = &mut self.successors[part].size;
        *own = with(*own, size);
        Ok(())
    }

    /// Scales all parts but one so that together they take `more` than before, where the parts fill a region.
    fn give_way(&mut self, but: Option<usize>, more: f64) -> Result<(), GrammarEditError> {
        if !self.fills {
            return Ok(());
        }
        let others: Vec<usize> = (0..self.successors.len())
            .filter(|k| Some(*k) != but)
            .collect();
        let sizes = self.sizes();
        let now: f64 = others.iter().map(|k| self.times(*k) * sizes[*k]).sum();
        let factor = (now + more) / now;
        if !(factor.is_finite() && factor > 0.0) {
            let part = but.unwrap_or(0);
            return Err(self.error(part, sizes[part], now));
        }
        for k in others {
            let own = &mut self.successors[k].size;
            *own = with(*own, sizes[k] * factor);
        }
        Ok(())
    }
}

/// The same kind of size with another number.
fn with(size: Size, value: f64) -> Size {
    match size {
        Size::Absolute(_) => Size::Absolute(value),
        Size::Relative(_) => Size::Relative(value),
    }
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
