//! MAP parameters of a network, from data with missing values and hidden variables: from a table
//! to standardised evidence, so that one prior serves all, and back to the columns' own units.

use rand::{Rng, RngExt};

use super::super::conjugate::{Linear, Priors};
use super::super::em::{Fit, Stopping, restarts};
use super::super::error::ModelError;
use super::super::standardize::{Constant, moments};
use super::super::table::Table;
use super::evidence::Known;
use super::expect::Problem;
use super::{Cpd, Network};

/// Settings of [`Network::fit`] and [`Network::fit_from`]; [`Fitted`] has an example with the default ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitSettings {
    /// Priors, on standardised columns.
    pub priors: Priors,
    /// Random starts.
    pub restarts: usize,
    /// When EM stops.
    pub stopping: Stopping,
}

impl Default for FitSettings {
    fn default() -> Self {
        Self {
            priors: Priors::default(),
            restarts: 3,
            stopping: Stopping::default(),
        }
    }
}

/// Result of [`Network::fit`]: parameters at a local maximum of `log p(data | Θ) + log p(Θ)`.
///
/// EM replaces the entries of a table by `(N_jk + α - 1) / Σ_k (N_jk + α - 1)`, `N_jk` the expected number of rows with category k
/// in configuration j and α [`Priors::dirichlet`]; linear Gaussians by the mode of their posterior ([`conjugate`](crate::conjugate));
/// softmax weights by Newton's method (Koller and Friedman 2009, Sec. 19.2). Columns are in their own units; what is missing is
/// summed or integrated out. Time of a round: one exact answer ([`Answer`](super::Answer)) for every row.
///
/// # Examples
/// ```
/// use edifice_model::{Table, network::{FitSettings, Network, Variable}};
/// // Seven times yes, three times no, and three rows that nobody looked at: they do not count.
/// let seen = (0..13).map(|i| (i < 10).then_some(i < 7));
/// let data = Table::new().binary("garage", seen)?;
/// let open = Network::new(vec![Variable::discrete("garage", &["no", "yes"], &[])])?;
/// let settings = FitSettings::default();
/// let fitted = open.fit_from(&data, &settings)?;
/// let alpha = settings.priors.dirichlet;
/// let yes = (7.0 + alpha - 1.0) / (10.0 + 2.0 * (alpha - 1.0));
/// assert!((fitted.network.probabilities("garage")?[1] - yes).abs() < 1e-9);
/// assert!(fitted.trace.windows(2).all(|w| w[1] >= w[0] - 1e-9));
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Fitted {
    /// The network with learned parameters.
    pub network: Network,
    /// `log p(data)`, nats, in the columns' own units.
    pub log_likelihood: f64,
    /// Log posterior on standardised columns, before each round and after the last.
    pub trace: Vec<f64>,
}

/// (mean, deviation) of every coordinate.
type Scales = Vec<(f64, f64)>;

impl Network {
    /// Learns tables, linear Gaussians and softmax weights from `data`, whose columns carry the variables' names
    /// (`name[i]` for the coordinates of a vector); a variable without columns is hidden.
    ///
    /// # Errors
    /// A column that is constant, all missing or of the wrong kind, an unseen category, a row
    /// that the structure makes impossible: each names its column and row.
    pub fn fit<R: Rng>(
        &self,
        data: &Table,
        settings: &FitSettings,
        rng: &mut R,
    ) -> Result<Fitted, ModelError> {
        let (rows, scales) = self.rows(data)?;
        let starts: Vec<Network> = (0..settings.restarts.max(1))
            .map(|_| self.random(&rows, rng))
            .collect();
        self.fitted(starts, &rows, &scales, settings)
    }

    /// As [`Network::fit`], with one run of EM from this network's own parameters.
    ///
    /// # Errors
    /// As [`Network::fit`].
    pub fn fit_from(&self, data: &Table, settings: &FitSettings) -> Result<Fitted, ModelError> {
        let (rows, scales) = self.rows(data)?;
        let mut start = self.clone();
        let inverse: Scales = scales.iter().map(|(m, s)| (-m / s, 1.0 / s)).collect();
        start.rescale(&inverse);
        self.fitted(vec![start], &rows, &scales, settings)
    }

    /// EM from standardised starts on standardised rows, back in the columns' own units.
    fn fitted(
        &self,
        starts: Vec<Network>,
        rows: &[Known],
        scales: &Scales,
        settings: &FitSettings,
    ) -> Result<Fitted, ModelError> {
        settings.priors.check()?;
        let problem = Problem {
            rows,
            priors: &settings.priors,
            start: self,
        };
        let Fit {
            mut model,
            mut log_likelihood,
            trace,
            ..
        } = restarts(&problem, starts, &settings.stopping)?;
        model.rescale(scales);
        for row in rows {
            let seen = row.real.iter().zip(scales).filter(|(v, _)| !v.is_nan());
            log_likelihood -= seen.map(|(_, s)| s.1.ln()).sum::<f64>();
        }
        Ok(Fitted {
            network: model,
            log_likelihood,
            trace,
        })
    }

    /// Rows as standardised evidence, and (mean, deviation) of every coordinate.
    fn rows(&self, data: &Table) -> Result<(Vec<Known>, Scales), ModelError> {
        let mut rows = self.table_rows(data)?;
        let mut scales = vec![(0.0, 1.0); self.width];
        for (n, node) in self.nodes.iter().enumerate() {
            let empty = node.is_discrete() && rows.iter().all(|r| r.discrete[n].is_none());
            if empty && data.column(&node.name).is_ok() {
                return Err(ModelError::AllMissing {
                    column: node.name.clone(),
                });
            }
            for (i, c) in node.coordinates.clone().enumerate() {
                let name = self.column_name(n, i);
                if data.column(&name).is_err() {
                    continue;
                }
                let seen = rows.iter().map(|r| r.real[c]).filter(|v| !v.is_nan());
                let seen: Vec<f64> = seen.collect();
                let (mean, deviation) = moments(&name, &seen, Constant::Refuse)?;
                scales[c] = (mean, deviation);
                for row in &mut rows {
                    row.real[c] = (row.real[c] - mean) / deviation;
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
                Cpd::Softmax(weights) => {
                    let small = |w: &mut f64| *w = 0.1 * (rng.random::<f64>() - 0.5);
                    weights.iter_mut().for_each(small);
                }
            }
        }
        network
    }

    /// From standardised to own units: y' = (y - m_y) / s_y throughout.
    fn rescale(&mut self, scales: &[(f64, f64)]) {
        for node in &mut self.nodes {
            let own: Vec<(f64, f64)> = node.coordinates.clone().map(|c| scales[c]).collect();
            let states = match &mut node.cpd {
                Cpd::Linear(states) => states,
                // w · (x - m) / s + w_0 = (w / s) · x + w_0 - Σ w m / s.
                Cpd::Softmax(weights) => {
                    for weights in weights.chunks_mut(node.regressors.len() + 1) {
                        for (i, &c) in node.regressors.iter().enumerate() {
                            weights[i + 1] /= scales[c].1;
                            weights[0] -= weights[i + 1] * scales[c].0;
                        }
                    }
                    continue;
                }
                Cpd::Table(_) => continue,
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
