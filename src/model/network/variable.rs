//! Variables as stated, and their distributions once checked.

use super::super::conjugate::Linear;

/// A conditional distribution as stated.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Stated {
    Table(Vec<f64>),
    Softmax(Vec<f64>),
    Linear(Vec<(Vec<f64>, Vec<f64>)>),
    /// To be learned: uniform, or standard normal.
    Open,
}

/// A variable as stated by a user: a name, parents, and a conditional distribution, or none yet where it is to be learned.
///
/// With q configurations of the discrete parents, r categories, d coordinates, and p inputs (1 and the coordinates of the
/// continuous parents): a table is q x r, a softmax q x r x p, a linear Gaussian q pairs of B (p x d) and Σ (d x d, a
/// covariance in squared units of the variable). Formulas: [the module](super); Koller and Friedman 2009, Sec. 5.1 and 5.5.
///
/// # Examples
/// ```
/// use edifice_model::network::{Evidence, Network, Variable};
/// let network = Network::new(vec![
///     Variable::table("kind", &["house", "tower"], &[], &[0.5, 0.5]),
///     Variable::linear("height", 1, &["kind"], &[(&[6.0], &[1.0]), (&[40.0], &[100.0])]),
///     Variable::softmax("lift", &["no", "yes"], &["height"], &[0.0, 0.0, -10.0, 1.0]),
/// ])?;
/// let given = Evidence::new().real("height", &[10.0]);
/// assert!((network.marginal(&given, "lift")?[1] - 0.5).abs() < 1e-12);
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    pub(super) name: String,
    pub(super) categories: Vec<String>,
    pub(super) dimension: usize,
    pub(super) parents: Vec<String>,
    pub(super) stated: Stated,
}

impl Variable {
    pub(super) fn new(
        name: &str,
        categories: &[&str],
        dimension: usize,
        parents: &[&str],
        stated: Stated,
    ) -> Self {
        let own = |list: &[&str]| list.iter().map(|s| (*s).to_owned()).collect();
        Self {
            name: name.to_owned(),
            categories: own(categories),
            dimension,
            parents: own(parents),
            stated,
        }
    }

    /// Discrete, with a table: for each configuration of the (discrete) parents, the first parent
    /// slowest, the probabilities of `categories`.
    pub fn table(name: &str, categories: &[&str], parents: &[&str], table: &[f64]) -> Self {
        Self::new(name, categories, 0, parents, Stated::Table(table.to_vec()))
    }

    /// Discrete, with a softmax of its continuous parents: for each configuration of the discrete
    /// parents and each category, a weight for the constant 1 and for each coordinate of the
    /// continuous parents in order. With two categories, weights 0 for the first: a sigmoid.
    pub fn softmax(name: &str, categories: &[&str], parents: &[&str], weights: &[f64]) -> Self {
        Self::new(
            name,
            categories,
            0,
            parents,
            Stated::Softmax(weights.to_vec()),
        )
    }

    /// A real vector of `dimension` coordinates, linear Gaussian: for each configuration of the
    /// discrete parents, B (row-major: one row for the constant 1 and one for each coordinate of
    /// the continuous parents) and Σ (row-major).
    pub fn linear(
        name: &str,
        dimension: usize,
        parents: &[&str],
        states: &[(&[f64], &[f64])],
    ) -> Self {
        let states = states
            .iter()
            .map(|(b, s)| (b.to_vec(), s.to_vec()))
            .collect();
        Self::new(name, &[], dimension, parents, Stated::Linear(states))
    }

    /// Discrete, with a table to be learned; with continuous parents, a softmax to be learned.
    pub fn discrete(name: &str, categories: &[&str], parents: &[&str]) -> Self {
        Self::new(name, categories, 0, parents, Stated::Open)
    }

    /// A real vector whose linear Gaussians are to be learned.
    pub fn continuous(name: &str, dimension: usize, parents: &[&str]) -> Self {
        Self::new(name, &[], dimension, parents, Stated::Open)
    }
}

/// A conditional distribution, checked.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Cpd {
    /// Probabilities, discrete parents slowest first, own categories fastest.
    Table(Vec<f64>),
    /// Weights: configuration, category, (1, x).
    Softmax(Vec<f64>),
    /// One per configuration of the discrete parents.
    Linear(Vec<Linear>),
}
