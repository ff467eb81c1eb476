//! The forward pass, from which everything else is read.

use std::collections::BinaryHeap;

use rand::Rng;

use super::super::linalg::categorical;
use super::factor::{add, index};
use super::{Factor, Mode, Order, TooWide};

/// A bucket after the forward pass.
#[derive(Debug)]
pub(super) struct Bucket {
    pub var: usize,
    /// The variables of its table; `var` is the last of them.
    pub scope: Vec<usize>,
    /// After a sum, `P(var | rest of the scope)`; after a maximum, the logarithm of the product.
    pub table: Vec<f64>,
    /// Logarithm of the product summed (or maximised) over `var`, by configuration of the rest of the scope; after a sum
    /// it has gone to the parent.
    pub message: Vec<f64>,
    /// The bucket that received the message.
    pub parent: Option<usize>,
}

/// The buckets of an elimination, and its result.
///
/// The bucket of v has a table over its scope U_v: `t_v = Π f` over the factors and messages that it holds, and the message
/// `m_v = Σ_v t_v` (or `max_v t_v`) goes to the first of the rest of U_v in the order; `total` is the product of those without
/// variables. Time of [`BucketTree::new`]: `O(c (f + b))` for f factors, b buckets and tables of c cells at most
/// (each is added to one table), memory for the tables of all buckets ([`Order`]). Numbers are natural logarithms; `total` is in
/// nats, as [`BucketTree::best`] has them. Sources: as [`super::elimination`](crate::elimination).
///
/// # Examples
/// The two most probable of four assignments, and draws:
/// ```
/// use edifice_model::elimination::{BucketTree, Factor, Mode};
/// use edifice_base::rng::stream;
/// let factor = Factor::new(vec![0, 1], [0.1_f64, 0.4, 0.3, 0.2].map(f64::ln).to_vec());
/// let tree = BucketTree::new(vec![factor.clone()], &[2, 2], Mode::Max)?;
/// let mut most = [0; 2];
/// tree.decode(&mut most);
/// assert_eq!(most, [0, 1]);
/// let best = tree.best(2, &[0; 2]);
/// assert_eq!(best[1].1, [1, 0]);
/// assert!((best[1].0 - 0.3_f64.ln()).abs() < 1e-12);
/// let tree = BucketTree::new(vec![factor], &[2, 2], Mode::Sum)?;
/// let mut rng = stream(1, "draws", 0);
/// let mut hits = 0;
/// for _ in 0..2000 {
///     let mut drawn = [0; 2];
///     tree.draw(&mut drawn, &mut rng);
///     hits += usize::from(drawn == [0, 1]);
/// }
/// // Five standard deviations are 110.
/// assert!(hits.abs_diff(800) < 110);
/// # Ok::<(), edifice_model::elimination::TooWide>(())
/// ```
#[derive(Debug)]
pub struct BucketTree {
    pub(super) sizes: Vec<usize>,
    pub(super) buckets: Vec<Bucket>,
    /// The bucket of each variable; `usize::MAX` for one that is in no factor.
    pub(super) place: Vec<usize>,
    /// Logarithm of the total sum (or maximum); minus infinity when every product is 0.
    pub total: f64,
}

impl BucketTree {
    /// Eliminates every variable of `factors`, whose values are logarithms; `sizes` are the numbers of categories of all
    /// variables, in factors or not.
    ///
    /// # Errors
    /// [`TooWide`], before any table is made.
    pub fn new(factors: Vec<Factor>, sizes: &[usize], mode: Mode) -> Result<Self, TooWide> {
        let order = Order::new(factors.iter().map(|f| &f.vars[..]), sizes);
        order.check()?;
        Ok(Self::along(&order, factors, sizes, mode))
    }

    /// Eliminates in a known order.
    pub(crate) fn along(order: &Order, factors: Vec<Factor>, sizes: &[usize], mode: Mode) -> Self {
        let mut place = vec![usize::MAX; sizes.len()];
        for (i, &v) in order.variables.iter().enumerate() {
            place[v] = i;
        }
        let mut inbox: Vec<Vec<Factor>> = vec![Vec::new(); order.variables.len()];
        let mut total = 0.0;
        let mut deliver = |f: Factor, inbox: &mut Vec<Vec<Factor>>| -> Option<usize> {
            let first = f.vars.iter().map(|&v| place[v]).min();
            match first {
                Some(b) => inbox[b].push(f),
                None => total += f.values[0],
            }
            first
        };
        for f in factors {
            deliver(f, &mut inbox);
        }
        let mut buckets = Vec::with_capacity(order.variables.len());
        for (b, &var) in order.variables.iter().enumerate() {
            let held = std::mem::take(&mut inbox[b]);
            let mut scope: Vec<usize> = held.iter().flat_map(|f| f.vars.iter().copied()).collect();
            scope.sort_unstable_by_key(|&v| std::cmp::Reverse(place[v]));
            scope.dedup();
            let mut table = vec![0.0; scope.iter().map(|&v| sizes[v]).product()];
            for f in &held {
                add(&mut table, &scope, f, sizes);
            }
            drop(held);
            let message = match mode {
                Mode::Sum => normalise(&mut table, sizes[var]),
                Mode::Max => table.chunks(sizes[var]).map(maximum).collect(),
            };
            let (told, kept) = match mode {
                Mode::Sum => (message, Vec::new()),
                Mode::Max => (message.clone(), message),
            };
            let told = Factor::new(scope[..scope.len() - 1].to_vec(), told);
            let parent = deliver(told, &mut inbox);
            buckets.push(Bucket {
                var,
                scope,
                table,
                message: kept,
                parent,
            });
        }
        Self {
            sizes: sizes.to_vec(),
            buckets,
            place,
            total,
        }
    }

    /// An exact draw of the eliminated variables after a sum, written into `assignment`: from the last bucket to the first,
    /// each from `P(v | rest of its scope)`. O(Σ_v |U_v| + k_v).
    pub fn draw<R: Rng>(&self, assignment: &mut [usize], rng: &mut R) {
        for bucket in self.buckets.iter().rev() {
            let row = self.row(bucket, assignment);
            assignment[bucket.var] = categorical(row, rng);
        }
    }

    /// The most probable assignment after a maximum, the first of several, written into `assignment`. O(Σ_v |U_v| + k_v).
    pub fn decode(&self, assignment: &mut [usize]) {
        for bucket in self.buckets.iter().rev() {
            let row = self.row(bucket, assignment);
            let best = (0..row.len())
                .rev()
                .max_by(|&a, &b| row[a].total_cmp(&row[b]));
            assignment[bucket.var] = best.unwrap_or(0);
        }
    }

    /// Values of the bucket's variable given the others of its scope.
    fn row<'b>(&self, bucket: &'b Bucket, assignment: &mut [usize]) -> &'b [f64] {
        assignment[bucket.var] = 0;
        let start = index(&bucket.scope, assignment, &self.sizes);
        &bucket.table[start..start + self.sizes[bucket.var]]
    }

    /// The `count` most probable assignments with their log values, after a maximum: best-first search whose bound is
    /// exact, so that it expands only what it needs: for n variables of at most k categories at most n partial assignments for
    /// each answer, k successors each. Fewer where no more have a product above 0. `start` gives the variables that were not
    /// eliminated. Not for use after a sum, which keeps no bounds (it panics).
    pub fn best(&self, count: usize, start: &[usize]) -> Vec<(f64, Vec<usize>)> {
        let mut heap = BinaryHeap::new();
        heap.push(Entry {
            bound: self.total,
            left: self.buckets.len(),
            assignment: start.to_vec(),
        });
        let mut found = Vec::new();
        while let Some(entry) = heap.pop() {
            if entry.bound == f64::NEG_INFINITY || found.len() == count {
                break;
            }
            if entry.left == 0 {
                found.push((entry.bound, entry.assignment));
                continue;
            }
            let bucket = &self.buckets[entry.left - 1];
            let mut assignment = entry.assignment;
            let rest = &bucket.scope[..bucket.scope.len() - 1];
            let best = bucket.message[index(rest, &assignment, &self.sizes)];
            for (value, log) in self.row(bucket, &mut assignment).iter().enumerate() {
                assignment[bucket.var] = value;
                heap.push(Entry {
                    bound: entry.bound - best + log,
                    left: entry.left - 1,
                    assignment: assignment.clone(),
                });
            }
        }
        found
    }
}

/// Turns every row of `k` log values into probabilities; returns the logarithms of the sums.
fn normalise(table: &mut [f64], k: usize) -> Vec<f64> {
    let sum = |row: &mut [f64]| {
        let top = maximum(row);
        if top == f64::NEG_INFINITY {
            row.fill(0.0);
            return top;
        }
        let mut sum = 0.0;
        for v in row.iter_mut() {
            *v = (*v - top).exp();
            sum += *v;
        }
        for v in row {
            *v /= sum;
        }
        top + sum.ln()
    };
    table.chunks_mut(k).map(sum).collect()
}

fn maximum(row: &[f64]) -> f64 {
    row.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

/// A partial assignment and the log value of its best completion.
struct Entry {
    bound: f64,
    left: usize,
    assignment: Vec<usize>,
}

impl Ord for Entry {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        // Highest bound first; among equals the more complete, then the smaller assignment.
        self.bound
            .total_cmp(&other.bound)
            .then_with(|| other.left.cmp(&self.left))
            .then_with(|| other.assignment.cmp(&self.assignment))
    }
}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Entry {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Entry {}
