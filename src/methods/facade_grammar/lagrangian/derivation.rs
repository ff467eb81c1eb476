//! The cheapest derivation of a facade, rule by rule a shortest path.

use super::program::Program;
use super::region_type::RegionType;

/// A rule: the operator, and the arcs of its path from the first to the last.
#[derive(Debug, Clone)]
pub(crate) struct Rule {
    pub region_type: u32,
    pub operator: usize,
    pub arcs: Vec<usize>,
}

impl Rule {
    /// The items of the rule.
    pub(crate) fn items<'a>(
        &'a self,
        region_type: &RegionType,
    ) -> impl Iterator<Item = usize> + use<'a> {
        std::iter::once(region_type.operation(self.operator)).chain(self.arcs.iter().copied())
    }
}

/// Costs under which the rules of an occurrence are compared.
pub(crate) struct Prices<'a> {
    /// Cost of each item of its region type.
    pub items: &'a [f64],
    /// Cost of deriving a part, by occurrence; the entry behind all occurrences is that of terminals.
    pub parts: &'a [f64],
}

/// Shortest paths through the rules of an occurrence.
#[derive(Debug, Default)]
pub(crate) struct Paths {
    distance: Vec<f64>,
    previous: Vec<usize>,
}

impl Paths {
    /// Cost of the cheapest rule of an occurrence, and its operator; infinite when it has none.
    pub(super) fn cheapest(
        &mut self,
        program: &Program,
        occurrence: u32,
        prices: &Prices,
    ) -> (f64, usize) {
        let region_type = program.region_type(occurrence);
        let mut best = (f64::INFINITY, 0);
        for operator in 0..region_type.operators.len() {
            let cost = self.along(program, occurrence, operator, prices);
            // Noise of additions must not decide between operators of equal cost.
            if cost < best.0 - 1e-12 {
                best = (cost, operator);
            }
        }
        best
    }

    /// Cost of the cheapest rule along one operator.
    fn along(
        &mut self,
        program: &Program,
        occurrence: u32,
        operator: usize,
        prices: &Prices,
    ) -> f64 {
        let region_type = program.region_type(occurrence);
        let Self { distance, previous } = self;
        let (last, arcs) = (
            usize::from(region_type.operators[operator].last),
            region_type.operators[operator].arcs.clone(),
        );
        distance.clear();
        distance.resize(last + 1, f64::INFINITY);
        previous.resize(previous.len().max(last + 1), 0);
        distance[0] = prices.items[region_type.operation(operator)];
        for item in arcs {
            let arc = &region_type.arcs[item];
            let below = program.below(occurrence, region_type, item, prices.parts);
            let cost = distance[usize::from(arc.from)] + prices.items[item] + below;
            if cost < distance[usize::from(arc.to)] {
                distance[usize::from(arc.to)] = cost;
                previous[usize::from(arc.to)] = item;
            }
        }
        distance[last]
    }

    /// The cheapest rule along one operator.
    pub(super) fn rule(
        &mut self,
        program: &Program,
        occurrence: u32,
        operator: usize,
        prices: &Prices,
    ) -> Rule {
        self.along(program, occurrence, operator, prices);
        let region_type = program.region_type(occurrence);
        let mut node = region_type.operators[operator].last;
        let mut arcs = Vec::new();
        while node > 0 {
            let arc = self.previous[usize::from(node)];
            arcs.push(arc);
            node = region_type.arcs[arc].from;
        }
        arcs.reverse();
        Rule {
            region_type: program.occurrences[occurrence as usize].region_type,
            operator,
            arcs,
        }
    }
}
