//! Parameters, sufficient statistics, the M step and the Cheeseman-Stutz score.

use super::super::conjugate::{
    Linear, Priors, dirichlet_evidence, dirichlet_log_density, dirichlet_mode,
};
use super::super::error::ModelError;
use super::super::graph;
use super::super::table::MISSING;
use super::background::Background;
use super::schema::Schema;
use super::structure::{Selector, Structure};

/// Assignments alive at once.
pub(crate) const MOST: usize = 2048;
/// The same while structures are searched: their scores differ by far more than what the least probable ones add.
pub(crate) const MOST_SEARCHED: usize = 64;

/// Θ of a hierarchical model.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Params {
    /// P(S = s).
    pub style: Vec<f64>,
    /// Per real group with a hidden variable, P(h | s) at `h * styles + s`; empty for others.
    pub tables: Vec<Vec<f64>>,
    /// Per real group, per state.
    pub linear: Vec<Vec<Linear>>,
    /// Per categorical column, P(c | configuration, s) at `(configuration * size + c) * styles + s`.
    pub codes: Vec<Vec<f64>>,
}

/// Expected sufficient statistics, in the same layouts as [`Params`].
#[derive(Clone, Debug)]
pub(crate) struct Stats {
    pub style: Vec<f64>,
    pub tables: Vec<Vec<f64>>,
    /// Per group, per state, lower triangle of `Σ w u uᵀ`, u = (1, parents, own columns).
    pub scatter: Vec<Vec<Vec<f64>>>,
    pub codes: Vec<Vec<f64>>,
    pub log_likelihood: f64,
}

/// Shapes that follow from a schema and a structure.
#[derive(Clone, Debug)]
pub(crate) struct Shape {
    pub structure: Structure,
    /// Topological order of the real groups.
    pub order: Vec<usize>,
    /// Numbers of categories.
    pub sizes: Vec<usize>,
    /// Per group, columns of an extended row in u after the leading 1: parents' columns, indicators of the categories
    /// that shift it, own columns.
    pub columns: Vec<Vec<usize>>,
    /// Per group, length of x and of y.
    pub p: Vec<usize>,
    pub d: Vec<usize>,
    /// Categorical columns that are parents of something.
    pub regressors: Vec<usize>,
    /// The index at which the indicators of each categorical column start in an extended row, and its length at the
    /// end.
    pub indicators: Vec<usize>,
    /// The distribution of rows that no state explains; `None` without a background.
    pub background: Option<Background>,
    /// Assignments of linked groups that are alive at once in a row with missing values.
    pub alive: usize,
}

impl Shape {
    pub(crate) fn new(schema: &Schema, structure: Structure) -> Result<Self, ModelError> {
        let order = structure.order(&schema.groups)?;
        let names: Vec<String> = schema.codes.iter().map(|c| c.name.clone()).collect();
        graph::order(&structure.code_parents, &names)?;
        let mut columns = Vec::new();
        let (mut p, mut d) = (Vec::new(), Vec::new());
        for g in 0..schema.groups.len() {
            let mut list: Vec<usize> = Vec::new();
            for &parent in &structure.parents[g] {
                list.extend(schema.columns(parent));
            }
            let indicators = schema.indicators();
            for &c in &structure.shifts[g] {
                list.extend(indicators[c]..indicators[c + 1]);
            }
            p.push(1 + list.len());
            d.push(schema.columns(g).len());
            list.extend(schema.columns(g));
            columns.push(list);
        }
        Ok(Self {
            order,
            sizes: schema.sizes(),
            background: Background::new(structure.background, &p, &d),
            columns,
            p,
            d,
            regressors: structure.regressors(),
            indicators: schema.indicators(),
            structure,
            alive: MOST,
        })
    }

    /// The row that linear Gaussians read: `real`, then an indicator of every category, where a category shifts a mean
    /// (1 for the category that the row has; all 0 for a missing one).
    pub(crate) fn extended<'r>(
        &self,
        real: &'r [f64],
        codes: &[u32],
        row: &'r mut Vec<f64>,
    ) -> &'r [f64] {
        if self.structure.shifts.iter().all(Vec::is_empty) {
            return real;
        }
        row.clear();
        row.extend(&real[..self.indicators[0]]);
        row.resize(self.indicators[self.sizes.len()], 0.0);
        for (start, &code) in self.indicators.iter().zip(codes) {
            if code != MISSING {
                row[start + code as usize] = 1.0;
            }
        }
        row
    }

    pub(crate) fn groups(&self) -> usize {
        self.columns.len()
    }

    pub(crate) fn states(&self, g: usize) -> usize {
        self.structure.states(g, &self.sizes)
    }

    pub(crate) fn hidden(&self, g: usize) -> bool {
        matches!(self.structure.selectors[g], Selector::Hidden(_))
    }

    /// The state that a particle means by `state` of group `g`, and true if it is of the background instead (numbers
    /// from [`Self::states`] on; which state is then open but for categories that select it).
    pub(crate) fn read(&self, g: usize, state: usize) -> (usize, bool) {
        let states = self.states(g);
        match state.checked_sub(states) {
            Some(state) => (state, true),
            None => (state, false),
        }
    }

    fn rows_of_table(&self, c: usize) -> usize {
        let parents = &self.structure.code_parents[c];
        parents.iter().map(|&p| self.sizes[p]).product()
    }

    /// All assignments of categories to `columns`, the first slowest.
    pub(crate) fn configurations(&self, columns: &[usize]) -> Vec<Vec<usize>> {
        columns.iter().fold(vec![Vec::new()], |all, &c| {
            let longer =
                |codes: Vec<usize>| (0..self.sizes[c]).map(move |v| [&codes[..], &[v]].concat());
            all.into_iter().flat_map(longer).collect()
        })
    }

    pub(crate) fn stats(&self) -> Stats {
        let s = self.structure.styles;
        let groups = 0..self.groups();
        Stats {
            style: vec![0.0; s],
            tables: groups
                .clone()
                .map(|g| {
                    vec![
                        0.0;
                        if self.hidden(g) {
                            self.states(g) * s
                        } else {
                            0
                        }
                    ]
                })
                .collect(),
            scatter: groups
                .map(|g| vec![vec![0.0; (self.p[g] + self.d[g]).pow(2)]; self.states(g)])
                .collect(),
            codes: (0..self.sizes.len())
                .map(|c| vec![0.0; self.rows_of_table(c) * self.sizes[c] * s])
                .collect(),
            log_likelihood: 0.0,
        }
    }

    /// Parameters of highest expected complete-data posterior.
    pub(crate) fn maximize(&self, stats: &Stats, priors: &Priors) -> Result<Params, ModelError> {
        let s = self.structure.styles;
        let mut linear = Vec::with_capacity(self.groups());
        for (g, states) in stats.scatter.iter().enumerate() {
            let fitted: Option<Vec<Linear>> = states
                .iter()
                .map(|m| priors.linear.mode(m, self.p[g], self.d[g]))
                .collect();
            linear.push(fitted.ok_or_else(|| ModelError::Singular {
                variable: format!("group {g}"),
            })?);
        }
        Ok(Params {
            style: dirichlet_mode(&stats.style, priors.dirichlet),
            tables: (0..self.groups())
                .map(|g| conditional(&stats.tables[g], self.states(g), s, dirichlet_mode, priors))
                .collect(),
            linear,
            codes: (0..self.sizes.len())
                .map(|c| conditional(&stats.codes[c], self.sizes[c], s, dirichlet_mode, priors))
                .collect(),
        })
    }

    /// `log P(Θ)`.
    pub(crate) fn log_prior(&self, params: &Params, priors: &Priors) -> f64 {
        let s = self.structure.styles;
        let alpha = priors.dirichlet;
        let table = |t: &[f64], k: usize| -> f64 {
            columns(t, k, s)
                .map(|c| dirichlet_log_density(&c, alpha))
                .sum()
        };
        let mut total = dirichlet_log_density(&params.style, alpha);
        for g in 0..self.groups() {
            total += table(&params.tables[g], self.states(g));
            total += params.linear[g]
                .iter()
                .map(|l| priors.linear.log_density(l))
                .sum::<f64>();
        }
        for (c, t) in params.codes.iter().enumerate() {
            total += table(t, self.sizes[c]);
        }
        total
    }

    /// Cheeseman-Stutz score (Eq. 2 with a uniform P(G)):
    /// `log P(O* | G) + log P(O | G, Θ) - log P(O* | G, Θ)`, O* given by its expected statistics.
    pub(crate) fn score(&self, params: &Params, stats: &Stats, priors: &Priors) -> Option<f64> {
        let s = self.structure.styles;
        let alpha = priors.dirichlet;
        let table = |counts: &[f64], probabilities: &[f64], k: usize| -> f64 {
            let evidence: f64 = columns(counts, k, s)
                .map(|c| dirichlet_evidence(&c, alpha))
                .sum();
            evidence - plug_in(counts, probabilities)
        };
        let mut total = stats.log_likelihood + dirichlet_evidence(&stats.style, alpha)
            - plug_in(&stats.style, &params.style);
        for g in 0..self.groups() {
            total += table(&stats.tables[g], &params.tables[g], self.states(g));
            for (m, l) in stats.scatter[g].iter().zip(&params.linear[g]) {
                total +=
                    priors.linear.evidence(m, self.p[g], self.d[g])? - l.expected_log_likelihood(m);
            }
        }
        for (c, (counts, probabilities)) in stats.codes.iter().zip(&params.codes).enumerate() {
            total += table(counts, probabilities, self.sizes[c]);
        }
        total.is_finite().then_some(total)
    }

    /// Number of free parameters, for BIC.
    pub(crate) fn free_parameters(&self) -> usize {
        let s = self.structure.styles;
        let mut count = s - 1;
        for g in 0..self.groups() {
            let k = self.states(g);
            if self.hidden(g) {
                count += s * (k - 1);
            }
            // The indicators of a column sum to the leading 1.
            let p = self.p[g] - self.structure.shifts[g].len();
            count += k * (p * self.d[g] + self.d[g] * (self.d[g] + 1) / 2);
        }
        for c in 0..self.sizes.len() {
            count += s * self.rows_of_table(c) * (self.sizes[c] - 1);
        }
        count
    }
}

impl Stats {
    /// Adds the statistics of other rows.
    pub(crate) fn merge(&mut self, other: &Self) {
        add(&mut self.style, &other.style);
        for (a, b) in self.tables.iter_mut().zip(&other.tables) {
            add(a, b);
        }
        for (a, b) in self
            .scatter
            .iter_mut()
            .flatten()
            .zip(other.scatter.iter().flatten())
        {
            add(a, b);
        }
        for (a, b) in self.codes.iter_mut().zip(&other.codes) {
            add(a, b);
        }
        self.log_likelihood += other.log_likelihood;
    }
}

impl Params {
    /// Largest absolute difference of a parameter.
    pub(crate) fn movement(&self, other: &Self) -> f64 {
        let far = |a: &[f64], b: &[f64]| {
            a.iter()
                .zip(b)
                .map(|(x, y)| (x - y).abs())
                .fold(0.0, f64::max)
        };
        let mut most = far(&self.style, &other.style);
        for (a, b) in self.tables.iter().zip(&other.tables) {
            most = most.max(far(a, b));
        }
        for (a, b) in self.codes.iter().zip(&other.codes) {
            most = most.max(far(a, b));
        }
        for (a, b) in self
            .linear
            .iter()
            .flatten()
            .zip(other.linear.iter().flatten())
        {
            most = most.max(far(&a.coefficients, &b.coefficients));
            most = most.max(far(&a.covariance, &b.covariance));
        }
        most
    }
}

fn add(a: &mut [f64], b: &[f64]) {
    for (x, y) in a.iter_mut().zip(b) {
        *x += y;
    }
}

/// The distributions of a table laid out with `styles` fastest: `k` values each.
fn columns(table: &[f64], k: usize, styles: usize) -> impl Iterator<Item = Vec<f64>> + '_ {
    let blocks = if k == 0 {
        0
    } else {
        table.len() / (k * styles)
    };
    (0..blocks).flat_map(move |b| {
        (0..styles).map(move |s| (0..k).map(|h| table[(b * k + h) * styles + s]).collect())
    })
}

fn conditional(
    counts: &[f64],
    k: usize,
    styles: usize,
    mode: impl Fn(&[f64], f64) -> Vec<f64>,
    priors: &Priors,
) -> Vec<f64> {
    let mut table = vec![0.0; counts.len()];
    for (i, column) in columns(counts, k, styles).enumerate() {
        let (b, s) = (i / styles, i % styles);
        for (h, p) in mode(&column, priors.dirichlet).into_iter().enumerate() {
            table[(b * k + h) * styles + s] = p;
        }
    }
    table
}

/// `Σ n log p`, with 0 log 0 = 0.
fn plug_in(counts: &[f64], probabilities: &[f64]) -> f64 {
    counts
        .iter()
        .zip(probabilities)
        .map(|(n, p)| if *n > 0.0 { n * p.ln() } else { 0.0 })
        .sum()
}
