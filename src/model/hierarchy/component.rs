//! Groups whose Gaussians depend on missing values: exact by enumeration of their states.
//!
//! Within one row, groups that are linked by missing values form components. For every assignment
//! of states to a component the values are jointly Gaussian; walking the groups in topological
//! order, each new group extends the Gaussian over the missing values seen so far and is then
//! conditioned on its own observed values. An assignment with its Gaussian is a [`Particle`]; all of them lie in one piece of memory.
//! An assignment is given up as soon as a bound says that it ends [`NEGLIGIBLE`] nats below one that is known. The walk is
//! exact (to 1e-10) while no more than [`MOST`](super::params::MOST) assignments are alive; beyond, the least probable are dropped. While structures are
//! searched no more than [`MOST_SEARCHED`](super::params::MOST_SEARCHED) are kept; the structure that is found is fitted with all.

use super::super::conjugate::Linear;
use super::super::gaussian::{Extension, Particle, Particles, Workspace};
use super::params::{Params, Shape};
use super::structure::{Selector, configuration};

/// Assignments this much below a known one (nats) are left out: with [`MOST`](super::params::MOST) of them, less than 1e-10 of the density.
const NEGLIGIBLE: f64 = 32.0;

/// Groups of one row that missing values link, with their assignments.
#[derive(Clone, Debug)]
pub(crate) struct Component {
    /// Groups, every parent before its children.
    pub groups: Vec<usize>,
    /// Real columns without a value, in order of appearance.
    pub missing: Vec<usize>,
    pub particles: Particles,
    /// P(states of a particle | s), particle by particle.
    pub weights: Vec<f64>,
}

/// The groups of a row, sorted by the place of its missing values.
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
    pub(crate) fn of(shape: &Shape, real: &[f64]) -> Self {
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
    pub(crate) fn new(
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
            let extension = Extension::new(&missing, &shape.columns[g], shape.d[g], real);
            levels.push((g, extension));
            let own = &shape.columns[g][shape.p[g] - 1..];
            missing.extend(own.iter().filter(|&&c| real[c].is_nan()));
        }
        let mut work = Workspace::default();
        let least = row.least(&levels, &mut work);
        let reaches = |density: f64, weights: &[f64], to_come: f64| {
            let most = density + to_come;
            let mut styles = weights.iter().zip(&least);
            density > f64::NEG_INFINITY
                && styles.any(|(w, least)| *w > 0.0 && most + w.ln() >= *least)
        };
        // And no assignment explains what is still to come better than at the peaks of its densities.
        let mut to_come: f64 = groups.iter().map(|&g| row.peak(g)).sum();
        let mut alive = Front::start(shape.structure.styles);
        for level in &levels {
            to_come -= row.peak(level.0);
            let mut next = alive.after(&level.1);
            for (particle, weights) in alive.iter() {
                let kept = |density: f64, weights: &[f64]| reaches(density, weights, to_come);
                row.extend((particle, weights), level, &mut work, &mut next, kept);
            }
            alive = next.most_probable(shape.alive);
        }
        Self {
            groups: groups.to_vec(),
            missing,
            particles: alive.particles,
            weights: alive.weights,
        }
    }

    /// `P(states | s) exp(log p(observed values | particle) - most(s))`, particle by particle, and for every style the
    /// greatest log density of its particles, `most(s)`: a style of small densities may be the one that other groups
    /// of the row ask for.
    pub(crate) fn by_style(&self, styles: usize) -> (Vec<f64>, Vec<f64>) {
        let mut most = vec![f64::NEG_INFINITY; styles];
        let rows = || self.weights.chunks(styles).zip(self.particles.iter());
        for (weights, particle) in rows() {
            for (most, _) in most.iter_mut().zip(weights).filter(|(_, w)| **w > 0.0) {
                *most = most.max(particle.log_density);
            }
        }
        let mut densities = self.weights.clone();
        for (row, particle) in densities.chunks_mut(styles).zip(self.particles.iter()) {
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

/// Particles with P(their states | s) of every style s.
struct Front {
    particles: Particles,
    styles: usize,
    weights: Vec<f64>,
}

impl Front {
    fn start(styles: usize) -> Self {
        Self {
            particles: Particles::start(),
            styles,
            weights: vec![1.0; styles],
        }
    }

    fn get(&self, i: usize) -> (Particle<'_>, &[f64]) {
        let weights = &self.weights[i * self.styles..(i + 1) * self.styles];
        (self.particles.get(i), weights)
    }

    fn iter(&self) -> impl Iterator<Item = (Particle<'_>, &[f64])> {
        (0..self.particles.len()).map(|i| self.get(i))
    }

    /// An empty list over one group more.
    fn after(&self, extension: &Extension) -> Self {
        Self {
            particles: self.particles.after(extension),
            styles: self.styles,
            weights: Vec::new(),
        }
    }

    /// The extended particle whose weights were appended already stays if a style is left that an earlier state does not
    /// exclude, and if `kept` holds.
    fn finish(
        &mut self,
        from: Particle,
        extension: &Extension,
        linear: &Linear,
        state: usize,
        work: &mut Workspace,
        kept: &impl Fn(f64, &[f64]) -> bool,
    ) {
        let first = self.particles.len() * self.styles;
        let own = &self.weights[first..];
        if own.iter().any(|w| *w > 0.0) && kept(extension.density(from, linear, work), own) {
            extension.append(from, Some(state), work, &mut self.particles);
        } else {
            self.weights.truncate(first);
        }
    }

    /// A copy of the chosen particles.
    fn some(&self, chosen: &[usize]) -> Self {
        let mut some = Self {
            particles: self.particles.like(),
            styles: self.styles,
            weights: Vec::with_capacity(chosen.len() * self.styles),
        };
        for &i in chosen {
            let (particle, weights) = self.get(i);
            some.particles.push(particle);
            some.weights.extend(weights);
        }
        some
    }

    /// The `most` of greatest density.
    fn most_probable(self, most: usize) -> Self {
        if self.particles.len() <= most {
            return self;
        }
        let density = |i: usize| self.particles.get(i).log_density;
        let mut order: Vec<usize> = (0..self.particles.len()).collect();
        order.sort_by(|&a, &b| density(b).total_cmp(&density(a)));
        self.some(&order[..most])
    }
}

/// A group, and how it extends the particles of the groups before it.
type Level<'a> = (usize, Extension<'a>);

/// A row under a model.
struct Row<'a> {
    shape: &'a Shape,
    params: &'a Params,
    real: &'a [f64],
    codes: &'a [u32],
}

impl Row<'_> {
    /// Appends a particle with every state of a group, and with the background, where `kept` holds of density and weights.
    fn extend(
        &self,
        (particle, weights): (Particle, &[f64]),
        (g, extension): &Level,
        work: &mut Workspace,
        out: &mut Front,
        kept: impl Fn(f64, &[f64]) -> bool,
    ) {
        let (shape, params, g) = (self.shape, self.params, *g);
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
        if let Some(background) = &shape.background {
            // Its density is the same for every state: one particle for all that the row leaves open.
            let selected = match shape.structure.selectors[g] {
                Selector::Codes(_) => states.start,
                _ => 0,
            };
            let scaled = weights.iter().map(|w| w * background.share);
            out.weights.extend(scaled);
            let state = shape.states(g) + selected;
            let linear = &background.linear[g];
            out.finish(particle, extension, linear, state, work, &kept);
        }
        for state in states {
            weigh(shape, params, g, state, weights, &mut out.weights);
            let linear = &params.linear[g][state];
            out.finish(particle, extension, linear, state, work, &kept);
        }
    }

    /// For every style, [`NEGLIGIBLE`] nats less than `log P(states | s) p(observed values | states)` of one assignment,
    /// taken greedily: what all together come to at least. Other groups of the row may leave any style alone possible, so
    /// that an assignment is negligible only where it is so for each style by itself.
    fn least(&self, levels: &[Level], work: &mut Workspace) -> Vec<f64> {
        let styles = self.shape.structure.styles;
        let log = |(particle, weights): (Particle, &[f64]), s: usize| {
            particle.log_density + weights[s].ln()
        };
        // Styles that took the same states so far share their assignment.
        let mut taken = vec![(Front::start(styles), (0..styles).collect::<Vec<_>>())];
        for level in levels {
            let mut next = Vec::new();
            for (one, own) in taken {
                let mut all = one.after(&level.1);
                self.extend(one.get(0), level, work, &mut all, |_, _| true);
                let count = all.particles.len();
                let mut of: Vec<Vec<usize>> = vec![Vec::new(); count];
                for s in own {
                    let best = (0..count)
                        .max_by(|&a, &b| log(all.get(a), s).total_cmp(&log(all.get(b), s)));
                    if let Some(best) = best {
                        of[best].push(s);
                    }
                }
                let chosen = of
                    .into_iter()
                    .enumerate()
                    .filter(|(_, own)| !own.is_empty());
                next.extend(chosen.map(|(i, own)| (all.some(&[i]), own)));
            }
            taken = next;
        }
        let mut least = vec![f64::NEG_INFINITY; styles];
        for (one, own) in &taken {
            for &s in own {
                least[s] = log(one.get(0), s) - NEGLIGIBLE;
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

/// Appends `weights` (by style) times P(H_g = state, not the background | s).
fn weigh(
    shape: &Shape,
    params: &Params,
    g: usize,
    state: usize,
    weights: &[f64],
    all: &mut Vec<f64>,
) {
    let styles = shape.structure.styles;
    let first = all.len();
    all.extend(weights);
    let out = &mut all[first..];
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
}
