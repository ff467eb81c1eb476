//! Branch and bound over sets of non-terminal types.

use edifice_facade_grammar::Operations;
use edifice_grammar::{Costs, Grammar};

use super::catalogue::Catalogue;
use super::content::Content;
use super::landmarks::{Landmarks, Status};
use super::network::Network;
use super::write;

/// Beyond these the search gives up.
#[derive(Debug, Clone, Copy)]
pub struct Limits {
    /// Region types.
    pub types: usize,
    /// Steps of all rules.
    pub steps: usize,
    /// Lower bounds computed.
    pub bounds: usize,
}

/// A grammar of least cost.
#[derive(Debug, Clone)]
pub struct Smallest {
    /// Its cost.
    pub cost: f64,
    /// The grammar.
    pub grammar: Grammar,
    /// Lower bounds computed.
    pub bounds: usize,
}

/// Sums of costs that differ by less are equal.
const NOISE: f64 = 1e-7;
/// Number of times that all types are tried before the search branches.
const PASSES: usize = 2;

/// The smallest grammar of some facades; `None` when `limits` do not suffice.
pub fn smallest(
    facades: &[Content],
    operations: Operations,
    costs: &Costs,
    limits: &Limits,
) -> Option<Smallest> {
    let catalogue = Catalogue::new(facades, limits.types)?;
    let network = Network::new(&catalogue, operations, costs, limits.steps)?;
    let mut status = vec![Status::Open; catalogue.types.len()];
    for &root in &network.roots {
        status[root] = Status::In;
    }
    let mut search = Search {
        network: &network,
        landmarks: Landmarks::new(&network),
        best: (f64::INFINITY, Vec::new()),
        bounds: 0,
        most: limits.bounds,
        grain: grain(costs),
    };
    search.try_plan(&status);
    let finished = search.fix(&mut status) && search.branch(&status);
    finished.then(|| Smallest {
        cost: search.best.0,
        grammar: write::grammar(&catalogue, &network, &search.best.1, facades),
        bounds: search.bounds,
    })
}

/// A number of which all costs are multiples, so that two different sums differ by it at least; 0 when none is known.
fn grain(costs: &Costs) -> f64 {
    let all = [
        costs.split,
        costs.repeat,
        costs.repeat_aba,
        costs.sym_split,
        costs.grid_split,
        costs.successor,
    ];
    let divides = |grain: &f64| {
        all.iter()
            .all(|c| ((c / grain).round() * grain - c).abs() < 1e-12)
    };
    let candidates = [
        1.0,
        1.0 / 2.0,
        1.0 / 3.0,
        1.0 / 4.0,
        1.0 / 5.0,
        1.0 / 6.0,
        1.0 / 10.0,
    ];
    candidates.into_iter().find(divides).unwrap_or(0.0)
}

struct Search<'n> {
    network: &'n Network,
    landmarks: Landmarks<'n>,
    /// The cheapest grammar so far: its cost, and its types.
    best: (f64, Vec<bool>),
    bounds: usize,
    most: usize,
    grain: f64,
}

impl Search<'_> {
    /// No better grammar than the best known costs as much.
    fn enough(&self) -> f64 {
        match self.grain {
            0.0 => self.best.0 - NOISE,
            grain => self.best.0 - grain + NOISE,
        }
    }

    /// True if no grammar that agrees with `status` is better than the best known.
    fn hopeless(&mut self, status: &[Status]) -> bool {
        self.bounds += 1;
        let enough = self.enough();
        self.landmarks.bound(status, enough) >= enough
    }

    /// Decides types one by one where the other decision is hopeless; false when limits do not suffice.
    fn fix(&mut self, status: &mut [Status]) -> bool {
        let types = status.len();
        for t in (0..PASSES).flat_map(|_| (0..types).rev()) {
            if status[t] != Status::Open {
                continue;
            }
            if self.bounds >= self.most {
                return false;
            }
            status[t] = Status::In;
            status[t] = match self.hopeless(status) {
                true => Status::Out,
                false => Status::Open,
            };
        }
        true
    }

    /// Searches all grammars that agree with `status`; false when limits do not suffice.
    fn branch(&mut self, status: &[Status]) -> bool {
        if self.bounds >= self.most {
            return false;
        }
        if self.hopeless(status) {
            return true;
        }
        // A bound that is not infinite has a plan.
        let plan = self.try_plan(status).unwrap_or_default();
        if self.hopeless(status) {
            return true;
        }
        let open = |t: &usize| status[*t] == Status::Open;
        let types = || (0..status.len()).rev();
        let chosen = types().find(|t| open(t) && plan.get(*t) == Some(&true));
        let Some(t) = chosen.or_else(|| types().find(open)) else {
            // Everything is decided: `try_plan` found the cheapest rules.
            return true;
        };
        let mut status = status.to_vec();
        status[t] = Status::In;
        let first = self.branch(&status);
        status[t] = Status::Out;
        first && self.branch(&status)
    }

    /// Tries the grammar that `plan` proposes; its types.
    fn try_plan(&mut self, status: &[Status]) -> Option<Vec<bool>> {
        let plan = self.plan(status)?;
        if let Some(cost) = self.cost(&plan)
            && cost < self.best.0 - NOISE
        {
            self.best = (cost, plan.clone());
            self.polish();
        }
        Some(plan)
    }

    /// Adds types to the best grammar and takes them away as long as that makes it cheaper.
    fn polish(&mut self) {
        let (mut cost, mut members) = self.best.clone();
        let mut changed = true;
        while changed {
            changed = false;
            for t in 0..members.len() {
                if self.network.roots.contains(&t) {
                    continue;
                }
                members[t] = !members[t];
                match self.cost(&members) {
                    Some(less) if less < cost - NOISE => (cost, changed) = (less, true),
                    _ => members[t] = !members[t],
                }
            }
        }
        self.best = (cost, members);
    }

    /// The cost of the grammar with these non-terminals; `None` when one of them has no rule.
    fn cost(&self, members: &[bool]) -> Option<f64> {
        let mut sum = 0.0;
        let mut value = vec![f64::INFINITY; self.network.nodes];
        for t in (0..members.len()).filter(|&t| members[t]) {
            for step in &self.network.steps[self.network.steps_of[t].clone()] {
                if step.needs.iter().all(|&t| members[t]) {
                    let before = step.from.map_or(0.0, |node| value[node]);
                    value[step.to] = value[step.to].min(before + step.cost);
                }
            }
            if value[t] == f64::INFINITY {
                return None;
            }
            sum += value[t];
        }
        Some(sum)
    }

    /// The types of a grammar that agrees with `status`: every rule is the one that would be the cheapest if
    /// nothing were shared.
    fn plan(&self, status: &[Status]) -> Option<Vec<bool>> {
        let network = self.network;
        let mut value = vec![f64::INFINITY; network.nodes];
        let mut last = vec![usize::MAX; network.nodes];
        for (i, step) in network.steps.iter().enumerate() {
            let needs = step.needs.iter().map(|&t| match status[t] {
                Status::Open => value[t],
                Status::In => 0.0,
                Status::Out => f64::INFINITY,
            });
            let before = step.from.map_or(0.0, |node| value[node]);
            let sum = before + step.cost + needs.sum::<f64>();
            if sum < value[step.to] {
                (value[step.to], last[step.to]) = (sum, i);
            }
        }
        let mut members: Vec<bool> = status.iter().map(|s| *s == Status::In).collect();
        for t in (0..members.len()).rev() {
            let mut node = members[t].then_some(t);
            while let Some(at) = node {
                let step = network.steps.get(last[at])?;
                for &need in &step.needs {
                    members[need] = true;
                }
                node = step.from;
            }
        }
        Some(members)
    }
}
