//! Groups whose Gaussians depend on missing values: exact by enumeration of their states.
//!
//! Within one row, groups that are linked by missing values form components. For every assignment
//! of states to a component the values are jointly Gaussian; walking the groups in topological
//! order, each new group extends the Gaussian over the missing values seen so far and is then
//! conditioned on its own observed values. An assignment with its Gaussian is a [`Particle`].
//! An assignment is given up as soon as a bound says that it ends [`NEGLIGIBLE`] nats below one that is known. The walk is
//! exact (to 1e-10) while no more than [`MOST`] assignments are alive; beyond, the least probable are dropped.

use super::super::conjugate::Linear;
use super::super::gaussian::{Particle, extend};
use super::params::{Params, Shape};
use super::structure::{Selector, configuration};

/// Assignments alive at once.
pub(crate) const MOST: usize = 2048;
/// Assignments this much below a known one (nats) are left out: with [`MOST`] of them, less than 1e-10 of the density.
const NEGLIGIBLE: f64 = 32.0;

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
        let row = Row {
            shape,
            params,
            real,
            codes,
        };
        let mut missing = Vec::new();
        let mut levels = Vec::with_capacity(groups.len());
        for &g in groups {
            levels.push((g, missing.clone()));
            let own = &shape.columns[g][shape.p[g] - 1..];
            missing.extend(own.iter().filter(|&&c| real[c].is_nan()));
        }
        let first = (Particle::empty(), vec![1.0; shape.structure.styles]);
        let least = row.least(&first, &levels);
        let reaches = |(particle, weights): &Weighted, to_come: f64| {
            let most = particle.log_density + to_come;
            let mut styles = weights.iter().zip(&least);
            styles.any(|(w, least)| *w > 0.0 && most + w.ln() >= *least)
        };
        // And no assignment explains what is still to come better than at the peaks of its densities.
        let mut to_come: f64 = groups.iter().map(|&g| row.peak(g)).sum();
        let mut alive = vec![first];
        for (g, missing) in &levels {
            to_come -= row.peak(*g);
            let mut next: Vec<Weighted> = Vec::new();
            for particle in &alive {
                let extensions = row.extensions(particle, *g, missing).into_iter();
                next.extend(extensions.filter(|p| reaches(p, to_come)));
            }
            next.retain(|(p, _)| p.log_density > f64::NEG_INFINITY);
            if next.len() > MOST {
                next.sort_by(|a, b| b.0.log_density.total_cmp(&a.0.log_density));
                next.truncate(MOST);
            }
            alive = next;
        }
        let (particles, weights): (Vec<Particle>, Vec<Vec<f64>>) = alive.into_iter().unzip();
        Self {
            groups: groups.to_vec(),
            missing,
            particles,
            weights: weights.concat(),
        }
    }

    /// `P(states | s) exp(log p(observed values | particle) - most(s))`, particle by particle, and for every style the
    /// greatest log density of its particles, `most(s)`: a style of small densities may be the one that other groups
    /// of the row ask for.
    pub fn by_style(&self, styles: usize) -> (Vec<f64>, Vec<f64>) {
        let mut most = vec![f64::NEG_INFINITY; styles];
        let rows = || self.weights.chunks(styles).zip(&self.particles);
        for (weights, particle) in rows() {
            for (most, _) in most.iter_mut().zip(weights).filter(|(_, w)| **w > 0.0) {
                *most = most.max(particle.log_density);
            }
        }
        let mut densities = self.weights.clone();
        for (row, particle) in densities.chunks_mut(styles).zip(&self.particles) {
            // As a rule all styles have the same greatest one.
            let mut last = (f64::NAN, 0.0);
            for (density, &most) in row.iter_mut().zip(&most).filter(|(w, _)| **w > 0.0) {
                if most != last.0 {
                    last = (most, (particle.log_density - most).exp());
                }
                *density *= last.1;
            }
        }
        (densities, most)
    }
}

/// An assignment with P(its states | s) of every style s.
type Weighted = (Particle, Vec<f64>);

/// A row under a model.
struct Row<'a> {
    shape: &'a Shape,
    params: &'a Params,
    real: &'a [f64],
    codes: &'a [u32],
}

impl Row<'_> {
    /// A particle over `missing` with every state of group `g`, and with the background.
    fn extensions(&self, from: &Weighted, g: usize, missing: &[usize]) -> Vec<Weighted> {
        let (shape, params) = (self.shape, self.params);
        let (particle, weights) = from;
        let styles = shape.structure.styles;
        let states = match &shape.structure.selectors[g] {
            Selector::Hidden(k) => 0..*k,
            Selector::Codes(c) => {
                let s = configuration(c, &shape.sizes, self.codes);
                s..s + 1
            }
            Selector::Style => {
                let mut known = particle.states.iter().filter(|s| **s < styles);
                known.next().map_or(0..styles, |&s| s..s + 1)
            }
        };
        let extended = |linear: &Linear, state: usize| {
            let mut p = extend(particle, missing, &shape.columns[g], linear, self.real);
            p.states.push(state);
            p
        };
        let mut all = Vec::with_capacity(states.len() + 1);
        if let Some(background) = &shape.background {
            // Its density is the same for every state: one particle for all that the row leaves open.
            let selected = match shape.structure.selectors[g] {
                Selector::Codes(_) => states.start,
                _ => 0,
            };
            let weights = weights.iter().map(|w| w * background.share).collect();
            let state = shape.states(g) + selected;
            all.push((extended(&background.linear[g], state), weights));
        }
        for state in states {
            let weights = weighted(shape, params, g, state, weights);
            // A style that an earlier state excludes.
            if weights.iter().any(|w| *w > 0.0) {
                all.push((extended(&params.linear[g][state], state), weights));
            }
        }
        all
    }

    /// For every style, [`NEGLIGIBLE`] nats less than `log P(states | s) p(observed values | states)` of one assignment,
    /// taken greedily: what all together come to at least. Other groups of the row may leave any style alone possible, so
    /// that an assignment is negligible only where it is so for each style by itself.
    fn least(&self, first: &Weighted, levels: &[(usize, Vec<usize>)]) -> Vec<f64> {
        let styles = self.shape.structure.styles;
        let log = |(particle, weights): &Weighted, s: usize| particle.log_density + weights[s].ln();
        // Styles that took the same states so far share their assignment.
        let mut taken = vec![(first.clone(), (0..styles).collect::<Vec<_>>())];
        for (g, missing) in levels {
            let mut next: Vec<(Weighted, Vec<usize>)> = Vec::new();
            for (one, own) in taken {
                let extensions = self.extensions(&one, *g, missing);
                let mut of: Vec<Vec<usize>> = vec![Vec::new(); extensions.len()];
                for s in own {
                    let best = (0..extensions.len())
                        .max_by(|&a, &b| log(&extensions[a], s).total_cmp(&log(&extensions[b], s)));
                    if let Some(best) = best {
                        of[best].push(s);
                    }
                }
                let all = extensions.into_iter().zip(of);
                next.extend(all.filter(|(_, styles)| !styles.is_empty()));
            }
            taken = next;
        }
        let mut least = vec![f64::NEG_INFINITY; styles];
        for (one, own) in &taken {
            for &s in own {
                least[s] = log(one, s) - NEGLIGIBLE;
            }
        }
        least
    }

    /// The greatest log density that any state of group `g` can give to its observed values, whatever its inputs are.
    fn peak(&self, g: usize) -> f64 {
        let own = &self.shape.columns[g][self.shape.p[g] - 1..];
        let seen: Vec<usize> = (0..own.len())
            .filter(|&j| !self.real[own[j]].is_nan())
            .collect();
        let states = self.params.linear[g].iter();
        let background = self.shape.background.iter().map(|b| &b.linear[g]);
        let peaks = states
            .chain(background)
            .map(|linear| linear.log_peak(&seen));
        peaks.fold(f64::NEG_INFINITY, f64::max)
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
