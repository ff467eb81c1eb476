//! A network as JSON, and back with every invariant checked.

use super::super::error::ModelError;
use super::{Cpd, Network, Stated, Variable};

/// The value of the key `format`.
pub const FORMAT: &str = "edifice/network";
/// The version written, and the only one read.
pub const VERSION: u64 = 1;
/// The id of files without a version, which mean the same as version 1.
const OLD_FORMAT: &str = "edifice-network-1";

#[derive(serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Stored {
    format: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    version: Option<u64>,
    variables: Vec<StoredVariable>,
}

#[derive(serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct StoredVariable {
    name: String,
    categories: Vec<String>,
    dimension: usize,
    parents: Vec<String>,
    distribution: StoredCpd,
}

#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
enum StoredCpd {
    Table(Vec<f64>),
    Softmax(Vec<f64>),
    /// (B, Σ) per configuration.
    Linear(Vec<(Vec<f64>, Vec<f64>)>),
}

impl Network {
    /// The network as JSON.
    ///
    /// # Errors
    /// [`ModelError::Corrupt`] should a parameter not be finite.
    pub fn to_json(&self) -> Result<String, ModelError> {
        let variables = self.nodes.iter().map(|n| StoredVariable {
            name: n.name.clone(),
            categories: n.categories.clone(),
            dimension: n.coordinates.len(),
            parents: n
                .parents
                .iter()
                .map(|&p| self.nodes[p].name.clone())
                .collect(),
            distribution: match &n.cpd {
                Cpd::Table(t) => StoredCpd::Table(t.clone()),
                Cpd::Softmax(w) => StoredCpd::Softmax(w.clone()),
                Cpd::Linear(states) => StoredCpd::Linear(
                    states
                        .iter()
                        .map(|l| (l.coefficients.clone(), l.covariance.clone()))
                        .collect(),
                ),
            },
        });
        let stored = Stored {
            format: FORMAT.to_owned(),
            version: Some(VERSION),
            variables: variables.collect(),
        };
        serde_json::to_string_pretty(&stored)
            .map_err(|e| ModelError::corrupt("the network", e.to_string()))
    }

    /// A network from its JSON.
    ///
    /// # Errors
    /// [`ModelError::Corrupt`] with the place, and those of [`Network::new`].
    pub fn from_json(text: &str) -> Result<Self, ModelError> {
        let stored: Stored = serde_json::from_str(text).map_err(|e| {
            ModelError::corrupt(
                format!("line {}, column {}", e.line(), e.column()),
                e.to_string(),
            )
        })?;
        match (stored.format.as_str(), stored.version) {
            (FORMAT, Some(VERSION)) | (OLD_FORMAT, None) => {}
            (FORMAT, version) => {
                let found = version.map_or("missing".to_owned(), |v| v.to_string());
                let problem = format!("{found}, expected {VERSION}");
                return Err(ModelError::corrupt("version", problem));
            }
            (other, _) => {
                let problem = format!("`{other}` is not `{FORMAT}`");
                return Err(ModelError::corrupt("format", problem));
            }
        }
        let variables = stored.variables.into_iter().map(|v| Variable {
            name: v.name,
            categories: v.categories,
            dimension: v.dimension,
            parents: v.parents,
            stated: match v.distribution {
                StoredCpd::Table(t) => Stated::Table(t),
                StoredCpd::Softmax(w) => Stated::Softmax(w),
                StoredCpd::Linear(s) => Stated::Linear(s),
            },
        });
        Self::new(variables.collect())
    }
}
