//! Questions to a factor graph of discrete variables: marginals, explanations, the partition function.

use super::super::elimination::{BucketTree, Factor as Table, Messages, Mode, TooWide};
use super::super::error::ModelError;
use super::Gibbs;

/// A factor graph with its weights, and what is known of its variables.
///
/// `p(x | known) ∝ exp(Σ_i w[weight_i] f_i(x))` over x that agree with what is known. [`Question::marginals`], [`Question::explain`] and
/// [`Question::log_partition`] are exact, by variable elimination, exponential in the width of the graph; beyond it,
/// [`Question::loopy`], [`super::sample`] and [`Question::annealed`].
///
/// # Examples
/// A ring of four bits with weight 1 for equal neighbours, the first bit known:
/// ```
/// use edifice_model::factor_graph::{Factor, Gibbs};
/// let equal = |a, b| Factor { variables: vec![a, b], weight: 0, feature: Box::new(|x| f64::from(u8::from(x[0] == x[1]))) };
/// let ring = Gibbs::new(vec![2; 4], vec![equal(0, 1), equal(1, 2), equal(2, 3), equal(3, 0)])?;
/// let question = ring.ask(&[1.0])?.given(0, 1)?;
/// let marginals = question.marginals()?;
/// assert_eq!(marginals[0], [0.0, 1.0]);
/// assert!(marginals[1][1] > marginals[2][1] && marginals[2][1] > 0.5);
/// let (most, log) = question.explain()?;
/// assert_eq!(most, [1; 4]);
/// // The weight of the most probable state is 4.
/// assert!((log - (4.0 - question.log_partition()?)).abs() < 1e-12);
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
#[derive(Clone)]
pub struct Question<'g> {
    pub(super) graph: &'g Gibbs,
    pub(super) weights: Vec<f64>,
    pub(super) known: Vec<Option<usize>>,
}

/// Result of loopy belief propagation ([`Question::loopy`]).
#[derive(Clone, Debug, PartialEq)]
pub struct Beliefs {
    /// Of each variable, the probabilities of its values.
    pub marginals: Vec<Vec<f64>>,
    /// Bethe's approximation of the logarithm of the partition function, nats.
    pub log_partition: f64,
    /// Rounds made.
    pub rounds: usize,
    /// True if no message moved by more than the tolerance in the last round.
    pub converged: bool,
}

impl Gibbs {
    /// A question with these weights, nothing known.
    ///
    /// # Errors
    /// [`ModelError::Parameter`] for weights of another number, or not finite.
    pub fn ask(&self, weights: &[f64]) -> Result<Question<'_>, ModelError> {
        if weights.len() != self.weights {
            return Err(ModelError::parameter("weights", "of another number"));
        }
        if let Some(i) = weights.iter().position(|w| !w.is_finite()) {
            return Err(ModelError::parameter(
                format!("weight {i}"),
                "is not finite",
            ));
        }
        Ok(Question {
            graph: self,
            weights: weights.to_vec(),
            known: vec![None; self.sizes.len()],
        })
    }
}

impl Question<'_> {
    /// The same with one more variable known.
    ///
    /// # Errors
    /// [`ModelError::Parameter`] for a variable or a value that is not there.
    pub fn given(mut self, variable: usize, value: usize) -> Result<Self, ModelError> {
        let size = self.graph.sizes.get(variable).copied().unwrap_or(0);
        if value >= size {
            let problem = format!("has {size} values, {value} is none of them");
            return Err(ModelError::parameter(
                format!("variable {variable}"),
                problem,
            ));
        }
        self.known[variable] = Some(value);
        Ok(self)
    }

    /// Probabilities of the values of each variable, exactly; 0 and 1 where it is known.
    ///
    /// # Errors
    /// [`ModelError::TooWide`]; [`ModelError::Parameter`] for a factor of more than 2¹² configurations.
    pub fn marginals(&self) -> Result<Vec<Vec<f64>>, ModelError> {
        let tree = self.tree(Mode::Sum)?;
        let beliefs = tree.beliefs();
        let one = |v: usize| match self.known[v] {
            Some(value) => point(value, self.graph.sizes[v]),
            None => match beliefs.of(&[v]) {
                found if found.is_empty() => {
                    vec![1.0 / self.graph.sizes[v] as f64; self.graph.sizes[v]]
                }
                found => found,
            },
        };
        Ok((0..self.graph.sizes.len()).map(one).collect())
    }

    /// The most probable state, the first of several, and the logarithm of its probability given what is known.
    ///
    /// # Errors
    /// As [`Question::marginals`].
    pub fn explain(&self) -> Result<(Vec<usize>, f64), ModelError> {
        let tree = self.tree(Mode::Max)?;
        let mut state: Vec<usize> = self.known.iter().map(|k| k.unwrap_or(0)).collect();
        tree.decode(&mut state);
        Ok((state, tree.total - self.log_partition()?))
    }

    /// `log Σ_x exp(wᵀ f(x))` over the states that agree with what is known, exactly, nats.
    ///
    /// # Errors
    /// As [`Question::marginals`].
    pub fn log_partition(&self) -> Result<f64, ModelError> {
        Ok(self.tree(Mode::Sum)?.total + self.free())
    }

    /// `E f(x)` given what is known, exactly.
    ///
    /// # Errors
    /// As [`Question::marginals`].
    pub fn expectations(&self) -> Result<Vec<f64>, ModelError> {
        let tree = self.tree(Mode::Sum)?;
        let beliefs = tree.beliefs();
        let mut mean = vec![0.0; self.weights.len()];
        for (factor, table) in self.graph.factors.iter().zip(&self.graph.tables) {
            let features = Table::new(factor.variables.clone(), table.clone());
            let features = features.reduce(&self.known, &self.graph.sizes);
            let joint = beliefs.of(&features.vars);
            mean[factor.weight] += super::dot(&features.values, &joint);
        }
        Ok(mean)
    }

    /// Loopy belief propagation: `rounds` at most, or until no message moves by more than `tolerance` (a probability). Exact where
    /// the factors form a tree, else without a guarantee. `O(Σ_f c_f s_f²)` a round for factors of `c_f` cells and `s_f` variables, whatever the width.
    ///
    /// # Errors
    /// [`ModelError::Parameter`] for a factor of more than 2¹² configurations.
    pub fn loopy(&self, rounds: usize, tolerance: f64) -> Result<Beliefs, ModelError> {
        let sizes = &self.graph.sizes;
        let all = self.tables()?;
        let (factors, constants): (Vec<Table>, Vec<Table>) =
            all.into_iter().partition(|f| !f.vars.is_empty());
        let constant: f64 = constants.iter().map(|f| f.values[0]).sum();
        let mut messages = Messages::new(&factors, sizes);
        let (mut made, mut converged) = (0, false);
        while made < rounds && !converged {
            made += 1;
            converged = messages.round() <= tolerance;
        }
        let one = |v: usize| match self.known[v] {
            Some(value) => point(value, sizes[v]),
            None => {
                let found = messages.belief(v);
                found.unwrap_or_else(|| vec![1.0 / sizes[v] as f64; sizes[v]])
            }
        };
        Ok(Beliefs {
            marginals: (0..sizes.len()).map(one).collect(),
            log_partition: messages.log_partition() + constant + self.free(),
            rounds: made,
            converged,
        })
    }

    /// The factors as tables of logarithms, known variables fixed.
    pub(super) fn tables(&self) -> Result<Vec<Table>, ModelError> {
        let mut all = Vec::with_capacity(self.graph.factors.len());
        for (i, (factor, table)) in self
            .graph
            .factors
            .iter()
            .zip(&self.graph.tables)
            .enumerate()
        {
            if table.is_empty() {
                let problem = "has too many configurations to be tabulated";
                return Err(ModelError::parameter(format!("factor {i}"), problem));
            }
            let logs = table
                .iter()
                .map(|f| self.weights[factor.weight] * f)
                .collect();
            let table = Table::new(factor.variables.clone(), logs);
            all.push(table.reduce(&self.known, &self.graph.sizes));
        }
        Ok(all)
    }

    fn tree(&self, mode: Mode) -> Result<BucketTree, ModelError> {
        let wide = |e: TooWide| ModelError::TooWide {
            variable: e.variable.to_string(),
            width: e.width,
            cells: e.cells,
        };
        BucketTree::new(self.tables()?, &self.graph.sizes, mode).map_err(wide)
    }

    /// Unknown variables without a factor are free.
    fn free(&self) -> f64 {
        let alone = |v: &usize| self.graph.around[*v].is_empty() && self.known[*v].is_none();
        let sizes = (0..self.graph.sizes.len())
            .filter(alone)
            .map(|v| self.graph.sizes[v]);
        sizes.map(|k| (k as f64).ln()).sum()
    }
}

fn point(value: usize, size: usize) -> Vec<f64> {
    (0..size).map(|v| f64::from(u8::from(v == value))).collect()
}
