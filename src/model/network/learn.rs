//! MAP parameters of a network by EM, from data with missing values and hidden variables.
//!
//! Each row is a question: its posterior over every family (a variable with its parents) gives
//! expected counts, and over every linked set of real vectors expected scatter matrices. Real
//! columns are standardised inside, so that one prior serves all.
//! Weights of a softmax are not learned: they stay as stated.

use rand::{Rng, RngExt};

use super::super::chunks;
use super::super::conjugate::{Linear, LinearPrior, dirichlet_log_density, dirichlet_mode};
use super::super::em::{Em, Fit, Stopping, restarts};
use super::super::error::ModelError;
use super::super::hierarchy::Priors;
use super::super::hierarchy::component::add_scatter;
use super::super::table::{Cell, Table};
use super::evidence::Known;
use super::factor::{Mode, advance};
use super::query::distribution;
use super::{Cpd, Network};

/// Settings of [`Network::learn`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LearnSettings {
    /// Priors, on standardised columns.
    pub priors: Priors,
    /// Random starts.
    pub restarts: usize,
    /// When EM stops.
    pub stopping: Stopping,
}

impl Default for LearnSettings {
    fn default() -> Self {
        Self {
            priors: Priors::default(),
            restarts: 3,
            stopping: Stopping::default(),
        }
    }
}

/// Result of [`Network::learn`].
#[derive(Clone, Debug)]
pub struct Trained {
    /// The network with learned parameters.
    pub network: Network,
    /// `log p(data)`, nats, in the columns' own units.
    pub log_likelihood: f64,
    /// Log posterior on standardised columns, before each round and after the last.
    pub trace: Vec<f64>,
}

/// Expected counts per table, expected scatter per configuration of a real vector.
struct Stats {
    counts: Vec<Vec<f64>>,
    scatter: Vec<Vec<Vec<f64>>>,
    log_likelihood: f64,
}

/// (mean, deviation) of every coordinate.
type Scales = Vec<(f64, f64)>;

struct Problem<'a> {
    rows: &'a [Known],
    priors: &'a Priors,
    start: &'a Network,
}

impl Network {
    /// Learns tables and linear Gaussians from `data`, whose columns carry the variables' names
    /// (`name[i]` for the coordinates of a vector); a variable without columns is hidden.
    ///
    /// # Errors
    /// A column that is constant, all missing or of the wrong kind, an unseen category, a row
    /// that the structure makes impossible: each names its column and row.
    pub fn learn<R: Rng>(
        &self,
        data: &Table,
        settings: &LearnSettings,
        rng: &mut R,
    ) -> Result<Trained, ModelError> {
        settings.priors.check()?;
        let (rows, scales) = self.rows(data)?;
        let problem = Problem {
            rows: &rows,
            priors: &settings.priors,
            start: self,
        };
        let starts: Vec<Network> = (0..settings.restarts.max(1))
            .map(|_| self.random(&rows, rng))
            .collect();
        let Fit {
            mut model,
            mut log_likelihood,
            trace,
            ..
        } = restarts(&problem, starts, &settings.stopping)?;
        model.rescale(&scales);
        for row in &rows {
            let seen = row.real.iter().zip(&scales).filter(|(v, _)| !v.is_nan());
            log_likelihood -= seen.map(|(_, s)| s.1.ln()).sum::<f64>();
        }
        Ok(Trained {
            network: model,
            log_likelihood,
            trace,
        })
    }

    /// Rows as standardised evidence, and (mean, deviation) of every coordinate.
    fn rows(&self, data: &Table) -> Result<(Vec<Known>, Scales), ModelError> {
        if data.rows() == 0 {
            return Err(ModelError::Empty { what: "rows" });
        }
        let empty = Known {
            discrete: vec![None; self.nodes.len()],
            real: vec![f64::NAN; self.width],
        };
        let mut rows = vec![empty; data.rows()];
        let mut scales = vec![(0.0, 1.0); self.width];
        for (n, node) in self.nodes.iter().enumerate() {
            if node.is_discrete() {
                let Ok(column) = data.column(&node.name) else {
                    continue;
                };
                for (i, row) in rows.iter_mut().enumerate() {
                    row.discrete[n] = match (column.cell(i), column.categories()) {
                        (Cell::Code(c), Some(names)) => {
                            let found = node.categories.iter().position(|k| *k == names[c]);
                            Some(found.ok_or_else(|| ModelError::UnseenCategory {
                                column: node.name.clone(),
                                row: i,
                                category: names[c].clone(),
                            })?)
                        }
                        (Cell::Missing, Some(_)) => None,
                        _ => return Err(kind(&node.name, "real", "categorical")),
                    };
                }
                if rows.iter().all(|r| r.discrete[n].is_none()) {
                    return Err(ModelError::AllMissing {
                        column: node.name.clone(),
                    });
                }
            }
            for (i, c) in node.coordinates.clone().enumerate() {
                let name = self.column_name(n, i);
                let Ok(column) = data.column(&name) else {
                    continue;
                };
                if column.categories().is_some() {
                    return Err(kind(&name, "categorical", "real"));
                }
                let seen: Vec<f64> = (0..data.rows())
                    .filter_map(|r| match column.cell(r) {
                        Cell::Real(v) => Some(v),
                        _ => None,
                    })
                    .collect();
                if seen.is_empty() {
                    return Err(ModelError::AllMissing { column: name });
                }
                let mean = seen.iter().sum::<f64>() / seen.len() as f64;
                let spread = seen.iter().map(|v| (v - mean).abs()).fold(0.0, f64::max);
                if spread <= 1e-12 * mean.abs() || spread < f64::MIN_POSITIVE {
                    return Err(ModelError::Constant {
                        column: name,
                        value: seen[0].to_string(),
                    });
                }
                let variance = seen
                    .iter()
                    .map(|v| ((v - mean) / spread).powi(2))
                    .sum::<f64>();
                scales[c] = (mean, spread * (variance / seen.len() as f64).sqrt());
                for (r, row) in rows.iter_mut().enumerate() {
                    if let Cell::Real(v) = column.cell(r) {
                        row.real[c] = (v - mean) / scales[c].1;
                    }
                }
            }
        }
        Ok((rows, scales))
    }

    /// A random start: tables near uniform, means at values of random rows.
    fn random<R: Rng>(&self, rows: &[Known], rng: &mut R) -> Self {
        let mut network = self.clone();
        for (n, node) in network.nodes.iter_mut().enumerate() {
            match &mut node.cpd {
                Cpd::Table(table) => {
                    for row in table.chunks_mut(self.sizes[n]) {
                        row.iter_mut().for_each(|p| *p = 0.5 + rng.random::<f64>());
                        let sum: f64 = row.iter().sum();
                        row.iter_mut().for_each(|p| *p /= sum);
                    }
                }
                Cpd::Linear(states) => {
                    for state in states {
                        let (p, d) = (state.p, state.d);
                        let row = &rows[rng.random_range(0..rows.len())];
                        let mut b = vec![0.0; p * d];
                        for (b, c) in b.iter_mut().zip(node.coordinates.clone()) {
                            *b = if row.real[c].is_nan() {
                                rng.random::<f64>()
                            } else {
                                row.real[c]
                            };
                        }
                        let unit = (0..d * d).map(|i| f64::from(u8::from(i % (d + 1) == 0)));
                        if let Some(linear) = Linear::new(p, d, b, unit.collect()) {
                            *state = linear;
                        }
                    }
                }
                Cpd::Softmax(_) => {}
            }
        }
        network
    }

    /// From standardised to own units: y' = (y - m_y) / s_y throughout.
    fn rescale(&mut self, scales: &[(f64, f64)]) {
        for node in &mut self.nodes {
            let own: Vec<(f64, f64)> = node.coordinates.clone().map(|c| scales[c]).collect();
            let Cpd::Linear(states) = &mut node.cpd else {
                continue;
            };
            for state in states {
                let (p, d) = (state.p, state.d);
                let mut b = state.coefficients.clone();
                let mut covariance = state.covariance.clone();
                for (j, (mean, scale)) in own.iter().enumerate() {
                    b[j] = mean + scale * b[j];
                    for (i, &c) in node.regressors.iter().enumerate() {
                        let slope = scale * b[(i + 1) * d + j] / scales[c].1;
                        b[(i + 1) * d + j] = slope;
                        b[j] -= slope * scales[c].0;
                    }
                    for k in 0..d {
                        covariance[j * d + k] *= scale * own[k].1;
                    }
                }
                if let Some(linear) = Linear::new(p, d, b, covariance) {
                    *state = linear;
                }
            }
        }
    }
}

fn kind(column: &str, got: &'static str, expected: &'static str) -> ModelError {
    ModelError::Kind {
        column: column.to_owned(),
        got,
        expected,
    }
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
            log_likelihood: 0.0,
        }
    }

    fn row(&self, network: &Network, i: usize, stats: &mut Stats) -> Result<(), ModelError> {
        let at_row = |e| match e {
            ModelError::Contradiction { variable, .. } => {
                ModelError::Contradiction { row: i, variable }
            }
            e => e,
        };
        let question = network.question(self.rows[i].clone())?;
        let tree = network.tree(&question, Mode::Sum).map_err(at_row)?;
        let beliefs = tree.beliefs();
        let sizes = &network.sizes;
        let spread = |vars: &[usize]| -> Vec<f64> {
            if vars.is_empty() {
                return vec![1.0];
            }
            let found = beliefs
                .iter()
                .find(|b| vars.iter().all(|v| b.vars.contains(v)));
            found.map_or_else(Vec::new, |b| distribution(&b.onto(vars, sizes, Mode::Sum)))
        };
        let fixed: Vec<usize> = question
            .known
            .discrete
            .iter()
            .map(|v| v.unwrap_or(0))
            .collect();
        for (n, counts) in stats
            .counts
            .iter_mut()
            .enumerate()
            .filter(|(_, c)| !c.is_empty())
        {
            let family = network.nodes[n].discrete.iter().copied().chain([n]);
            let vars: Vec<usize> = family
                .filter(|&v| question.known.discrete[v].is_none())
                .collect();
            let mut assignment = fixed.clone();
            for w in spread(&vars) {
                let index = network.configuration(n, &assignment) * sizes[n] + assignment[n];
                counts[index] += w;
                advance(&vars, sizes, &mut assignment);
            }
        }
        for linked in &question.linked {
            let mut assignment = fixed.clone();
            for (particle, w) in linked.particles.iter().zip(spread(&linked.vars)) {
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
                Cpd::Softmax(_) => {}
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
                Cpd::Softmax(_) => 0.0,
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
                (Cpd::Table(a), Cpd::Table(b)) => far(a, b),
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
