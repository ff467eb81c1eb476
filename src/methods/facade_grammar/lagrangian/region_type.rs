//! The rules of a type as paths.

use std::ops::Range;
use std::rc::Rc;

use crate::regions::{Region, Types};
use crate::rules::{AddRule, Arrangement, RuleCandidate};
use edifice_shape::Axis;

/// A non-terminal type, and all rules that it can have. Each rule is a path: its *items* are
/// the arcs of the path and, behind them, the operation.
#[derive(Debug)]
pub(crate) struct RegionType {
    /// The first occurrence found with the type.
    pub region: Region,
    pub operators: Vec<Operator>,
    pub arcs: Vec<Arc>,
    /// Positions, among the parts of an occurrence, of the parts of arcs with several copies.
    pub slots: Vec<u32>,
    /// Cost of each item: of the arcs, then of the operators.
    pub full_costs: Vec<f64>,
    /// The part of each item's cost that is split by multipliers: all of it, unless the type is known to have a rule
    /// ([`Program::require`](super::Program::require)).
    pub costs: Vec<f64>,
    /// True if the type is known to have a rule.
    pub required: bool,
    /// Index of the region type's first item among those of all region types.
    pub first: usize,
    /// Indices of the occurrences of the type.
    pub occurrences: Vec<u32>,
    /// Maximal cliques of overlapping occurrences, each by its indices in `occurrences`: of occurrences that overlap, a derivation
    /// splits one at most.
    pub cliques: Vec<Vec<u32>>,
    /// The cliques of each occurrence.
    pub cliques_of: Vec<Vec<u32>>,
    /// Index of the first clique's first item among those of all cliques.
    pub first_multiplier: usize,
}

/// An operation along one axis: paths from node 0 to the last node.
#[derive(Debug, Clone)]
pub(crate) struct Operator {
    pub arrangement: Arrangement,
    pub axis: Axis,
    pub last: u16,
    /// Range of its arcs, sorted by the node to which they lead.
    pub arcs: Range<usize>,
}

/// A successor of a rule, or the end of a mirrored rule whose halves meet.
#[derive(Debug, Clone)]
pub(crate) struct Arc {
    pub from: u16,
    pub to: u16,
    /// The cuts between which the successor stands first.
    pub lines: (u16, u16),
    /// Number of times that the rule writes the successor out.
    pub copies: u32,
    /// Position of the only copy among the parts of an occurrence; of several copies, the start of their list in [`RegionType::slots`].
    pub slot: u32,
}

impl RegionType {
    /// Item of an operator's operation.
    pub(crate) fn operation(&self, operator: usize) -> usize {
        self.arcs.len() + operator
    }

    /// Items that no rule with this one has.
    pub(crate) fn excluded_by(&self, item: usize) -> impl Iterator<Item = usize> {
        let operator = |item: usize| match item.checked_sub(self.arcs.len()) {
            Some(operator) => operator,
            None => self.operators.partition_point(|w| w.arcs.end <= item),
        };
        let mine = operator(item);
        let operations = (0..self.operators.len()).filter(move |&w| w != mine);
        let overlapping = self.operators[mine].arcs.clone().filter(move |&other| {
            other != item
                && self.arcs.get(item).is_some_and(|arc| {
                    self.arcs[other].from < arc.to && arc.from < self.arcs[other].to
                })
        });
        operations.map(|w| self.operation(w)).chain(overlapping)
    }

    /// The rule that follows some arcs of an operator.
    pub(crate) fn written(&self, operator: usize, arcs: &[usize]) -> Written {
        let written = arcs.iter().map(|&a| &self.arcs[a]).filter(|a| a.copies > 0);
        let lines = std::iter::once(0)
            .chain(written.map(|a| a.lines.1))
            .collect();
        let middle = |arc: &Arc| arc.to == self.operators[operator].last && arc.copies > 0;
        let arrangement = match self.operators[operator].arrangement {
            Arrangement::Symmetric(axis, _) => {
                Arrangement::Symmetric(axis, arcs.iter().any(|&a| middle(&self.arcs[a])))
            }
            other => other,
        };
        Written {
            region: self.region,
            axis: self.operators[operator].axis,
            arrangement,
            lines,
        }
    }
}

/// A rule of the type of a region, whatever program it was found with.
#[derive(Debug)]
pub(crate) struct Written {
    region: Region,
    axis: Axis,
    arrangement: Arrangement,
    /// Cuts between which the successors stand.
    lines: Vec<u16>,
}

impl Written {
    /// The rule as the other methods write it.
    pub(crate) fn rule(&self, types: &mut Types) -> AddRule {
        let id = types.intern(self.region);
        let strips = types.strips(id, self.axis);
        AddRule {
            id,
            candidate: Rc::new(RuleCandidate::between(
                self.arrangement,
                self.lines.clone(),
                &strips,
            )),
        }
    }
}
