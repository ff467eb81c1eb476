//! The best grammar known.

use super::derivation::{Paths, Prices, Rule};
use super::program::Program;
use super::region_type::Written;
use crate::operations::Operations;
use crate::regions::Types;
use crate::rules::AddRule;
use edifice_base::{Progress, Watched};
use edifice_grammar::Costs;

/// Noise of sums of costs, which are 0 or between [`Costs::LEAST`] and [`Costs::GREATEST`].
pub(crate) const NOISE: f64 = 1e-7;

/// The cheapest grammar met, and when a bound shows that none is cheaper.
pub(crate) struct Incumbent<'a> {
    pub cost: f64,
    /// Asked at every step of the search for a cheaper one whether it goes on.
    pub watched: Option<&'a Watched<'a>>,
    /// Its rules; none when only the cost is known.
    rules: Vec<Written>,
    /// A number of which all costs of grammars are multiples; `None` where there is none.
    granularity: Option<f64>,
}

impl Incumbent<'_> {
    /// Knows that some grammar has a cost; infinite when none is known.
    pub(crate) fn new(cost: f64, costs: &Costs, operations: Operations) -> Self {
        Self {
            cost,
            watched: None,
            rules: Vec::new(),
            granularity: granularity(costs, operations),
        }
    }

    /// True if the search for a cheaper one shall go on.
    pub(crate) fn goes_on(&self) -> bool {
        let bound = Progress::stage("Lagrangian bound");
        self.watched.is_none_or(|watched| watched.goes_on(bound))
    }

    /// The least cost not below a bound that a grammar can have.
    pub(crate) fn round_up(&self, bound: f64) -> f64 {
        self.granularity
            .map_or(bound, |q| ((bound - NOISE) / q).ceil() * q)
    }

    /// True if a lower bound shows that no grammar is cheaper than the incumbent.
    pub(crate) fn is_optimal(&self, bound: f64) -> bool {
        self.round_up(bound) >= self.cost - NOISE
    }

    /// Keeps a grammar when it is cheaper.
    pub(crate) fn offer(&mut self, program: &Program, cost: f64, rules: &[Rule]) {
        if cost < self.cost - NOISE {
            let written = |rule: &Rule| {
                let region_type = &program.region_types[rule.region_type as usize];
                region_type.written(rule.operator, &rule.arcs)
            };
            (self.cost, self.rules) = (cost, rules.iter().map(written).collect());
        }
    }

    /// The rules of the cheapest grammar that was offered, over the types of another search.
    pub(crate) fn rules(&self, types: &mut Types) -> Vec<AddRule> {
        self.rules.iter().map(|rule| rule.rule(types)).collect()
    }
}

/// The greatest common divisor of the costs of what rules may be made of, down to a thousandth; `None` where every
/// grammar costs nothing, or the costs have no such divisor.
fn granularity(costs: &Costs, operations: Operations) -> Option<f64> {
    let used = [
        (true, costs.split),
        (true, costs.successor),
        (operations.repeat, costs.repeat),
        (operations.repeat_aba, costs.repeat_aba),
        (operations.sym_split, costs.sym_split),
        (operations.grid_split, costs.grid_split),
    ];
    let used = || used.iter().filter(|(used, _)| *used).map(|(_, cost)| *cost);
    let divisor = used().fold(0.0, common_divisor);
    let divides = |cost: f64| ((cost / divisor).round() * divisor - cost).abs() < EXACT;
    (divisor >= 1e-3 - EXACT && used().all(divides)).then_some(divisor)
}

/// Noise of a single cost.
const EXACT: f64 = 1e-12;

/// Euclid's algorithm up to noise.
fn common_divisor(a: f64, b: f64) -> f64 {
    let (mut a, mut b) = (a.max(b), a.min(b));
    while b > EXACT {
        // A remainder within noise of the divisor is none.
        (a, b) = (b, (a - b * (a / b + EXACT).floor()).max(0.0));
    }
    a
}

/// Best grammars over given sets of region types.
#[derive(Debug)]
pub(super) struct Restricted {
    /// 0 for terminals and the members, infinite for other occurrences.
    parts: Vec<f64>,
    paths: Paths,
}

impl Restricted {
    pub(super) fn new(program: &Program) -> Self {
        let mut parts = vec![f64::INFINITY; program.values()];
        parts[program.occurrences.len()] = 0.0;
        Self {
            parts,
            paths: Paths::default(),
        }
    }

    /// The best grammar over a set of region types that contains those of the roots, each rule being the cheapest;
    /// rules that the roots do not need are left out.
    pub(super) fn cheapest(&mut self, program: &Program, members: &[u32]) -> (f64, Vec<Rule>) {
        self.price(program, members, 0.0);
        let region_type_of = |part: u32| program.region_type_of(part);
        let mut needed: Vec<u32> = program
            .roots
            .iter()
            .map(|&root| region_type_of(root))
            .collect();
        let (mut total, mut rules) = (0.0, Vec::new());
        while let Some(&region_type) = needed.get(rules.len()) {
            let known = &program.region_types[region_type as usize];
            let occurrence = known.occurrences[0];
            let prices = Prices {
                items: &known.full_costs,
                parts: &self.parts,
            };
            let (cost, operator) = self.paths.cheapest(program, occurrence, &prices);
            if cost == f64::INFINITY {
                total = cost;
                break;
            }
            let rule = self.paths.rule(program, occurrence, operator, &prices);
            for part in rule
                .arcs
                .iter()
                .flat_map(|&arc| program.parts(occurrence, known, arc))
            {
                if !program.is_terminal(part) && !needed.contains(&region_type_of(part)) {
                    needed.push(region_type_of(part));
                }
            }
            total += cost;
            rules.push(rule);
        }
        self.price(program, members, f64::INFINITY);
        (total, rules)
    }

    fn price(&mut self, program: &Program, region_types: &[u32], price: f64) {
        for &region_type in region_types {
            for &occurrence in &program.region_types[region_type as usize].occurrences {
                self.parts[occurrence as usize] = price;
            }
            self.parts[program.removed(region_type) as usize] = price;
        }
    }
}
