//! Numbers: computed, named, and drawn at random.

use std::cell::Cell;

use chumsky::span::SimpleSpan;

use super::super::error::Fault;
use super::super::syntax::{At, Entry, Expression, Target};
use super::Builder;

/// Number of equal parts that a range is divided into, a prime.
pub(super) const DRAWS: usize = 5;

/// The value of every `rand` of an alternative: the middle of one of [`DRAWS`] equal parts of its range.
///
/// In the alternative for part k, the j-th `rand` takes part (j k + k) mod 5: any two of the first four
/// together take each part of one with a different part of the other, as a lattice rule has it.
#[derive(Default)]
pub(super) struct Draw {
    /// The part; `None` outside rules, where a range stands for its middle.
    part: Option<usize>,
    /// Number of values taken so far.
    taken: Cell<usize>,
}

impl Draw {
    pub fn new(part: usize) -> Self {
        Self {
            part: Some(part),
            taken: Cell::new(0),
        }
    }

    fn between(&self, low: f64, high: f64) -> f64 {
        let fraction = match self.part {
            None => 0.5,
            Some(part) => {
                let taken = self.taken.replace(self.taken.get() + 1);
                let part = part * (taken % (DRAWS - 1) + 1) % DRAWS;
                (part as f64 + 0.5) / DRAWS as f64
            }
        };
        low + fraction * (high - low)
    }
}

/// True if a size in the target is drawn at random.
pub(super) fn is_random(target: &Target<'_>) -> bool {
    fn random(expression: &Expression<'_>) -> bool {
        match expression {
            Expression::Number(_) | Expression::Name(_) => false,
            Expression::Between(..) => true,
            Expression::Negative(value) => random(value),
            Expression::Binary(left, _, right) => random(left) || random(right),
        }
    }
    fn in_entry(entry: &Entry<'_>) -> bool {
        match entry {
            Entry::Part(part) => random(&part.size.0) || is_random(&part.target.0),
            Entry::Repeat(entries, _) => entries.iter().any(in_entry),
        }
    }
    match target {
        Target::Symbol(_) => false,
        Target::Split(_, entries) => entries.iter().any(in_entry),
        Target::Calls(_, after) => after.as_deref().is_some_and(is_random),
    }
}

impl Builder<'_> {
    /// The value of an expression, a finite number.
    pub(super) fn value(&self, (expression, span): &At<Expression<'_>>) -> Result<f64, Fault> {
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
            Expression::Between(low, high) => {
                let (low, high) = (self.evaluate(low, span)?, self.evaluate(high, span)?);
                Ok(self.draw.between(low, high))
            }
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
}
