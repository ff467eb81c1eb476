//! Procedural logic with every setting of its parameters, on one facade.

use serde::{Deserialize, Serialize};

use super::super::BEST;
use super::super::likeness::likeness;
use super::super::runs::{Question, Solver, mean, solve};
use edifice_base::{Error, Result};
use edifice_facade_grammar::{Method, Operations};
use edifice_grammar::{Costs, evaluate};
use edifice_procedural_logic::{Joining, Parameters, baseline_grammar_joining, search_axes};
use edifice_shape::Facade;

/// The ways in which binary splits become n-ary, with their names in tables; that of Table 2 first.
pub(crate) const JOININGS: [(&str, Joining); 3] = [
    ("procedural_logic", Joining::All),
    ("procedural_logic_used_once", Joining::UsedOnce),
    ("procedural_logic_binary", Joining::Binary),
];

/// Every setting: the values over which Weissenberg et al. search (Eq. 12), with both settings of their text among them.
pub(crate) fn settings() -> Vec<Parameters> {
    let [alphas, parental, horizontal] = search_axes();
    let mut all = Vec::new();
    for &alpha in &alphas {
        for &parental_bias in &parental {
            all.extend(horizontal.iter().map(|&horizontal_bias| Parameters {
                alpha,
                parental_bias,
                horizontal_bias,
                ..Parameters::COMPRESSION
            }));
        }
    }
    all
}

/// The costs of the methods on one facade, splits only.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct Measured {
    /// `costs[joining][setting]`.
    pub costs: [Vec<f64>; 3],
    /// BGL.
    pub bayesian: f64,
    /// This project's ADP.
    pub adp: f64,
    /// True if the grammar of Table 2's column and that of BGL split the same regions.
    pub same_regions: bool,
}

/// Measures one facade.
///
/// # Errors
/// Those of the methods, or of a grammar that does not derive its facade.
pub(crate) fn measure(facade: &Facade, iterations: u64, seed: u64) -> Result<Measured> {
    let one = std::slice::from_ref(facade);
    let question = |method, iterations| Question {
        operations: Operations::split_only(),
        ..Question::new(Solver::Infer(method, iterations), seed)
    };
    let grammar = |parameters: &Parameters, joining| {
        baseline_grammar_joining(facade, parameters, joining).map_err(Error::method)
    };
    let settings = settings();
    let mut costs = [Vec::new(), Vec::new(), Vec::new()];
    for ((_, joining), costs) in JOININGS.into_iter().zip(&mut costs) {
        for parameters in &settings {
            let found = evaluate(&grammar(parameters, joining)?, one, &Costs::default());
            costs.push(found.map_err(Error::method)?.cost);
        }
    }
    let (bayesian_grammar, bayesian) = solve(one, &question(Method::Bayesian, 1))?;
    let (_, adp) = solve(one, &question(BEST, iterations))?;
    let column = grammar(&Parameters::COMPRESSION, Joining::All)?;
    Ok(Measured {
        costs,
        bayesian: bayesian.cost,
        adp: adp.cost,
        same_regions: likeness(&column, &bayesian_grammar)?.f_score == 1.0,
    })
}

/// The number that is picked from the costs of all settings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Pick {
    /// The least over the settings.
    Least,
    /// Their mean.
    Mean,
    /// The most.
    Most,
    /// One setting.
    At(usize),
}

impl Pick {
    /// The number taken.
    pub(crate) fn of(self, costs: &[f64]) -> f64 {
        match self {
            Pick::Least => costs.iter().copied().fold(f64::INFINITY, f64::min),
            Pick::Mean => mean(costs),
            Pick::Most => costs.iter().copied().fold(0.0, f64::max),
            Pick::At(setting) => costs[setting],
        }
    }
}

/// Place of a setting; both settings of Weissenberg et al. are on the axes.
pub(crate) fn place(parameters: &Parameters) -> Result<usize> {
    let at = settings().iter().position(|s| s == parameters);
    at.ok_or_else(|| Error::method("the setting is not on the axes of the search"))
}

/// `alpha, b_p, b_h` as text.
pub(crate) fn text(parameters: &Parameters) -> String {
    format!(
        "{}, {}, {}",
        parameters.alpha, parameters.parental_bias, parameters.horizontal_bias
    )
}
