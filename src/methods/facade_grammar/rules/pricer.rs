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

#[cfg(test)]
mod tests {
    use super::*;
    use edifice_base::rng::stream;
    use edifice_shape::{Facade, Rect, Region};
    use rand::RngExt;

    /// A row of unit cells.
    fn row(labels: &[u8]) -> Facade {
        let cells = labels.iter().enumerate().map(|(x, label)| Region {
            label: label.to_string(),
            rect: Rect::new(x as f64, 0.0, 1.0, 1.0),
        });
        Facade::new("row", "cell", labels.len() as f64, 1.0, cells.collect()).unwrap()
    }

    /// The least cost of a rule for a row of strips, by trying every set of cuts: as a split, and as what its successors allow.
    fn least(
        strips: &Strips,
        costs: &Costs,
        operations: Operations,
        price: &impl Fn(TypeId) -> f64,
    ) -> f64 {
        let n = strips.intervals();
        let mut best = f64::INFINITY;
        for cuts in 1..1_u32 << (n - 1) {
            let mut lines = vec![0];
            lines.extend((1..n).filter(|i| cuts >> (i - 1) & 1 == 1));
            lines.push(n);
            let all: Vec<TypeId> = lines.windows(2).map(|w| strips.strip(w[0], w[1])).collect();
            let written = |operation: f64, types: &[TypeId]| {
                let prices: f64 = types.iter().map(|t| price(*t)).sum();
                operation + costs.successor * types.len() as f64 + prices
            };
            best = best.min(written(costs.split, &all));
            let m = all.len();
            for period in (1..m).filter(|p| operations.repeat && m.is_multiple_of(*p)) {
                if all.chunks(period).all(|c| c == &all[..period]) {
                    best = best.min(written(costs.repeat, &all[..period]));
                }
            }
            if m % 2 == 1 && (2..m).all(|i| all[i] == all[i - 2]) {
                best = best.min(written(costs.repeat_aba, &all[..2]));
            }
            if operations.sym_split && (0..m).all(|i| all[i] == all[m - 1 - i]) {
                best = best.min(written(costs.sym_split, &all[..m.div_ceil(2)]));
            }
        }
        best
    }

    #[test]
    fn no_rule_of_a_row_is_cheaper() {
        let costs = Costs::default();
        let mut kinds = [0; 4];
        for case in 0..600 {
            // The other operations are cheaper than an alternation wherever there is a choice.
            let operations = Operations {
                repeat: case % 4 != 1,
                repeat_aba: true,
                sym_split: case % 4 != 1,
                grid_split: false,
            };
            let mut pricer = RulePricer::new(costs, operations);
            let mut rng = stream(1, "rows", case);
            let mut length = rng.random_range(2..10);
            let mut labels: Vec<u8> = (0..length).map(|_| rng.random_range(0..3)).collect();
            // A quarter mirrored, two with a period of one to three cells, which every second time ends in its first cell again.
            let period = rng.random_range(1..4);
            if case % 4 == 1 && length > period {
                length = (length - 1) / period * period + 1;
                labels.truncate(length);
            }
            for i in 0..length {
                match case % 4 {
                    0 => labels[length - 1 - i] = labels[i],
                    1 | 2 if i >= period => labels[i] = labels[i - period],
                    _ => {}
                }
            }
            let mut types = Types::new(&[row(&labels)]).unwrap();
            let root = types.roots[0];
            let strips = types.strips(root, Axis::X);
            // Also prices below zero, as a search for reduced costs has them.
            let prices: Vec<f64> = (0..200).map(|_| rng.random_range(-0.5..3.0)).collect();
            let price = |t: TypeId| prices[t as usize % prices.len()];
            let (cost, rule) = pricer
                .along(&strips, Axis::X, f64::INFINITY, &price)
                .unwrap();
            let expected = least(&strips, &costs, operations, &price);
            assert!(
                (cost - expected).abs() < 1e-8,
                "{labels:?}: {cost} {expected}"
            );
            let paid: f64 = rule.successors.iter().map(|t| price(*t)).sum();
            assert!((rule.cost(&costs) + paid - cost).abs() < 1e-8, "{rule:?}");
            kinds[match rule.arrangement {
                Arrangement::Split(_) => 0,
                Arrangement::Repeat(_) => 1,
                Arrangement::RepeatAba(_) => 2,
                _ => 3,
            }] += 1;
        }
        assert!(kinds.iter().all(|k| *k > 15), "{kinds:?}");
    }
}
