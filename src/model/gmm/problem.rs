//! Points to fit a mixture to, relative to their mean, and the sums of a round.

use super::super::em::{Fit, Outcome, Stopping};
use super::super::error::ModelError;
use super::mixture::Mixture;
use super::points::Points;
use super::settings::{Covariance, Settings};

/// Result of [`fit`](super::fit).
///
/// The trace has the posterior of the best start only; it never falls. Log densities are of data in their own unit: in
/// another unit c times as fine, `log_likelihood` is `N d log c` less. The example of [`fit_from`](super::fit_from) reads one.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// The mixture of highest log posterior.
    pub mixture: Mixture,
    /// `Σ weight log p(x)`, nats.
    pub log_likelihood: f64,
    /// Log posterior (up to a constant of the prior) before each round and after the last.
    pub trace: Vec<f64>,
    /// Why EM stopped.
    pub outcome: Outcome,
}

/// Points relative to their mean, and what to fit to them.
pub(crate) struct Steps<'a> {
    pub points: &'a Points<'a>,
    pub settings: &'a Settings,
    pub k: usize,
    pub centre: Vec<f64>,
    /// Standard deviation of each coordinate: prior and convergence are in these units.
    pub scale: Vec<f64>,
}

/// Expected sufficient statistics.
pub(crate) struct Moments {
    /// Per component, lower triangle of `Σ r u uᵀ`, u = (1, x - centre), (d + 1)² values; with
    /// diagonal covariances `Σ r`, `Σ r x`, `Σ r x²`, 2d + 1 values.
    pub sums: Vec<Vec<f64>>,
    pub log_likelihood: f64,
}

impl<'a> Steps<'a> {
    pub(super) fn new(
        points: &'a Points<'a>,
        k: usize,
        settings: &'a Settings,
    ) -> Result<Self, ModelError> {
        if k == 0 {
            return Err(ModelError::Empty { what: "components" });
        }
        if points.len() < k {
            return Err(ModelError::TooFewRows {
                rows: points.len(),
                parameters: k,
                variable: "components of the mixture".to_owned(),
            });
        }
        let p = &settings.prior;
        for (name, v) in [
            ("mean", p.mean),
            ("scatter", p.scatter),
            ("freedom", p.freedom),
        ] {
            if !(v > 0.0 && v.is_finite()) {
                return Err(ModelError::parameter(name, "must be positive and finite"));
            }
        }
        let d = points.dimension();
        let mut totals = vec![0.0; d];
        for (i, x) in points.rows().enumerate() {
            for (t, _) in totals.iter_mut().zip(x).filter(|(_, v)| !v.is_nan()) {
                *t += points.weight(i);
            }
        }
        if let Some(i) = totals.iter().position(|t| *t <= 0.0) {
            return Err(ModelError::AllMissing {
                column: i.to_string(),
            });
        }
        let mut centre = vec![0.0; d];
        for (i, x) in points.rows().enumerate() {
            let seen = centre
                .iter_mut()
                .zip(&totals)
                .zip(x)
                .filter(|(_, v)| !v.is_nan());
            for ((c, total), v) in seen {
                *c += points.weight(i) / total * v;
            }
        }
        let scale = scale(points, &centre, &totals);
        // Covariances are squares of these, and the prior is a small share of them.
        let out_of_range = |s: &f64| !(1e-140..=1e140).contains(s);
        if let Some(i) = scale.iter().position(out_of_range) {
            return Err(ModelError::parameter(
                format!("coordinate {i}"),
                format!(
                    "has deviations of {:e}, whose squares are no numbers: another unit is needed",
                    scale[i]
                ),
            ));
        }
        Ok(Self {
            points,
            settings,
            k,
            centre,
            scale,
        })
    }

    /// When EM stops: the gain a row is one of all rows.
    pub(super) fn stopping(&self) -> Stopping {
        let stopping = self.settings.stopping;
        Stopping {
            gain: stopping.gain.max(self.settings.gain * self.points.total()),
            ..stopping
        }
    }

    /// The mixture relative to the centre.
    pub(super) fn centred(&self, mixture: &Mixture) -> Mixture {
        self.moved(mixture, -1.0)
    }

    fn moved(&self, mixture: &Mixture, sign: f64) -> Mixture {
        let mut moved = mixture.clone();
        for mean in moved.means.chunks_mut(moved.d) {
            for (m, c) in mean.iter_mut().zip(&self.centre) {
                *m += sign * c;
            }
        }
        moved
    }

    /// The fit in the points' own origin.
    pub(super) fn result(&self, fit: Fit<Mixture>) -> Fitted {
        Fitted {
            mixture: self.moved(&fit.model, 1.0),
            log_likelihood: fit.log_likelihood,
            trace: fit.trace,
            outcome: fit.outcome,
        }
    }

    pub(super) fn empty(&self) -> Moments {
        let d = self.points.dimension();
        let size = match self.settings.covariance {
            Covariance::Diagonal => 2 * d + 1,
            _ => (d + 1) * (d + 1),
        };
        Moments {
            sums: vec![vec![0.0; size]; self.k],
            log_likelihood: 0.0,
        }
    }
}

/// Standard deviation of each coordinate; where it is constant, its size, so that units never matter, or 1 for 0.
/// `totals` are the weights of each coordinate's observed values.
fn scale(points: &Points, centre: &[f64], totals: &[f64]) -> Vec<f64> {
    // In units of the greatest deviation, so that no square is too large or too small.
    let mut units = vec![0.0_f64; centre.len()];
    for x in points.rows() {
        let seen = units.iter_mut().zip(x).zip(centre);
        for ((unit, v), c) in seen.filter(|((_, v), _)| !v.is_nan()) {
            *unit = unit.max((v - c).abs());
        }
    }
    let mut squares = vec![0.0; centre.len()];
    for (i, x) in points.rows().enumerate() {
        let seen = squares
            .iter_mut()
            .zip(x)
            .zip(centre.iter().zip(&units))
            .filter(|((_, v), (_, unit))| !v.is_nan() && **unit > 0.0);
        for ((s, v), (c, unit)) in seen {
            *s += points.weight(i) * ((v - c) / unit).powi(2);
        }
    }
    let each = squares
        .iter()
        .zip(centre.iter().zip(&units))
        .zip(totals)
        .map(|((square, (c, unit)), total)| {
            let deviation = unit * (square / total).sqrt();
            match deviation > 1e-12 * c.abs() {
                true => deviation,
                false if *c != 0.0 => c.abs(),
                false => 1.0,
            }
        });
    each.collect()
}

/// Adds `weight u uᵀ`, or its diagonal.
pub(super) fn add_row(sums: &mut [f64], u: &[f64], weight: f64, kind: Covariance) {
    let q = u.len();
    match kind {
        Covariance::Diagonal => {
            sums[0] += weight;
            for i in 1..q {
                sums[i] += weight * u[i];
                sums[q - 1 + i] += weight * u[i] * u[i];
            }
        }
        _ => {
            for i in 0..q {
                for j in 0..=i {
                    sums[i * q + j] += weight * u[i] * u[j];
                }
            }
        }
    }
}
