//! Bayesian networks of discrete and continuous variables: stated in a few lines, then asked.
//!
//! A variable is discrete or a real vector, with parents and a conditional distribution
//! ([`Variable`]): a table; a sigmoid or softmax `P(y = k | x) ∝ exp(w_kᵀ (1, x))` for each
//! configuration of discrete parents; or a linear Gaussian `y ~ N(Bᵀ(1, x), Σ)` for each. The joint
//! density is the product. Answers given any evidence (any discrete variables, any coordinates of
//! real ones) are exact: continuous variables are integrated out first, each linked set of them
//! giving one table over its discrete parents; the rest is variable elimination ([`super::elimination`]). What has no
//! evidence on or below it and is not asked for is left out (barren variables), and drawn from its parents.
//!
//! ```
//! use edifice_model::network::{Evidence, Network, Variable};
//! let network = Network::new(vec![
//!     Variable::table("rain", &["no", "yes"], &[], &[0.8, 0.2]),
//!     Variable::table("wet", &["no", "yes"], &["rain"], &[0.9, 0.1, 0.2, 0.8]),
//!     Variable::linear("level", 1, &["rain"], &[(&[1.0], &[0.5]), (&[3.0], &[0.5])]),
//! ])?;
//! let given = Evidence::new().is("wet", "yes").real("level", &[2.5]);
//! let rain = network.marginal(&given, "rain")?;
//! assert!(rain[1] > 0.9);
//! # Ok::<(), edifice_model::ModelError>(())
//! ```
//!
//! # Deviations and readings
//! - A sigmoid or softmax needs its continuous parents observed, unless it is barren for the
//!   question (no evidence on it or its descendants): the integral has no closed form.
//! - The most probable explanations are over the discrete variables, continuous ones integrated.
//! - Cost is exponential in the width of the elimination order; tables over 2²⁶ cells are refused before they are made. A
//!   single posterior then leaves out what is independent of the variable given the evidence, too, so that evidence there
//!   is not checked for contradictions.
//!
//! - Softmax weights are learned with a weak Gaussian prior (precision 0.01 on standardised inputs), since rows that a plane
//!   separates have no largest likelihood.
//!
//! Sources: Koller and Friedman 2009, Ch. 9, 13 and 14; Dechter 1999; Lauritzen 1992.

mod approximate;
mod bif;
mod bif_reader;
mod check;
mod dot;
mod evidence;
mod expect;
mod learn;
mod logistic;
mod query;
mod sample;
mod score;
mod store;
pub mod structure;
mod variable;
#[cfg(feature = "xml")]
mod xmlbif;

use std::collections::{HashMap, HashSet};

use super::error::ModelError;
use super::graph::order;
pub use approximate::{Estimate, Loopy};
use check::check;
pub use evidence::Evidence;
pub use learn::{FitSettings, Fitted};
pub use query::{Answer, Explanation};
pub use store::{FORMAT, OLD_FORMAT, VERSION};
pub(crate) use variable::Cpd;
use variable::Stated;
pub use variable::Variable;

/// A variable of a network, checked.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Node {
    pub name: String,
    /// Categories; empty for a real vector.
    pub categories: Vec<String>,
    /// Coordinates of a real vector: where they are among all coordinates.
    pub coordinates: std::ops::Range<usize>,
    /// All parents, as stated.
    pub parents: Vec<usize>,
    /// Discrete ones among them.
    pub discrete: Vec<usize>,
    /// Coordinates of the continuous ones among them.
    pub regressors: Vec<usize>,
    pub cpd: Cpd,
}

impl Node {
    pub(crate) fn is_discrete(&self) -> bool {
        !self.categories.is_empty()
    }
}

/// A Bayesian network: checked [`Variable`]s without cycles, `p(x) = Π_i p(x_i | parents of i)` (Koller and Friedman 2009, Sec. 3.2).
///
/// Posteriors ([`Answer`]), explanations ([`Explanation`]) and [`Network::sample`] are exact; [`Estimate`] and [`Loopy`] are not;
/// [`Fitted`] is learned. Time of an exact answer: `O(n k^(w+1))` for n variables of at most k categories and an order of
/// elimination of width w, besides one Gaussian for each configuration of the discrete parents of linked real vectors.
/// [The module](self) has an example.
#[derive(Clone, Debug, PartialEq)]
pub struct Network {
    pub(crate) nodes: Vec<Node>,
    /// Numbers of categories; 1 for real vectors.
    pub(crate) sizes: Vec<usize>,
    /// Parents before children.
    pub(crate) order: Vec<usize>,
    /// Number of coordinates of all real vectors.
    pub(crate) width: usize,
}

impl Network {
    /// A network of variables stated in any order.
    ///
    /// # Errors
    /// [`ModelError::Duplicate`], [`ModelError::Unknown`] parent, [`ModelError::Cycle`],
    /// [`ModelError::Kind`] for a table with a continuous parent, [`ModelError::Parameter`] for
    /// numbers that do not fit or probabilities that do not sum to 1, [`ModelError::Singular`].
    pub fn new(variables: Vec<Variable>) -> Result<Self, ModelError> {
        if variables.is_empty() {
            return Err(ModelError::Empty { what: "variables" });
        }
        let names: Vec<String> = variables.iter().map(|v| v.name.clone()).collect();
        let mut places: HashMap<&str, usize> = HashMap::new();
        for (i, v) in variables.iter().enumerate() {
            if places.insert(&v.name, i).is_some() {
                let name = v.name.clone();
                return Err(ModelError::Duplicate { name });
            }
        }
        let mut width = 0_usize;
        let mut coordinates = Vec::new();
        let mut parents = Vec::new();
        for v in &variables {
            let mut seen = HashSet::new();
            if let Some(category) = v.categories.iter().find(|c| !seen.insert(*c)) {
                let name = format!("{}={category}", v.name);
                return Err(ModelError::Duplicate { name });
            }
            if v.categories.is_empty() == (v.dimension == 0) {
                return Err(ModelError::parameter(
                    &v.name,
                    "needs categories or coordinates",
                ));
            }
            let end = width.checked_add(v.dimension).ok_or_else(|| {
                ModelError::parameter(&v.name, "has more coordinates than can be counted")
            })?;
            coordinates.push(width..end);
            width = end;
            let mut seen = HashSet::new();
            if let Some(twice) = v.parents.iter().find(|p| !seen.insert(*p)) {
                let problem = format!("has the parent `{twice}` twice");
                return Err(ModelError::parameter(&v.name, problem));
            }
            let found: Result<Vec<usize>, ModelError> = v
                .parents
                .iter()
                .map(|p| {
                    let at = places.get(p.as_str()).copied();
                    at.ok_or_else(|| ModelError::Unknown { name: p.clone() })
                })
                .collect();
            parents.push(found?);
        }
        let order = order(&parents, &names)?;
        let sizes: Vec<usize> = variables
            .iter()
            .map(|v| v.categories.len().max(1))
            .collect();
        let mut nodes = Vec::new();
        for (i, v) in variables.iter().enumerate() {
            let (discrete, real): (Vec<usize>, Vec<usize>) = parents[i]
                .iter()
                .partition(|&&p| variables[p].dimension == 0);
            let configurations = discrete.iter().try_fold(1, |n, &p| sizes[p].checked_mul(n));
            let inputs = real
                .iter()
                .try_fold(1, |n, &p| coordinates[p].len().checked_add(n));
            let cpd = check(v, configurations, inputs)?;
            let regressors = real.iter().flat_map(|&p| coordinates[p].clone()).collect();
            nodes.push(Node {
                name: v.name.clone(),
                categories: v.categories.clone(),
                coordinates: coordinates[i].clone(),
                parents: parents[i].clone(),
                discrete,
                regressors,
                cpd,
            });
        }
        Ok(Self {
            nodes,
            sizes,
            order,
            width,
        })
    }

    /// Names of the variables, as stated.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.nodes.iter().map(|n| n.name.as_str())
    }

    /// Categories of a discrete variable; none for a real vector.
    ///
    /// # Errors
    /// [`ModelError::Unknown`].
    pub fn categories(&self, name: &str) -> Result<&[String], ModelError> {
        Ok(&self.nodes[self.find(name)?].categories)
    }

    /// True if a real vector is among a variable's ancestors: then its probability has no closed form unless that is known.
    ///
    /// # Errors
    /// [`ModelError::Unknown`].
    pub fn depends_on_numbers(&self, name: &str) -> Result<bool, ModelError> {
        let mut open = self.nodes[self.find(name)?].parents.clone();
        let mut seen = HashSet::new();
        while let Some(n) = open.pop() {
            if !self.nodes[n].is_discrete() {
                return Ok(true);
            }
            if seen.insert(n) {
                open.extend(&self.nodes[n].parents);
            }
        }
        Ok(false)
    }

    /// Names of a variable's parents.
    ///
    /// # Errors
    /// [`ModelError::Unknown`].
    pub fn parents(&self, name: &str) -> Result<Vec<&str>, ModelError> {
        let node = &self.nodes[self.find(name)?];
        Ok(node
            .parents
            .iter()
            .map(|&p| self.nodes[p].name.as_str())
            .collect())
    }

    /// The table of a discrete variable, laid out as in [`Variable::table`].
    ///
    /// # Errors
    /// [`ModelError::Unknown`], [`ModelError::Kind`] when it has no table.
    pub fn probabilities(&self, name: &str) -> Result<&[f64], ModelError> {
        match &self.nodes[self.find(name)?].cpd {
            Cpd::Table(table) => Ok(table),
            _ => Err(ModelError::Kind {
                column: name.to_owned(),
                got: "without a table",
                expected: "discrete with a table",
            }),
        }
    }

    /// The weights of a softmax, laid out as in [`Variable::softmax`].
    ///
    /// # Errors
    /// [`ModelError::Unknown`], [`ModelError::Kind`] when it is no softmax.
    pub fn weights(&self, name: &str) -> Result<&[f64], ModelError> {
        match &self.nodes[self.find(name)?].cpd {
            Cpd::Softmax(weights) => Ok(weights),
            _ => Err(ModelError::Kind {
                column: name.to_owned(),
                got: "without weights",
                expected: "a softmax",
            }),
        }
    }

    /// B and Σ of a real vector for one configuration of its discrete parents, laid out as in
    /// [`Variable::linear`].
    ///
    /// # Errors
    /// [`ModelError::Unknown`], [`ModelError::Kind`] when it is discrete, [`ModelError::Parameter`]
    /// for a configuration out of range.
    pub fn regression(
        &self,
        name: &str,
        configuration: usize,
    ) -> Result<(&[f64], &[f64]), ModelError> {
        match &self.nodes[self.find(name)?].cpd {
            Cpd::Linear(states) => match states.get(configuration) {
                Some(l) => Ok((&l.coefficients, &l.covariance)),
                None => Err(ModelError::parameter(name, "has fewer configurations")),
            },
            _ => Err(ModelError::Kind {
                column: name.to_owned(),
                got: "discrete",
                expected: "a real vector",
            }),
        }
    }

    pub(crate) fn find(&self, name: &str) -> Result<usize, ModelError> {
        self.nodes
            .iter()
            .position(|n| n.name == name)
            .ok_or_else(|| ModelError::Unknown {
                name: name.to_owned(),
            })
    }
}
