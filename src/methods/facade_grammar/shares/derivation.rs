//! The cheapest derivation of a facade, rule by rule a shortest path.

use super::kind::Kind;
use super::program::Program;

/// A rule: the way, and the arcs of its path from the first to the last.
#[derive(Debug, Clone)]
pub(crate) struct Rule {
    pub kind: u32,
    pub way: usize,
    pub arcs: Vec<usize>,
}

impl Rule {
    /// Everything that the rule pays for.
    pub fn items<'a>(&'a self, kind: &Kind) -> impl Iterator<Item = usize> + use<'a> {
        std::iter::once(kind.operation(self.way)).chain(self.arcs.iter().copied())
    }
}

/// What the rules of a place cost.
pub(crate) struct Prices<'a> {
    /// By item of its kind.
    pub items: &'a [f64],
    /// What it costs to derive a part, by place; the entry behind all places is that of terminals.
    pub parts: &'a [f64],
}

/// Shortest paths through the rules of a place.
#[derive(Debug, Default)]
pub(crate) struct Paths {
    distance: Vec<f64>,
    previous: Vec<usize>,
}

impl Paths {
    /// Cost of the cheapest rule of a place, and its way; infinite when it has none.
    pub fn cheapest(&mut self, program: &Program, place: u32, prices: &Prices) -> (f64, usize) {
        let kind = program.kind(place);
        let mut best = (f64::INFINITY, 0);
        for way in 0..kind.ways.len() {
            let cost = self.along(program, place, way, prices);
            // Noise of additions must not decide between ways of equal cost.
            if cost < best.0 - 1e-12 {
                best = (cost, way);
            }
        }
        best
    }

    /// Cost of the cheapest rule along one way.
    fn along(&mut self, program: &Program, place: u32, way: usize, prices: &Prices) -> f64 {
        let kind = program.kind(place);
        let Self { distance, previous } = self;
        let (last, arcs) = (
            usize::from(kind.ways[way].last),
            kind.ways[way].arcs.clone(),
        );
        distance.clear();
        distance.resize(last + 1, f64::INFINITY);
        previous.resize(previous.len().max(last + 1), 0);
        distance[0] = prices.items[kind.operation(way)];
        for item in arcs {
            let arc = &kind.arcs[item];
            let below = program.below(place, kind, item, prices.parts);
            let cost = distance[usize::from(arc.from)] + prices.items[item] + below;
            if cost < distance[usize::from(arc.to)] {
                distance[usize::from(arc.to)] = cost;
                previous[usize::from(arc.to)] = item;
            }
        }
        distance[last]
    }

    /// The cheapest rule along one way.
    pub fn rule(&mut self, program: &Program, place: u32, way: usize, prices: &Prices) -> Rule {
        self.along(program, place, way, prices);
        let kind = program.kind(place);
        let mut node = kind.ways[way].last;
        let mut arcs = Vec::new();
        while node > 0 {
            let arc = self.previous[usize::from(node)];
            arcs.push(arc);
            node = kind.arcs[arc].from;
        }
        arcs.reverse();
        Rule {
            kind: program.places[place as usize].kind,
            way,
            arcs,
        }
    }
}
