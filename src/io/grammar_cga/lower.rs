//! From statements to a grammar.

use chumsky::span::SimpleSpan;
use rustc_hash::{FxHashMap, FxHashSet};

use super::error::Fault;
use super::note::Note;
use super::syntax::{Alternative, At, CgaRule, Chance, Entry, Expression, Item, Part, Target};
use crate::grammar::{Grammar, GrammarError, Operation, Rule, Size, Start, Successor, check};
use crate::shape::Axis;

/// The unit of text that names none: CityEngine's metre.
const UNIT: &str = "m";

/// Two percentages are the same when they differ by at most this much.
const PERCENT_SLACK: f64 = 1e-6;

/// Builds the grammar and checks it.
pub(super) fn lower(
    header: &[At<Note>],
    items: &[Item<'_>],
    end: SimpleSpan,
) -> Result<Grammar, Fault> {
    let mut builder = Builder::default();
    for (note, span) in header {
        if let Note::Symbol { identifier, name } = note
            && builder.renamed.insert(identifier, name).is_some()
        {
            return Err(Fault::new(
                *span,
                "this identifier already stands for a symbol",
            ));
        }
    }
    for item in items {
        match item {
            Item::Constant((name, span), value) => {
                let value = builder.value(value)?;
                if builder.constants.insert(name, value).is_some() {
                    return Err(Fault::new(*span, "this constant is defined twice"));
                }
            }
            Item::Rule(rule) => {
                let symbol = builder.symbol(rule.name.0);
                builder.used.insert(symbol);
            }
            Item::Version | Item::StartRule => {}
        }
    }
    let mut axiom = None;
    let mut marked = false;
    for item in items {
        match item {
            Item::StartRule => marked = true,
            Item::Rule(rule) => {
                if std::mem::take(&mut marked) || axiom.is_none() {
                    axiom = Some(rule.name);
                }
                builder.rule(rule)?;
            }
            Item::Version | Item::Constant(..) => {}
        }
    }
    builder.finish(header, axiom, end)
}

#[derive(Default)]
struct Builder<'a> {
    /// Symbols that identifiers stand for.
    renamed: FxHashMap<&'a str, &'a str>,
    constants: FxHashMap<&'a str, f64>,
    /// Left-hand sides, so that helper symbols are new.
    used: FxHashSet<String>,
    rules: Vec<Rule>,
    /// Where each rule is written.
    places: Vec<SimpleSpan>,
}

impl<'a> Builder<'a> {
    fn symbol(&self, identifier: &str) -> String {
        let name = self.renamed.get(identifier);
        name.copied().unwrap_or(identifier).to_owned()
    }

    fn value(&self, (expression, span): &At<Expression<'_>>) -> Result<f64, Fault> {
        let value = self.evaluate(expression, *span)?;
        match value.is_finite() {
            true => Ok(value),
            false => Err(Fault::new(
                *span,
                format!("this is {value}, expected a finite number"),
            )),
        }
    }

    fn evaluate(&self, expression: &Expression<'_>, span: SimpleSpan) -> Result<f64, Fault> {
        match expression {
            Expression::Number(text) => text
                .parse()
                .map_err(|_| Fault::new(span, format!("{text} is not a number"))),
            Expression::Name(name) => self.constants.get(name).copied().ok_or_else(|| {
                Fault::new(
                    span,
                    format!("constant {name} is not defined above this line"),
                )
            }),
            Expression::Negative(value) => Ok(-self.evaluate(value, span)?),
            Expression::Binary(left, sign, right) => {
                let (left, right) = (self.evaluate(left, span)?, self.evaluate(right, span)?);
                Ok(match sign {
                    '+' => left + right,
                    '-' => left - right,
                    '*' => left * right,
                    _ => left / right,
                })
            }
        }
    }

    fn rule(&mut self, rule: &CgaRule<'_>) -> Result<(), Fault> {
        let symbol = self.symbol(rule.name.0);
        let weights = self.weights(rule)?;
        for (alternative, weight) in rule.alternatives.iter().zip(weights) {
            let leftover = matches!(alternative.target.0, Target::Symbol("NIL"));
            if leftover && matches!(alternative.chance, Chance::Else) && weight == Some(0.0) {
                continue;
            }
            // The rule takes its place before the helpers that its parts need.
            let index = self.rules.len();
            self.rules.push(Rule {
                symbol: symbol.clone(),
                weight,
                operation: Operation::Split {
                    axis: Axis::X,
                    successors: Vec::new(),
                },
            });
            self.places.push(match rule.alternatives.len() {
                1 => rule.name.1,
                _ => alternative.target.1,
            });
            self.rules[index].operation = self.alternative(alternative, &symbol)?;
        }
        Ok(())
    }

    /// The weight of each alternative: its percentage, or what a comment says that it was.
    fn weights(&self, rule: &CgaRule<'_>) -> Result<Vec<Option<f64>>, Fault> {
        let mut shares = Vec::new();
        for alternative in &rule.alternatives {
            let rest = || 100.0 - shares.iter().flatten().sum::<f64>();
            let share = match &alternative.chance {
                Chance::Always => None,
                Chance::Percent(value) => Some(self.value(value)?),
                Chance::Else => Some(rest()).map(|r| if r.abs() < PERCENT_SLACK { 0.0 } else { r }),
            };
            shares.push(share);
        }
        for &(text, span) in &rule.notes {
            let Note::Weights(weights) = Note::parse(text, span)? else {
                return Err(Fault::new(span, "this comment belongs below the arrow"));
            };
            let total: f64 = weights.iter().sum();
            let explains = |(weight, share): (&f64, &Option<f64>)| {
                share.is_some_and(|s| (100.0 * weight / total - s).abs() <= PERCENT_SLACK)
            };
            // A closing `else : NIL` of nothing has no weight.
            let extra = shares.len() - weights.len().min(shares.len());
            let rest_is_nothing =
                shares[weights.len().min(shares.len())..] == vec![Some(0.0); extra];
            if weights.len() > shares.len()
                || !rest_is_nothing
                || !weights.iter().zip(&shares).all(explains)
            {
                let message = "these weights do not match the percentages below; correct or remove the comment";
                return Err(Fault::new(span, message));
            }
            for (share, weight) in shares.iter_mut().zip(weights) {
                *share = Some(weight);
            }
        }
        Ok(shares)
    }

    fn alternative(
        &mut self,
        alternative: &Alternative<'_>,
        symbol: &str,
    ) -> Result<Operation, Fault> {
        let (target, _) = &alternative.target;
        let mut notes = alternative.notes.iter();
        let note = match notes.next() {
            None => return self.operation(target, symbol),
            Some(&(text, at)) => (Note::parse(text, at)?, at),
        };
        if let Some(&(_, at)) = notes.next() {
            return Err(Fault::new(at, "one comment of this kind is enough"));
        }
        match (note, target) {
            ((Note::SymSplit, at), Target::Split(axis, entries)) => {
                self.sym_split(*axis, entries, symbol, at)
            }
            ((Note::GridSplit, at), Target::Split(Axis::Y, entries)) => {
                self.grid_split(entries, at)
            }
            ((_, at), _) => Err(Fault::new(at, "this comment does not fit what is below it")),
        }
    }

    fn operation(&mut self, target: &Target<'_>, symbol: &str) -> Result<Operation, Fault> {
        let (axis, entries) = match target {
            Target::Split(axis, entries) => (*axis, entries),
            Target::Symbol(name) => {
                let size = Size::Relative(1.0);
                let successors = vec![Successor {
                    symbol: self.symbol(name),
                    size,
                }];
                return Ok(Operation::Split {
                    axis: Axis::X,
                    successors,
                });
            }
        };
        if let [Entry::Repeat(parts, _)] = &entries[..] {
            let successors = self.successors(parts, symbol)?;
            return Ok(Operation::Repeat { axis, successors });
        }
        if let [Entry::Part(a), Entry::Repeat(parts, _)] = &entries[..]
            && let [b, again] = &parts[..]
            && let (Target::Symbol(first), Target::Symbol(last)) = (&a.target.0, &again.target.0)
            && first == last
            && self.size(a)? == self.size(again)?
        {
            let a = self.successor(a, symbol)?;
            let b = self.successor(b, symbol)?;
            return Ok(Operation::RepeatAba { axis, a, b });
        }
        let mut successors = Vec::new();
        let mut repeats = 0;
        for entry in entries {
            successors.push(match entry {
                Entry::Part(part) => self.successor(part, symbol)?,
                Entry::Repeat(parts, span) => {
                    repeats += 1;
                    if repeats > 1 {
                        return Err(Fault::new(*span, "a split can have one repeat"));
                    }
                    self.repeated_middle(axis, parts, *span, symbol)?
                }
            });
        }
        Ok(Operation::Split { axis, successors })
    }

    /// A repeat among other parts: a helper symbol that takes what the others leave.
    fn repeated_middle(
        &mut self,
        axis: Axis,
        parts: &[Part<'_>],
        span: SimpleSpan,
        symbol: &str,
    ) -> Result<Successor, Fault> {
        let successors = self.successors(parts, symbol)?;
        let period = successors.iter().map(|s| s.size.value()).sum();
        let operation = Operation::Repeat { axis, successors };
        Ok(Successor {
            symbol: self.helper(symbol, operation, span),
            size: Size::Relative(period),
        })
    }

    fn successors<'p, 't: 'p>(
        &mut self,
        parts: impl IntoIterator<Item = &'p Part<'t>>,
        symbol: &str,
    ) -> Result<Vec<Successor>, Fault> {
        parts
            .into_iter()
            .map(|part| self.successor(part, symbol))
            .collect()
    }

    fn successor(&mut self, part: &Part<'_>, symbol: &str) -> Result<Successor, Fault> {
        let size = self.size(part)?;
        let (target, span) = &part.target;
        let symbol = match target {
            Target::Symbol(name) => self.symbol(name),
            Target::Split(..) => {
                let operation = self.operation(target, symbol)?;
                self.helper(symbol, operation, *span)
            }
        };
        Ok(Successor { symbol, size })
    }

    fn size(&self, part: &Part<'_>) -> Result<Size, Fault> {
        let value = self.value(&part.size)?;
        if value <= 0.0 {
            return Err(Fault::new(
                part.size.1,
                format!("size {value}, expected a positive number"),
            ));
        }
        Ok(match part.relative {
            true => Size::Relative(value),
            false => Size::Absolute(value),
        })
    }

    /// A new symbol for an operation written inside another.
    fn helper(&mut self, parent: &str, operation: Operation, span: SimpleSpan) -> String {
        let mut number = 1;
        let symbol = loop {
            let name = format!("{parent}_{number}");
            if self.used.insert(name.clone()) {
                break name;
            }
            number += 1;
        };
        self.rules.push(Rule {
            symbol: symbol.clone(),
            weight: None,
            operation,
        });
        self.places.push(span);
        symbol
    }

    fn sym_split(
        &mut self,
        axis: Axis,
        entries: &[Entry<'_>],
        symbol: &str,
        at: SimpleSpan,
    ) -> Result<Operation, Fault> {
        let asymmetric = || {
            Fault::new(
                at,
                "the split below is not the same from both ends; correct it or remove the comment",
            )
        };
        let parts = plain(entries).ok_or_else(asymmetric)?;
        let mut all = self.successors(parts, symbol)?;
        let mirrored = all.iter().eq(all.iter().rev());
        if !mirrored {
            return Err(asymmetric());
        }
        let center = all.len() % 2 == 1;
        all.truncate(all.len().div_ceil(2));
        Ok(Operation::SymSplit {
            axis,
            successors: all,
            center,
        })
    }

    fn grid_split(&mut self, entries: &[Entry<'_>], at: SimpleSpan) -> Result<Operation, Fault> {
        let no_grid = || {
            Fault::new(
                at,
                "the splits below are not one grid of symbols; correct them or remove the comment",
            )
        };
        let mut columns: Option<Vec<Size>> = None;
        let (mut rows, mut cells) = (Vec::new(), Vec::new());
        for part in plain(entries).ok_or_else(no_grid)? {
            rows.push(self.size(part)?);
            let Target::Split(Axis::X, inner) = &part.target.0 else {
                return Err(no_grid());
            };
            let inner = plain(inner).ok_or_else(no_grid)?;
            let mut row = Vec::new();
            let mut sizes = Vec::new();
            for part in inner {
                let Target::Symbol(name) = &part.target.0 else {
                    return Err(no_grid());
                };
                row.push(self.symbol(name));
                sizes.push(self.size(part)?);
            }
            if *columns.get_or_insert_with(|| sizes.clone()) != sizes {
                return Err(no_grid());
            }
            cells.push(row);
        }
        Ok(Operation::GridSplit {
            columns: columns.unwrap_or_default(),
            rows,
            cells,
        })
    }

    fn finish(
        self,
        header: &[At<Note>],
        axiom: Option<At<&str>>,
        end: SimpleSpan,
    ) -> Result<Grammar, Fault> {
        let mut unit = None;
        let mut starts = Vec::new();
        let mut places = Vec::new();
        for (note, span) in header {
            match note {
                Note::Unit(_) if unit.is_some() => {
                    return Err(Fault::new(*span, "the unit is given twice"));
                }
                Note::Unit(text) => unit = Some(text.clone()),
                Note::Facade {
                    symbol,
                    width,
                    height,
                    name,
                } => {
                    let symbol = self.symbol(symbol);
                    places.push(*span);
                    starts.push(Start {
                        name: name.clone().unwrap_or_else(|| symbol.clone()),
                        symbol,
                        width: *width,
                        height: *height,
                    });
                }
                _ => {}
            }
        }
        let mut unsized_axiom = None;
        if starts.is_empty() {
            let Some((axiom, span)) = axiom else {
                return Err(Fault::new(end, "no rules, and no //@ facade comment"));
            };
            let symbol = self.symbol(axiom);
            let extent = |axis| natural_extent(&self.rules, &symbol, axis);
            let size = extent(Axis::X).zip(extent(Axis::Y));
            if size.is_none() {
                let message = format!(
                    "the size of {symbol} does not follow from the rules; add a line like //@ facade {axiom} 400 x 600"
                );
                unsized_axiom = Some(Fault::new(span, message));
            }
            let (width, height) = size.unwrap_or((1.0, 1.0));
            starts.push(Start {
                name: symbol.clone(),
                symbol,
                width,
                height,
            });
            places.push(span);
        }
        let unit = unit.unwrap_or_else(|| UNIT.to_owned());
        let grammar = Grammar {
            unit,
            starts,
            rules: self.rules,
        };
        let place = |error: &GrammarError| {
            let start = |index: usize| places.get(index).copied();
            match error {
                GrammarError::StartSize { index, .. } => start(*index),
                GrammarError::UndefinedStart { .. } => start(0),
                GrammarError::Cycle { symbols } => {
                    let first = symbols.first();
                    let rule = grammar.rules.iter().position(|r| Some(&r.symbol) == first);
                    rule.map(|r| self.places[r])
                }
                error => error.rule().map(|r| self.places[r]),
            }
        };
        match (check(&grammar), unsized_axiom) {
            (Ok(_), None) => Ok(grammar),
            (Err(error), None) => Err(Fault::new(place(&error).unwrap_or(end), error.to_string())),
            // Without a size only what does not depend on it is told.
            (Err(error), Some(_)) if !error.depends_on_size() => {
                Err(Fault::new(place(&error).unwrap_or(end), error.to_string()))
            }
            (_, Some(fault)) => Err(fault),
        }
    }
}

/// The parts, when no entry is a repeat.
fn plain<'p, 'a>(entries: &'p [Entry<'a>]) -> Option<Vec<&'p Part<'a>>> {
    let part = |entry: &'p Entry<'a>| match entry {
        Entry::Part(part) => Some(part),
        Entry::Repeat(..) => None,
    };
    entries.iter().map(part).collect()
}

/// Extent of a symbol along `wanted`, where absolute sizes alone say it.
fn natural_extent(rules: &[Rule], symbol: &str, wanted: Axis) -> Option<f64> {
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
