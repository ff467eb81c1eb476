//! Discrete variables under factors with local features: Gibbs sampling, and exact sums by elimination.

use super::super::elimination::{self, BucketTree, Mode};
use super::super::error::ModelError;
use super::super::linalg::categorical_of_logs;
use super::{Chain, dot};
use edifice_base::rng::Stream;

/// A feature of the values of a few variables.
pub type Feature = Box<dyn Fn(&[usize]) -> f64 + Send + Sync>;

/// A factor: a feature of a few discrete variables, with the weight it shares.
///
/// It adds `w[weight] feature(values)` to the log of `p(x; w)`; factors with the same weight are of one kind. The feature of
/// a factor of at most 2^12 configurations is evaluated once for each, by [`Gibbs::new`], and otherwise at every move.
/// [`Gibbs`] has an example.
pub struct Factor {
    /// The variables it looks at.
    pub variables: Vec<usize>,
    /// Index of its weight.
    pub weight: usize,
    /// Its value for the variables' values, in that order; finite.
    pub feature: Feature,
}

/// Discrete variables under factors: Gibbs sampling, one sweep a move.
///
/// `p(x; w) ∝ exp(Σ_i w[weight_i] f_i(x))` over x of n values, variable v from 0 to `sizes[v] - 1`. A sweep draws each variable
/// given all others: `O(Σ_v sizes[v] (factors around v))`. [`Gibbs::exact`] is exponential in the width of the elimination order
/// instead, and feasible for trees and narrow graphs. Sources: Geman and Geman 1984; Koller and Friedman 2009, Sec. 9.3 and 12.3.
///
/// # Examples
/// A chain of three bits with weight `log 3` for equal neighbours: `Z = 2 (1 + 3)^2`.
/// ```
/// use edifice_model::factor_graph::{Factor, Gibbs, sample};
/// use edifice_base::rng::stream;
/// let equal = |a, b| Factor {
///     variables: vec![a, b],
///     weight: 0,
///     feature: Box::new(|x| f64::from(u8::from(x[0] == x[1]))),
/// };
/// let gibbs = Gibbs::new(vec![2; 3], vec![equal(0, 1), equal(1, 2)])?;
/// let weights = [3.0_f64.ln()];
/// let (log_z, mean) = gibbs.exact(&weights)?;
/// assert!((log_z - 32.0_f64.ln()).abs() < 1e-12 && (mean[0] - 1.5).abs() < 1e-12);
/// let draws = sample(&gibbs, &vec![0; 3], &weights, 20_000, 2, &mut stream(1, "bits", 0));
/// let share = draws.iter().filter(|x| x[0] == x[1]).count() as f64 / 20_000.0;
/// assert!((share - 0.75).abs() < 0.02);
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
pub struct Gibbs {
    sizes: Vec<usize>,
    factors: Vec<Factor>,
    weights: usize,
    /// Factors of each variable.
    around: Vec<Vec<usize>>,
    /// Per factor, its feature for every configuration of its variables, the last fastest; empty beyond [`TABULATED`].
    tables: Vec<Vec<f64>>,
}

/// Most configurations of a factor whose feature is tabulated.
const TABULATED: usize = 1 << 12;

impl Gibbs {
    /// A sampler of variables, given the number of values of each, and their factors.
    ///
    /// # Errors
    /// [`ModelError::Parameter`] for a factor on a variable that is not there, or that it names twice, or a variable
    /// without values; [`ModelError::Empty`] without factors.
    pub fn new(sizes: Vec<usize>, factors: Vec<Factor>) -> Result<Self, ModelError> {
        if factors.is_empty() {
            return Err(ModelError::Empty { what: "factors" });
        }
        if let Some(v) = sizes.iter().position(|k| *k == 0) {
            return Err(ModelError::parameter(v.to_string(), "has no values"));
        }
        let mut around = vec![Vec::new(); sizes.len()];
        for (i, factor) in factors.iter().enumerate() {
            for &v in &factor.variables {
                let list = around.get_mut(v).ok_or_else(|| {
                    ModelError::parameter(
                        format!("factor {i}"),
                        format!("there is no variable {v}"),
                    )
                })?;
                if list.last() == Some(&i) {
                    let problem = format!("names variable {v} twice");
                    return Err(ModelError::parameter(format!("factor {i}"), problem));
                }
                list.push(i);
            }
        }
        let tables = factors.iter().map(|f| tabulate(f, &sizes)).collect();
        Ok(Self {
            weights: factors.iter().map(|f| f.weight + 1).max().unwrap_or(0),
            sizes,
            factors,
            around,
            tables,
        })
    }

    fn value(&self, factor: usize, state: &[usize]) -> f64 {
        let (table, factor) = (&self.tables[factor], &self.factors[factor]);
        let variables = factor.variables.iter();
        if table.is_empty() {
            let values: Vec<usize> = variables.map(|&v| state[v]).collect();
            return (factor.feature)(&values);
        }
        table[variables.fold(0, |i, &v| i * self.sizes[v] + state[v])]
    }

    /// `log Z(w)` and `E_w f`, exactly, by variable elimination.
    ///
    /// # Errors
    /// [`ModelError::TooWide`]; [`ModelError::Parameter`] for a factor of more than 2¹² configurations, or weights of
    /// another number.
    pub fn exact(&self, weights: &[f64]) -> Result<(f64, Vec<f64>), ModelError> {
        if weights.len() != self.weights {
            return Err(ModelError::parameter("weights", "of another number"));
        }
        let mut factors = Vec::with_capacity(self.factors.len());
        for (i, (factor, table)) in self.factors.iter().zip(&self.tables).enumerate() {
            if table.is_empty() {
                let problem = "has too many configurations to be tabulated";
                return Err(ModelError::parameter(format!("factor {i}"), problem));
            }
            let logs = table.iter().map(|f| weights[factor.weight] * f).collect();
            factors.push(elimination::Factor::new(factor.variables.clone(), logs));
        }
        // Variables without a factor are free.
        let alone = (0..self.sizes.len()).filter(|&v| self.around[v].is_empty());
        let free: f64 = alone.map(|v| (self.sizes[v] as f64).ln()).sum();
        let tree = BucketTree::new(factors, &self.sizes, Mode::Sum);
        let tree = tree.map_err(|e| ModelError::TooWide {
            variable: e.variable.to_string(),
            width: e.width,
            cells: e.cells,
        })?;
        let beliefs = tree.beliefs();
        let mut mean = vec![0.0; self.weights];
        for (factor, table) in self.factors.iter().zip(&self.tables) {
            let joint = beliefs.of(&factor.variables);
            mean[factor.weight] += dot(table, &joint);
        }
        Ok((tree.total + free, mean))
    }
}

/// The feature for every configuration of the variables; nothing where there are too many.
fn tabulate(factor: &Factor, sizes: &[usize]) -> Vec<f64> {
    let variables = &factor.variables;
    let count = variables
        .iter()
        .try_fold(1_usize, |n, &v| n.checked_mul(sizes[v]));
    let Some(count) = count.filter(|n| *n <= TABULATED) else {
        return Vec::new();
    };
    let mut assignment = vec![0; sizes.len()];
    let each = (0..count).map(|_| {
        let values: Vec<usize> = variables.iter().map(|&v| assignment[v]).collect();
        elimination::advance(variables, sizes, &mut assignment);
        (factor.feature)(&values)
    });
    each.collect()
}

impl Chain for Gibbs {
    type State = Vec<usize>;

    fn weights(&self) -> usize {
        self.weights
    }

    fn features(&self, state: &Vec<usize>) -> Vec<f64> {
        let mut sums = vec![0.0; self.weights];
        for (i, factor) in self.factors.iter().enumerate() {
            sums[factor.weight] += self.value(i, state);
        }
        sums
    }

    fn step(&self, state: &mut Vec<usize>, weights: &[f64], rng: &mut Stream) {
        let mut logs = vec![0.0; self.sizes.iter().copied().max().unwrap_or(0)];
        for v in 0..self.sizes.len() {
            let logs = &mut logs[..self.sizes[v]];
            for (value, log) in logs.iter_mut().enumerate() {
                state[v] = value;
                let factors = self.around[v].iter();
                *log = factors
                    .map(|&f| weights[self.factors[f].weight] * self.value(f, state))
                    .sum();
            }
            state[v] = categorical_of_logs(logs, rng);
        }
    }
}
