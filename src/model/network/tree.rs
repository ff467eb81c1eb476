//! Variable elimination, kept as a tree of buckets so that one forward and one backward pass
//! answer every marginal (Dechter 1999, *Bucket elimination*).
//!
//! Variables are eliminated by least fill-in cost (smallest next table). The bucket of v holds the
//! factors whose first eliminated variable is v, and the messages of earlier buckets; its own
//! message is that product, summed (or maximised) over v.

use std::collections::BinaryHeap;

use rand::Rng;

use super::super::linalg::categorical_of_logs;
use super::factor::{Factor, Mode, product};

/// Most cells of one table: beyond, exact inference is refused.
pub(crate) const MOST_CELLS: usize = 1 << 26;

/// A bucket after the forward pass.
#[derive(Debug)]
struct Bucket {
    var: usize,
    /// Product of factors and incoming messages; `var` is last in its scope.
    table: Factor,
    /// The table reduced over `var`.
    message: Factor,
    /// The bucket that received the message.
    parent: Option<usize>,
}

/// The forward pass, from which everything else is read.
#[derive(Debug)]
pub(crate) struct Tree {
    sizes: Vec<usize>,
    buckets: Vec<Bucket>,
    /// Log of the total sum (or maximum).
    pub total: f64,
}

impl Tree {
    /// Eliminates every variable of `factors`; `None` when a table would have too many cells.
    pub fn new(factors: Vec<Factor>, sizes: &[usize], mode: Mode) -> Option<Self> {
        let mut vars: Vec<usize> = factors.iter().flat_map(|f| f.vars.clone()).collect();
        vars.sort_unstable();
        vars.dedup();
        let order = order(&factors, &vars, sizes);
        let mut position = vec![usize::MAX; sizes.len()];
        for (i, &v) in order.iter().enumerate() {
            position[v] = i;
        }
        let mut inbox: Vec<Vec<Factor>> = vec![Vec::new(); order.len()];
        let mut total = 0.0;
        let mut place = |f: Factor, inbox: &mut Vec<Vec<Factor>>| -> Option<usize> {
            let first = f.vars.iter().map(|&v| position[v]).min();
            match first {
                Some(b) => inbox[b].push(f),
                None => total += f.values[0],
            }
            first
        };
        for f in factors {
            place(f, &mut inbox);
        }
        let mut buckets = Vec::with_capacity(order.len());
        for (b, &var) in order.iter().enumerate() {
            let held = std::mem::take(&mut inbox[b]);
            let mut scope: Vec<usize> = held.iter().flat_map(|f| f.vars.clone()).collect();
            scope.sort_unstable_by_key(|&v| std::cmp::Reverse(position[v]));
            scope.dedup();
            let cells = scope
                .iter()
                .try_fold(1usize, |n, &v| n.checked_mul(sizes[v]))?;
            if cells > MOST_CELLS {
                return None;
            }
            let table = product(&held.iter().collect::<Vec<_>>(), &scope, sizes);
            let message = table.onto(&scope[..scope.len() - 1], sizes, mode);
            let parent = place(message.clone(), &mut inbox);
            buckets.push(Bucket {
                var,
                table,
                message,
                parent,
            });
        }
        Some(Self {
            sizes: sizes.to_vec(),
            buckets,
            total,
        })
    }

    /// Backward pass: the joint log belief of every bucket's scope, not normalised.
    pub fn beliefs(&self) -> Vec<Factor> {
        let mut beliefs: Vec<Factor> = self.buckets.iter().map(|b| b.table.clone()).collect();
        for b in (0..self.buckets.len()).rev() {
            let bucket = &self.buckets[b];
            let Some(parent) = bucket.parent else {
                continue;
            };
            // The parent's belief on the shared scope, without what this bucket told it.
            let scope: Vec<usize> = beliefs[parent]
                .vars
                .iter()
                .copied()
                .filter(|v| bucket.message.vars.contains(v))
                .collect();
            let mut down = beliefs[parent].onto(&scope, &self.sizes, Mode::Sum);
            let told = product(&[&bucket.message], &scope, &self.sizes);
            for (d, t) in down.values.iter_mut().zip(&told.values) {
                *d = if *d == f64::NEG_INFINITY { *d } else { *d - t };
            }
            let vars = bucket.table.vars.clone();
            beliefs[b] = product(&[&bucket.table, &down], &vars, &self.sizes);
        }
        beliefs
    }

    /// The most probable assignment after a `Max` pass, or an exact draw after a `Sum` pass, of
    /// the eliminated variables, written into `assignment`.
    pub fn decode<R: Rng>(&self, assignment: &mut [usize], mut rng: Option<&mut R>) {
        for bucket in self.buckets.iter().rev() {
            let logs = self.column(bucket, assignment);
            assignment[bucket.var] = match &mut rng {
                Some(rng) => categorical_of_logs(logs, *rng),
                None => (0..logs.len())
                    .rev()
                    .max_by(|&a, &b| logs[a].total_cmp(&logs[b]))
                    .unwrap_or(0),
            };
        }
    }

    /// Log values of the bucket's variable given the others of its scope.
    fn column<'b>(&self, bucket: &'b Bucket, assignment: &mut [usize]) -> &'b [f64] {
        assignment[bucket.var] = 0;
        let start = bucket.table.index(assignment, &self.sizes);
        // `var` is the last of the scope, so that its values are neighbours.
        &bucket.table.values[start..start + self.sizes[bucket.var]]
    }

    /// The `count` most probable assignments with their log values, after a `Max` pass: best-first
    /// search whose bound is exact, so that it expands only what it needs.
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
            let best = bucket.message.values[bucket.message.index(&assignment, &self.sizes)];
            let logs = self.column(bucket, &mut assignment);
            for (value, log) in logs.iter().enumerate() {
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

/// Greedy elimination order: always the variable whose next table is smallest.
fn order(factors: &[Factor], vars: &[usize], sizes: &[usize]) -> Vec<usize> {
    let mut neighbours: Vec<Vec<usize>> = vec![Vec::new(); sizes.len()];
    let join = |list: &mut Vec<usize>, others: &[usize], own: usize| {
        for &o in others {
            if o != own && !list.contains(&o) {
                list.push(o);
            }
        }
    };
    for f in factors {
        for &v in &f.vars {
            join(&mut neighbours[v], &f.vars, v);
        }
    }
    let mut left = vars.to_vec();
    let mut order = Vec::with_capacity(left.len());
    while !left.is_empty() {
        let cost = |v: usize| {
            neighbours[v]
                .iter()
                .fold(sizes[v] as f64, |c, &n| c * sizes[n] as f64)
        };
        let at = (0..left.len())
            .min_by(|&a, &b| cost(left[a]).total_cmp(&cost(left[b])))
            .unwrap_or(0);
        let v = left.remove(at);
        let around = std::mem::take(&mut neighbours[v]);
        for &n in &around {
            neighbours[n].retain(|&w| w != v);
            join(&mut neighbours[n], &around, n);
        }
        order.push(v);
    }
    order
}
