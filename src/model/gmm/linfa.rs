//! The mixtures behind linfa's traits: [`Parameters`] is a linfa `Fit`, [`Mixture`] a linfa `PredictInplace` (and so a `Predict`).
//! Feature `linfa`.
//!
//! ```
//! use edifice_model::gmm::linfa::{LinfaError, Parameters};
//! use linfa::DatasetBase;
//! use linfa::traits::{Fit, Predict};
//! use ndarray::Array2;
//!
//! let values = Array2::from_shape_fn((40, 1), |(i, _)| if i < 20 { 0.0 } else { 9.0 } + (i % 5) as f64 / 10.0);
//! let mixture = Parameters::new(2).fit(&DatasetBase::from(values.clone()))?;
//! let clusters = mixture.predict(&values);
//! assert_eq!(mixture.components(), 2);
//! assert!((0..40).all(|i| (clusters[i] == clusters[0]) == (i < 20)));
//! # Ok::<(), LinfaError>(())
//! ```
//! Weights of a data set are used. In contrast to `linfa-clustering`, a run that meets its limit of rounds returns its mixture,
//! restarts restart, and covariances may be diagonal or tied.

use linfa::DatasetBase;
use linfa::traits::{Fit, PredictInplace};
use ndarray::{Array1, ArrayBase, Data, Ix2};

use super::super::error::ModelError;
use super::{Criterion, Mixture, Points, Settings, fit, select};
use edifice_base::rng::stream;

/// The number of components, fixed or found by [`select`]; for [`Parameters`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Components {
    /// Exactly this number.
    Exactly(usize),
    /// The number, up to this one, that minimises the criterion.
    AtMost(usize, Criterion),
}

/// The parameters of an algorithm, in linfa's sense.
///
/// Its `Fit` copies the records (N x d) once and then is [`fit`] or [`select`], with the same random streams: equal seeds give
/// equal mixtures. The [module](self) has an example.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameters {
    /// The number of components.
    pub components: Components,
    /// Covariances, restarts, prior, stopping.
    pub settings: Settings,
    /// Seed of all random starts.
    pub seed: u64,
}

impl Parameters {
    /// Exactly `components` components, the default settings, seed 0.
    pub fn new(components: usize) -> Self {
        Self {
            components: Components::Exactly(components),
            settings: Settings::default(),
            seed: 0,
        }
    }
}

/// Why a fit of [`Parameters`] has no result.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LinfaError {
    /// The model layer refuses the data or the settings.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// linfa refuses the data set.
    #[error(transparent)]
    Linfa(#[from] linfa::Error),
}

impl<D: Data<Elem = f64>, T> Fit<ArrayBase<D, Ix2>, T, LinfaError> for Parameters {
    type Object = Mixture;

    fn fit(&self, dataset: &DatasetBase<ArrayBase<D, Ix2>, T>) -> Result<Mixture, LinfaError> {
        let records = dataset.records();
        let values: Vec<f64> = records.iter().copied().collect();
        let weights: Option<Vec<f64>> =
            (dataset.weights()).map(|weights| weights.iter().copied().map(f64::from).collect());
        let mut points = Points::new(records.ncols(), &values)?;
        if let Some(weights) = &weights {
            points = points.weighted(weights)?;
        }
        let fitted = match self.components {
            Components::Exactly(k) => {
                let mut rng = stream(self.seed, "gmm", k as u64);
                fit(&points, k, &self.settings, &mut rng)?
            }
            Components::AtMost(most, criterion) => {
                select(&points, most, criterion, &self.settings, self.seed)?.fitted
            }
        };
        Ok(fitted.mixture)
    }
}

/// The most probable component of every row, the first of equal ones.
///
/// # Panics
/// As linfa's own models: when the rows have another dimension, or the targets another length.
impl<D: Data<Elem = f64>> PredictInplace<ArrayBase<D, Ix2>, Array1<usize>> for Mixture {
    fn predict_inplace(&self, x: &ArrayBase<D, Ix2>, y: &mut Array1<usize>) {
        assert_eq!(x.ncols(), self.dimension(), "dimension of the rows");
        assert_eq!(x.nrows(), y.len(), "number of targets");
        for (row, target) in x.rows().into_iter().zip(y.iter_mut()) {
            let logs = self.log_joint(&row.to_vec());
            let best = |best: usize, k: usize| if logs[k] > logs[best] { k } else { best };
            *target = (1..logs.len()).fold(0, best);
        }
    }

    fn default_target(&self, x: &ArrayBase<D, Ix2>) -> Array1<usize> {
        Array1::zeros(x.nrows())
    }
}
