//! A rule for a region type, as it may be chosen.

use std::rc::Rc;

use edifice_grammar::Costs;
use edifice_shape::Axis;

use crate::regions::{Strips, TypeId};

/// The arrangement of the successors of a rule.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Arrangement {
    Split(Axis),
    Repeat(Axis),
    RepeatAba(Axis),
    /// Mirrored halves; `true` when the last successor stands once in the middle.
    Symmetric(Axis, bool),
    /// Columns and rows at once.
    Grid,
}

impl Arrangement {
    /// Direction of the cuts, `None` when they run both ways.
    pub(crate) fn axis(self) -> Option<Axis> {
        match self {
            Arrangement::Split(axis)
            | Arrangement::Repeat(axis)
            | Arrangement::RepeatAba(axis)
            | Arrangement::Symmetric(axis, _) => Some(axis),
            Arrangement::Grid => None,
        }
    }
}

/// A rule for one region type: `successors[i]` fills the strip from `lines[i]` to `lines[i + 1]`,
/// indices into the cuts of the type's [`Strips`]. Of a grid, `lines` bound the columns and `rows` the
/// rows (empty otherwise), and the successors are its cells, row by row.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct RuleCandidate {
    pub arrangement: Arrangement,
    pub lines: Vec<u16>,
    pub rows: Vec<u16>,
    pub successors: Vec<TypeId>,
}

impl RuleCandidate {
    /// Cost of the rule (Eq. 2).
    pub(crate) fn cost(&self, costs: &Costs) -> f64 {
        operation_cost(self.arrangement, costs) + costs.successor * self.successors.len() as f64
    }

    /// The rule whose successors lie between consecutive `lines`.
    pub(crate) fn between(arrangement: Arrangement, lines: Vec<u16>, strips: &Strips) -> Self {
        let successors = lines
            .windows(2)
            .map(|w| strips.strip(w[0].into(), w[1].into()))
            .collect();
        Self {
            arrangement,
            lines,
            rows: Vec::new(),
            successors,
        }
    }
}

/// The action of a walk, and a rule of a grammar: a rule for a type.
#[derive(Debug, Clone)]
pub(crate) struct AddRule {
    pub id: TypeId,
    pub candidate: Rc<RuleCandidate>,
}

/// `cost_op` of Eq. 2.
pub(crate) fn operation_cost(arrangement: Arrangement, costs: &Costs) -> f64 {
    match arrangement {
        Arrangement::Split(_) => costs.split,
        Arrangement::Repeat(_) => costs.repeat,
        Arrangement::RepeatAba(_) => costs.repeat_aba,
        Arrangement::Symmetric(..) => costs.sym_split,
        Arrangement::Grid => costs.grid_split,
    }
}
