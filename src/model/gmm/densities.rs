//! Densities of rows under a mixture, and the probabilities of its components.

use rayon::prelude::*;

use super::super::error::ModelError;
use super::super::linalg::log_sum_exp;
use super::missing::{Marginals, Pattern};
use super::mixture::Mixture;
use super::points::Points;

impl Mixture {
    /// `log (w_k N(x; μ_k, Σ_k))` of every component, missing coordinates (NaN) integrated out.
    pub(crate) fn log_joint(&self, x: &[f64]) -> Vec<f64> {
        if x.iter().any(|v| v.is_nan()) {
            return Marginals::new(self, Pattern::of(x)).log_joint(self, x);
        }
        let d = self.d;
        (0..self.components())
            .map(|k| {
                let (w, mean) = (self.whitening_of(k), self.mean(k));
                let quad: f64 = (0..d)
                    .map(|i| {
                        (0..=i)
                            .map(|j| w[i * d + j] * (x[j] - mean[j]))
                            .sum::<f64>()
                            .powi(2)
                    })
                    .sum();
                self.log_norms[k] - 0.5 * quad
            })
            .collect()
    }

    /// `log p(x)` of every row, nats; of what is observed, where values are missing.
    ///
    /// # Errors
    /// [`ModelError::Parameter`] for points of another dimension.
    pub fn log_density(&self, points: &Points) -> Result<Vec<f64>, ModelError> {
        self.check(points)?;
        let rows: Vec<usize> = (0..points.len()).collect();
        let logs = rows.par_chunks(256).flat_map_iter(|rows| {
            // Rows that follow each other often lack the same coordinates.
            let mut last: Option<Marginals> = None;
            rows.iter().map(move |&i| {
                let x = points.row(i);
                if !points.lacks(i) {
                    return log_sum_exp(&self.log_joint(x));
                }
                let marginals = match last.take() {
                    Some(same) if same.fits(x) => same,
                    _ => Marginals::new(self, Pattern::of(x)),
                };
                log_sum_exp(&last.insert(marginals).log_joint(self, x))
            })
        });
        Ok(logs.collect())
    }

    /// P(k | x) of every row.
    ///
    /// # Errors
    /// [`ModelError::Parameter`] for points of another dimension.
    pub fn posterior(&self, points: &Points) -> Result<Vec<Vec<f64>>, ModelError> {
        self.check(points)?;
        Ok(points
            .rows()
            .map(|x| {
                let logs = self.log_joint(x);
                let total = log_sum_exp(&logs);
                logs.iter().map(|l| (l - total).exp()).collect()
            })
            .collect())
    }

    fn check(&self, points: &Points) -> Result<(), ModelError> {
        if points.dimension() != self.d {
            return Err(ModelError::parameter(
                "points",
                format!("must have {} values", self.d),
            ));
        }
        Ok(())
    }
}
