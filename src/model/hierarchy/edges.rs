//! Lateral edges: greedy and acyclic, from the expected statistics of the current fit.
//!
//! With the hidden variables' posteriors held (O* of Eq. 2), the score of a structure is a sum
//! over groups, and an edge changes the term of its child only: the closed-form evidence of the
//! child's regression, summed over its states. All candidates are therefore read off one scatter
//! matrix over all real columns per state. The structure so proposed is fitted by EM and kept only
//! if its Cheeseman-Stutz score is higher.

use super::super::error::ModelError;
use super::fit::{Problem, Scored};
use super::infer::{Scratch, joint};
use super::structure::{Selector, Structure};

/// Per group, per state, lower triangle of `Σ w v vᵀ`, v = (1, all real columns).
pub(crate) type Wide = Vec<Vec<Vec<f64>>>;

/// The structure with lateral edges found greedily from nothing, all else as in `scored`.
pub(crate) fn propose(
    problem: &Problem,
    scored: &Scored,
    wide: &Wide,
    max_parents: usize,
) -> Structure {
    let schema = problem.schema;
    let groups = schema.groups.len();
    let q = problem.rows.d + 1;
    let evidence = |g: usize, parents: &[usize]| -> f64 {
        let mut index = vec![0];
        for &p in parents {
            index.extend(schema.columns(p).map(|c| c + 1));
        }
        let p = index.len();
        index.extend(schema.columns(g).map(|c| c + 1));
        let n = index.len();
        let mut sub = vec![0.0; n * n];
        wide[g]
            .iter()
            .map(|m| {
                for (a, &i) in index.iter().enumerate() {
                    for (b, &j) in index[..=a].iter().enumerate() {
                        sub[a * n + b] = m[i.max(j) * q + i.min(j)];
                    }
                }
                problem
                    .priors
                    .linear
                    .evidence(&sub, p, n - p)
                    .unwrap_or(f64::NEG_INFINITY)
            })
            .sum()
    };
    let mut structure = scored.shape.structure.clone();
    structure.parents = vec![Vec::new(); groups];
    let with = |parents: &[usize], p: usize| {
        let mut list = parents.to_vec();
        list.push(p);
        list.sort_unstable();
        list
    };
    let mut now: Vec<f64> = (0..groups).map(|g| evidence(g, &[])).collect();
    let gains_of = |g: usize, parents: &[usize], now: f64| -> Vec<f64> {
        (0..groups)
            .map(|p| {
                if p == g || parents.contains(&p) || parents.len() >= max_parents {
                    f64::NEG_INFINITY
                } else {
                    evidence(g, &with(parents, p)) - now
                }
            })
            .collect()
    };
    let mut gains: Vec<Vec<f64>> = (0..groups).map(|g| gains_of(g, &[], now[g])).collect();
    loop {
        let best = (0..groups)
            .flat_map(|g| (0..groups).map(move |p| (g, p)))
            .filter(|&(g, p)| gains[g][p] > 0.0 && !structure.reaches(g, p))
            .max_by(|a, b| gains[a.0][a.1].total_cmp(&gains[b.0][b.1]));
        let Some((g, p)) = best else {
            return structure;
        };
        structure.parents[g] = with(&structure.parents[g], p);
        now[g] += gains[g][p];
        gains[g] = gains_of(g, &structure.parents[g], now[g]);
    }
}

/// Rows with missing values enter with their posterior means.
pub(crate) fn wide(problem: &Problem, scored: &Scored) -> Result<Wide, ModelError> {
    let shape = &scored.shape;
    let params = &scored.params;
    let q = problem.rows.d + 1;
    let mut wide: Wide = (0..shape.groups())
        .map(|g| vec![vec![0.0; q * q]; shape.states(g)])
        .collect();
    let mut scratch = Scratch::new(shape);
    let mut outer = vec![0.0; q * q];
    let mut v = vec![1.0; q];
    for i in 0..problem.rows.rows {
        let real = problem.rows.real(i);
        problem.visit(params, i, &mut scratch, |scratch, _, weight| {
            let states = states(scratch, scored);
            for (v, r) in v[1..].iter_mut().zip(real) {
                *v = if r.is_nan() { 0.0 } else { *r };
            }
            for component in &scratch.components {
                for (particle, j) in
                    component
                        .particles
                        .iter()
                        .zip(joint(component, shape, params, &scratch.style))
                {
                    let w: f64 = j.iter().sum();
                    for (&c, m) in component.missing.iter().zip(&particle.mean) {
                        v[c + 1] += w * m;
                    }
                }
            }
            for a in 0..q {
                for b in 0..=a {
                    outer[a * q + b] = v[a] * v[b];
                }
            }
            for (g, r) in states {
                for (m, r) in wide[g].iter_mut().zip(r) {
                    let r = r * weight;
                    if r > 1e-6 {
                        for (m, o) in m.iter_mut().zip(&outer) {
                            *m += r * o;
                        }
                    }
                }
            }
        })?;
    }
    Ok(wide)
}

/// P(state | row) of every group that the row says something about.
pub(crate) fn states(scratch: &Scratch, scored: &Scored) -> Vec<(usize, Vec<f64>)> {
    let shape = &scored.shape;
    let params = &scored.params;
    let styles = shape.structure.styles;
    let mut all = Vec::with_capacity(shape.groups());
    for &g in &scratch.pattern.plain {
        let r = match shape.structure.selectors[g] {
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
        all.push((g, r));
    }
    for component in &scratch.components {
        let joint = joint(component, shape, params, &scratch.style);
        for (at, &g) in component.groups.iter().enumerate() {
            let mut r = vec![0.0; shape.states(g)];
            for (particle, j) in component.particles.iter().zip(&joint) {
                r[particle.states[at]] += j.iter().sum::<f64>();
            }
            all.push((g, r));
        }
    }
    all
}

impl Problem<'_> {
    /// Parameters for this structure from the posteriors of the hidden variables in `scored`,
    /// which differs in lateral edges only: one M step of structural EM (Friedman 1998).
    pub(crate) fn reparent(
        &self,
        scored: &Scored,
        wide: &Wide,
    ) -> Result<super::params::Params, ModelError> {
        let q = self.rows.d + 1;
        let mut stats = scored.stats.clone();
        for (g, states) in wide.iter().enumerate() {
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
        self.shape.maximize(&stats, self.priors)
    }
}
