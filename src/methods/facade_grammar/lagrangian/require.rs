//! Types that are known to have a rule.

use super::Program;

impl Program {
    /// Requires a rule of a type: the least that all its rules cost is a constant, whatever the multipliers, as each has
    /// an operation, a first successor, and, unless this is the only one, a last. The multipliers of
    /// these items shrink in proportion to what is left of their costs.
    pub(super) fn require(&mut self, region_type: usize, multipliers: &mut [f64]) {
        let known = &mut self.region_types[region_type];
        known.required = true;
        let cheapest = |operator: usize| {
            let arcs = known.operators[operator].arcs.clone();
            let last = known.operators[operator].last;
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
            [known.costs[known.operation(operator)], first, closing]
        };
        let parts: Vec<[f64; 3]> = (0..known.operators.len()).map(cheapest).collect();
        let common = parts
            .iter()
            .map(|parts| parts.iter().sum())
            .fold(f64::INFINITY, f64::min);
        if common == f64::INFINITY {
            return;
        }
        let before = known.costs.clone();
        for (operator, parts) in parts.iter().enumerate() {
            let mut left: f64 = common;
            let [operation, first, closing] = parts.map(|part| {
                let taken = left.min(part);
                left -= taken;
                taken
            });
            let item = known.operation(operator);
            known.costs[item] -= operation;
            let last = known.operators[operator].last;
            for item in known.operators[operator].arcs.clone() {
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
                for clique in 0..known.cliques.len() {
                    multipliers[known.first_multiplier + clique * items + item] *= *new / old;
                }
            }
        }
    }
}
