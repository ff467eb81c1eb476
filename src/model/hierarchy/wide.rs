//! Expected statistics of a fit over all columns at once, from which the regression of any group on any parents can be
//! read, and the parameters of a structure with other lateral edges.

use super::super::error::ModelError;
use super::super::table::MISSING;
use super::fit::{Problem, Scored};
use super::infer::{Scratch, joint};
use super::params::Params;
use super::structure::{Selector, configuration};

/// Statistics over all columns.
pub(crate) struct Wide {
    /// True if indicators of categories are among the columns.
    pub categories: bool,
    /// Length of v = (1, all real columns, and indicators of all categories).
    pub side: usize,
    /// Per group, per state, lower triangle of `Σ w v vᵀ`.
    pub scatter: Vec<Vec<Vec<f64>>>,
    /// Number of styles.
    pub styles: usize,
    /// P(s | row), row by row; empty without categories.
    posteriors: Vec<f64>,
}

/// `None` once `goes_on`, which is asked row by row, says no. Rows with missing values enter with their posterior means; a missing category that is no parent, with the shares of
/// its column.
pub(crate) fn wide(
    problem: &Problem,
    scored: &Scored,
    categories: bool,
    goes_on: &dyn Fn() -> bool,
) -> Result<Option<Wide>, ModelError> {
    let shape = &scored.shape;
    let params = &scored.params;
    let (d, styles) = (problem.rows.d, shape.structure.styles);
    let q = match categories {
        true => 1 + shape.indicators[shape.sizes.len()],
        false => 1 + d,
    };
    let mut scatter: Vec<Vec<Vec<f64>>> = (0..shape.groups())
        .map(|g| vec![vec![0.0; q * q]; shape.states(g)])
        .collect();
    let mut posteriors = vec![
        0.0;
        if categories {
            problem.rows.rows * styles
        } else {
            0
        }
    ];
    let shares = if categories {
        shares(problem)
    } else {
        Vec::new()
    };
    let mut scratch = Scratch::new(shape);
    // Entries of v vᵀ that are not zero, with their places.
    let mut outer: Vec<(usize, f64)> = Vec::new();
    let mut support: Vec<usize> = Vec::new();
    let mut v = vec![1.0; q];
    for i in 0..problem.rows.rows {
        if !goes_on() {
            return Ok(None);
        }
        problem.visit(params, i, &mut scratch, |scratch, real, codes, weight| {
            let states = explained(scratch, scored);
            for (v, r) in v[1..].iter_mut().zip(&real[..d]) {
                *v = if r.is_nan() { 0.0 } else { *r };
            }
            for component in &scratch.components {
                let joint = joint(component, &scratch.style);
                for (particle, j) in component.particles.iter().zip(joint.chunks(styles)) {
                    let w: f64 = j.iter().sum();
                    for (&c, m) in component.missing.iter().zip(particle.mean) {
                        v[c + 1] += w * m;
                    }
                }
            }
            support.clear();
            support.extend(0..=d);
            if categories {
                for (c, &code) in codes.iter().enumerate() {
                    let own = shape.indicators[c] + 1..shape.indicators[c + 1] + 1;
                    match code {
                        MISSING => {
                            v[own.clone()]
                                .copy_from_slice(&shares[own.start - d - 1..own.end - d - 1]);
                            support.extend(own);
                        }
                        code => {
                            v[own.start + code as usize] = 1.0;
                            support.push(own.start + code as usize);
                        }
                    }
                }
                let own = &mut posteriors[i * styles..(i + 1) * styles];
                for (p, r) in own.iter_mut().zip(&scratch.style) {
                    *p += weight * r;
                }
            }
            outer.clear();
            for (at, &a) in support.iter().enumerate() {
                outer.extend(support[..=at].iter().map(|&b| (a * q + b, v[a] * v[b])));
            }
            for (g, r) in states {
                for (m, r) in scatter[g].iter_mut().zip(r) {
                    let r = r * weight;
                    if r > 1e-6 {
                        for &(at, o) in &outer {
                            m[at] += r * o;
                        }
                    }
                }
            }
        })?;
    }
    Ok(Some(Wide {
        categories,
        side: q,
        scatter,
        styles,
        posteriors,
    }))
}

/// Share of every category among the rows that have one, column by column.
fn shares(problem: &Problem) -> Vec<f64> {
    let (rows, shape) = (problem.rows, &problem.shape);
    let mut all = Vec::new();
    for (c, &size) in shape.sizes.iter().enumerate() {
        let mut counts = vec![0.0; size];
        for code in (0..rows.rows).map(|i| rows.code(i)[c]) {
            if code != MISSING {
                counts[code as usize] += 1.0;
            }
        }
        let total: f64 = counts.iter().sum();
        all.extend(counts.into_iter().map(|n| n / total.max(1.0)));
    }
    all
}

impl Wide {
    /// Expected counts of a categorical column given `parents` and the style, in the layout of
    /// [`super::params::Stats::codes`]; rows that lack one of them are left out.
    pub(crate) fn counts(&self, problem: &Problem, c: usize, parents: &[usize]) -> Vec<f64> {
        let sizes = &problem.shape.sizes;
        let configurations: usize = parents.iter().map(|&p| sizes[p]).product();
        let mut counts = vec![0.0; configurations * sizes[c] * self.styles];
        for i in 0..problem.rows.rows {
            let codes = problem.rows.code(i);
            if codes[c] == MISSING || parents.iter().any(|&p| codes[p] == MISSING) {
                continue;
            }
            let at = configuration(parents, sizes, codes) * sizes[c] + codes[c] as usize;
            let own = &mut counts[at * self.styles..(at + 1) * self.styles];
            for (n, r) in own.iter_mut().zip(&self.posteriors[i * self.styles..]) {
                *n += r;
            }
        }
        counts
    }
}

/// P(state | row) of every group that the row says something about. Of a background that categories do not select, P(state)
/// is that given the style.
pub(crate) fn states(scratch: &Scratch, scored: &Scored) -> Vec<(usize, Vec<f64>)> {
    posteriors(scratch, scored, true)
}

/// P(state, and the row is not of the background | row): with what weight the row says something of a regression.
pub(crate) fn explained(scratch: &Scratch, scored: &Scored) -> Vec<(usize, Vec<f64>)> {
    posteriors(scratch, scored, false)
}

fn posteriors(scratch: &Scratch, scored: &Scored, with_background: bool) -> Vec<(usize, Vec<f64>)> {
    let shape = &scored.shape;
    let params = &scored.params;
    let styles = shape.structure.styles;
    let mut all = Vec::with_capacity(shape.groups());
    for &g in &scratch.pattern.plain {
        let mut r = match shape.structure.selectors[g] {
            Selector::Style => scratch.style.clone(),
            Selector::Codes(_) => scratch.dens[g].clone(),
            Selector::Hidden(k) => (0..k)
                .map(|h| {
                    let row = &params.tables[g][h * styles..(h + 1) * styles];
                    let messages = scratch.messages[g].iter().zip(&scratch.style);
                    let sum: f64 = row.iter().zip(messages).map(|(p, (m, r))| p * r / m).sum();
                    scratch.dens[g][h] * sum
                })
                .collect(),
        };
        if !with_background {
            r.iter_mut()
                .zip(&scratch.own[g])
                .for_each(|(r, own)| *r *= own);
        }
        all.push((g, r));
    }
    for component in &scratch.components {
        let joint = joint(component, &scratch.style);
        for (at, &g) in component.groups.iter().enumerate() {
            let mut r = vec![0.0; shape.states(g)];
            for (particle, j) in component.particles.iter().zip(joint.chunks(styles)) {
                match shape.read(g, particle.states[at]) {
                    (state, false) => r[state] += j.iter().sum::<f64>(),
                    _ if !with_background => {}
                    (state, true) => match shape.structure.selectors[g] {
                        Selector::Codes(_) => r[state] += j.iter().sum::<f64>(),
                        Selector::Style => r.iter_mut().zip(j).for_each(|(r, j)| *r += j),
                        Selector::Hidden(_) => {
                            for (r, table) in r.iter_mut().zip(params.tables[g].chunks(styles)) {
                                *r += table.iter().zip(j).map(|(p, j)| p * j).sum::<f64>();
                            }
                        }
                    },
                }
            }
            all.push((g, r));
        }
    }
    all
}

impl Problem<'_> {
    /// Parameters for this structure from the posteriors of the hidden variables in `scored`,
    /// which differs in lateral edges only: one M step of structural EM (Friedman 1998).
    pub(crate) fn reparent(&self, scored: &Scored, wide: &Wide) -> Result<Params, ModelError> {
        let q = wide.side;
        let mut stats = scored.stats.clone();
        for (g, states) in wide.scatter.iter().enumerate() {
            let index: Vec<usize> = std::iter::once(0)
                .chain(self.shape.columns[g].iter().map(|c| c + 1))
                .collect();
            let n = index.len();
            stats.scatter[g] = states
                .iter()
                .map(|m| {
                    let mut sub = vec![0.0; n * n];
                    for (a, &i) in index.iter().enumerate() {
                        for (b, &j) in index[..=a].iter().enumerate() {
                            sub[a * n + b] = m[i.max(j) * q + i.min(j)];
                        }
                    }
                    sub
                })
                .collect();
        }
        let before = &scored.shape.structure.code_parents;
        for (c, parents) in self.shape.structure.code_parents.iter().enumerate() {
            if parents != &before[c] {
                stats.codes[c] = wide.counts(self, c, parents);
            }
        }
        self.shape.maximize(&stats, self.priors)
    }
}
