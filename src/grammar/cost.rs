//! The cost of a grammar: its description length (Wu et al. 2014, Eq. 1 and 2).

use super::{Grammar, Operation};

/// Cost of each operation, `cost_op` of Eq. 2, and of each written successor.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Costs {
    /// Split.
    pub split: f64,
    /// Repeat.
    pub repeat: f64,
    /// A B A ... B A.
    pub repeat_aba: f64,
    /// Mirrored split.
    pub sym_split: f64,
    /// Columns and rows at once.
    pub grid_split: f64,
    /// Each successor written in a rule: 1 in the paper, 0 in the first row of its Table 5.
    pub successor: f64,
}

impl Default for Costs {
    /// Split 0.1 and repeat 0.5 (Sec. 3.2); the extensions cost what the rule they extend costs.
    fn default() -> Self {
        Self {
            split: 0.1,
            repeat: 0.5,
            repeat_aba: 0.5,
            sym_split: 0.1,
            grid_split: 0.1,
            successor: 1.0,
        }
    }
}

/// A cost that no sum of costs can be compared with.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "the cost of {name} is {cost}, expected 0 or a number from {} to {}",
    Costs::LEAST,
    Costs::GREATEST
)]
pub struct CostError {
    /// The operation, or `successor`.
    pub name: &'static str,
    /// The cost.
    pub cost: f64,
}

impl Costs {
    /// Least cost of an operation or a successor that is not free: sums of costs are compared up to noise.
    pub const LEAST: f64 = 1e-3;
    /// Greatest cost.
    pub const GREATEST: f64 = 1e3;

    /// The default costs, but for those of all kinds of splits and of all kinds of repeats.
    pub fn of(split: f64, repeat: f64) -> Self {
        Self {
            split,
            sym_split: split,
            grid_split: split,
            repeat,
            repeat_aba: repeat,
            ..Self::default()
        }
    }

    /// True if an operation or a successor may have this cost.
    pub fn allows(cost: f64) -> bool {
        cost == 0.0 || (Self::LEAST..=Self::GREATEST).contains(&cost)
    }

    /// Checks that all costs are in range.
    ///
    /// # Errors
    /// [`CostError`] with the first that is not.
    pub fn check(&self) -> Result<(), CostError> {
        let named = [
            ("split", self.split),
            ("repeat", self.repeat),
            ("repeat_aba", self.repeat_aba),
            ("sym_split", self.sym_split),
            ("grid_split", self.grid_split),
            ("successor", self.successor),
        ];
        match named.into_iter().find(|(_, cost)| !Self::allows(*cost)) {
            Some((name, cost)) => Err(CostError { name, cost }),
            None => Ok(()),
        }
    }

    /// `cost_op` of the operation.
    pub fn operation(&self, operation: &Operation) -> f64 {
        match operation {
            Operation::Split { .. } => self.split,
            Operation::Repeat { .. } => self.repeat,
            Operation::RepeatAba { .. } => self.repeat_aba,
            Operation::SymSplit { .. } => self.sym_split,
            Operation::GridSplit { .. } => self.grid_split,
        }
    }

    /// Eq. 2: cost of one rule.
    pub fn rule(&self, operation: &Operation) -> f64 {
        self.operation(operation) + self.successor * operation.successor_count() as f64
    }

    /// Eq. 1: cost of a grammar, the sum over its rules.
    pub fn grammar(&self, grammar: &Grammar) -> f64 {
        // The sum of nothing is -0: a facade of one region costs 0.
        let rules = grammar.rules.iter();
        rules
            .map(|rule| self.rule(&rule.operation))
            .fold(0.0, |sum, cost| sum + cost)
    }
}
