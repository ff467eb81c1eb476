//! Bayesian networks, learnt again from their own draws.

use rand::{Rng, RngExt};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use edifice_base::rng::stream;
use edifice_base::{Error, Result};
use edifice_io::read_bytes;
use edifice_model::conjugate::Priors;
use edifice_model::network::{Evidence, FitSettings, Network};
use edifice_model::{Cell, Table};
use edifice_sweep::{Better, Given, Outcome, Shared, Study};

/// Settings of learning.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
struct Settings {
    /// Rows drawn to learn from.
    rows: usize,
    /// Share of the cells that are missing, by chance.
    missing: f64,
    /// Variables that are never seen.
    hidden: Vec<String>,
    /// Random starts of EM.
    restarts: usize,
    /// Parameter of the Dirichlet prior of every table, at least 1 (uniform).
    dirichlet: f64,
}

impl Default for Settings {
    fn default() -> Self {
        let fit = FitSettings::default();
        Self {
            rows: 500,
            missing: 0.0,
            hidden: Vec::new(),
            restarts: fit.restarts,
            dirichlet: fit.priors.dirichlet,
        }
    }
}

/// Rows that judge.
const UNSEEN: usize = 1_000;

/// Learning of the parameters of a network.
pub fn study() -> Study {
    const METRICS: &[(&str, Better)] = &[("excess", Better::Lower)];
    let about = "parameters of a discrete Bayesian network (BIF) learnt from its own draws: log-likelihood of unseen rows below the true network's, nats a row";
    Study::new("model/network", about, "model", METRICS, run).made_of(&["edifice-model"], "generic")
}

/// The errors of a setting.
#[derive(Debug, thiserror::Error)]
enum NetworkError {
    #[error("missing is {0}, expected 0 to less than 1")]
    Missing(f64),
    #[error("the file is no text")]
    NotText,
}

fn run(settings: &Settings, given: &Given) -> Result<Outcome> {
    static NETWORKS: Shared<Network> = Shared::new();
    let path = given.path;
    let truth = NETWORKS.get(path.display().to_string(), || {
        let text = String::from_utf8(read_bytes(path)?)
            .map_err(|_| Error::content(path, NetworkError::NotText))?;
        Network::from_bif(&text).map_err(|e| Error::content(path, e))
    })?;
    if !(0.0..1.0).contains(&settings.missing) {
        return Err(Error::method(NetworkError::Missing(settings.missing)));
    }
    let rng = &mut stream(given.seed, "model/network rows", 0);
    let drawn = truth.sample(&Evidence::new(), settings.rows, rng);
    let rows = seen(
        &drawn.map_err(Error::method)?,
        settings,
        settings.missing,
        rng,
    )?;
    let asked = FitSettings {
        priors: Priors {
            dirichlet: settings.dirichlet,
            ..Priors::default()
        },
        restarts: settings.restarts,
        ..FitSettings::default()
    };
    let fitted = truth.fit(
        &rows,
        &asked,
        &mut stream(given.seed, "model/network fit", 0),
    );
    let fitted = fitted.map_err(Error::method)?.network;
    let rng = &mut stream(given.seed, "model/network unseen", 0);
    let drawn = truth.sample(&Evidence::new(), UNSEEN, rng);
    let unseen = seen(&drawn.map_err(Error::method)?, settings, 0.0, rng)?;
    // Both by the one inference engine, on rows that were not learnt from.
    let mean = |network: &Network| -> Result<f64> {
        let logs = network.log_likelihood(&unseen).map_err(Error::method)?;
        Ok(logs.iter().sum::<f64>() / logs.len() as f64)
    };
    let mut found = Outcome::default();
    let excess = mean(&truth)? - mean(&fitted)?;
    found.metrics.insert("excess".into(), excess);
    Ok(found)
}

/// A table without the hidden variables, and with some cells missing.
fn seen<R: Rng>(all: &Table, settings: &Settings, missing: f64, rng: &mut R) -> Result<Table> {
    for name in &settings.hidden {
        all.column(name).map_err(Error::method)?;
    }
    let mut table = Table::new();
    for column in all.columns() {
        let mut cells = Vec::with_capacity(all.rows());
        for row in 0..all.rows() {
            cells.push(match column.cell(row) {
                Cell::Code(code) if rng.random::<f64>() >= missing => Some(code),
                _ => None,
            });
        }
        if settings.hidden.iter().any(|name| name == column.name()) {
            continue;
        }
        let names: Vec<&str> = column
            .categories()
            .into_iter()
            .flatten()
            .map(String::as_str)
            .collect();
        table = table
            .codes(column.name(), &names, cells)
            .map_err(Error::method)?;
    }
    Ok(table)
}
