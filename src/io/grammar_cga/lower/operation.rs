//! The replacement of a part, and the sizes of the parts.

use chumsky::span::SimpleSpan;

use super::super::error::Fault;
use super::super::note::Note;
use super::super::reserved::is_appearance;
use super::super::syntax::{Alternative, At, Call, Entry, Expression, Part, Prefix, Target};
use super::Builder;
use edifice_grammar::{Operation, Size, Successor};
use edifice_shape::Axis;

/// The greatest difference of a sum of fractions from the whole.
const FRACTION_SLACK: f64 = 1e-9;

/// Most periods that fractions may repeat.
const MOST_PERIODS: f64 = 4096.0;

/// The replacement that a target names, without its looks.
#[derive(Clone, Copy)]
enum Plain<'t, 'a> {
    Symbol(&'a str, &'t [At<Expression<'a>>]),
    Split(Axis, &'t [Entry<'a>]),
}

/// A target without the operations that only change its looks; `is_rule` knows the rules that take numbers.
fn plain<'t, 'a>(
    (target, span): &'t At<Target<'a>>,
    is_rule: impl Fn(&str) -> bool,
) -> Result<Plain<'t, 'a>, Fault> {
    match target {
        Target::Symbol(name) => Ok(Plain::Symbol(name, &[])),
        Target::Split(axis, entries) => Ok(Plain::Split(*axis, entries)),
        Target::Calls(calls, after) => {
            let (calls, last) = match (&calls[..], after) {
                ([looks @ .., last], None) if is_rule(last.name.0) => (looks, Some(last)),
                (all, _) => (all, None),
            };
            let changes = calls.iter().find(|call| !is_appearance(call.name.0));
            if let Some(&Call {
                name: (name, span), ..
            }) = changes
            {
                return Err(changes_shape(name, span));
            }
            match (last, after.as_deref()) {
                (Some(last), _) => match &last.numbers {
                    Some(numbers) => Ok(Plain::Symbol(last.name.0, numbers)),
                    None => Err(Fault::new(last.name.1, "this rule takes numbers")),
                },
                (None, Some(Target::Symbol(name))) => Ok(Plain::Symbol(name, &[])),
                (None, Some(Target::Split(axis, entries))) => Ok(Plain::Split(*axis, entries)),
                _ => {
                    let message =
                        "this part becomes no symbol; name it, as in color(\"#ff0000\") Window";
                    Err(Fault::new(*span, message))
                }
            }
        }
    }
}

/// The error for an operation that is not read.
pub(super) fn changes_shape(name: &str, span: SimpleSpan) -> Fault {
    let message = format!("{name} is no operation of split grammars");
    Fault::new(span, message)
}

impl Builder<'_> {
    pub(super) fn alternative(
        &mut self,
        alternative: &Alternative<'_>,
        symbol: &str,
    ) -> Result<Operation, Fault> {
        self.floats_absolute = self.sizes_absolute;
        let mut note = None;
        for &(text, at) in &alternative.notes {
            match Note::parse(text, at)? {
                Note::Relative if !self.floats_absolute => {
                    let message =
                        "this comment needs //@ sizes absolute at the top, and stands once";
                    return Err(Fault::new(at, message));
                }
                Note::Relative => self.floats_absolute = false,
                _ if note.is_some() => {
                    return Err(Fault::new(at, "one comment of this kind is enough"));
                }
                other => note = Some((other, at)),
            }
        }
        let target = plain(&alternative.target, |name| self.takes_numbers(name))?;
        match (note, target) {
            (None, target) => self.operation(target, symbol, alternative.target.1),
            (Some((Note::SymSplit, at)), Plain::Split(axis, entries)) => {
                self.sym_split(axis, entries, symbol, at)
            }
            (Some((Note::GridSplit, at)), Plain::Split(Axis::Y, entries)) => {
                self.grid_split(entries, at)
            }
            (Some((_, at)), _) => Err(Fault::new(at, "this comment does not fit what is below it")),
        }
    }

    fn operation(
        &mut self,
        target: Plain<'_, '_>,
        symbol: &str,
        span: SimpleSpan,
    ) -> Result<Operation, Fault> {
        let (axis, entries) = match target {
            Plain::Split(axis, entries) => (axis, entries),
            Plain::Symbol(name, numbers) => {
                let size = Size::Relative(1.0);
                let successors = vec![Successor {
                    symbol: self.called(name, numbers, span)?,
                    size,
                }];
                return Ok(Operation::Split {
                    axis: Axis::X,
                    successors,
                });
            }
        };
        if let [Entry::Repeat(period, span)] = entries {
            return self.repeat(axis, period, *span, symbol);
        }
        if let [Entry::Part(a), Entry::Repeat(period, _)] = entries
            && let [Entry::Part(b), Entry::Part(again)] = &period[..]
            && let (Target::Symbol(first), Target::Symbol(last)) = (&a.target.0, &again.target.0)
            && first == last
            && ![a, b, again].iter().any(|p| p.prefix == Prefix::Fraction)
            && self.size(a)? == self.size(again)?
        {
            let a = self.successor(a, symbol)?;
            let b = self.successor(b, symbol)?;
            return Ok(Operation::RepeatAba { axis, a, b });
        }
        let successors = self.parts(axis, entries, symbol)?;
        Ok(Operation::Split { axis, successors })
    }

    /// A period of parts, repeated; a repeat of nothing but a repeat is that repeat.
    fn repeat(
        &mut self,
        axis: Axis,
        period: &[Entry<'_>],
        span: SimpleSpan,
        symbol: &str,
    ) -> Result<Operation, Fault> {
        if let [Entry::Repeat(inner, span)] = period {
            return self.repeat(axis, inner, *span, symbol);
        }
        let fraction = |entry: &Entry<'_>| match entry {
            Entry::Part(part) => part.prefix == Prefix::Fraction,
            Entry::Repeat(..) => false,
        };
        if !period.iter().any(fraction) {
            let successors = self.parts(axis, period, symbol)?;
            return Ok(Operation::Repeat { axis, successors });
        }
        // Fractions of the whole fit the same number of times at every size.
        let mut one = Vec::new();
        for entry in period {
            let Entry::Part(part) = entry else {
                return Err(Fault::new(span, "a repeat has either ' sizes only or none"));
            };
            if part.prefix != Prefix::Fraction {
                return Err(Fault::new(span, "a repeat has either ' sizes only or none"));
            }
            one.push(self.successor(part, symbol)?);
        }
        let sum: f64 = one.iter().map(|s| s.size.value()).sum();
        let periods = (1.0 / sum).round();
        if (periods * sum - 1.0).abs() > FRACTION_SLACK || !(1.0..=MOST_PERIODS).contains(&periods)
        {
            let message =
                format!("a period takes {sum} of the whole, which it does not fill exactly");
            return Err(Fault::new(span, message));
        }
        let periods = std::iter::repeat_n(one, periods as usize);
        let successors = periods.flatten().collect();
        Ok(Operation::Split { axis, successors })
    }

    /// The parts of a split or of a period. A repeat among them is a helper symbol that takes what the
    /// others leave.
    fn parts(
        &mut self,
        axis: Axis,
        entries: &[Entry<'_>],
        symbol: &str,
    ) -> Result<Vec<Successor>, Fault> {
        let mut successors = Vec::new();
        for entry in entries {
            successors.push(match entry {
                Entry::Part(part) => self.successor(part, symbol)?,
                Entry::Repeat(period, span) => {
                    let operation = self.repeat(axis, period, *span, symbol)?;
                    let sizes = match &operation {
                        Operation::Repeat { successors, .. }
                        | Operation::Split { successors, .. } => successors.as_slice(),
                        _ => &[],
                    };
                    let period = sizes.iter().map(|s| s.size.value()).sum();
                    Successor {
                        symbol: self.helper(symbol, operation, *span),
                        size: Size::Relative(period),
                    }
                }
            });
        }
        self.share(entries, &mut successors)?;
        Ok(successors)
    }

    /// Makes fractions of the whole weights: `'0.2 | ~1 | ~3` are weights 0.2, 0.2 and 0.6.
    fn share(&self, entries: &[Entry<'_>], successors: &mut [Successor]) -> Result<(), Fault> {
        let prefix = |entry: &Entry<'_>| match entry {
            Entry::Part(part) => part.prefix,
            Entry::Repeat(..) => Prefix::Floating,
        };
        let sum = |wanted: Prefix| -> f64 {
            let pairs = entries.iter().zip(successors.iter());
            let values = pairs.filter(|(e, _)| prefix(e) == wanted);
            values.map(|(_, s)| s.size.value()).sum()
        };
        let (fractions, floating) = (sum(Prefix::Fraction), sum(Prefix::Floating));
        if fractions == 0.0 {
            return Ok(());
        }
        let span = |wanted: Prefix| {
            entries.iter().find_map(|entry| match entry {
                Entry::Part(part) if part.prefix == wanted => Some(part.size.1),
                _ => None,
            })
        };
        let at = span(Prefix::Fraction).unwrap_or((0..0).into());
        if let Some(absolute) = span(Prefix::Absolute) {
            let message =
                "beside a ' size this leaves different gaps at different sizes; write ~ before it";
            return Err(Fault::new(absolute, message));
        }
        let rest = 1.0 - fractions;
        let fits = match floating > 0.0 {
            true => rest > FRACTION_SLACK,
            false => rest.abs() <= FRACTION_SLACK,
        };
        if !fits {
            let message = format!("the ' sizes add up to {fractions} of the whole");
            return Err(Fault::new(at, message));
        }
        for (entry, successor) in entries.iter().zip(successors) {
            let value = successor.size.value();
            successor.size = Size::Relative(match prefix(entry) {
                Prefix::Fraction => value,
                _ => value / floating * rest,
            });
        }
        Ok(())
    }

    pub(super) fn successors<'p, 't: 'p>(
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
        let symbol = self.target_symbol(part, symbol)?;
        Ok(Successor { symbol, size })
    }

    /// The symbol of a part; a helper for a split.
    fn target_symbol(&mut self, part: &Part<'_>, parent: &str) -> Result<String, Fault> {
        let span = part.target.1;
        match plain(&part.target, |name| self.takes_numbers(name))? {
            Plain::Symbol(name, numbers) => self.called(name, numbers, span),
            split => {
                let operation = self.operation(split, parent, span)?;
                Ok(self.helper(parent, operation, span))
            }
        }
    }

    /// The size of a part; a fraction of the whole is a weight for now.
    pub(super) fn size(&self, part: &Part<'_>) -> Result<Size, Fault> {
        let value = self.positive(part)?;
        Ok(match part.prefix {
            Prefix::Absolute => Size::Absolute(value),
            Prefix::Floating if self.floats_absolute => Size::Absolute(value),
            Prefix::Floating | Prefix::Fraction => Size::Relative(value),
        })
    }

    fn positive(&self, part: &Part<'_>) -> Result<f64, Fault> {
        let value = self.value(&part.size)?;
        match value > 0.0 {
            true => Ok(value),
            false => {
                let message = format!("size {value}, expected a positive number");
                Err(Fault::new(part.size.1, message))
            }
        }
    }
}
