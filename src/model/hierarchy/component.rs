//! Groups whose Gaussians depend on missing values: exact by enumeration of their states.
//!
//! Within one row, groups that are linked by missing values form components. For every assignment
//! of states to a component the values are jointly Gaussian; walking the groups in topological
//! order, each new group extends the Gaussian over the missing values seen so far and is then
//! conditioned on its own observed values. An assignment with its Gaussian is a [`Particle`].
//! The walk is exact while no more than [`MOST`] assignments are alive; beyond, the least probable
//! are dropped.

use super::super::conjugate::Linear;
use super::super::gaussian::{Particle, extend};
use super::params::{Params, Shape};
use super::structure::{Selector, configuration};

/// Assignments alive at once.
pub(crate) const MOST: usize = 2048;

/// Groups of one row that missing values link, with their assignments.
#[derive(Clone, Debug)]
pub(crate) struct Component {
    /// Groups, every parent before its children.
    pub groups: Vec<usize>,
    /// Real columns without a value, in order of appearance.
    pub missing: Vec<usize>,
    pub particles: Vec<Particle>,
    /// P(states of a particle | s), particle by particle.
    pub weights: Vec<f64>,
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
        let styles = shape.structure.styles;
        let mut component = Self {
            groups: groups.to_vec(),
            missing: Vec::new(),
            particles: Vec::new(),
            weights: Vec::new(),
        };
        let mut alive = vec![(Particle::empty(), vec![1.0; styles])];
        for &g in groups {
            let mut next: Vec<(Particle, Vec<f64>)> = Vec::new();
            for (particle, weights) in &alive {
                let states = match &shape.structure.selectors[g] {
                    Selector::Hidden(k) => 0..*k,
                    Selector::Codes(c) => {
                        let s = configuration(c, &shape.sizes, codes);
                        s..s + 1
                    }
                    Selector::Style => {
                        let mut known = particle.states.iter().filter(|s| **s < styles);
                        known.next().map_or(0..styles, |&s| s..s + 1)
                    }
                };
                let extended = |linear: &Linear, state: usize| {
                    let columns = &shape.columns[g];
                    let mut p = extend(particle, &component.missing, columns, linear, real);
                    p.states.push(state);
                    p
                };
                if let Some(background) = &shape.background {
                    // Its density is the same for every state: one particle for all that the row leaves open.
                    let selected = match shape.structure.selectors[g] {
                        Selector::Codes(_) => states.start,
                        _ => 0,
                    };
                    let weights = weights.iter().map(|w| w * background.share).collect();
                    let state = shape.states(g) + selected;
                    next.push((extended(&background.linear[g], state), weights));
                }
                for state in states {
                    let linear = &params.linear[g][state];
                    let weights = weighted(shape, params, g, state, weights);
                    next.push((extended(linear, state), weights));
                }
            }
            let own = &shape.columns[g][shape.p[g] - 1..];
            component
                .missing
                .extend(own.iter().filter(|&&c| real[c].is_nan()));
            next.retain(|(p, _)| p.log_density > f64::NEG_INFINITY);
            if next.len() > MOST {
                next.sort_by(|a, b| b.0.log_density.total_cmp(&a.0.log_density));
                next.truncate(MOST);
            }
            alive = next;
        }
        for (particle, weights) in alive {
            component.particles.push(particle);
            component.weights.extend(weights);
        }
        component
    }

    /// `exp(log p(observed values | particle) - most)` of every particle, and the greatest, most.
    pub fn densities(&self) -> (Vec<f64>, f64) {
        let logs = self.particles.iter().map(|p| p.log_density);
        let most = logs.clone().fold(f64::NEG_INFINITY, f64::max);
        (logs.map(|l| (l - most).exp()).collect(), most)
    }
}

/// `weights` (by style) times P(H_g = state, not the background | s).
fn weighted(shape: &Shape, params: &Params, g: usize, state: usize, weights: &[f64]) -> Vec<f64> {
    let styles = shape.structure.styles;
    let mut out = weights.to_vec();
    match shape.structure.selectors[g] {
        Selector::Hidden(_) => {
            let row = &params.tables[g][state * styles..(state + 1) * styles];
            out.iter_mut().zip(row).for_each(|(w, p)| *w *= p);
        }
        Selector::Style => {
            let others = out.iter_mut().enumerate().filter(|(s, _)| *s != state);
            others.for_each(|(_, w)| *w = 0.0);
        }
        Selector::Codes(_) => {}
    }
    if let Some(background) = &shape.background {
        out.iter_mut().for_each(|w| *w *= 1.0 - background.share);
    }
    out
}
