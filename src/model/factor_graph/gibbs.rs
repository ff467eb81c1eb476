//! Discrete variables under factors with local features: Gibbs sampling, and exact sums by elimination.

use super::super::elimination;
use super::super::error::ModelError;
use super::super::linalg::categorical_of_logs;
use super::Chain;
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
    pub(super) sizes: Vec<usize>,
    pub(super) factors: Vec<Factor>,
    pub(super) weights: usize,
    /// Factors of each variable.
    pub(super) around: Vec<Vec<usize>>,
    /// Per factor, its feature for every configuration of its variables, the last fastest; empty beyond [`TABULATED`].
    pub(super) tables: Vec<Vec<f64>>,
    /// Variables that are not in the data.
    hidden: Vec<usize>,
    /// Variables that chains move.
    free: Vec<usize>,
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
            hidden: Vec::new(),
            free: (0..sizes.len()).collect(),
            sizes,
            factors,
            around,
            tables,
        })
    }

    /// The same with hidden variables: their values in examples are not looked at; they are drawn given the others
    /// instead, so that [`super::fit`] climbs the likelihood of the observed ones (a restricted Boltzmann machine).
    ///
    /// # Errors
    /// [`ModelError::Parameter`] for a variable that is not there.
    ///
    /// # Examples
    /// Two bits that are equal, tied by a hidden one:
    /// ```
    /// use edifice_model::factor_graph::{Factor, Gibbs, fit_exact};
    /// let tie = |a, b, weight| Factor { variables: vec![a, b], weight, feature: Box::new(|x| f64::from(u8::from(x[0] == x[1]))) };
    /// let machine = Gibbs::new(vec![2; 3], vec![tie(0, 2, 0), tie(1, 2, 0)])?.hidden(&[2])?;
    /// let data = [vec![0, 0, 0], vec![1, 1, 0], vec![0, 0, 0], vec![0, 1, 0], vec![1, 1, 0]];
    /// let weights = fit_exact(&machine, &data, 0.0)?.weights;
    /// // P(equal) = (1 + e^2w) / (1 + e^w)^2 = 4/5.
    /// let w: f64 = weights[0].abs().exp();
    /// assert!(((1.0 + w * w) / (1.0 + w).powi(2) - 0.8).abs() < 1e-6);
    /// # Ok::<(), edifice_model::ModelError>(())
    /// ```
    pub fn hidden(mut self, variables: &[usize]) -> Result<Self, ModelError> {
        self.check(variables)?;
        self.hidden = variables.to_vec();
        Ok(self)
    }

    /// The same with inputs: variables that are always known and whose distribution is not modelled, `p(others | inputs)` is (a conditional
    /// random field). Chains leave them as they are in the examples.
    ///
    /// # Errors
    /// [`ModelError::Parameter`] for a variable that is not there.
    pub fn inputs(mut self, variables: &[usize]) -> Result<Self, ModelError> {
        self.check(variables)?;
        self.free.retain(|v| !variables.contains(v));
        Ok(self)
    }

    fn check(&self, variables: &[usize]) -> Result<(), ModelError> {
        match variables.iter().find(|v| **v >= self.sizes.len()) {
            Some(v) => Err(ModelError::parameter(
                format!("variable {v}"),
                "is not there",
            )),
            None => Ok(()),
        }
    }

    /// The known values of an example: all but those of hidden variables.
    pub(super) fn observed(&self, state: &[usize]) -> Vec<Option<usize>> {
        let one = |(v, x): (usize, &usize)| (!self.hidden.contains(&v)).then_some(*x);
        state.iter().enumerate().map(one).collect()
    }

    /// The values of the inputs of an example.
    pub(super) fn given(&self, state: &[usize]) -> Vec<Option<usize>> {
        let mut known: Vec<Option<usize>> = state.iter().map(|x| Some(*x)).collect();
        self.free.iter().for_each(|&v| known[v] = None);
        known
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
        let question = self.ask(weights)?;
        Ok((question.log_partition()?, question.expectations()?))
    }

    /// Draws each of some variables given all others, once.
    pub(super) fn sweep(
        &self,
        variables: &[usize],
        state: &mut [usize],
        weights: &[f64],
        rng: &mut Stream,
    ) {
        let mut logs = vec![0.0; self.sizes.iter().copied().max().unwrap_or(0)];
        for &v in variables {
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
        self.sweep(&self.free, state, weights, rng);
    }

    fn clamp(&self, state: &mut Vec<usize>, weights: &[f64], rng: &mut Stream) -> bool {
        self.sweep(&self.hidden, state, weights, rng);
        !self.hidden.is_empty()
    }
}
