//! Posteriors where exact elimination is too wide: likelihood weighting and Gibbs sampling with standard errors, and loopy
//! belief propagation. Asked for by name; no exact answer falls back on them.
//!
//! Sources: Koller and Friedman 2009, Sec. 12.2 (likelihood weighting), 12.3 (Gibbs), 11.3 (loopy belief propagation).

use rand::Rng;

use super::super::elimination::{Factor, Messages};
use super::super::error::ModelError;
use super::super::gaussian::{Particles, extend, gaussian};
use super::super::linalg::categorical_of_logs;
use super::evidence::{Asked, Evidence, Known, softmax};
use super::{Answer, Cpd, Network};

/// Estimated posterior of one variable, by [`Network::likelihood_weighting`] or [`Network::gibbs`].
///
/// From draws x_i of weights w_i, `P ≈ Σ_i w_i 1[x_i = v] / Σ_i w_i`, with the standard error
/// `√(Σ_i w_i² (1[x_i = v] - P)²) / Σ_i w_i` (Koller and Friedman 2009, Sec. 12.2); by Gibbs sampling (Sec. 12.3) the mean of
/// m = √sweeps batches, with the deviation of their means over √m. Time of a draw or sweep: `O(n)` tables looked at,
/// whatever the width, in a sweep once for each category.
///
/// # Examples
/// ```
/// use edifice_model::network::{Evidence, Network, Variable};
/// use edifice_base::rng::stream;
/// let network = Network::new(vec![
///     Variable::table("rain", &["no", "yes"], &[], &[0.8, 0.2]),
///     Variable::table("wet", &["no", "yes"], &["rain"], &[0.9, 0.1, 0.2, 0.8]),
/// ])?;
/// let given = Evidence::new().is("wet", "yes");
/// let exact = network.marginal(&given, "rain")?[1];
/// let drawn = network.likelihood_weighting(&given, 4000, &mut stream(1, "draws", 0))?;
/// let rain = &drawn[0];
/// assert!(rain.errors[1] < 0.02 && (rain.probabilities[1] - exact).abs() < 5.0 * rain.errors[1]);
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// The variable.
    pub name: String,
    /// Estimates of P(category | evidence), in order of the categories.
    pub probabilities: Vec<f64>,
    /// Their standard errors.
    pub errors: Vec<f64>,
}

/// Result of [`Network::loopy`].
///
/// The message of a factor f to its variable v is `Σ f(x) Π_u Π_g m_(g→u)(x_u)` over the other variables u of f and the other
/// factors g of u; a belief is the product of the messages to a variable (Koller and Friedman 2009, Sec. 11.3). Exact where
/// the factors form a tree, otherwise without a guarantee, converged or not. Time of a round: `O(Σ_f c_f s_f²)` for
/// factors of c_f cells and s_f variables.
///
/// # Examples
/// ```
/// use edifice_model::network::{Evidence, Network, Variable};
/// let network = Network::new(vec![
///     Variable::table("a", &["0", "1"], &[], &[0.7, 0.3]),
///     Variable::table("b", &["0", "1"], &["a"], &[0.9, 0.1, 0.4, 0.6]),
///     Variable::table("c", &["0", "1"], &["b"], &[0.8, 0.2, 0.3, 0.7]),
/// ])?;
/// let given = Evidence::new().is("c", "1");
/// let loopy = network.loopy(&given, 200, 1e-12)?;
/// assert!(loopy.converged && loopy.rounds < 200);
/// let exact = network.marginal(&given, "a")?;
/// assert!((loopy.answers[0].probabilities[1] - exact[1]).abs() < 1e-9);
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Loopy {
    /// Beliefs of every discrete variable.
    pub answers: Vec<Answer>,
    /// Rounds made.
    pub rounds: usize,
    /// True if no message moved by more than the tolerance in the last round.
    pub converged: bool,
}

/// Weighted draws of every discrete variable.
type Draws = Vec<(Vec<usize>, f64)>;

impl Network {
    /// Likelihood weighting: every variable without evidence is drawn given its parents, and a draw weighs as much as the
    /// evidence is likely given it. One estimate for each discrete variable; standard errors by the delta method, but at least
    /// `1 / (n + 2)` for draws that are worth n of equal weight, `n = (Σ w)² / Σ w²`: that of a category that none of them has is not 0.
    ///
    /// # Errors
    /// Evidence that does not fit; [`ModelError::Parameter`] when no draw agrees with the evidence, or `draws` is 0.
    pub fn likelihood_weighting<R: Rng>(
        &self,
        evidence: &Evidence,
        draws: usize,
        rng: &mut R,
    ) -> Result<Vec<Estimate>, ModelError> {
        let known = self.known(evidence)?;
        let mut drawn: Draws = (0..draws).map(|_| self.weighted(&known, rng)).collect();
        let top = drawn.iter().map(|d| d.1).fold(f64::NEG_INFINITY, f64::max);
        if top == f64::NEG_INFINITY {
            let problem = format!("no draw out of {draws} agrees with the evidence");
            return Err(ModelError::parameter("draws", problem));
        }
        for draw in &mut drawn {
            draw.1 = (draw.1 - top).exp();
        }
        let total: f64 = drawn.iter().map(|d| d.1).sum();
        let effective = total.powi(2) / drawn.iter().map(|d| d.1.powi(2)).sum::<f64>();
        let least = 1.0 / (effective + 2.0);
        Ok(self.estimates(|n, v| {
            let hits = |d: &(Vec<usize>, f64)| f64::from(u8::from(d.0[n] == v));
            let p = drawn.iter().map(|d| d.1 * hits(d)).sum::<f64>() / total;
            let spread = drawn.iter().map(|d| (d.1 * (hits(d) - p)).powi(2));
            let error = spread.sum::<f64>().sqrt() / total;
            match known.discrete[n] {
                Some(_) => (p, error),
                None => (p, error.max(least)),
            }
        }))
    }

    /// A draw that agrees with the evidence where it can, and the logarithm of its weight.
    fn weighted<R: Rng>(&self, known: &Known, rng: &mut R) -> (Vec<usize>, f64) {
        let mut assignment = known.assignment();
        let mut real = known.real.clone();
        let mut weight = 0.0;
        for &n in &self.order {
            let node = &self.nodes[n];
            let at = self.configuration(n, &assignment) * self.sizes[n] + assignment[n];
            match &node.cpd {
                Cpd::Linear(states) => {
                    let linear = &states[self.configuration(n, &assignment)];
                    let start = Particles::start();
                    let given = extend(start.get(0), &[], &self.columns(n), linear, &real);
                    let given = given.get(0);
                    weight += given.log_density;
                    let drawn = gaussian(given.mean, given.cov, rng);
                    let open = node.coordinates.clone().filter(|&c| real[c].is_nan());
                    let open: Vec<usize> = open.collect();
                    for (c, v) in open.into_iter().zip(drawn) {
                        real[c] = v;
                    }
                }
                _ if known.discrete[n].is_none() => {
                    self.draw_node(n, &mut assignment, &mut real, rng);
                }
                Cpd::Table(table) => weight += table[at].ln(),
                Cpd::Softmax(weights) => {
                    weight += softmax(weights, &node.regressors, &real, self.sizes[n])[at];
                }
            }
        }
        for (n, logs) in &known.soft {
            weight += logs[assignment[*n]];
        }
        (assignment, weight)
    }

    /// Gibbs sampling: every unobserved discrete variable in turn is drawn given all others, continuous ones integrated out.
    /// The first half as many sweeps again are dropped; standard errors by means of batches.
    ///
    /// # Errors
    /// As [`Network::marginals`], but for width; [`ModelError::Parameter`] for fewer than 100 sweeps, and where
    /// probabilities are 0: the chain may then not reach every state, and its standard errors would not tell.
    pub fn gibbs<R: Rng>(
        &self,
        evidence: &Evidence,
        sweeps: usize,
        rng: &mut R,
    ) -> Result<Vec<Estimate>, ModelError> {
        if sweeps < 100 {
            return Err(ModelError::parameter("sweeps", "must be at least 100"));
        }
        let question = self.question(self.known(evidence)?, Asked::Discrete)?;
        let zero = |f: &&Factor| f.values.contains(&f64::NEG_INFINITY);
        if let Some(factor) = question.factors.iter().find(zero) {
            let name = &self.nodes[factor.vars.last().copied().unwrap_or(0)].name;
            let problem = "has probabilities of 0, between which Gibbs sampling may not move: use likelihood weighting";
            return Err(ModelError::parameter(name, problem));
        }
        let (mut state, _) = self.weighted(&question.known, rng);
        let mut around: Vec<Vec<&Factor>> = vec![Vec::new(); self.nodes.len()];
        for factor in &question.factors {
            factor.vars.iter().for_each(|&v| around[v].push(factor));
        }
        let batches = (sweeps as f64).sqrt() as usize;
        let mut counts: Vec<Vec<Vec<f64>>> = (self.sizes.iter())
            .map(|&k| vec![vec![0.0; k]; batches])
            .collect();
        for sweep in 0..sweeps + sweeps / 2 {
            for n in (0..self.nodes.len()).filter(|&n| !around[n].is_empty()) {
                let mut logs = vec![0.0; self.sizes[n]];
                for (v, log) in logs.iter_mut().enumerate() {
                    state[n] = v;
                    let values = around[n].iter();
                    *log = values.map(|f| f.values[f.index(&state, &self.sizes)]).sum();
                }
                state[n] = categorical_of_logs(&logs, rng);
            }
            if let Some(kept) = sweep.checked_sub(sweeps / 2) {
                let batch = kept * batches / sweeps;
                for (n, &v) in state.iter().enumerate() {
                    counts[n][batch][v] += batches as f64 / sweeps as f64;
                }
            }
        }
        Ok(self.estimates(|n, v| {
            let means = || counts[n].iter().map(|batch| batch[v]);
            let mean = means().sum::<f64>() / batches as f64;
            let spread: f64 = means().map(|m| (m - mean).powi(2)).sum();
            (mean, (spread / (batches * (batches - 1)) as f64).sqrt())
        }))
    }

    /// An estimate for each discrete variable; `of` gives probability and standard error of a category.
    fn estimates(&self, of: impl Fn(usize, usize) -> (f64, f64)) -> Vec<Estimate> {
        let nodes = self
            .nodes
            .iter()
            .enumerate()
            .filter(|(_, n)| n.is_discrete());
        let estimate = |(n, node): (usize, &super::Node)| {
            let (probabilities, errors) = (0..self.sizes[n]).map(|v| of(n, v)).unzip();
            Estimate {
                name: node.name.clone(),
                probabilities,
                errors,
            }
        };
        nodes.map(estimate).collect()
    }

    /// Loopy belief propagation: sum-product messages between factors and variables, in rounds over all factors, each
    /// message the geometric mean of the old and the new one. Exact where the factors form a tree.
    ///
    /// # Errors
    /// As [`Network::marginals`], but for width; impossible evidence is found only where messages become 0.
    pub fn loopy(
        &self,
        evidence: &Evidence,
        rounds: usize,
        tolerance: f64,
    ) -> Result<Loopy, ModelError> {
        let question = self.question(self.known(evidence)?, Asked::Discrete)?;
        let mut messages = Messages::new(&question.factors, &self.sizes);
        let (mut made, mut converged) = (0, false);
        while made < rounds && !converged {
            made += 1;
            converged = messages.round() <= tolerance;
        }
        let mut answers = Vec::new();
        for (n, node) in self
            .nodes
            .iter()
            .enumerate()
            .filter(|(_, n)| n.is_discrete())
        {
            let belief = match question.known.discrete[n] {
                Some(v) => (0..self.sizes[n])
                    .map(|i| f64::from(u8::from(i == v)))
                    .collect(),
                None if messages.is_free(n) => continue,
                None => messages
                    .belief(n)
                    .ok_or_else(|| ModelError::Contradiction {
                        row: None,
                        variable: node.name.clone(),
                    })?,
            };
            answers.push(Answer {
                name: node.name.clone(),
                probabilities: belief,
            });
        }
        Ok(Loopy {
            answers,
            rounds: made,
            converged,
        })
    }
}
