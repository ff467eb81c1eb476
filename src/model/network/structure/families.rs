//! Scores of families, each counted once.

use rayon::prelude::*;
use rustc_hash::FxHashMap;
use statrs::function::gamma::ln_gamma;

use super::super::super::conjugate::dirichlet_mode;
use super::super::super::error::ModelError;
use super::super::super::table::{MISSING, Table, Values};
use super::settings::Score;

/// Cells of a table of counts up to which it is dense.
const DENSE: usize = 1 << 16;

/// Complete rows of categories, and the scores of the families asked for.
pub(super) struct Families<'a> {
    columns: Vec<&'a [u32]>,
    sizes: Vec<usize>,
    rows: usize,
    score: Score,
    known: FxHashMap<(usize, Vec<usize>), f64>,
}

impl<'a> Families<'a> {
    pub(super) fn new(data: &'a Table, score: Score) -> Result<Self, ModelError> {
        if data.rows() == 0 || data.columns().is_empty() {
            return Err(ModelError::Empty { what: "rows" });
        }
        if matches!(score, Score::Bdeu(ess) if !(ess > 0.0 && ess.is_finite())) {
            return Err(ModelError::parameter("ess", "must be positive and finite"));
        }
        let mut columns = Vec::new();
        let mut sizes = Vec::new();
        for column in data.columns() {
            let Values::Codes { categories, codes } = &column.values else {
                return Err(ModelError::Kind {
                    column: column.name().to_owned(),
                    got: column.kind(),
                    expected: "categorical",
                });
            };
            if let Some(row) = codes.iter().position(|c| *c == MISSING) {
                return Err(ModelError::Missing {
                    column: column.name().to_owned(),
                    row,
                });
            }
            columns.push(codes.as_slice());
            sizes.push(categories.len());
        }
        Ok(Self {
            columns,
            sizes,
            rows: data.rows(),
            score,
            known: FxHashMap::default(),
        })
    }

    pub(super) fn variables(&self) -> usize {
        self.sizes.len()
    }

    /// Families counted so far.
    pub(super) fn counted(&self) -> usize {
        self.known.len()
    }

    /// The score of `child` with the given parents, ascending.
    pub(super) fn score(&mut self, child: usize, parents: &[usize]) -> f64 {
        let key = (child, parents.to_vec());
        if let Some(&known) = self.known.get(&key) {
            return known;
        }
        let score = self.count(child, parents);
        self.known.insert(key, score);
        score
    }

    /// Counts the families that are not yet known, in parallel.
    pub(super) fn prepare(&mut self, mut wanted: Vec<(usize, Vec<usize>)>) {
        wanted.retain(|key| !self.known.contains_key(key));
        let scores: Vec<f64> = wanted
            .par_iter()
            .map(|(child, parents)| self.count(*child, parents))
            .collect();
        self.known.extend(wanted.into_iter().zip(scores));
    }

    fn count(&self, child: usize, parents: &[usize]) -> f64 {
        let r = self.sizes[child];
        let configurations = parents
            .iter()
            .try_fold(1_usize, |n, &p| n.checked_mul(self.sizes[p]));
        // More configurations than can be counted: no rows could tell them apart.
        let Some(configurations) = configurations else {
            return f64::NEG_INFINITY;
        };
        let q = configurations as f64;
        match configurations.checked_mul(r) {
            Some(cells) if cells <= DENSE => {
                let mut counts = vec![0_u32; cells];
                for row in 0..self.rows {
                    let at = self.configuration(parents, row) as usize * r;
                    counts[at + self.columns[child][row] as usize] += 1;
                }
                self.of_counts(counts.chunks(r), q)
            }
            _ => {
                let mut counts: FxHashMap<u128, Vec<u32>> = FxHashMap::default();
                for row in 0..self.rows {
                    let own = counts
                        .entry(self.configuration(parents, row))
                        .or_insert_with(|| vec![0; r]);
                    own[self.columns[child][row] as usize] += 1;
                }
                // In the order of configurations, so that sums do not depend on the hash.
                let mut counts: Vec<(u128, Vec<u32>)> = counts.into_iter().collect();
                counts.sort_unstable();
                self.of_counts(counts.iter().map(|(_, own)| own.as_slice()), q)
            }
        }
    }

    /// The table of `child` given `parents`, the first slowest: per configuration the mode under a Dirichlet prior of `alpha`.
    pub(super) fn table(&self, child: usize, parents: &[usize], alpha: f64) -> Vec<f64> {
        let r = self.sizes[child];
        let configurations: usize = parents.iter().map(|&p| self.sizes[p]).product();
        let mut counts = vec![0.0; configurations * r];
        for row in 0..self.rows {
            let at = self.configuration(parents, row) as usize * r;
            counts[at + self.columns[child][row] as usize] += 1.0;
        }
        let tables = counts.chunks(r.max(1));
        tables.flat_map(|c| dirichlet_mode(c, alpha)).collect()
    }

    fn configuration(&self, parents: &[usize], row: usize) -> u128 {
        parents.iter().fold(0, |at, &p| {
            at * self.sizes[p] as u128 + u128::from(self.columns[p][row])
        })
    }

    /// The score from `N_jk` by configuration; those without rows add nothing but parameters.
    fn of_counts<'c>(&self, counts: impl Iterator<Item = &'c [u32]>, q: f64) -> f64 {
        let mut score = 0.0;
        let mut r = 1.0;
        for own in counts {
            r = own.len() as f64;
            let n: u32 = own.iter().sum();
            if n == 0 {
                continue;
            }
            let n = f64::from(n);
            let seen = own.iter().filter(|k| **k > 0).map(|&k| f64::from(k));
            match self.score {
                Score::Bic => score += seen.map(|k| k * (k / n).ln()).sum::<f64>(),
                Score::Bdeu(ess) => {
                    let (a, a_k) = (ess / q, ess / (q * r));
                    score += ln_gamma(a) - ln_gamma(a + n);
                    score += seen.map(|k| ln_gamma(a_k + k) - ln_gamma(a_k)).sum::<f64>();
                }
            }
        }
        match self.score {
            Score::Bic => score - 0.5 * (r - 1.0) * q * (self.rows as f64).ln(),
            Score::Bdeu(_) => score,
        }
    }
}
