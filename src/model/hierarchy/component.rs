//! Groups whose Gaussians depend on missing values: exact by enumeration of their states.
//!
//! Within one row, groups that are linked by missing values form components. For every assignment
//! of states to a component the values are jointly Gaussian; walking the groups in topological
//! order, each new group extends the Gaussian over the missing values seen so far and is then
//! conditioned on its own observed values. An assignment with its Gaussian is a [`Particle`].
//! The walk is exact while no more than [`MOST`] assignments are alive; beyond, the least probable
//! are dropped.

use super::super::conjugate::Linear;
use super::super::linalg::{LN_2PI, cholesky};
use super::params::{Params, Shape};
use super::structure::{Selector, configuration};

/// Assignments alive at once.
pub(crate) const MOST: usize = 2048;

/// An assignment of states to the groups of a component, with the Gaussian of its missing values.
#[derive(Clone, Debug)]
pub(crate) struct Particle {
    /// `log p(observed values of the component | states)`.
    pub log_density: f64,
    /// States, in the order of [`Component::groups`].
    pub states: Vec<usize>,
    /// Posterior mean of the missing values, in the order of [`Component::missing`].
    pub mean: Vec<f64>,
    /// Their posterior covariance, row-major.
    pub cov: Vec<f64>,
}

/// Groups of one row that missing values link, with their assignments.
#[derive(Clone, Debug)]
pub(crate) struct Component {
    /// Groups, every parent before its children.
    pub groups: Vec<usize>,
    /// Real columns without a value, in order of appearance.
    pub missing: Vec<usize>,
    pub particles: Vec<Particle>,
}

/// What a row's missing values mean for each group.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pattern {
    /// Groups whose u is fully observed.
    pub plain: Vec<usize>,
    /// Linked groups, each list in topological order.
    pub linked: Vec<Vec<usize>>,
    /// Groups without observed values below them: they say nothing about the rest of the row.
    pub barren: Vec<usize>,
}

impl Pattern {
    /// Sorts the groups of a row; `real` has NaN for missing values.
    pub fn of(shape: &Shape, real: &[f64]) -> Self {
        let groups = shape.groups();
        let own = |g: usize| shape.columns[g][shape.p[g] - 1..].iter();
        let mut active = vec![false; groups];
        for &g in shape.order.iter().rev() {
            active[g] = active[g] || own(g).any(|&c| !real[c].is_nan());
            if active[g] {
                for &p in &shape.structure.parents[g] {
                    active[p] = active[p] || own(p).any(|&c| real[c].is_nan());
                }
            }
        }
        let mut pattern = Self::default();
        let mut label: Vec<usize> = (0..groups).collect();
        let gap = |g: usize| shape.columns[g].iter().any(|&c| real[c].is_nan());
        let linked: Vec<usize> = shape
            .order
            .iter()
            .copied()
            .filter(|&g| active[g] && gap(g))
            .collect();
        for &g in &linked {
            for &p in &shape.structure.parents[g] {
                if own(p).any(|&c| real[c].is_nan()) {
                    let (from, to) = (label[p], label[g]);
                    label
                        .iter_mut()
                        .filter(|l| **l == from)
                        .for_each(|l| *l = to);
                }
            }
        }
        for &g in &shape.order {
            if !active[g] {
                pattern.barren.push(g);
            } else if !gap(g) {
                pattern.plain.push(g);
            }
        }
        for &g in &linked {
            match pattern.linked.iter_mut().find(|c| label[c[0]] == label[g]) {
                Some(component) => component.push(g),
                None => pattern.linked.push(vec![g]),
            }
        }
        pattern
    }
}

impl Component {
    /// Enumerates the assignments of `groups` (in topological order) for one row.
    pub fn new(
        shape: &Shape,
        params: &Params,
        groups: &[usize],
        real: &[f64],
        codes: &[u32],
    ) -> Self {
        let mut component = Self {
            groups: groups.to_vec(),
            missing: Vec::new(),
            particles: vec![Particle {
                log_density: 0.0,
                states: Vec::new(),
                mean: Vec::new(),
                cov: Vec::new(),
            }],
        };
        for &g in groups {
            let mut next = Vec::new();
            for particle in &component.particles {
                let states = match &shape.structure.selectors[g] {
                    Selector::Hidden(k) => 0..*k,
                    Selector::Codes(c) => {
                        let s = configuration(c, &shape.sizes, codes);
                        s..s + 1
                    }
                    Selector::Style => match particle.states.first() {
                        Some(&s) => s..s + 1,
                        None => 0..shape.structure.styles,
                    },
                };
                for state in states {
                    let linear = &params.linear[g][state];
                    let columns = &shape.columns[g];
                    let mut p = extend(particle, &component.missing, columns, linear, real);
                    p.states.push(state);
                    next.push(p);
                }
            }
            let own = &shape.columns[g][shape.p[g] - 1..];
            component
                .missing
                .extend(own.iter().filter(|&&c| real[c].is_nan()));
            next.retain(|p| p.log_density > f64::NEG_INFINITY);
            if next.len() > MOST {
                next.sort_by(|a, b| b.log_density.total_cmp(&a.log_density));
                next.truncate(MOST);
            }
            component.particles = next;
        }
        component
    }

    /// P(states of `particle` | s).
    pub fn weight(&self, shape: &Shape, params: &Params, particle: &Particle, s: usize) -> f64 {
        let styles = shape.structure.styles;
        let mut weight = 1.0;
        for (&g, &state) in self.groups.iter().zip(&particle.states) {
            weight *= match shape.structure.selectors[g] {
                Selector::Hidden(_) => params.tables[g][state * styles + s],
                Selector::Style => f64::from(u8::from(state == s)),
                Selector::Codes(_) => 1.0,
            };
        }
        weight
    }
}

/// E[u uᵀ] under `particle`, u = (1, columns), lower triangle added to `scatter` times `weight`;
/// `missing` are the columns the particle's Gaussian is over.
pub(crate) fn add_scatter(
    particle: &Particle,
    missing: &[usize],
    columns: &[usize],
    real: &[f64],
    weight: f64,
    scatter: &mut [f64],
) {
    let q = columns.len() + 1;
    let place: Vec<Option<usize>> = std::iter::once(None)
        .chain(columns.iter().map(|c| missing.iter().position(|m| m == c)))
        .collect();
    let u: Vec<f64> = (0..q)
        .map(|i| match place[i] {
            Some(m) => particle.mean[m],
            None if i == 0 => 1.0,
            None => real[columns[i - 1]],
        })
        .collect();
    let m = missing.len();
    for i in 0..q {
        for j in 0..=i {
            let mut v = u[i] * u[j];
            if let (Some(a), Some(b)) = (place[i], place[j]) {
                v += particle.cov[a * m + b];
            }
            scatter[i * q + j] += weight * v;
        }
    }
}

/// Extends a particle by a group with Gaussian `linear`, conditioned on the group's own values.
pub(crate) fn extend(
    particle: &Particle,
    missing: &[usize],
    columns: &[usize],
    linear: &Linear,
    real: &[f64],
) -> Particle {
    let (m, p, d) = (missing.len(), linear.p, linear.d);
    // Mean of y, and slopes on the values that are still missing.
    let mut mean_y = linear.coefficients[..d].to_vec();
    let mut slopes = vec![0.0; m * d];
    for (i, column) in columns[..p - 1].iter().enumerate() {
        let b = &linear.coefficients[(i + 1) * d..(i + 2) * d];
        let place = missing.iter().position(|c| c == column);
        let x = place.map_or(real[*column], |k| particle.mean[k]);
        for j in 0..d {
            mean_y[j] += b[j] * x;
            if let Some(k) = place {
                slopes[k * d + j] = b[j];
            }
        }
    }
    // cross = C B (m x d), cov_y = Bᵀ C B + Σ.
    let mut cross = vec![0.0; m * d];
    for a in 0..m {
        for k in 0..m {
            let c = particle.cov[a * m + k];
            for j in 0..d {
                cross[a * d + j] += c * slopes[k * d + j];
            }
        }
    }
    let mut cov_y = linear.covariance.clone();
    for a in 0..m {
        for i in 0..d {
            for j in 0..d {
                cov_y[i * d + j] += slopes[a * d + i] * cross[a * d + j];
            }
        }
    }
    let own = &columns[p - 1..];
    let seen: Vec<usize> = (0..d).filter(|&j| !real[own[j]].is_nan()).collect();
    let gone: Vec<usize> = (0..d).filter(|&j| real[own[j]].is_nan()).collect();
    // Joint over the old and the new missing values, then conditioned on the seen ones.
    let t = m + gone.len();
    let mut mean = particle.mean.clone();
    mean.extend(gone.iter().map(|&j| mean_y[j]));
    let mut cov = vec![0.0; t * t];
    for a in 0..t {
        for b in 0..=a {
            let v = match (a < m, b < m) {
                (true, _) => particle.cov[a * m + b],
                (false, true) => cross[b * d + gone[a - m]],
                (false, false) => cov_y[gone[a - m] * d + gone[b - m]],
            };
            cov[a * t + b] = v;
            cov[b * t + a] = v;
        }
    }
    let o = seen.len();
    let mut l = vec![0.0; o * o];
    for (a, &i) in seen.iter().enumerate() {
        for (b, &j) in seen.iter().enumerate() {
            l[a * o + b] = cov_y[i * d + j];
        }
    }
    let mut log_density = particle.log_density;
    if o > 0 && !cholesky(&mut l, o) {
        log_density = f64::NEG_INFINITY;
    } else {
        // Rows: whitened residual, and whitened covariances with each missing value.
        let whiten = |v: &mut [f64]| {
            for i in 0..o {
                let dot: f64 = (0..i).map(|k| l[i * o + k] * v[k]).sum();
                v[i] = (v[i] - dot) / l[i * o + i];
            }
        };
        let mut z: Vec<f64> = seen.iter().map(|&j| real[own[j]] - mean_y[j]).collect();
        whiten(&mut z);
        log_density -= 0.5 * (o as f64 * LN_2PI + z.iter().map(|v| v * v).sum::<f64>());
        log_density -= (0..o).map(|i| l[i * o + i].ln()).sum::<f64>();
        let gains: Vec<Vec<f64>> = (0..t)
            .map(|a| {
                let mut v: Vec<f64> = seen
                    .iter()
                    .map(|&j| {
                        if a < m {
                            cross[a * d + j]
                        } else {
                            cov_y[gone[a - m] * d + j]
                        }
                    })
                    .collect();
                whiten(&mut v);
                v
            })
            .collect();
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        for a in 0..t {
            mean[a] += dot(&gains[a], &z);
            for b in 0..t {
                cov[a * t + b] -= dot(&gains[a], &gains[b]);
            }
        }
    }
    Particle {
        log_density,
        states: particle.states.clone(),
        mean,
        cov,
    }
}
