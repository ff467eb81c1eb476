//! The rules of a type as paths.

use std::ops::Range;
use std::rc::Rc;

use crate::methods::facade_grammar::choice::{Arrangement, Choice};
use crate::methods::facade_grammar::regions::{Region, Types};
use crate::methods::facade_grammar::walk::AddRule;
use crate::shape::Axis;

/// A non-terminal type, and all rules that it can have. Each rule is a path: the *items* that it pays
/// for are the arcs of the path and, behind them, the operation.
#[derive(Debug)]
pub(crate) struct Kind {
    /// The first place found with the type.
    pub region: Region,
    pub ways: Vec<Way>,
    pub arcs: Vec<Arc>,
    /// Where the parts of arcs with several copies stand among those of a place.
    pub slots: Vec<u32>,
    /// Cost of each item: of the arcs, then of the ways.
    pub full_costs: Vec<f64>,
    /// What of it is shared: all, unless the type is known to have a rule ([`Program::require`](super::Program::require)).
    pub costs: Vec<f64>,
    /// Whether it is.
    pub required: bool,
    /// Index of the kind's first item among those of all kinds.
    pub first: usize,
    /// Where the type occurs.
    pub places: Vec<u32>,
    /// Groups of places that pay together, each by its indices in `places`: of places that overlap, a derivation
    /// splits one at most.
    pub purses: Vec<Vec<u32>>,
    /// The purses of each place.
    pub purses_of: Vec<Vec<u32>>,
    /// Index of the first purse's first item among those of all purses.
    pub first_share: usize,
}

/// An operation along one axis: paths from node 0 to the last node.
#[derive(Debug, Clone)]
pub(crate) struct Way {
    pub arrangement: Arrangement,
    pub axis: Axis,
    pub last: u16,
    /// Sorted by where they lead.
    pub arcs: Range<usize>,
}

/// A successor of a rule, or the end of a mirrored rule whose halves meet.
#[derive(Debug, Clone)]
pub(crate) struct Arc {
    pub from: u16,
    pub to: u16,
    /// The cuts between which the successor stands first.
    pub lines: (u16, u16),
    /// How often the rule writes the successor out.
    pub copies: u32,
    /// Where the only copy stands among the parts of a place; of several copies, where their list begins.
    pub slot: u32,
}

impl Kind {
    /// Item of a way's operation.
    pub fn operation(&self, way: usize) -> usize {
        self.arcs.len() + way
    }

    /// Items that no rule with this one has.
    pub fn excluded_by(&self, item: usize) -> impl Iterator<Item = usize> {
        let way = |item: usize| match item.checked_sub(self.arcs.len()) {
            Some(way) => way,
            None => self.ways.partition_point(|w| w.arcs.end <= item),
        };
        let mine = way(item);
        let operations = (0..self.ways.len()).filter(move |&w| w != mine);
        let overlapping = self.ways[mine].arcs.clone().filter(move |&other| {
            other != item
                && self.arcs.get(item).is_some_and(|arc| {
                    self.arcs[other].from < arc.to && arc.from < self.arcs[other].to
                })
        });
        operations.map(|w| self.operation(w)).chain(overlapping)
    }

    /// The rule that follows some arcs of a way.
    pub fn written(&self, way: usize, arcs: &[usize]) -> Written {
        let written = arcs.iter().map(|&a| &self.arcs[a]).filter(|a| a.copies > 0);
        let lines = std::iter::once(0)
            .chain(written.map(|a| a.lines.1))
            .collect();
        let middle = |arc: &Arc| arc.to == self.ways[way].last && arc.copies > 0;
        let arrangement = match self.ways[way].arrangement {
            Arrangement::Symmetric(axis, _) => {
                Arrangement::Symmetric(axis, arcs.iter().any(|&a| middle(&self.arcs[a])))
            }
            other => other,
        };
        Written {
            region: self.region,
            axis: self.ways[way].axis,
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
    pub fn rule(&self, types: &mut Types) -> AddRule {
        let id = types.intern(self.region);
        let strips = types.strips(id, self.axis);
        AddRule {
            id,
            choice: Rc::new(Choice::between(
                self.arrangement,
                self.lines.clone(),
                &strips,
            )),
        }
    }
}
