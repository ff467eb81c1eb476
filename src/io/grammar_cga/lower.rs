//! From statements to a grammar.

mod chance;
mod natural;
mod written_out;

use chumsky::span::SimpleSpan;
use rustc_hash::{FxHashMap, FxHashSet};

use super::error::Fault;
use super::note::Note;
use super::syntax::{Alternative, At, CgaRule, Chance, Entry, Expression, Item, Part, Target};
use crate::grammar::{Grammar, GrammarError, Operation, Rule, Size, Start, Successor, check};
use crate::shape::Axis;
use natural::natural_extent;

/// The unit of text that names none: CityEngine's metre.
const UNIT: &str = "m";

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
