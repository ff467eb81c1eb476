//! Numbers: computed and named, and the places where they are drawn at random.

use chumsky::span::SimpleSpan;

use super::super::error::Fault;
use super::super::reserved::is_leaf_operation;
use super::super::syntax::{At, Entry, Expression, Target};
use super::Builder;

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
        Target::Calls(_, Some(after)) => is_random(after),
        // The last call may be a rule with parameters; what an operation takes changes looks alone.
        Target::Calls(calls, None) => calls.last().is_some_and(|call| {
            let mut numbers = call.numbers.iter().flatten();
            !is_leaf_operation(call.name.0) && numbers.any(|number| random(&number.0))
        }),
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
            Expression::Name(name) => {
                let numbers = [&self.numbers, &self.constants];
                let known = numbers.into_iter().find_map(|known| known.get(name));
                let message = || format!("constant {name} is not defined above this line");
                known.copied().ok_or_else(|| Fault::new(span, message()))
            }
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
