//! From statements to a grammar.

mod call;
mod chance;
mod draw;
mod natural;
mod operation;
mod value;
mod written_out;

use std::collections::VecDeque;

use chumsky::span::SimpleSpan;
use rustc_hash::{FxHashMap, FxHashSet};

use super::error::Fault;
use super::note::Note;
use super::reserved::is_leaf_operation;
use super::syntax::{At, Call, CgaRule, Chance, Item, Target};
use draw::{DRAWS, Draw};
use edifice_grammar::{Grammar, GrammarError, Operation, Rule, Start, check};
use edifice_shape::Axis;
use natural::natural_extent;

/// The unit of text that names none: CityEngine's metre.
const UNIT: &str = "m";

/// Builds the grammar and checks it.
pub(super) fn lower<'a>(
    header: &'a [At<Note>],
    items: &'a [Item<'a>],
    end: SimpleSpan,
) -> Result<Grammar, Fault> {
    let mut builder = Builder::default();
    for (note, span) in header {
        match note {
            Note::Symbol { identifier, name } => {
                let before = builder.renamed.insert(identifier, name);
                let twice = "this identifier already stands for a symbol";
                before.map_or(Ok(()), |_| Err(Fault::new(*span, twice)))?;
            }
            Note::SizesAbsolute => builder.sizes_absolute = true,
            _ => {}
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
                if !rule.parameters.is_empty() && builder.taking.insert(rule.name.0, rule).is_some()
                {
                    return Err(Fault::new(rule.name.1, "this symbol already has a rule"));
                }
            }
            Item::Skipped | Item::StartRule => {}
        }
    }
    let (mut first, mut start) = (None, None);
    let mut marked = false;
    for item in items {
        match item {
            Item::StartRule => marked = true,
            Item::Rule(rule) => {
                if builder.takes_numbers(rule.name.0) {
                    if std::mem::take(&mut marked) || rule.parameters.is_empty() {
                        let message = "a rule that starts, or has two forms, takes no numbers";
                        return Err(Fault::new(rule.name.1, message));
                    }
                    continue;
                }
                first = first.or(Some(rule.name));
                if std::mem::take(&mut marked) {
                    start = start.or(Some(rule.name));
                }
                builder.rule(rule, builder.symbol(rule.name.0))?;
            }
            Item::Skipped | Item::Constant(..) => {}
        }
    }
    builder.called_rules()?;
    builder.finish(header, start.or(first), end)
}

#[derive(Default)]
struct Builder<'a> {
    /// Symbols that identifiers stand for.
    renamed: FxHashMap<&'a str, &'a str>,
    constants: FxHashMap<&'a str, f64>,
    /// Rules that take numbers, by their identifiers.
    taking: FxHashMap<&'a str, &'a CgaRule<'a>>,
    /// The numbers that the rule at hand was called with.
    numbers: FxHashMap<&'a str, f64>,
    /// Called rules that are not built yet, with their symbols and numbers.
    waiting: VecDeque<(&'a CgaRule<'a>, String, Vec<f64>)>,
    /// Number of symbols that calls made.
    calls: usize,
    /// Left-hand sides, so that helper symbols are new.
    used: FxHashSet<String>,
    /// Symbols whose rule only says how they look, and where it is written.
    leaves: FxHashMap<String, SimpleSpan>,
    rules: Vec<Rule>,
    /// The place of each rule in the text.
    places: Vec<SimpleSpan>,
    /// `//@ sizes absolute`.
    sizes_absolute: bool,
    /// True if floating sizes of the alternative at hand are absolute.
    floats_absolute: bool,
    /// The values of `rand` in the alternative at hand.
    draw: Draw,
}

impl<'a> Builder<'a> {
    fn symbol(&self, identifier: &str) -> String {
        let name = self.renamed.get(identifier);
        name.copied().unwrap_or(identifier).to_owned()
    }

    fn rule(&mut self, rule: &CgaRule<'_>, symbol: String) -> Result<(), Fault> {
        if let [alternative] = &rule.alternatives[..]
            && matches!(alternative.chance, Chance::Always)
            && let (Target::Calls(calls, None), _) = &alternative.target
            && !calls
                .last()
                .is_some_and(|last| self.takes_numbers(last.name.0))
        {
            return self.leaf(symbol, rule.name.1, calls);
        }
        let weights = self.weights(rule)?;
        for (alternative, weight) in rule.alternatives.iter().zip(weights) {
            let leftover = matches!(alternative.target.0, Target::Symbol("NIL"));
            if leftover && matches!(alternative.chance, Chance::Else) && weight == Some(0.0) {
                continue;
            }
            let place = match rule.alternatives.len() {
                1 => rule.name.1,
                _ => alternative.target.1,
            };
            if !value::is_random(&alternative.target.0) {
                self.push(&symbol, weight, place, alternative)?;
                continue;
            }
            // A range of sizes: equally likely rules, one for each of its equal parts.
            let share = weight.unwrap_or(100.0) / DRAWS as f64;
            for part in 0..DRAWS {
                self.draw = Draw::new(part);
                let pushed = self.push(&symbol, Some(share), place, alternative);
                self.draw = Draw::default();
                pushed?;
            }
        }
        Ok(())
    }

    /// A rule that divides nothing: its symbol is a terminal.
    fn leaf(&mut self, symbol: String, at: SimpleSpan, calls: &[Call<'_>]) -> Result<(), Fault> {
        let changes = calls.iter().find(|call| !is_leaf_operation(call.name.0));
        if let Some(&Call {
            name: (name, span), ..
        }) = changes
        {
            return Err(operation::changes_shape(name, span));
        }
        match self.leaves.insert(symbol, at) {
            None => Ok(()),
            Some(_) => Err(Fault::new(at, "this symbol already has a rule")),
        }
    }

    fn push(
        &mut self,
        symbol: &str,
        weight: Option<f64>,
        place: SimpleSpan,
        alternative: &super::syntax::Alternative<'_>,
    ) -> Result<(), Fault> {
        // The rule takes its place before the helpers that its parts need.
        let index = self.rules.len();
        self.rules.push(Rule {
            symbol: symbol.to_owned(),
            weight,
            operation: Operation::Split {
                axis: Axis::X,
                successors: Vec::new(),
            },
        });
        self.places.push(place);
        self.rules[index].operation = self.alternative(alternative, symbol)?;
        Ok(())
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
        if let Some(rule) = self
            .rules
            .iter()
            .find(|r| self.leaves.contains_key(&r.symbol))
        {
            let at = self.leaves[&rule.symbol];
            return Err(Fault::new(at, "this symbol already has a rule"));
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
