//! Types that are known to have a rule.

use super::Program;

impl Program {
    /// Says that a type has a rule, so that what all its rules pay at least is paid once, whatever the shares: each pays
    /// for its operation, for a first successor, and, unless this is the only one, for a last. The shares of
    /// these items shrink in proportion to what is left of their costs.
    pub(super) fn require(&mut self, kind: usize, shares: &mut [f64]) {
        let known = &mut self.kinds[kind];
        known.required = true;
        let cheapest = |way: usize| {
            let arcs = known.ways[way].arcs.clone();
            let last = known.ways[way].last;
            let least = |wanted: &dyn Fn(usize) -> bool| {
                let costs = arcs.clone().filter(|&item| wanted(item));
                costs
                    .map(|item| known.costs[item])
                    .fold(f64::INFINITY, f64::min)
            };
            let first = least(&|item| known.arcs[item].from == 0);
            let single = arcs
                .clone()
                .any(|item| known.arcs[item].from == 0 && known.arcs[item].to == last);
            let closing = match single {
                true => 0.0,
                false => least(&|item| known.arcs[item].to == last),
            };
            [known.costs[known.operation(way)], first, closing]
        };
        let parts: Vec<[f64; 3]> = (0..known.ways.len()).map(cheapest).collect();
        let common = parts
            .iter()
            .map(|parts| parts.iter().sum())
            .fold(f64::INFINITY, f64::min);
        if common == f64::INFINITY {
            return;
        }
        let before = known.costs.clone();
        for (way, parts) in parts.iter().enumerate() {
            let mut left: f64 = common;
            let [operation, first, closing] = parts.map(|part| {
                let taken = left.min(part);
                left -= taken;
                taken
            });
            let item = known.operation(way);
            known.costs[item] -= operation;
            let last = known.ways[way].last;
            for item in known.ways[way].arcs.clone() {
                if known.arcs[item].from == 0 {
                    known.costs[item] -= first;
                } else if known.arcs[item].to == last {
                    known.costs[item] -= closing;
                }
            }
        }
        self.constant += common;
        let items = known.costs.len();
        for (item, (old, new)) in before.iter().zip(&mut known.costs).enumerate() {
            // Noise of the subtractions must leave no cost below 0.
            *new = new.max(0.0);
            if *new < *old {
                for purse in 0..known.purses.len() {
                    shares[known.first_share + purse * items + item] *= *new / old;
                }
            }
        }
    }
}
