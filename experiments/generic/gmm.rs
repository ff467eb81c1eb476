//! Gaussian mixtures, on tables of numbers.

use std::collections::BTreeMap;
use std::num::NonZeroUsize;
use std::path::Path;

use nalgebra::{Cholesky, DMatrix, DVector};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::density::{self, Question, Truth};
use edifice_base::rng::stream;
use edifice_base::{Error, Result, Watched};
use edifice_model::gmm::{self, Criterion, Mixture, Points, select};
use edifice_sweep::trial::{Answered, Posed, Trial};
use edifice_sweep::{Better, Given, Study};

/// The criterion that the number of components minimizes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum CriterionName {
    Mdl,
    Bic,
}

/// Shape of the covariances.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum Covariance {
    Full,
    Diagonal,
    Tied,
}

/// Settings of the mixture.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
struct Settings {
    /// Criterion that the number of components minimizes.
    criterion: CriterionName,
    /// Shape of the covariances: full, diagonal, or one for all components.
    covariance: Covariance,
    /// Most components, at least 1.
    most: NonZeroUsize,
    /// k-means++ starts.
    restarts: usize,
    /// Share of the rows that is learnt from; the others judge.
    share: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            criterion: CriterionName::Mdl,
            covariance: Covariance::Full,
            most: const { NonZeroUsize::new(8).unwrap() },
            restarts: gmm::Settings::default().restarts,
            share: 0.8,
        }
    }
}

/// Gaussian mixtures.
pub fn study() -> Study {
    const METRICS: &[(&str, Better)] = &[("nll", Better::Lower), ("components", Better::Lower)];
    let about = "Gaussian mixtures on a CSV table of numbers: negative log-likelihood of unseen rows; seeds split the rows";
    Study::trial::<Density>("model/gmm", about, "model", METRICS)
        .made_of(&["edifice-model", "edifice-io"], "generic")
        .asking(&["share"])
}

/// The errors of a setting or a mixture.
#[derive(Debug, thiserror::Error)]
enum GmmError {
    #[error("share is {0}, expected a number between 0 and 1 that leaves rows on both sides")]
    Share(f64),
    #[error("a covariance of the mixture is not positive definite")]
    Singular,
}

/// Densities of tables of numbers.
struct Density;

impl Trial for Density {
    type Settings = Settings;
    type Question = Question;
    type Truth = Truth;
    /// Log densities, nats.
    type Answer = Vec<f64>;

    const OUTPUT: &'static str = "answer.csv";
    const CLAIMS: &'static [&'static str] = &["components"];

    fn prepare(settings: &Settings, given: &Given) -> Result<(Question, Truth)> {
        use rand::seq::SliceRandom;
        let (header, rows) = density::read(given.path)?;
        let mut order: Vec<usize> = (0..rows.len()).collect();
        order.shuffle(&mut stream(given.seed, "model/gmm split", 0));
        let kept = (settings.share * rows.len() as f64).round() as usize;
        if kept == 0 || kept >= rows.len() {
            return Err(Error::method(GmmError::Share(settings.share)));
        }
        let (train, test) = order.split_at(kept);
        let train = train.iter().map(|&i| rows[i].clone()).collect();
        let unseen: Vec<Vec<f64>> = test.iter().map(|&i| rows[i].clone()).collect();
        Ok(density::question(header, train, &unseen, given.seed))
    }

    fn candidate(
        settings: &Settings,
        question: &Question,
        seed: u64,
        _: &Watched,
    ) -> Result<Answered<Vec<f64>>> {
        let d = question.header.len();
        let values: Vec<f64> = question.train.iter().flatten().copied().collect();
        let points = Points::new(d, &values).map_err(Error::method)?;
        let asked = gmm::Settings {
            covariance: match settings.covariance {
                Covariance::Full => gmm::Covariance::Full,
                Covariance::Diagonal => gmm::Covariance::Diagonal,
                Covariance::Tied => gmm::Covariance::Tied,
            },
            restarts: settings.restarts,
            ..gmm::Settings::default()
        };
        let criterion = match settings.criterion {
            CriterionName::Mdl => Criterion::Mdl,
            CriterionName::Bic => Criterion::Bic,
        };
        let selected = select(&points, settings.most.get(), criterion, &asked, seed);
        let mixture = selected.map_err(Error::method)?.fitted.mixture;
        let logs = log_densities(&mixture, &question.asked);
        let logs = logs.ok_or_else(|| Error::method(GmmError::Singular))?;
        Ok(Answered {
            claims: BTreeMap::from([("components".to_owned(), mixture.components() as f64)]),
            ..Answered::plain(logs)
        })
    }

    fn judge(
        _: &Settings,
        _: &Question,
        truth: &Truth,
        logs: &Vec<f64>,
    ) -> Result<BTreeMap<String, f64>> {
        let nll = density::judge(truth, logs).map_err(Error::method)?;
        Ok(BTreeMap::from([("nll".to_owned(), nll)]))
    }

    fn pose(question: &Question, folder: &Path) -> Result<Posed> {
        let (input, learn) = (folder.join("rows.csv"), folder.join("learn.csv"));
        for (rows, path) in [(&question.asked, &input), (&question.train, &learn)] {
            density::write(&question.header, rows.iter().map(Vec::as_slice), path)?;
        }
        let learn = Some(learn);
        Ok(Posed { input, learn })
    }

    fn posed(posed: &Posed) -> Result<Question> {
        let (header, asked) = density::read(&posed.input)?;
        let train = match &posed.learn {
            Some(path) => density::read(path)?.1,
            None => Vec::new(),
        };
        Ok(Question {
            header,
            train,
            asked,
        })
    }

    fn write(_: &Question, logs: &Vec<f64>, path: &Path) -> Result<()> {
        let rows = logs.iter().map(std::slice::from_ref);
        density::write(&["log_density".to_owned()], rows, path)
    }

    fn read(question: &Question, path: &Path) -> Result<Vec<f64>> {
        density::read_answer(path, question.asked.len())
    }
}

/// Log densities of rows, nats: written out again here, so that the mixture does not judge itself.
fn log_densities(mixture: &Mixture, rows: &[Vec<f64>]) -> Option<Vec<f64>> {
    let d = mixture.dimension();
    let parts: Vec<(f64, DVector<f64>, Cholesky<f64, nalgebra::Dyn>)> = (0..mixture.components())
        .map(|k| {
            let covariance = DMatrix::from_row_slice(d, d, mixture.covariance(k));
            let mean = DVector::from_row_slice(mixture.mean(k));
            Some((mixture.weights()[k], mean, covariance.cholesky()?))
        })
        .collect::<Option<_>>()?;
    let log_density = |row: &Vec<f64>| {
        let logs = parts.iter().map(|(weight, mean, cholesky)| {
            let centred = DVector::from_row_slice(row) - mean;
            let distance = centred.dot(&cholesky.solve(&centred));
            let log_det = 2.0 * cholesky.l().diagonal().map(f64::ln).sum();
            weight.ln() - 0.5 * (d as f64 * std::f64::consts::TAU.ln() + log_det + distance)
        });
        let logs: Vec<f64> = logs.collect();
        let top = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        top + logs.iter().map(|log| (log - top).exp()).sum::<f64>().ln()
    };
    Some(rows.iter().map(log_density).collect())
}
