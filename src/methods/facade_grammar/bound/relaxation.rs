//! The Lagrangian relaxation of [`super`]: its value, and multipliers that raise it.

use super::program::{Program, Side, TERMINAL};
use crate::grammar::Costs;

/// What a branch has decided on a type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Fixed {
    Free,
    In,
    Out,
}

/// The cheapest rule of a type: its arcs, and the seams that its lines make.
#[derive(Debug, Default)]
pub(super) struct Rule {
    pub arcs: Vec<usize>,
    pub seams: Vec<u32>,
}

/// Solution of the relaxed program.
#[derive(Debug)]
pub(super) struct Relaxed {
    /// The lower bound.
    pub value: f64,
    /// `R_t - sum of the multipliers of arcs into t`.
    pub reduced: Vec<f64>,
    /// `y_t` and the rule of the types with `y_t = 1`.
    pub rules: Vec<Option<Rule>>,
}

/// How a rule's lines are laid: the side, and where which kind of path ends.
#[derive(Clone, Copy)]
enum Way {
    Path(usize),
    Alternation(usize, usize),
    Mirror(usize),
}

/// Multipliers of arcs (`lambda`) and seams (`mu`), and tables of the shortest paths.
#[derive(Debug)]
pub(super) struct Relaxation<'a> {
    pub program: &'a Program,
    costs: Costs,
    lambda: Vec<f64>,
    mu: Vec<f64>,
    reward: Vec<f64>,
    distance: Vec<f64>,
    previous: Vec<usize>,
}

impl<'a> Relaxation<'a> {
    /// With all multipliers 0.
    pub fn new(program: &'a Program, costs: Costs) -> Self {
        Self {
            program,
            costs,
            lambda: vec![0.0; program.arcs],
            mu: vec![0.0; program.seams],
            reward: Vec::new(),
            distance: Vec::new(),
            previous: Vec::new(),
        }
    }

    /// `L(lambda, mu)` under the decisions of a branch; `None` when these leave no grammar.
    pub fn solve(&mut self, fixed: &[Fixed]) -> Option<Relaxed> {
        let program = self.program;
        let mut incoming = vec![0.0; program.types()];
        for (t, sides) in program.sides.iter().enumerate() {
            if fixed[t] == Fixed::Out {
                continue;
            }
            for side in sides {
                for (i, &u) in side.targets.iter().enumerate() {
                    if u != TERMINAL {
                        incoming[u as usize] += self.lambda[side.first + i];
                    }
                }
            }
        }
        let mut value: f64 = self.mu.iter().sum();
        let mut reduced = vec![f64::INFINITY; program.types()];
        let mut rules: Vec<Option<Rule>> = Vec::new();
        rules.resize_with(program.types(), || None);
        for t in 0..program.types() {
            if fixed[t] == Fixed::Out {
                continue;
            }
            reduced[t] = self.cheapest(t, fixed, None) - incoming[t];
            let needed = fixed[t] == Fixed::In;
            if needed && reduced[t] == f64::INFINITY {
                return None;
            }
            if needed || reduced[t] < 0.0 {
                value += reduced[t];
                let mut rule = Rule::default();
                self.cheapest(t, fixed, Some(&mut rule));
                rules[t] = Some(rule);
            }
        }
        Some(Relaxed {
            value,
            reduced,
            rules,
        })
    }

    /// Raises the bound of a branch by subgradient steps; returns the best solution seen, and
    /// keeps its multipliers. Stops early once `enough(bound)`.
    pub fn ascend(
        &mut self,
        fixed: &[Fixed],
        upper: f64,
        steps: u64,
        enough: impl Fn(f64) -> bool,
    ) -> Option<Relaxed> {
        let mut best = self.solve(fixed)?;
        let mut kept = (self.lambda.clone(), self.mu.clone());
        let mut scale = 1.0;
        let mut stalled = 0;
        let mut gradient = (vec![0.0; self.lambda.len()], vec![0.0; self.mu.len()]);
        let mut relaxed: Option<Relaxed> = None;
        for _ in 0..steps {
            if enough(best.value) {
                break;
            }
            let at = relaxed.as_ref().unwrap_or(&best);
            let norm = self.gradient(fixed, at, &mut gradient);
            if norm == 0.0 {
                break;
            }
            let step = scale * (upper - at.value).max(1e-3) / norm;
            let ascend = |multipliers: &mut [f64], gradient: &[f64]| {
                for (m, g) in multipliers.iter_mut().zip(gradient) {
                    *m = (*m + step * g).max(0.0);
                }
            };
            ascend(&mut self.lambda, &gradient.0);
            ascend(&mut self.mu, &gradient.1);
            let found = self.solve(fixed)?;
            if found.value > best.value + 1e-6 {
                stalled = 0;
                kept = (self.lambda.clone(), self.mu.clone());
                best = found;
                relaxed = None;
            } else {
                stalled += 1;
                relaxed = Some(found);
                if stalled == PATIENCE {
                    (stalled, scale) = (0, scale * 0.5);
                    self.lambda.clone_from(&kept.0);
                    self.mu.clone_from(&kept.1);
                    relaxed = None;
                }
            }
        }
        (self.lambda, self.mu) = kept;
        Some(best)
    }

    /// Subgradient without the components that point out of the positive orthant; returns its
    /// squared length.
    fn gradient(&self, fixed: &[Fixed], at: &Relaxed, gradient: &mut (Vec<f64>, Vec<f64>)) -> f64 {
        let (arcs, seams) = gradient;
        arcs.fill(0.0);
        seams.fill(1.0);
        for rule in at.rules.iter().flatten() {
            for &arc in &rule.arcs {
                arcs[arc] += 1.0;
            }
            for &seam in &rule.seams {
                seams[seam as usize] -= 1.0;
            }
        }
        for (t, sides) in self.program.sides.iter().enumerate() {
            for side in sides {
                let range = side.first..side.first + side.targets.len();
                for (g, &u) in arcs[range].iter_mut().zip(&side.targets) {
                    if u == TERMINAL || fixed[t] == Fixed::Out {
                        *g = 0.0;
                    } else if at.rules[u as usize].is_some() {
                        *g -= 1.0;
                    }
                }
            }
        }
        let mut norm = 0.0;
        for (g, m) in arcs
            .iter_mut()
            .zip(&self.lambda)
            .chain(seams.iter_mut().zip(&self.mu))
        {
            if *m == 0.0 && *g < 0.0 {
                *g = 0.0;
            }
            norm += *g * *g;
        }
        norm
    }

    /// Cost of the best grammar over a set of types, `None` when they derive no facade. Types of
    /// the set that the rules do not need cost nothing.
    pub fn exact(&mut self, set: &[Fixed]) -> Option<f64> {
        let kept = (
            std::mem::replace(&mut self.lambda, vec![0.0; self.program.arcs]),
            std::mem::replace(&mut self.mu, vec![0.0; self.program.seams]),
        );
        let mut total = 0.0;
        let mut needed = vec![false; self.program.types()];
        needed[0] = true;
        let mut waiting = vec![0];
        while let Some(t) = waiting.pop() {
            let mut rule = Rule::default();
            total += self.cheapest(t, set, Some(&mut rule));
            for u in rule.arcs.iter().map(|&arc| self.target(t, arc)) {
                if u != TERMINAL && !std::mem::replace(&mut needed[u as usize], true) {
                    waiting.push(u as usize);
                }
            }
        }
        (self.lambda, self.mu) = kept;
        total.is_finite().then_some(total)
    }

    /// Type that an arc of `t` leads to.
    pub fn target(&self, t: usize, arc: usize) -> u32 {
        let sides = &self.program.sides[t];
        let side = &sides[usize::from(arc >= sides[1].first)];
        side.targets[arc - side.first]
    }

    /// `R_t`: the least cost of a rule with the multipliers of its arcs, less those of its seams.
    fn cheapest(&mut self, t: usize, fixed: &[Fixed], rule: Option<&mut Rule>) -> f64 {
        let program = self.program;
        let mut best: (f64, Option<(&Side, Way)>) = (f64::INFINITY, None);
        for side in &program.sides[t] {
            if side.intervals > 1 {
                let (cost, way) = self.along(side, fixed);
                if cost < best.0 {
                    best = (cost, Some((side, way)));
                }
            }
        }
        if let (Some(rule), Some((side, way))) = (rule, best.1) {
            self.along(side, fixed);
            self.trace(side, way, fixed, rule);
        }
        best.0
    }

    fn price(&self, side: &Side, arc: usize, fixed: &[Fixed]) -> f64 {
        match side.targets[arc] {
            TERMINAL => 0.0,
            u if fixed[u as usize] == Fixed::Out => f64::INFINITY,
            _ => self.lambda[side.first + arc],
        }
    }

    fn along(&mut self, side: &Side, fixed: &[Fixed]) -> (f64, Way) {
        let (n, costs) = (side.intervals, self.costs);
        self.reward.clear();
        let mu = &self.mu;
        let sum = |seams: &Vec<u32>| seams.iter().map(|&s| mu[s as usize]).sum::<f64>();
        self.reward.extend(side.seams.iter().map(sum));
        self.distance.clear();
        self.distance.resize(n + 1, 0.0);
        self.previous.clear();
        self.previous.resize(n + 1, 0);
        for b in 1..=n {
            let (mut least, mut from) = (f64::INFINITY, 0);
            for a in usize::from(b == n)..b {
                let cost = self.distance[a] + self.price(side, arc(a, b), fixed);
                if cost < least {
                    (least, from) = (cost, a);
                }
            }
            self.distance[b] = least + costs.successor - self.reward[b];
            self.previous[b] = from;
        }
        let mut best = (costs.split + self.distance[n], Way::Path(n));
        let mut offer = |cost: f64, way| {
            if cost < best.0 {
                best = (cost, way);
            }
        };
        for &end in &side.periods {
            offer(costs.repeat + self.distance[end], Way::Path(end));
        }
        for &(a, b) in &side.alternations {
            let prices = self.price(side, arc(0, a), fixed) + self.price(side, arc(a, b), fixed);
            let rewards = self.reward[a] + self.reward[b];
            let cost = costs.repeat_aba + 2.0 * costs.successor + prices - rewards;
            offer(cost, Way::Alternation(a, b));
        }
        if !side.mirrors.is_empty() {
            let (_, ends) = self.mirrored(side, fixed);
            for (end, cost) in ends.into_iter().enumerate() {
                offer(costs.sym_split + cost, Way::Mirror(end));
            }
        }
        best
    }

    /// Shortest mirrored halves: predecessors, and the cost of closing the rule at each mirror.
    fn mirrored(&self, side: &Side, fixed: &[Fixed]) -> (Vec<usize>, Vec<f64>) {
        let count = side.mirrors.len();
        let (mut half, mut previous) = (vec![f64::INFINITY; count], vec![0; count]);
        let mut closed = vec![f64::INFINITY; count];
        half[0] = 0.0;
        for b in 1..count {
            let (left, right) = side.mirrors[b];
            let rewards = if left == right {
                self.reward[left]
            } else {
                self.reward[left] + self.reward[right]
            };
            for &a in &side.mirrored[b] {
                let price = self.price(side, arc(side.mirrors[a].0, left), fixed);
                let cost = half[a] + self.costs.successor + price - rewards;
                if cost < half[b] {
                    (half[b], previous[b]) = (cost, a);
                }
            }
            closed[b] = if left == right {
                half[b]
            } else {
                half[b] + self.costs.successor + self.price(side, arc(left, right), fixed)
            };
        }
        (previous, closed)
    }

    fn trace(&self, side: &Side, way: Way, fixed: &[Fixed], rule: &mut Rule) {
        let mut arcs = Vec::new();
        let mut cuts = Vec::new();
        match way {
            Way::Path(end) => {
                let mut at = end;
                while at > 0 {
                    cuts.push(at);
                    arcs.push(arc(self.previous[at], at));
                    at = self.previous[at];
                }
            }
            Way::Alternation(a, b) => {
                cuts.extend([a, b]);
                arcs.extend([arc(0, a), arc(a, b)]);
            }
            Way::Mirror(end) => {
                let (previous, _) = self.mirrored(side, fixed);
                let (left, right) = side.mirrors[end];
                if left != right {
                    arcs.push(arc(left, right));
                }
                let mut at = end;
                while at > 0 {
                    let (left, right) = side.mirrors[at];
                    cuts.push(left);
                    if left != right {
                        cuts.push(right);
                    }
                    arcs.push(arc(side.mirrors[previous[at]].0, left));
                    at = previous[at];
                }
            }
        }
        rule.seams = cuts
            .iter()
            .flat_map(|&c| side.seams[c].iter().copied())
            .collect();
        rule.arcs = arcs.into_iter().map(|a| side.first + a).collect();
    }
}

/// Steps without progress after which the step length is halved.
const PATIENCE: u32 = 12;

fn arc(a: usize, b: usize) -> usize {
    b * (b - 1) / 2 + a
}
