//! A lower bound on the cost of the steps that reach some types.
//!
//! A *landmark* is a set of steps of which every grammar makes one at least, so the cheapest of them has to be
//! paid. Charging that much of the cost of each step of the set leaves a network whose least cost is smaller by
//! no more than what was charged, and so the charges of one landmark after the other add up to a lower bound.
//! Landmarks are cuts between what is reached at no cost and the dearest type that is still to be reached
//! (LM-cut: Helmert and Domshlak, *Landmarks, critical paths and abstractions*, ICAPS 2009).

use super::network::Network;

/// The decision on a type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Status {
    /// No decision yet.
    Open,
    /// It is a non-terminal of the grammar.
    In,
    /// It is no non-terminal of the grammar.
    Out,
}

/// Costs below this are noise of subtractions; to neglect them lowers the bound.
const NOISE: f64 = 1e-10;

/// The computation and its memory.
pub(super) struct Landmarks<'n> {
    network: &'n Network,
    costs: Vec<f64>,
    /// The steps that grammars at hand can make, in order.
    active: Vec<usize>,
    /// By node: a lower bound on the cost to reach it, the dearest of what each step needs.
    value: Vec<f64>,
    /// By step: the dearest node that it needs; none when it needs nothing that is not there.
    supporter: Vec<Option<usize>>,
    /// By step: the value of its supporter.
    reached: Vec<f64>,
    zone: Vec<bool>,
    before: Vec<bool>,
}

impl<'n> Landmarks<'n> {
    /// A computation on a network, before its first bound.
    pub(super) fn new(network: &'n Network) -> Self {
        let (nodes, steps) = (network.nodes, network.steps.len());
        Self {
            network,
            costs: vec![0.0; steps],
            active: Vec::new(),
            value: vec![0.0; nodes],
            supporter: vec![None; steps],
            reached: vec![0.0; steps],
            zone: vec![false; nodes],
            before: vec![false; nodes],
        }
    }

    /// A lower bound on the cost of all grammars that agree with `status`, complete or just above `enough`.
    /// Infinite when there is none.
    pub(super) fn bound(&mut self, status: &[Status], enough: f64) -> f64 {
        self.activate(status);
        let goals: Vec<usize> = (0..status.len())
            .filter(|&t| status[t] == Status::In)
            .collect();
        let mut bound = 0.0;
        while bound < enough {
            self.reach(status);
            let dearest = goals
                .iter()
                .copied()
                .reduce(|a, b| if self.value[b] > self.value[a] { b } else { a });
            match dearest {
                Some(goal) if self.value[goal] == f64::INFINITY => return f64::INFINITY,
                Some(goal) if self.value[goal] > NOISE => bound += self.charge(goal),
                _ => break,
            }
        }
        bound
    }

    /// Finds the steps of the types that are in and of those that these may need; their costs are whole again.
    fn activate(&mut self, status: &[Status]) {
        let network = self.network;
        let mut relevant: Vec<bool> = status.iter().map(|s| *s == Status::In).collect();
        self.active.clear();
        // Parts come before wholes.
        for t in (0..status.len())
            .rev()
            .filter(|&t| status[t] != Status::Out)
        {
            if !relevant[t] {
                continue;
            }
            for i in network.steps_of[t].clone().rev() {
                let step = &network.steps[i];
                if step.needs.iter().all(|&need| status[need] != Status::Out) {
                    for &need in &step.needs {
                        relevant[need] = true;
                    }
                    self.costs[i] = step.cost;
                    self.active.push(i);
                }
            }
        }
        self.active.reverse();
    }

    /// Values of all nodes under the costs that are left.
    fn reach(&mut self, status: &[Status]) {
        self.value.fill(f64::INFINITY);
        for &i in &self.active {
            let step = &self.network.steps[i];
            let mut dearest = None;
            let mut most = 0.0;
            let needs = step.needs.iter().filter(|&&t| status[t] != Status::In);
            for &node in needs.chain(&step.from) {
                let out = status.get(node) == Some(&Status::Out);
                let value = if out { f64::INFINITY } else { self.value[node] };
                if dearest.is_none() || value > most {
                    (dearest, most) = (Some(node), value);
                }
            }
            self.supporter[i] = dearest;
            self.reached[i] = most;
            let value = &mut self.value[step.to];
            *value = value.min(most + self.costs[i]);
        }
    }

    /// Charges the cut around everything from which `goal` is reached at no cost.
    fn charge(&mut self, goal: usize) -> f64 {
        let steps = &self.network.steps;
        self.zone.fill(false);
        self.zone[goal] = true;
        for &i in self.active.iter().rev() {
            let step = &steps[i];
            if self.zone[step.to]
                && self.costs[i] == 0.0
                && self.reached[i] < f64::INFINITY
                && let Some(node) = self.supporter[i]
            {
                self.zone[node] = true;
            }
        }
        self.before.fill(false);
        let mut cut = Vec::new();
        for &i in &self.active {
            let step = &steps[i];
            let starts = self.supporter[i].is_none_or(|node| self.before[node]);
            if starts && self.reached[i] < f64::INFINITY {
                if self.zone[step.to] {
                    cut.push(i);
                } else {
                    self.before[step.to] = true;
                }
            }
        }
        let least = cut
            .iter()
            .map(|&i| self.costs[i])
            .fold(f64::INFINITY, f64::min);
        for i in cut {
            let left = self.costs[i] - least;
            self.costs[i] = if left > NOISE { left } else { 0.0 };
        }
        least
    }
}
