//! EM for a network.
//!
//! Each row is a question: its posterior over every family (a variable with its parents) gives
//! expected counts, and over every linked set of real vectors expected scatter matrices. What is barren in a row (nothing
//! is observed on or below it) is no part of the row's complete data: it says nothing about the parameters, and counting its
//! expectation would only shorten the steps towards the same maximum.

use super::super::chunks;
use super::super::conjugate::{LinearPrior, Priors, dirichlet_log_density, dirichlet_mode};
use super::super::elimination::{Mode, advance};
use super::super::em::Em;
use super::super::error::ModelError;
use super::super::gaussian::add_scatter;
use super::evidence::{Asked, Known};
use super::logistic::{self, Case};
use super::{Cpd, Network};

/// Expected counts per table, expected scatter per configuration of a real vector, cases per configuration of a softmax.
pub(super) struct Stats {
    counts: Vec<Vec<f64>>,
    scatter: Vec<Vec<Vec<f64>>>,
    cases: Vec<Vec<Vec<Case>>>,
    log_likelihood: f64,
}

/// Evidence of every row, and the network whose parameters are sought.
pub(super) struct Problem<'a> {
    pub rows: &'a [Known],
    pub priors: &'a Priors,
    pub start: &'a Network,
}

impl Problem<'_> {
    fn empty(&self) -> Stats {
        let nodes = &self.start.nodes;
        Stats {
            counts: nodes
                .iter()
                .map(|n| match &n.cpd {
                    Cpd::Table(t) => vec![0.0; t.len()],
                    _ => Vec::new(),
                })
                .collect(),
            scatter: nodes
                .iter()
                .map(|n| match &n.cpd {
                    Cpd::Linear(s) => s.iter().map(|l| vec![0.0; (l.p + l.d).pow(2)]).collect(),
                    _ => Vec::new(),
                })
                .collect(),
            cases: (0..nodes.len())
                .map(|n| vec![Vec::new(); self.configurations(n)])
                .collect(),
            log_likelihood: 0.0,
        }
    }

    /// Configurations of the discrete parents of a softmax; 0 for other nodes.
    fn configurations(&self, n: usize) -> usize {
        let node = &self.start.nodes[n];
        match &node.cpd {
            Cpd::Softmax(weights) => {
                weights.len() / (self.start.sizes[n] * (node.regressors.len() + 1))
            }
            _ => 0,
        }
    }

    fn row(&self, network: &Network, i: usize, stats: &mut Stats) -> Result<(), ModelError> {
        let question = network.question(self.rows[i].clone(), Asked::Evidence)?;
        let tree = network
            .tree(&question, Mode::Sum)
            .map_err(|e| e.in_row(i))?;
        let beliefs = tree.beliefs();
        let sizes = &network.sizes;
        let fixed = question.known.assignment();
        let mut barren = vec![false; network.nodes.len()];
        question.left_out.iter().for_each(|&n| barren[n] = true);
        for (n, counts) in stats
            .counts
            .iter_mut()
            .enumerate()
            .filter(|(n, c)| !c.is_empty() && !barren[*n])
        {
            let family = network.nodes[n].discrete.iter().copied().chain([n]);
            let vars: Vec<usize> = family
                .filter(|&v| question.known.discrete[v].is_none())
                .collect();
            let mut assignment = fixed.clone();
            for w in beliefs.of(&vars) {
                let index = network.configuration(n, &assignment) * sizes[n] + assignment[n];
                counts[index] += w;
                advance(&vars, sizes, &mut assignment);
            }
        }
        for (n, cases) in stats.cases.iter_mut().enumerate() {
            if cases.is_empty() || barren[n] {
                continue;
            }
            let node = &network.nodes[n];
            let real = node.regressors.iter().map(|&c| question.known.real[c]);
            let inputs: Vec<f64> = std::iter::once(1.0).chain(real).collect();
            let mut shares = vec![vec![0.0; sizes[n]]; cases.len()];
            let family = node.discrete.iter().copied().chain([n]);
            let vars: Vec<usize> = family
                .filter(|&v| question.known.discrete[v].is_none())
                .collect();
            let mut assignment = fixed.clone();
            for w in beliefs.of(&vars) {
                shares[network.configuration(n, &assignment)][assignment[n]] += w;
                advance(&vars, sizes, &mut assignment);
            }
            for (cases, shares) in cases.iter_mut().zip(shares) {
                if shares.iter().any(|r| *r > 0.0) {
                    let inputs = inputs.clone();
                    cases.push(Case { inputs, shares });
                }
            }
        }
        for linked in &question.linked {
            let mut assignment = fixed.clone();
            for (particle, w) in linked.particles.iter().zip(beliefs.of(&linked.vars)) {
                for &n in &linked.nodes {
                    let state = network.configuration(n, &assignment);
                    let (columns, scatter) = (network.columns(n), &mut stats.scatter[n][state]);
                    add_scatter(
                        particle,
                        &linked.missing,
                        &columns,
                        &question.known.real,
                        w,
                        scatter,
                    );
                }
                advance(&linked.vars, sizes, &mut assignment);
            }
        }
        stats.log_likelihood += tree.total;
        Ok(())
    }
}

impl Em for Problem<'_> {
    type Model = Network;
    type Stats = Stats;

    fn expect(&self, network: &Network) -> Result<(Stats, f64), ModelError> {
        let stats = chunks::fold(
            self.rows.len(),
            256,
            |range| {
                let mut stats = self.empty();
                for i in range {
                    self.row(network, i, &mut stats)?;
                }
                Ok(stats)
            },
            |total: &mut Stats, part| {
                let counts = total.counts.iter_mut().flatten();
                counts
                    .zip(part.counts.iter().flatten())
                    .for_each(|(a, b)| *a += b);
                let scatter = total.scatter.iter_mut().flatten().flatten();
                scatter
                    .zip(part.scatter.iter().flatten().flatten())
                    .for_each(|(a, b)| *a += b);
                let cases = total.cases.iter_mut().flatten();
                cases
                    .zip(part.cases.into_iter().flatten())
                    .for_each(|(a, b)| a.extend(b));
                total.log_likelihood += part.log_likelihood;
            },
        )?;
        let log_likelihood = stats.log_likelihood;
        Ok((stats, log_likelihood))
    }

    fn maximize(&self, stats: &Stats) -> Result<Network, ModelError> {
        let mut network = self.start.clone();
        for (n, node) in network.nodes.iter_mut().enumerate() {
            match &mut node.cpd {
                Cpd::Table(table) => {
                    let counts = stats.counts[n].chunks(self.start.sizes[n]);
                    *table = counts
                        .flat_map(|c| dirichlet_mode(c, self.priors.dirichlet))
                        .collect();
                }
                Cpd::Linear(states) => {
                    let prior: &LinearPrior = &self.priors.linear;
                    for (state, scatter) in states.iter_mut().zip(&stats.scatter[n]) {
                        *state = prior.mode(scatter, state.p, state.d).ok_or_else(|| {
                            ModelError::Singular {
                                variable: node.name.clone(),
                            }
                        })?;
                    }
                }
                Cpd::Softmax(weights) => {
                    let size = weights.len() / stats.cases[n].len();
                    for (weights, cases) in weights.chunks_mut(size).zip(&stats.cases[n]) {
                        // The objective is concave: it does not matter where the start is.
                        weights.copy_from_slice(&logistic::fit(&vec![0.0; size], cases));
                    }
                }
            }
        }
        Ok(network)
    }

    fn log_prior(&self, network: &Network) -> f64 {
        let nodes = network.nodes.iter().zip(&network.sizes);
        nodes
            .map(|(node, &k)| match &node.cpd {
                Cpd::Table(table) => table
                    .chunks(k)
                    .map(|row| dirichlet_log_density(row, self.priors.dirichlet))
                    .sum::<f64>(),
                Cpd::Linear(states) => states
                    .iter()
                    .map(|l| self.priors.linear.log_density(l))
                    .sum(),
                Cpd::Softmax(weights) => logistic::log_prior(weights),
            })
            .sum()
    }

    fn movement(&self, before: &Network, after: &Network) -> f64 {
        let far = |a: &[f64], b: &[f64]| {
            a.iter()
                .zip(b)
                .map(|(x, y)| (x - y).abs())
                .fold(0.0, f64::max)
        };
        before
            .nodes
            .iter()
            .zip(&after.nodes)
            .map(|(a, b)| match (&a.cpd, &b.cpd) {
                (Cpd::Table(a), Cpd::Table(b)) | (Cpd::Softmax(a), Cpd::Softmax(b)) => far(a, b),
                (Cpd::Linear(a), Cpd::Linear(b)) => a
                    .iter()
                    .zip(b)
                    .map(|(a, b)| {
                        far(&a.coefficients, &b.coefficients).max(far(&a.covariance, &b.covariance))
                    })
                    .fold(0.0, f64::max),
                _ => 0.0,
            })
            .fold(0.0, f64::max)
    }
}
