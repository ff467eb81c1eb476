//! Lists all rules of a type.

use std::rc::Rc;

use super::region_type::{Arc, Operator, RegionType};
use crate::operations::Operations;
use crate::regions::{Region, Strips};
use crate::rules::{Arrangement, operation_cost};
use edifice_grammar::Costs;
use edifice_shape::Axis;

/// A type with all rules that it can have, and no occurrences yet.
pub(super) fn region_type_of(
    region: Region,
    strips: &[Rc<Strips>; 2],
    costs: &Costs,
    operations: Operations,
    first: usize,
) -> RegionType {
    let mut rules = Rules::default();
    let mut offset = 0;
    for (axis, strips) in Axis::BOTH.into_iter().zip(strips) {
        if strips.intervals() < 2 {
            continue;
        }
        rules.offset = offset;
        offset += strips.all().len();
        rules.along(strips, axis, costs, operations);
    }
    let mut costs = rules.arc_costs;
    costs.extend(rules.operator_costs);
    RegionType {
        region,
        operators: rules.operators,
        arcs: rules.arcs,
        slots: rules.slots,
        full_costs: costs.clone(),
        costs,
        required: false,
        first,
        occurrences: Vec::new(),
        cliques: Vec::new(),
        cliques_of: Vec::new(),
        first_multiplier: 0,
    }
}

/// The rules of a type while they are listed.
#[derive(Default)]
struct Rules {
    operators: Vec<Operator>,
    operator_costs: Vec<f64>,
    arcs: Vec<Arc>,
    arc_costs: Vec<f64>,
    slots: Vec<u32>,
    /// First part along the axis at hand.
    offset: usize,
}

impl Rules {
    fn along(&mut self, strips: &Strips, axis: Axis, costs: &Costs, operations: Operations) {
        let n = strips.intervals();
        // The whole region is no successor of itself.
        self.paths(n, 1, costs, |a, b| b - a < n);
        self.close(n, Arrangement::Split(axis), axis, costs);
        if operations.repeat {
            for period in &strips.periods {
                let k = usize::from(period.intervals);
                self.paths(k, period.repeats.into(), costs, |_, _| true);
                self.close(k, Arrangement::Repeat(axis), axis, costs);
            }
        }
        if operations.repeat_aba {
            for &(a, b) in &strips.alternations {
                let (a, b) = (usize::from(a), usize::from(b));
                let outer = (0..n).step_by(b).map(|s| (s, s + a));
                let inner = (a..n).step_by(b).map(|s| (s, s + b - a));
                self.arc(0, 1, costs.successor, outer);
                self.arc(1, 2, costs.successor, inner);
                self.close(2, Arrangement::RepeatAba(axis), axis, costs);
            }
        }
        if operations.sym_split && strips.mirrors.len() > 1 {
            self.mirrored(strips, costs);
            let arrangement = Arrangement::Symmetric(axis, true);
            self.close(strips.mirrors.len(), arrangement, axis, costs);
        }
    }

    /// Arcs between the cuts of a period, each of which has its copies in all periods.
    fn paths(
        &mut self,
        period: usize,
        repeats: usize,
        costs: &Costs,
        allowed: impl Fn(usize, usize) -> bool,
    ) {
        for b in 1..=period {
            for a in (0..b).filter(|&a| allowed(a, b)) {
                let copies = (0..repeats).map(|r| (a + r * period, b + r * period));
                self.arc(a, b, costs.successor, copies);
            }
        }
    }

    /// Arcs between mirrored cuts, and those that close a rule: with what is left in the middle, or, where
    /// the two halves meet, with nothing.
    fn mirrored(&mut self, strips: &Strips, costs: &Costs) {
        let cut = |m: usize| {
            (
                usize::from(strips.mirrors[m].0),
                usize::from(strips.mirrors[m].1),
            )
        };
        let count = strips.mirrors.len();
        for b in 1..count {
            for a in 0..b {
                let (outer, inner) = (cut(a), cut(b));
                let halves = [(outer.0, inner.0), (inner.1, outer.1)];
                if strips.strip(outer.0, inner.0) == strips.strip(inner.1, outer.1) {
                    self.arc(a, b, costs.successor, halves);
                }
            }
        }
        for b in 1..count {
            match cut(b) {
                (left, right) if left == right => self.arc(b, count, 0.0, []),
                middle => self.arc(b, count, costs.successor, [middle]),
            }
        }
    }

    /// An arc with the strips, cut to cut, that its successor fills.
    fn arc(
        &mut self,
        from: usize,
        to: usize,
        cost: f64,
        copies: impl IntoIterator<Item = (usize, usize)>,
    ) {
        let first = self.slots.len();
        let mut lines = None;
        for (a, b) in copies {
            lines = lines.or(Some((a as u16, b as u16)));
            self.slots.push((self.offset + b * (b - 1) / 2 + a) as u32);
        }
        let copies = self.slots.len() - first;
        let slot = match copies {
            1 => self.slots.pop(),
            _ => None,
        };
        self.arcs.push(Arc {
            from: from as u16,
            to: to as u16,
            lines: lines.unwrap_or_default(),
            copies: copies as u32,
            slot: slot.unwrap_or(first as u32),
        });
        self.arc_costs.push(cost);
    }

    /// Ends an operator: its arcs are those since the last one.
    fn close(&mut self, last: usize, arrangement: Arrangement, axis: Axis, costs: &Costs) {
        let start = self.operators.last().map_or(0, |w| w.arcs.end);
        self.operators.push(Operator {
            arrangement,
            axis,
            last: last as u16,
            arcs: start..self.arcs.len(),
        });
        self.operator_costs.push(operation_cost(arrangement, costs));
    }
}
