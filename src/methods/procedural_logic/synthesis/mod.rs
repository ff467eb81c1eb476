//! Virtual facade synthesis (Sec. 4.4): a starting rule with new parameters.
//!
//! The facades that share a starting rule have parameter vectors of one length. Extended by width
//! and height, `v = (W, H, x)`, they satisfy the same linear equations: the sizes of every split sum
//! to the extent of its scope. Mean and principal components of the vectors therefore satisfy them
//! too, and so does every sample `v = mean + sigma sum_k sqrt(lambda_k) z_k u_k`, `z_k ~ N(0, 1)`:
//! it fills the facade by construction. What remains to be ensured is that all sizes are positive.

mod similar;

use nalgebra::{DMatrix, DVector};
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

use crate::model::{Known, Model};
use crate::rules::{Call, Instance, InstanceError};
use similar::Structure;

/// Facades of similar structure that a starting rule of one facade borrows from, at most.
const NEIGHBOURS: usize = 10;

/// A component whose variance is below this share of the largest one is numerical noise.
const NEGLIGIBLE: f64 = 1e-12;

/// Largest multiple of the deviations: beyond any use, and far from what numbers can hold.
const MOST_SIGMA: f64 = 1e6;

/// Draws per facade before the last one is pulled towards the mean.
const DRAWS: usize = 1000;

/// A Gaussian over the parameter vectors of one starting rule.
#[derive(Debug, Clone, PartialEq)]
pub struct Style {
    /// The starting rule.
    pub start: Call,
    /// Number of facades with this starting rule.
    pub examples: usize,
    /// Number of facades with similar starting rules whose proportions were borrowed; 0 where two
    /// facades or more have this one.
    pub similar: usize,
    /// Width, height and parameters, averaged over the facades.
    pub mean: DVector<f64>,
    /// One column per principal component, scaled by its standard deviation.
    pub components: DMatrix<f64>,
    /// Unit of the facades.
    pub unit: String,
}

/// Why a starting rule gives no new facades.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StyleError {
    /// Too few facades in the model to see how the parameters vary.
    #[error("the model has {found} facades to learn from, at least 2 are needed")]
    TooFew {
        /// Number of facades in the model.
        found: usize,
    },
    /// No facade of the model starts with the rule.
    #[error("no facade of the model starts with this rule")]
    NoExample,
    /// A facade's call does not fit the rules.
    #[error(transparent)]
    Instance(#[from] InstanceError),
    /// A facade of the rule has another number of parameters.
    #[error("facade {name} has {found} parameters, the others {expected}")]
    Parameters {
        /// Name of the facade.
        name: String,
        /// Number of parameters of the others.
        expected: usize,
        /// Number of parameters of this facade.
        found: usize,
    },
    /// `sigma` is out of range.
    #[error("sigma is {value}, expected a number from 0 to {MOST_SIGMA}")]
    Sigma {
        /// The value found.
        value: f64,
    },
}

impl Style {
    /// Learns mean and principal components of the facades that start with `start`.
    ///
    /// If that is a single one, the ten facades of most similar structure lend their proportions (their
    /// size, and the share of each part that has a counterpart): mean and components are those of this
    /// facade and of its structure at the proportions of the others.
    ///
    /// Complexity: `O(n^2 p)` for `n` facades and `p` parameters: the components come from the
    /// `n x n` matrix of inner products, of which at most `n - 1` are not zero.
    ///
    /// # Errors
    /// [`StyleError::TooFew`] for a model of fewer than two facades, [`StyleError::NoExample`],
    /// [`StyleError::Parameters`], [`StyleError::Instance`].
    pub fn learn(model: &Model, start: Call) -> Result<Self, StyleError> {
        let is_example = |known: &&Known| known.instance.start == start;
        let examples: Vec<&Known> = model.facades.iter().filter(is_example).collect();
        let first = examples.first().ok_or(StyleError::NoExample)?;
        if model.facades.len() < 2 {
            let found = model.facades.len();
            return Err(StyleError::TooFew { found });
        }
        let borrowed = match examples.len() {
            1 => borrow(model, &first.instance)?,
            _ => Vec::new(),
        };
        let own = examples.iter().map(|known| &known.instance);
        let vectors: Vec<DVector<f64>> = own.chain(&borrowed).map(vector).collect();
        let count = vectors.len();
        let length = vectors[0].len();
        for (known, vector) in examples.iter().zip(&vectors) {
            if vector.len() != length {
                return Err(StyleError::Parameters {
                    name: known.name.clone(),
                    expected: length,
                    found: vector.len(),
                });
            }
        }
        let mean = vectors.iter().sum::<DVector<f64>>() / count as f64;
        let deviations: Vec<DVector<f64>> = vectors.iter().map(|v| v - &mean).collect();
        let centred = DMatrix::from_columns(&deviations) / ((count - 1) as f64).sqrt();
        Ok(Self {
            start,
            examples: examples.len(),
            similar: borrowed.len(),
            mean,
            components: scaled_components(&centred),
            unit: first.unit.clone(),
        })
    }

    /// A new facade: same structure, sizes drawn with `sigma` times the deviations of the examples.
    ///
    /// A draw with a size that is not positive is thrown away; after a thousand of them the last
    /// one is pulled towards the mean, whose sizes are all positive, until it is valid.
    ///
    /// # Errors
    /// [`StyleError::Sigma`].
    pub fn sample<R: Rng>(&self, sigma: f64, rng: &mut R) -> Result<Instance, StyleError> {
        if !(0.0..=MOST_SIGMA).contains(&sigma) {
            return Err(StyleError::Sigma { value: sigma });
        }
        let smallest = 1e-6 * self.mean.min();
        let mut offset = DVector::zeros(self.mean.len());
        for _ in 0..DRAWS {
            let z = DVector::from_fn(self.components.ncols(), |_, _| rng.sample(StandardNormal));
            offset = &self.components * (z * sigma);
            if (&self.mean + &offset).min() >= smallest {
                return Ok(self.instance(&(&self.mean + &offset)));
            }
        }
        let reach = self.mean.iter().zip(&offset).map(|(&mean, &offset)| {
            if mean + offset < smallest {
                (mean - smallest) / -offset
            } else {
                1.0
            }
        });
        let share = reach.fold(1.0, f64::min);
        Ok(self.instance(&(&self.mean + offset * share)))
    }

    fn instance(&self, vector: &DVector<f64>) -> Instance {
        Instance {
            width: vector[0],
            height: vector[1],
            start: self.start,
            parameters: vector.iter().skip(2).copied().collect(),
        }
    }
}

/// The structure of a facade at the proportions of those most similar to it, the nearest first.
fn borrow(model: &Model, own: &Instance) -> Result<Vec<Instance>, InstanceError> {
    let rules = &model.inference.rules;
    let structure = Structure::new(rules, own)?;
    let others = model.facades.iter().map(|known| &known.instance);
    let mut found: Vec<(Instance, f64)> = others
        .filter(|instance| instance.start != own.start)
        .map(|instance| Ok(structure.proportioned(&Structure::new(rules, instance)?)))
        .collect::<Result<_, InstanceError>>()?;
    found.sort_by(|a, b| b.1.total_cmp(&a.1));
    found.truncate(NEIGHBOURS);
    Ok(found.into_iter().map(|(instance, _)| instance).collect())
}

/// `(W, H, x)`.
pub fn vector(instance: &Instance) -> DVector<f64> {
    let sizes = [instance.width, instance.height];
    let all: Vec<f64> = sizes
        .into_iter()
        .chain(instance.parameters.iter().copied())
        .collect();
    DVector::from_vec(all)
}

/// Principal directions of the columns, each scaled by its standard deviation.
///
/// With `X = U S V'`, the directions scaled are `U S = X V`, and `V` diagonalizes `X' X`.
fn scaled_components(centred: &DMatrix<f64>) -> DMatrix<f64> {
    let eigen = (centred.transpose() * centred).symmetric_eigen();
    let largest = eigen.eigenvalues.max();
    let mut order: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    let kept: Vec<DVector<f64>> = order
        .into_iter()
        .filter(|&k| eigen.eigenvalues[k] > NEGLIGIBLE * largest.max(f64::MIN_POSITIVE))
        .map(|k| centred * eigen.eigenvectors.column(k))
        .collect();
    if kept.is_empty() {
        DMatrix::zeros(centred.nrows(), 0)
    } else {
        DMatrix::from_columns(&kept)
    }
}

/// The starting rules with the number of facades of each, most frequent first.
pub fn starting_rules(model: &Model) -> Vec<(Call, usize)> {
    let mut counts = std::collections::BTreeMap::new();
    for known in &model.facades {
        *counts.entry(known.instance.start).or_insert(0) += 1;
    }
    let mut starts: Vec<(Call, usize)> = counts.into_iter().collect();
    starts.sort_by_key(|&(start, count)| (std::cmp::Reverse(count), start));
    starts
}
