//! Models of tables (those of Fan and Wonka 2016, Fig. 12), learned from the same rows with the same priors and judged
//! on others.

use std::ops::ControlFlow;

use super::Dataset;
use super::joined::learn_one_group;
use super::kernels::Kernels;
use super::learn::{encode, extended, learn_encoded};
use super::mixture::Baseline;
use crate::ModelError;
use crate::hierarchy::{SearchStep, Settings, Variant, learn};

/// Share of the background in comparisons ([`Settings::background`], of the mixture likewise): with none, a single row of an
/// unforeseen kind decides a mean over hundreds.
pub const BACKGROUND: f64 = 0.002;

/// A model of Fig. 12.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Contender {
    /// The hierarchical model with lateral edges.
    Ours,
    /// The hierarchical model without lateral edges.
    Model1,
    /// The hierarchical model without the second hidden level (Fig. 4b).
    Model2,
    /// A directed model without hidden variables (Fig. 4a).
    Model3,
    /// A Gaussian mixture chosen by MDL.
    Gmm,
    /// The hierarchical model of an encoded table ([`Encoding`](super::encoding::Encoding)), with lateral edges from categories as well: none of the
    /// paper's. At an atom its density is a probability.
    Extended,
    /// The same with all real columns in one group, which share one hidden variable (`one_group`).
    OneGroup,
    /// The same with the groups of real columns as they are given, one each by default (`apart`).
    Apart,
    /// One Gaussian over all columns.
    Gaussian,
    /// A kernel density ([`Kernels`]).
    Kde,
}

impl Contender {
    /// The five of the paper, in the order of Fig. 12.
    pub const ALL: [Contender; 5] = [
        Contender::Ours,
        Contender::Model1,
        Contender::Model2,
        Contender::Model3,
        Contender::Gmm,
    ];

    /// All that there are.
    pub const EVERY: [Contender; 10] = [
        Contender::Ours,
        Contender::Model1,
        Contender::Model2,
        Contender::Model3,
        Contender::Gmm,
        Contender::Extended,
        Contender::OneGroup,
        Contender::Apart,
        Contender::Gaussian,
        Contender::Kde,
    ];

    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Contender::Ours => "ours",
            Contender::Model1 => "model_1",
            Contender::Model2 => "model_2",
            Contender::Model3 => "model_3",
            Contender::Gmm => "gmm",
            Contender::Extended => "extended",
            Contender::OneGroup => "one_group",
            Contender::Apart => "apart",
            Contender::Gaussian => "gaussian",
            Contender::Kde => "kde",
        }
    }

    fn variant(self) -> Option<Variant> {
        match self {
            Contender::Ours | Contender::Extended | Contender::OneGroup | Contender::Apart => {
                Some(Variant::Full)
            }
            Contender::Model1 => Some(Variant::NoLateral),
            Contender::Model2 => Some(Variant::NoSecondLevel),
            Contender::Model3 => Some(Variant::Directed),
            Contender::Gmm | Contender::Gaussian | Contender::Kde => None,
        }
    }
}

/// Negative log-likelihood of each row of `test`, in nats, under a model learned from `train`.
/// `settings.variant` is set by the contender; the mixture shares the prior of the Gaussians and the share of the
/// background.
///
/// # Errors
/// As [`learn`] and [`Baseline::learn`].
pub fn held_out(
    contender: Contender,
    train: &Dataset,
    test: &Dataset,
    settings: &Settings,
    seed: u64,
) -> Result<Vec<f64>, ModelError> {
    if let Contender::Extended | Contender::OneGroup | Contender::Apart = contender {
        let go_on = |_: Option<&SearchStep>| ControlFlow::Continue(());
        let (encoding, model) = match contender {
            Contender::OneGroup => {
                let (encoding, encoded) = encode(train, settings, seed, &go_on)?;
                let (table, groups) = (&encoded.table, &encoded.groups);
                let settings = extended(settings);
                let model = match learn_one_group(table, groups, &settings, seed, &go_on)? {
                    Some((learned, _)) => learned.model,
                    None => learn(table, groups, &settings, seed)?.model,
                };
                (encoding, model)
            }
            Contender::Apart => {
                let (encoding, encoded) = encode(train, settings, seed, &go_on)?;
                let settings = extended(settings);
                let found = learn(&encoded.table, &encoded.groups, &settings, seed)?;
                (encoding, found.model)
            }
            _ => {
                let (encoding, found) = learn_encoded(train, settings, seed, &go_on)?;
                (encoding, found.learned.model)
            }
        };
        let logs = model.log_likelihood(&encoding.encode(&test.table)?)?;
        let slopes = encoding.log_slopes(&test.table);
        return Ok(logs.iter().zip(slopes).map(|(l, s)| -l - s).collect());
    }
    if contender == Contender::Kde {
        let logs = Kernels::learn(&train.table)?.log_likelihood(&test.table)?;
        return Ok(logs.into_iter().map(|log| -log).collect());
    }
    let logs = match contender.variant() {
        Some(variant) => {
            let settings = Settings {
                variant,
                ..settings.clone()
            };
            let learned = learn(&train.table, &train.groups, &settings, seed)?;
            learned.model.log_likelihood(&test.table)?
        }
        None => {
            let most = match contender {
                Contender::Gaussian => 1,
                _ => *settings.styles.end(),
            };
            let prior = &settings.priors.linear;
            let baseline = Baseline::learn(&train.table, prior, most, seed)?;
            baseline.log_likelihood(&test.table, settings.background, seed)?
        }
    };
    Ok(logs.into_iter().map(|log| -log).collect())
}

/// The fit of a learned model to unseen rows.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub struct Judged {
    /// Mean negative log-likelihood of a row, nats.
    pub loss: f64,
    /// Per attribute, mean of `-log p(attribute | all others)`, nats.
    pub attributes: Vec<(String, f64)>,
    /// Lateral edges of the model.
    pub edges: usize,
}

/// As [`held_out`], and where the likelihood is lost; `None` for the mixture, which has no exact
/// marginals of discrete attributes.
///
/// # Errors
/// As [`held_out`].
pub fn judge(
    contender: Contender,
    train: &Dataset,
    test: &Dataset,
    settings: &Settings,
    seed: u64,
) -> Result<Option<Judged>, ModelError> {
    let Some(variant) = contender.variant() else {
        return Ok(None);
    };
    let settings = Settings {
        variant,
        ..settings.clone()
    };
    let model = learn(&train.table, &train.groups, &settings, seed)?.model;
    let mean = |logs: Vec<f64>| logs.iter().sum::<f64>() / logs.len().max(1) as f64;
    let all = mean(model.log_likelihood(&test.table)?);
    let mut attributes = Vec::with_capacity(test.groups.len());
    for group in &test.groups {
        let others = test.without(&group.name)?;
        let rest = mean(model.log_likelihood(&others.table)?);
        attributes.push((group.name.clone(), rest - all));
    }
    Ok(Some(Judged {
        loss: -all,
        attributes,
        edges: model.lateral_edges().len(),
    }))
}

/// Row numbers of split `index`: those to learn from, then the others.
///
/// `share` of `rows` are learned from; the same seed gives the same splits to every model.
pub fn split(rows: usize, share: f64, seed: u64, index: u64) -> (Vec<usize>, Vec<usize>) {
    use rand::seq::SliceRandom;
    let mut order: Vec<usize> = (0..rows).collect();
    order.shuffle(&mut edifice_base::rng::stream(
        seed,
        "building_exteriors/split",
        index,
    ));
    let test = order.split_off(((rows as f64) * share).round() as usize);
    (order, test)
}

/// Mean loss of a model over splits, beside that of a reference on the same splits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summary {
    /// Mean over splits, nats a row.
    pub mean: f64,
    /// Its standard error; NaN for one split.
    pub error: f64,
    /// Mean of the model's loss less the reference's.
    pub difference: f64,
    /// Its standard error, paired; NaN for one split.
    pub difference_error: f64,
}

/// Summarises losses by split (`losses[i]`: of split i) beside those of a reference.
pub fn summary(losses: &[f64], reference: &[f64]) -> Summary {
    let (mean, error) = mean_and_error(losses);
    let differences: Vec<f64> = losses.iter().zip(reference).map(|(a, b)| a - b).collect();
    let (difference, difference_error) = mean_and_error(&differences);
    Summary {
        mean,
        error,
        difference,
        difference_error,
    }
}

fn mean_and_error(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let square: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
    (mean, (square / (n * (n - 1.0))).sqrt())
}
