//! The backward pass: marginals of every bucket's scope.

use super::BucketTree;
use super::factor::sum_onto;

/// Marginals of an elimination by sums, `P(x_A) = Σ_rest Π_i f_i / Σ_x Π_i f_i`, from [`BucketTree::beliefs`].
///
/// Once the buckets are a Bayesian network, one pass from the last to the first gives the joint distribution of every bucket's
/// scope: time and memory linear in the cells of all buckets. Source: Koller and Friedman 2009, Sec. 10.2 (the pass back).
///
/// # Examples
/// ```
/// use edifice_model::elimination::{BucketTree, Factor, Mode};
/// // A chain of three: each is as the one before three times out of four.
/// let agree = |a, b| Factor::new(vec![a, b], [0.75_f64, 0.25, 0.25, 0.75].map(f64::ln).to_vec());
/// let first = Factor::new(vec![0], [0.9_f64, 0.1].map(f64::ln).to_vec());
/// let tree = BucketTree::new(vec![first, agree(0, 1), agree(1, 2)], &[2, 2, 2], Mode::Sum)?;
/// let beliefs = tree.beliefs();
/// // Each link halves the distance from a half.
/// assert!((beliefs.of(&[2])[0] - (0.5 + 0.4 * 0.25)).abs() < 1e-12);
/// let pair = beliefs.of(&[1, 2]);
/// assert!((pair[0] - 0.7 * 0.75).abs() < 1e-12 && (pair[1] - 0.7 * 0.25).abs() < 1e-12);
/// # Ok::<(), edifice_model::elimination::TooWide>(())
/// ```
#[derive(Debug)]
pub struct Beliefs<'t> {
    tree: &'t BucketTree,
    /// Joint probability of every bucket's scope.
    tables: Vec<Vec<f64>>,
}

impl BucketTree {
    /// Marginals, after a sum; after a maximum they have no meaning.
    pub fn beliefs(&self) -> Beliefs<'_> {
        Beliefs::new(self)
    }
}

impl<'t> Beliefs<'t> {
    /// From the last eliminated variable down: `P(scope) = P(var | rest) P(rest)`, where the rest is in the parent's scope.
    fn new(tree: &'t BucketTree) -> Self {
        let mut tables: Vec<Vec<f64>> = vec![Vec::new(); tree.buckets.len()];
        for (b, bucket) in tree.buckets.iter().enumerate().rev() {
            let mut table = bucket.table.clone();
            if let Some(parent) = bucket.parent {
                let (rest, k) = (
                    &bucket.scope[..bucket.scope.len() - 1],
                    tree.sizes[bucket.var],
                );
                let above = &tree.buckets[parent].scope;
                let given = sum_onto(&tables[parent], above, rest, &tree.sizes);
                for (row, p) in table.chunks_mut(k).zip(given) {
                    row.iter_mut().for_each(|v| *v *= p);
                }
            }
            tables[b] = table;
        }
        Self { tree, tables }
    }

    /// The joint distribution of variables that share a factor, the last fastest; 1 for none.
    ///
    /// Variables that share no factor may be in no bucket together: then, and for a variable that is in no factor, nothing
    /// is known and the result is empty. Where [`BucketTree::total`] is minus infinity there is no distribution, and the numbers
    /// of the variables concerned are NaN. Time: linear in the cells of one bucket.
    pub fn of(&self, vars: &[usize]) -> Vec<f64> {
        let Some(first) = vars.iter().map(|&v| self.tree.place[v]).min() else {
            return vec![1.0];
        };
        let Some(bucket) = self.tree.buckets.get(first) else {
            return Vec::new();
        };
        if !vars.iter().all(|v| bucket.scope.contains(v)) {
            return Vec::new();
        }
        let table = &self.tables[first];
        let mut sums = sum_onto(table, &bucket.scope, vars, &self.tree.sizes);
        // Rounding: the parts of a distribution sum to 1.
        let total: f64 = sums.iter().sum();
        sums.iter_mut().for_each(|v| *v /= total);
        sums
    }
}
