//! The cheapest rule for a region type.
//!
//! With a price `p(t)` on every successor type, the cheapest split of a region over *all* sets of
//! its full lines is a shortest path over its cut positions,
//!
//! ```text
//! d(0) = 0,   d(b) = min_{a < b} d(a) + c_1 + p(type of strip a..b),
//! split = c_split + d(n),   repeat with period k = c_repeat + d(k),
//! ```
//!
//! where `c_1` is the cost of a written successor. No split needs to be sampled. Grids are found in
//! [`super::grid`].

use crate::operations::Operations;
use crate::regions::{Strips, TypeId, Types};
use edifice_grammar::Costs;
use edifice_shape::Axis;

use super::candidate::{Arrangement, RuleCandidate};
use super::grid;
use super::trace::trace;

/// Finds cheapest rules; keeps its tables between calls.
#[derive(Debug)]
pub(crate) struct RulePricer {
    pub costs: Costs,
    pub operations: Operations,
    distance: Vec<f64>,
    previous: Vec<u16>,
    mirrored: Vec<f64>,
    mirrored_previous: Vec<u16>,
}

impl RulePricer {
    pub(crate) fn new(costs: Costs, operations: Operations) -> Self {
        let (distance, previous) = (Vec::new(), Vec::new());
        Self {
            costs,
            operations,
            distance,
            previous,
            mirrored: Vec::new(),
            mirrored_previous: Vec::new(),
        }
    }

    /// The cheapest rule for a type, with its cost; `None` when every rule has an infinite price. `price` gives the price of each
    /// type that a rule names.
    pub(crate) fn cheapest(
        &mut self,
        types: &mut Types,
        id: TypeId,
        price: &impl Fn(&Types, TypeId) -> f64,
    ) -> Option<(f64, RuleCandidate)> {
        let mut best: Option<(f64, RuleCandidate)> = None;
        for axis in Axis::BOTH {
            let strips = types.strips(id, axis);
            let bound = best.as_ref().map_or(f64::INFINITY, |(cost, _)| *cost);
            if let Some(found) = self.along(&strips, axis, bound, &|t| price(types, t)) {
                best = Some(found);
            }
        }
        if self.operations.grid_split
            && let Some(cells) = types.cells(id)
        {
            let bound = best.as_ref().map_or(f64::INFINITY, |(cost, _)| *cost);
            let found = grid::cheapest(&cells, &self.costs, bound, &|t| price(types, t));
            best = found.or(best);
        }
        best
    }

    /// The cheapest rule along one axis, if it costs less than `bound`.
    pub(crate) fn along(
        &mut self,
        strips: &Strips,
        axis: Axis,
        bound: f64,
        price: &impl Fn(TypeId) -> f64,
    ) -> Option<(f64, RuleCandidate)> {
        let n = strips.intervals();
        if n < 2 {
            return None;
        }
        self.shortest_paths(strips, price);
        // Noise of additions must not decide between rules of equal cost.
        let mut limit = bound - 1e-9;
        let mut found: Option<(Arrangement, usize)> = None;
        let mut offer = |cost: f64, arrangement, end| {
            if cost < limit {
                limit = cost - 1e-9;
                found = Some((arrangement, end));
            }
        };
        offer(
            self.costs.split + self.distance[n],
            Arrangement::Split(axis),
            n,
        );
        if self.operations.repeat {
            for period in &strips.periods {
                let end = usize::from(period.intervals);
                offer(
                    self.costs.repeat + self.distance[end],
                    Arrangement::Repeat(axis),
                    end,
                );
            }
        }
        if self.operations.repeat_aba {
            for &(a, b) in &strips.alternations {
                let (a, b) = (usize::from(a), usize::from(b));
                let prices = price(strips.strip(0, a)) + price(strips.strip(a, b));
                let cost = self.costs.repeat_aba + 2.0 * self.costs.successor + prices;
                offer(cost, Arrangement::RepeatAba(axis), b);
            }
        }
        if self.operations.sym_split && !strips.mirrors.is_empty() {
            let (cost, end, center) = self.shortest_mirrored(strips, price);
            offer(cost, Arrangement::Symmetric(axis, center), end);
        }
        let (arrangement, end) = found?;
        let lines = match arrangement {
            Arrangement::RepeatAba(_) => vec![0, strips.alternation_inner(end), end as u16],
            Arrangement::Symmetric(_, center) => self.trace_mirrored(strips, end, center),
            _ => trace(&self.previous, end),
        };
        Some((
            limit + 1e-9,
            RuleCandidate::between(arrangement, lines, strips),
        ))
    }

    fn shortest_paths(&mut self, strips: &Strips, price: &impl Fn(TypeId) -> f64) {
        let n = strips.intervals();
        self.distance.clear();
        self.distance.resize(n + 1, f64::INFINITY);
        self.previous.clear();
        self.previous.resize(n + 1, 0);
        self.distance[0] = 0.0;
        for b in 1..=n {
            // The whole region is no successor of itself.
            let first = usize::from(b == n);
            let (mut best, mut from) = (f64::INFINITY, 0);
            for (a, &strip) in strips.ending_at(b).iter().enumerate().skip(first) {
                let cost = self.distance[a] + price(strip);
                if cost < best {
                    (best, from) = (cost, a);
                }
            }
            self.distance[b] = best + self.costs.successor;
            self.previous[b] = from as u16;
        }
    }

    /// Cheapest half of a mirrored split: cost of the rule, mirror index where the half ends, and
    /// whether its last successor is the middle part.
    fn shortest_mirrored(
        &mut self,
        strips: &Strips,
        price: &impl Fn(TypeId) -> f64,
    ) -> (f64, usize, bool) {
        let mirrors = &strips.mirrors;
        self.mirrored.clear();
        self.mirrored.resize(mirrors.len(), f64::INFINITY);
        self.mirrored_previous.clear();
        self.mirrored_previous.resize(mirrors.len(), 0);
        self.mirrored[0] = 0.0;
        let mut best = (f64::INFINITY, 0, false);
        for b in 0..mirrors.len() {
            let (left, right) = (usize::from(mirrors[b].0), usize::from(mirrors[b].1));
            for (a, &(start, end)) in mirrors[..b].iter().enumerate() {
                let (start, end) = (usize::from(start), usize::from(end));
                let strip = strips.strip(start, left);
                if strip != strips.strip(right, end) {
                    continue;
                }
                let cost = self.mirrored[a] + self.costs.successor + price(strip);
                if cost < self.mirrored[b] {
                    self.mirrored[b] = cost;
                    self.mirrored_previous[b] = a as u16;
                }
            }
            let closed = if left == right {
                self.mirrored[b]
            } else if b > 0 {
                self.mirrored[b] + self.costs.successor + price(strips.strip(left, right))
            } else {
                f64::INFINITY
            };
            if closed + self.costs.sym_split < best.0 {
                best = (closed + self.costs.sym_split, b, left != right);
            }
        }
        best
    }

    fn trace_mirrored(&self, strips: &Strips, end: usize, center: bool) -> Vec<u16> {
        let mut lines: Vec<u16> = trace(&self.mirrored_previous, end)
            .into_iter()
            .map(|m| strips.mirrors[usize::from(m)].0)
            .collect();
        if center {
            lines.push(strips.mirrors[end].1);
        }
        lines
    }
}
