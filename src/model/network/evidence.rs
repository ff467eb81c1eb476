//! Evidence, and the factors it leaves over the unobserved discrete variables.

use super::super::conjugate::Linear;
use super::super::elimination::{Factor, advance};
use super::super::error::ModelError;
use super::super::gaussian::{Particles, extend};
use super::{Cpd, Network};

/// The known facts: categories, likelihoods of categories, coordinates of real vectors, each in the variable's own
/// unit.
///
/// Hard evidence restricts `p(x)` to what agrees with it; soft evidence on `y` multiplies it by `λ(y)`, as a child of `y`
/// that was seen would: `P(x | e) ∝ P(x) λ(y)` (Pearl 1988, Sec. 2.2.2). Said twice, soft evidence multiplies, hard
/// evidence must agree, and the last coordinates count. Names are looked up when a question is put
/// ([`Network::marginal`] and others): `O(n)` for each, of n variables.
///
/// # Examples
/// ```
/// use edifice_model::{ModelError, network::{Evidence, Network, Variable}};
/// let network = Network::new(vec![Variable::table("rain", &["no", "yes"], &[], &[0.8, 0.2])])?;
/// let forecast = Evidence::new().likely("rain", &[1.0, 4.0]);
/// assert!((network.marginal(&forecast, "rain")?[1] - 0.5).abs() < 1e-12);
/// let both = Evidence::new().is("rain", "no").is("rain", "yes");
/// assert!(matches!(network.marginal(&both, "rain"), Err(ModelError::Contradiction { .. })));
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Evidence {
    discrete: Vec<(String, String)>,
    soft: Vec<(String, Vec<f64>)>,
    real: Vec<(String, Vec<Option<f64>>)>,
}

impl Evidence {
    /// Evidence without any fact.
    pub fn new() -> Self {
        Self::default()
    }

    /// A discrete variable has this category.
    pub fn is(mut self, name: &str, category: &str) -> Self {
        self.discrete.push((name.to_owned(), category.to_owned()));
        self
    }

    /// Soft (virtual) evidence on a discrete variable: `P(what was seen | category)`, up to a common factor, for every
    /// category in order (Pearl 1988, Sec. 2.2.2).
    pub fn likely(mut self, name: &str, likelihoods: &[f64]) -> Self {
        self.soft.push((name.to_owned(), likelihoods.to_vec()));
        self
    }

    /// A real vector has these coordinates.
    pub fn real(self, name: &str, values: &[f64]) -> Self {
        let values: Vec<Option<f64>> = values.iter().map(|v| Some(*v)).collect();
        self.partly(name, &values)
    }

    /// Some coordinates of a real vector are known.
    pub fn partly(mut self, name: &str, values: &[Option<f64>]) -> Self {
        self.real.push((name.to_owned(), values.to_vec()));
        self
    }
}

/// Evidence by index.
#[derive(Clone, Debug)]
pub(crate) struct Known {
    /// Per node.
    pub discrete: Vec<Option<usize>>,
    /// Nodes with soft evidence, and the logarithms of its likelihoods.
    pub soft: Vec<(usize, Vec<f64>)>,
    /// Per coordinate, NaN for unknown.
    pub real: Vec<f64>,
}

impl Known {
    /// Known categories, and the first category of every other node: an assignment to start from.
    pub(crate) fn assignment(&self) -> Vec<usize> {
        self.discrete.iter().map(|v| v.unwrap_or(0)).collect()
    }
}

/// Continuous variables that unknown values link, given the discrete parents of all of them.
#[derive(Debug)]
pub(crate) struct Linked {
    /// Nodes, parents first.
    pub nodes: Vec<usize>,
    /// Unknown coordinates, in the order of the Gaussians.
    pub missing: Vec<usize>,
    /// Unobserved discrete parents.
    pub vars: Vec<usize>,
    /// One Gaussian per configuration of `vars`, the last fastest.
    pub particles: Particles,
}

/// The target of a question, besides the evidence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Asked {
    /// No variable: the evidence alone.
    Evidence,
    /// One variable.
    Variable(usize),
    /// All discrete variables.
    Discrete,
}

/// A question made ready for elimination.
#[derive(Debug)]
pub(crate) struct Question {
    pub known: Known,
    pub factors: Vec<Factor>,
    pub linked: Vec<Linked>,
    /// Unobserved nodes that the question leaves out, parents first.
    pub left_out: Vec<usize>,
}

impl Question {
    /// The factors that node n is connected with.
    pub(crate) fn component(&self, n: usize) -> Vec<Factor> {
        let mut reached = vec![n];
        let mut left: Vec<&Factor> = self.factors.iter().collect();
        let mut found = Vec::new();
        loop {
            let near = |f: &&Factor| f.vars.iter().any(|v| reached.contains(v));
            let (own, others): (Vec<&Factor>, Vec<&Factor>) = left.into_iter().partition(near);
            if own.is_empty() {
                return found;
            }
            for factor in own {
                reached.extend(&factor.vars);
                found.push(factor.clone());
            }
            reached.sort_unstable();
            reached.dedup();
            left = others;
        }
    }
}

impl Network {
    pub(crate) fn known(&self, evidence: &Evidence) -> Result<Known, ModelError> {
        let mut known = Known {
            discrete: vec![None; self.nodes.len()],
            soft: Vec::new(),
            real: vec![f64::NAN; self.width],
        };
        for (name, category) in &evidence.discrete {
            let node = self.find(name)?;
            let found = self.nodes[node]
                .categories
                .iter()
                .position(|c| c == category);
            let value = found.ok_or_else(|| ModelError::UnseenCategory {
                column: name.clone(),
                row: 0,
                category: category.clone(),
            })?;
            if known.discrete[node].is_some_and(|v| v != value) {
                return Err(ModelError::Contradiction {
                    row: None,
                    variable: name.clone(),
                });
            }
            known.discrete[node] = Some(value);
        }
        for (name, likelihoods) in &evidence.soft {
            let node = self.find(name)?;
            let fits = likelihoods.len() == self.nodes[node].categories.len();
            let likely = likelihoods.iter().all(|l| l.is_finite() && *l >= 0.0);
            if !fits || !likely || likelihoods.iter().all(|l| *l == 0.0) {
                let problem = "needs a likelihood, not all 0, for each of its categories";
                return Err(ModelError::parameter(name, problem));
            }
            let logs = likelihoods.iter().map(|l| l.ln()).collect();
            known.soft.push((node, logs));
        }
        for (name, values) in &evidence.real {
            let range = self.nodes[self.find(name)?].coordinates.clone();
            if range.len() != values.len() || range.is_empty() {
                let problem = format!("has {} coordinates", range.len());
                return Err(ModelError::parameter(name, problem));
            }
            for (at, value) in range.zip(values) {
                match value {
                    Some(v) if v.is_finite() => known.real[at] = *v,
                    None => known.real[at] = f64::NAN,
                    Some(v) => {
                        return Err(ModelError::NotFinite {
                            column: name.clone(),
                            row: 0,
                            value: *v,
                        });
                    }
                }
            }
        }
        Ok(known)
    }

    /// Factors over the unobserved discrete variables; continuous ones integrated out. Variables without evidence on or
    /// below them that are not asked for are barren and left out.
    pub(crate) fn question(&self, known: Known, asked: Asked) -> Result<Question, ModelError> {
        let unknown = |n: usize| {
            self.nodes[n]
                .coordinates
                .clone()
                .any(|c| known.real[c].is_nan())
        };
        let active = self.active(&known, asked);
        let mut factors = Vec::new();
        for (n, node) in self.nodes.iter().enumerate() {
            let mut vars = node.discrete.clone();
            vars.push(n);
            match &node.cpd {
                Cpd::Table(table) if active[n] => {
                    let values = table.iter().map(|p| p.ln()).collect();
                    factors.push(Factor::new(vars, values).reduce(&known.discrete, &self.sizes));
                }
                Cpd::Softmax(weights) if active[n] => {
                    if node.regressors.iter().any(|&c| known.real[c].is_nan()) {
                        let problem = "a continuous parent must be observed here";
                        return Err(ModelError::parameter(&node.name, problem));
                    }
                    let values = softmax(weights, &node.regressors, &known.real, self.sizes[n]);
                    factors.push(Factor::new(vars, values).reduce(&known.discrete, &self.sizes));
                }
                _ => {}
            }
        }
        for (n, logs) in &known.soft {
            let factor = Factor::new(vec![*n], logs.clone());
            factors.push(factor.reduce(&known.discrete, &self.sizes));
        }
        let mut label: Vec<usize> = (0..self.nodes.len()).collect();
        let real = |n: &usize| matches!(self.nodes[*n].cpd, Cpd::Linear(_));
        for &n in self.order.iter().filter(|n| real(n) && active[**n]) {
            for &p in self.nodes[n]
                .parents
                .iter()
                .filter(|p| real(p) && unknown(**p))
            {
                let (from, to) = (label[p], label[n]);
                label
                    .iter_mut()
                    .filter(|l| **l == from)
                    .for_each(|l| *l = to);
            }
        }
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for &n in self.order.iter().filter(|n| real(n) && active[**n]) {
            match groups.iter_mut().find(|g| label[g[0]] == label[n]) {
                Some(group) => group.push(n),
                None => groups.push(vec![n]),
            }
        }
        let linked: Vec<Linked> = groups.into_iter().map(|g| self.link(g, &known)).collect();
        for l in &linked {
            let densities = l.particles.iter().map(|p| p.log_density).collect();
            factors.push(Factor::new(l.vars.clone(), densities));
        }
        let left_out = self.order.iter().copied();
        let left_out = left_out.filter(|&n| !active[n] && known.discrete[n].is_none());
        Ok(Question {
            left_out: left_out.collect(),
            known,
            factors,
            linked,
        })
    }

    /// The nodes that a question depends on: with evidence on them or below, or asked for.
    fn active(&self, known: &Known, asked: Asked) -> Vec<bool> {
        let mut active = vec![false; self.nodes.len()];
        for (n, _) in &known.soft {
            active[*n] = true;
        }
        for &n in self.order.iter().rev() {
            let node = &self.nodes[n];
            active[n] = active[n]
                || asked == Asked::Variable(n)
                || known.discrete[n].is_some()
                || node.coordinates.clone().any(|c| !known.real[c].is_nan());
            if active[n] {
                for &p in &node.parents {
                    active[p] = true;
                }
            }
        }
        if asked != Asked::Discrete {
            return active;
        }
        // All other discrete variables but those below a softmax of unknown values.
        let mut without = vec![false; self.nodes.len()];
        for &n in &self.order {
            let node = &self.nodes[n];
            let gap = matches!(node.cpd, Cpd::Softmax(_))
                && node.regressors.iter().any(|&c| known.real[c].is_nan());
            without[n] = !active[n] && (gap || node.discrete.iter().any(|&p| without[p]));
            active[n] |= node.is_discrete() && !without[n];
        }
        active
    }

    fn link(&self, nodes: Vec<usize>, known: &Known) -> Linked {
        let mut vars: Vec<usize> = nodes
            .iter()
            .flat_map(|&n| self.nodes[n].discrete.clone())
            .filter(|&v| known.discrete[v].is_none())
            .collect();
        vars.sort_unstable();
        vars.dedup();
        let count: usize = vars.iter().map(|&v| self.sizes[v]).product();
        let mut assignment = known.assignment();
        let mut particles = Particles::default();
        let mut missing = Vec::new();
        for _ in 0..count {
            missing.clear();
            let mut one = Particles::start();
            for &n in &nodes {
                let columns = self.columns(n);
                if let Some(linear) = self.state(n, &assignment) {
                    one = extend(one.get(0), &missing, &columns, linear, &known.real);
                }
                let own = self.nodes[n].coordinates.clone();
                missing.extend(own.filter(|&c| known.real[c].is_nan()));
            }
            match particles.len() {
                0 => particles = one,
                _ => particles.push(one.get(0)),
            }
            advance(&vars, &self.sizes, &mut assignment);
        }
        Linked {
            nodes,
            missing,
            vars,
            particles,
        }
    }

    /// Coordinates of u after the leading 1.
    pub(crate) fn columns(&self, n: usize) -> Vec<usize> {
        let node = &self.nodes[n];
        let own = node.coordinates.clone();
        node.regressors.iter().copied().chain(own).collect()
    }

    /// Index of the configuration of a node's discrete parents.
    pub(crate) fn configuration(&self, n: usize, assignment: &[usize]) -> usize {
        let parents = &self.nodes[n].discrete;
        parents
            .iter()
            .fold(0, |i, &p| i * self.sizes[p] + assignment[p])
    }

    /// The linear Gaussian of a real vector under an assignment of discrete variables.
    pub(crate) fn state(&self, n: usize, assignment: &[usize]) -> Option<&Linear> {
        match &self.nodes[n].cpd {
            Cpd::Linear(states) => states.get(self.configuration(n, assignment)),
            _ => None,
        }
    }
}

/// Log probabilities of every category for every configuration of discrete parents.
pub(crate) fn softmax(weights: &[f64], regressors: &[usize], real: &[f64], k: usize) -> Vec<f64> {
    let p = regressors.len() + 1;
    let scores: Vec<f64> = weights
        .chunks(p)
        .map(|w| {
            w[0] + w[1..]
                .iter()
                .zip(regressors)
                .map(|(w, &c)| w * real[c])
                .sum::<f64>()
        })
        .collect();
    scores
        .chunks(k)
        .flat_map(|s| {
            let total = super::super::linalg::log_sum_exp(s);
            s.iter().map(move |v| v - total).collect::<Vec<_>>()
        })
        .collect()
}
