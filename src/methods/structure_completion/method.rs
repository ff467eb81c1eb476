//! The table of methods.

use serde::{Deserialize, Serialize};

use super::annealing;
use super::baselines;
use super::best::modes;
use super::completion::Completion;
use super::model::Model;
use super::partial::PartialLayout;
use super::policy;
use edifice_base::rng::Stream;

/// A way to complete a layout.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Elements by expected F1 from exact draws, symmetry and transfer.
    Best,
    /// The paper's own: policies optimized by a genetic algorithm (Sec. 5).
    Paper,
    /// Simulated annealing on the paper's score (Fig. 14).
    Annealing,
    /// Low-rank completion of the matrix of cells (Fig. 19).
    LowRank,
    /// The observed lattice continued, gaps filled.
    Lattice,
    /// The observed lattice continued outward only.
    LatticeOpen,
    /// Mirror images about the facade's axis.
    Mirror,
    /// The nearest facade of the database.
    Nearest,
}

impl Method {
    /// All methods.
    pub const ALL: [Method; 8] = [
        Method::Best,
        Method::Paper,
        Method::Annealing,
        Method::LowRank,
        Method::Lattice,
        Method::LatticeOpen,
        Method::Mirror,
        Method::Nearest,
    ];

    /// True if it searches for seconds rather than milliseconds.
    pub fn is_slow(self) -> bool {
        matches!(self, Method::Paper | Method::Annealing)
    }

    /// True if it asks more of a model than its examples and the spacing of their lines.
    pub fn is_learnt(self) -> bool {
        matches!(self, Method::Best | Method::Paper | Method::Annealing)
    }

    /// Its name in commands.
    pub fn option(self) -> &'static str {
        match self {
            Method::LowRank => "low-rank",
            Method::LatticeOpen => "lattice-open",
            other => other.name(),
        }
    }

    /// Its name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Method::Best => "best",
            Method::Paper => "paper",
            Method::Annealing => "annealing",
            Method::LowRank => "low_rank",
            Method::Lattice => "lattice",
            Method::LatticeOpen => "lattice_open",
            Method::Mirror => "mirror",
            Method::Nearest => "nearest",
        }
    }

    /// The method that a command names.
    pub fn of_option(option: &str) -> Option<Self> {
        Method::ALL
            .into_iter()
            .find(|method| method.option() == option)
    }
}

/// Completes a layout in up to `count` ways, the best first. Baselines know one.
///
/// Added elements respect the unknown part, the forbidden rectangles and the observed elements.
pub fn complete(
    method: Method,
    partial: &PartialLayout,
    model: &Model,
    count: usize,
    rng: &mut Stream,
) -> Vec<Completion> {
    match method {
        Method::Best => modes::complete(partial, model, count, rng).completions,
        Method::Paper => policy::complete(partial, model, count, rng),
        Method::Annealing => annealing::complete(partial, model, rng),
        Method::LowRank => vec![baselines::low_rank(partial)],
        Method::Lattice => vec![baselines::lattice(partial, true)],
        Method::LatticeOpen => vec![baselines::lattice(partial, false)],
        Method::Mirror => vec![baselines::mirror(partial)],
        Method::Nearest => vec![baselines::nearest(partial, model)],
    }
}
