//! Rules that take numbers: for each list of numbers that a rule is called with there is a symbol of its own.

use chumsky::span::SimpleSpan;

use super::super::error::Fault;
use super::super::syntax::{At, Expression};
use super::Builder;

/// Most symbols that calls make.
const MOST_CALLS: usize = 20_000;

impl Builder<'_> {
    /// True for the identifier of a rule that takes numbers.
    pub(super) fn takes_numbers(&self, identifier: &str) -> bool {
        self.taking.contains_key(identifier)
    }

    /// The symbol that an identifier stands for, with what it is called with: `Floor(3, 1.2)`. The rule of a new one is
    /// built later.
    pub(super) fn called(
        &mut self,
        identifier: &str,
        numbers: &[At<Expression<'_>>],
        span: SimpleSpan,
    ) -> Result<String, Fault> {
        let symbol = self.symbol(identifier);
        let Some(&rule) = self.taking.get(identifier) else {
            return Ok(symbol);
        };
        let count = rule.parameters.len();
        if numbers.len() != count {
            let message = format!("{identifier} takes {count} numbers, not {}", numbers.len());
            return Err(Fault::new(span, message));
        }
        let values = numbers.iter().map(|number| self.value(number));
        let values: Vec<f64> = values.collect::<Result<_, _>>()?;
        let texts: Vec<String> = values.iter().map(f64::to_string).collect();
        let symbol = format!("{symbol}({})", texts.join(", "));
        if self.used.insert(symbol.clone()) {
            self.calls += 1;
            if self.calls > MOST_CALLS {
                let message = format!("calls of {identifier} go on without end");
                return Err(Fault::new(span, message));
            }
            self.waiting.push_back((rule, symbol.clone(), values));
        }
        Ok(symbol)
    }

    /// Builds the rules that are called, and those that they call in turn.
    pub(super) fn called_rules(&mut self) -> Result<(), Fault> {
        while let Some((rule, symbol, values)) = self.waiting.pop_front() {
            self.numbers = rule.parameters.iter().copied().zip(values).collect();
            self.rule(rule, symbol)?;
        }
        self.numbers.clear();
        Ok(())
    }
}
