//! EM for a fixed structure, and starts for it.

use rand::Rng;

use super::super::chunks;
use super::super::em::{Em, Fit, Outcome, Stopping, run_kept};
use super::super::error::ModelError;
use super::super::graph;
use super::super::table::MISSING;
use super::Priors;
use super::infer::{Scratch, assignments};
use super::params::{Params, Shape, Stats};
use super::schema::{Rows, Schema};
use super::structure::{Selector, Structure, configuration};
use edifice_cluster::kmeans_unweighted;

/// Rows of one parallel piece of work.
const CHUNK: usize = 512;
/// Rows that a start looks at.
const SAMPLE: usize = 10_000;

/// A structure to be fitted to rows: the [`Em`] of hierarchical models.
pub(crate) struct Problem<'a> {
    pub schema: &'a Schema,
    pub rows: &'a Rows,
    pub priors: &'a Priors,
    pub shape: Shape,
    /// Asked within an E step, which ends where it says no; never asked unless set.
    pub within: Option<&'a (dyn Fn() -> bool + Sync)>,
}

/// A fitted structure and its score.
#[derive(Clone, Debug)]
pub(crate) struct Scored {
    pub shape: Shape,
    pub params: Params,
    pub stats: Stats,
    pub score: f64,
}

impl<'a> Problem<'a> {
    pub(crate) fn new(
        schema: &'a Schema,
        rows: &'a Rows,
        priors: &'a Priors,
        structure: Structure,
    ) -> Result<Self, ModelError> {
        Ok(Self {
            schema,
            rows,
            priors,
            shape: Shape::new(schema, structure)?,
            within: None,
        })
    }

    /// Calls `visit` with every completion of row `i` (extended real values, codes), already inferred, and its
    /// probability given the row; returns `log p(row)`.
    pub(crate) fn visit(
        &self,
        params: &Params,
        i: usize,
        scratch: &mut Scratch,
        mut visit: impl FnMut(&mut Scratch, &[f64], &[u32], f64),
    ) -> Result<f64, ModelError> {
        let (real, codes) = (self.rows.real(i), self.rows.code(i));
        let shape = &self.shape;
        let mut row = Vec::new();
        let contradiction = || ModelError::Contradiction {
            row: Some(i),
            variable: self.culprit(params, i),
        };
        if shape.regressors.iter().all(|&c| codes[c] != MISSING) {
            let real = shape.extended(real, codes, &mut row);
            scratch.infer(shape, params, real, codes);
            if !scratch.log_likelihood.is_finite() {
                return Err(contradiction());
            }
            let l = scratch.log_likelihood;
            visit(scratch, real, codes, 1.0);
            return Ok(l);
        }
        let all = assignments(shape, |c| self.schema.codes[c].name.clone(), codes)?;
        let logs: Vec<f64> = all
            .iter()
            .map(|a| {
                scratch.infer(shape, params, shape.extended(real, a, &mut row), a);
                scratch.log_likelihood
            })
            .collect();
        let total = super::super::linalg::log_sum_exp(&logs);
        if !total.is_finite() {
            return Err(contradiction());
        }
        for (a, l) in all.iter().zip(&logs) {
            let weight = (l - total).exp();
            if weight > 1e-15 {
                let real = shape.extended(real, a, &mut row);
                scratch.infer(shape, params, real, a);
                visit(scratch, real, a, weight);
            }
        }
        Ok(total)
    }

    /// The first variable at which the evidence of a row becomes impossible or overflows.
    fn culprit(&self, params: &Params, i: usize) -> String {
        let whole = "the row as a whole".to_owned();
        let known = self.rows.code(i);
        let parents = &self.shape.structure.code_parents;
        let columns = self.shape.regressors.iter();
        if columns.copied().any(|c| known[c] == MISSING) {
            return whole;
        }
        let names: Vec<String> = self.schema.codes.iter().map(|c| c.name.clone()).collect();
        let Ok(order) = graph::order(parents, &names) else {
            return whole;
        };
        let mut row = Vec::new();
        let mut real = vec![f64::NAN; self.rows.d];
        let mut codes = vec![MISSING; self.rows.c];
        let mut scratch = Scratch::new(&self.shape);
        for c in order {
            codes[c] = known[c];
            let real = self.shape.extended(&real, &codes, &mut row);
            scratch.infer(&self.shape, params, real, &codes);
            if !scratch.log_likelihood.is_finite() {
                return names[c].clone();
            }
        }
        for (c, column) in self.schema.reals.iter().enumerate() {
            real[c] = self.rows.real(i)[c];
            let real = self.shape.extended(&real, &codes, &mut row);
            scratch.infer(&self.shape, params, real, &codes);
            if !scratch.log_likelihood.is_finite() {
                return column.name.clone();
            }
        }
        whole
    }

    /// EM as long as `goes_on`, then the Cheeseman-Stutz score.
    pub(crate) fn fit_while(
        &self,
        start: Params,
        stopping: &Stopping,
        goes_on: &dyn Fn() -> bool,
    ) -> Result<Scored, ModelError> {
        Ok(self.fit_told(start, stopping, goes_on)?.0)
    }

    /// As [`Self::fit_while`], and why EM ended.
    pub(crate) fn fit_told(
        &self,
        start: Params,
        stopping: &Stopping,
        goes_on: &dyn Fn() -> bool,
    ) -> Result<(Scored, Outcome), ModelError> {
        let (Fit { model, outcome, .. }, stats) = run_kept(self, start, stopping, goes_on)?;
        Ok((self.with_score(model, stats)?, outcome))
    }

    /// The score at given parameters and their statistics.
    fn with_score(&self, params: Params, stats: Stats) -> Result<Scored, ModelError> {
        let score = self
            .shape
            .score(&params, &stats, self.priors)
            .ok_or_else(|| ModelError::Singular {
                variable: "the model".to_owned(),
            })?;
        Ok(Scored {
            shape: self.shape.clone(),
            params,
            stats,
            score,
        })
    }

    /// Parameters from hard assignments: style, and state per group, of the given rows.
    pub(crate) fn assigned(
        &self,
        rows: &[usize],
        styles: &[usize],
        states: &[Vec<usize>],
    ) -> Result<Params, ModelError> {
        let shape = &self.shape;
        let s_count = shape.structure.styles;
        let mut stats = shape.stats();
        let mut extended = Vec::new();
        for (i, (&row, &s)) in rows.iter().zip(styles).enumerate() {
            let codes = self.rows.code(row);
            let real = shape.extended(self.rows.real(row), codes, &mut extended);
            stats.style[s] += 1.0;
            for (c, &code) in codes.iter().enumerate().filter(|(_, v)| **v != MISSING) {
                let parents = &shape.structure.code_parents[c];
                if parents.iter().all(|&p| codes[p] != MISSING) {
                    let k = configuration(parents, &shape.sizes, codes) * shape.sizes[c];
                    stats.codes[c][(k + code as usize) * s_count + s] += 1.0;
                }
            }
            for (g, columns) in shape.columns.iter().enumerate() {
                let h = match &shape.structure.selectors[g] {
                    Selector::Hidden(_) => {
                        stats.tables[g][states[g][i] * s_count + s] += 1.0;
                        states[g][i]
                    }
                    Selector::Style => s,
                    Selector::Codes(c) if c.iter().all(|&c| codes[c] != MISSING) => {
                        configuration(c, &shape.sizes, codes)
                    }
                    Selector::Codes(_) => continue,
                };
                add_filled(&mut stats.scatter[g][h], columns, real);
            }
        }
        shape.maximize(&stats, self.priors)
    }

    /// A start from k-means++ clusters: of whole rows for S, of each group for its hidden variable.
    /// Many rows are represented by a systematic sample.
    pub(crate) fn start<R: Rng>(&self, rng: &mut R) -> Result<Params, ModelError> {
        let n = self.rows.rows;
        let rows: Vec<usize> = (0..n).step_by(n.div_ceil(SAMPLE).max(1)).collect();
        let all: Vec<usize> = (0..self.rows.d).collect();
        let styles = self.cluster(&rows, &all, true, self.shape.structure.styles, rng);
        let states: Vec<Vec<usize>> = (0..self.shape.groups())
            .map(|g| match self.shape.structure.selectors[g] {
                Selector::Hidden(k) => {
                    let own: Vec<usize> = self.schema.columns(g).collect();
                    self.cluster(&rows, &own, false, k, rng)
                }
                _ => Vec::new(),
            })
            .collect();
        self.assigned(&rows, &styles, &states)
    }

    /// k-means++ and a few Lloyd rounds over the standardised real columns `reals` (0 for missing),
    /// and the categories as indicators.
    fn cluster<R: Rng>(
        &self,
        rows: &[usize],
        reals: &[usize],
        codes: bool,
        k: usize,
        rng: &mut R,
    ) -> Vec<usize> {
        if k <= 1 {
            return vec![0; rows.len()];
        }
        let indicators: usize = self.shape.sizes.iter().sum();
        let width = reals.len() + if codes { indicators } else { 0 };
        let mut points = vec![0.0; rows.len() * width];
        for (point, &i) in points.chunks_mut(width.max(1)).zip(rows) {
            let real = self.rows.real(i);
            for (p, &c) in point.iter_mut().zip(reals) {
                *p = if real[c].is_nan() { 0.0 } else { real[c] };
            }
            if codes {
                let mut at = reals.len();
                for (&code, &size) in self.rows.code(i).iter().zip(&self.shape.sizes) {
                    if code != MISSING {
                        point[at + code as usize] = 1.0;
                    }
                    at += size;
                }
            }
        }
        kmeans_unweighted(&points, width, k, 8, rng).labels
    }
}

impl Em for Problem<'_> {
    type Model = Params;
    type Stats = Stats;

    fn expect(&self, params: &Params) -> Result<(Stats, f64), ModelError> {
        let stats = chunks::fold(
            self.rows.rows,
            CHUNK,
            |range| {
                if self.within.is_some_and(|goes_on| !goes_on()) {
                    return Err(ModelError::Interrupted);
                }
                let mut stats = self.shape.stats();
                let mut scratch = Scratch::new(&self.shape);
                for i in range {
                    let l =
                        self.visit(params, i, &mut scratch, |scratch, real, codes, weight| {
                            scratch.accumulate(
                                &self.shape,
                                params,
                                real,
                                codes,
                                weight,
                                &mut stats,
                            );
                        })?;
                    stats.log_likelihood += l;
                }
                Ok(stats)
            },
            |total, part| total.merge(&part),
        )?;
        let log_likelihood = stats.log_likelihood;
        Ok((stats, log_likelihood))
    }

    fn maximize(&self, stats: &Stats) -> Result<Params, ModelError> {
        self.shape.maximize(stats, self.priors)
    }

    fn log_prior(&self, params: &Params) -> f64 {
        self.shape.log_prior(params, self.priors)
    }

    fn movement(&self, before: &Params, after: &Params) -> f64 {
        before.movement(after)
    }
}

/// Adds u uᵀ to a lower triangle; a missing value counts as the overall mean 0 with variance 1.
fn add_filled(scatter: &mut [f64], columns: &[usize], real: &[f64]) {
    let q = columns.len() + 1;
    let u = |i: usize| match i {
        0 => 1.0,
        i if real[columns[i - 1]].is_nan() => 0.0,
        i => real[columns[i - 1]],
    };
    for i in 0..q {
        for j in 0..=i {
            scatter[i * q + j] += u(i) * u(j);
        }
        if i > 0 && real[columns[i - 1]].is_nan() {
            scatter[i * q + i] += 1.0;
        }
    }
}
