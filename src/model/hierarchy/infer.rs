//! Exact inference for one row: messages from the leaves to S and back.
//!
//! Given s, the groups (or components of linked groups) are independent, so with
//! `m_g(s) = Σ_h P(h | s) p(x_g | h)` one pass gives `p(x) = Σ_s P(s) Π_g m_g(s) Π_c P(c | s)`,
//! `P(s | x)`, and `P(s, h | x) = P(s | x) P(h | s) p(x_g | h) / m_g(s)`. Missing categories that
//! are parents are enumerated; the others, and groups without observed values below them, drop out.

use super::super::error::ModelError;
use super::super::gaussian::add_scatter;
use super::super::linalg::log_sum_exp;
use super::super::table::MISSING;
use super::component::{Component, Pattern};
use super::params::{Params, Shape, Stats};
use super::structure::{Selector, configuration};

/// Assignments of missing parent categories tried for one row.
pub(super) const MOST_ASSIGNMENTS: usize = 4096;

/// Posterior of a row, reused from row to row.
#[derive(Debug)]
pub(crate) struct Scratch {
    /// `log p(x)`.
    pub log_likelihood: f64,
    /// P(s | x).
    pub style: Vec<f64>,
    /// `p(x_g | h)` over its maximum, for plain groups.
    pub dens: Vec<Vec<f64>>,
    /// Share of the state's own Gaussian in it, for plain groups: the rest is the background's.
    pub own: Vec<Vec<f64>>,
    /// `m_g(s)` over the same maximum, for plain groups with a hidden variable.
    pub messages: Vec<Vec<f64>>,
    pub pattern: Pattern,
    pub components: Vec<Component>,
    u: Vec<f64>,
    residual: Vec<f64>,
    product: Vec<f64>,
}

impl Scratch {
    pub(crate) fn new(shape: &Shape) -> Self {
        let styles = shape.structure.styles;
        let groups = 0..shape.groups();
        let widest = shape.columns.iter().map(Vec::len).max().unwrap_or(0) + 1;
        Self {
            log_likelihood: 0.0,
            style: vec![0.0; styles],
            dens: groups.clone().map(|g| vec![0.0; shape.states(g)]).collect(),
            own: groups.clone().map(|g| vec![1.0; shape.states(g)]).collect(),
            messages: groups
                .map(|g| vec![0.0; if shape.hidden(g) { styles } else { 0 }])
                .collect(),
            pattern: Pattern {
                plain: shape.order.clone(),
                ..Pattern::default()
            },
            components: Vec::new(),
            u: vec![0.0; widest],
            residual: vec![0.0; widest],
            product: vec![0.0; styles],
        }
    }

    /// Infers the posterior of a row whose parent categories are all known.
    pub(crate) fn infer(&mut self, shape: &Shape, params: &Params, real: &[f64], codes: &[u32]) {
        let styles = shape.structure.styles;
        for (l, p) in self.style.iter_mut().zip(&params.style) {
            *l = p.ln();
        }
        self.product.fill(1.0);
        for (c, &code) in codes.iter().enumerate().filter(|(_, v)| **v != MISSING) {
            let parents = &shape.structure.code_parents[c];
            let row = configuration(parents, &shape.sizes, codes) * shape.sizes[c] + code as usize;
            multiply(
                &mut self.product,
                &mut self.style,
                &params.codes[c][row * styles..(row + 1) * styles],
            );
        }
        // Indicators are never missing.
        let complete = real.iter().all(|v| !v.is_nan());
        let was_complete = self.pattern.plain.len() == shape.groups();
        if !(complete && was_complete) {
            self.pattern = Pattern::of(shape, real);
        }
        let mut shift = 0.0;
        for i in 0..self.pattern.plain.len() {
            shift += self.plain(shape, params, self.pattern.plain[i], real, codes);
        }
        self.components.clear();
        for i in 0..self.pattern.linked.len() {
            let groups = &self.pattern.linked[i];
            let component = Component::new(shape, params, groups, real, codes);
            let (densities, most) = component.by_style(styles);
            let mut totals = vec![0.0; styles];
            for row in densities.chunks(styles) {
                totals.iter_mut().zip(row).for_each(|(t, d)| *t += d);
            }
            for ((l, total), most) in self.style.iter_mut().zip(&totals).zip(&most) {
                *l += most + total.ln();
            }
            self.components.push(component);
        }
        for (l, p) in self.style.iter_mut().zip(&self.product) {
            *l += p.ln();
        }
        let total = log_sum_exp(&self.style);
        for l in &mut self.style {
            *l = if total == f64::NEG_INFINITY {
                0.0
            } else {
                (*l - total).exp()
            };
        }
        self.log_likelihood = total + shift;
    }

    /// Densities and message of a plain group; returns what the densities were divided by, as log.
    fn plain(
        &mut self,
        shape: &Shape,
        params: &Params,
        g: usize,
        real: &[f64],
        codes: &[u32],
    ) -> f64 {
        let styles = shape.structure.styles;
        let columns = &shape.columns[g];
        self.u[0] = 1.0;
        for (u, &c) in self.u[1..].iter_mut().zip(columns) {
            *u = real[c];
        }
        let u = &self.u[..columns.len() + 1];
        let residual = &mut self.residual[..shape.d[g]];
        let dens = &mut self.dens[g];
        if let Selector::Codes(c) = &shape.structure.selectors[g] {
            let state = configuration(c, &shape.sizes, codes);
            dens.fill(0.0);
            dens[state] = params.linear[g][state].log_density(u, residual);
            if let Some(background) = &shape.background {
                let (only, own) = (&mut dens[state..=state], &mut self.own[g][state..=state]);
                let most = background.mix(g, u, residual, only, own);
                return most + std::mem::replace(&mut dens[state], 1.0).ln();
            }
            return std::mem::replace(&mut dens[state], 1.0);
        }
        for (l, linear) in dens.iter_mut().zip(&params.linear[g]) {
            *l = linear.log_density(u, residual);
        }
        let mut max = dens.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if let Some(background) = &shape.background {
            max = background.mix(g, u, residual, dens, &mut self.own[g]);
            if !shape.hidden(g) {
                dens.iter_mut()
                    .for_each(|density| *density = max + density.ln());
            }
        } else if shape.hidden(g) {
            dens.iter_mut().for_each(|l| *l = (*l - max).exp());
        }
        if !shape.hidden(g) {
            for (total, l) in self.style.iter_mut().zip(dens.iter()) {
                *total += l;
            }
            return 0.0;
        }
        let message = &mut self.messages[g];
        message.fill(0.0);
        for (h, density) in dens.iter().enumerate() {
            for (m, p) in message
                .iter_mut()
                .zip(&params.tables[g][h * styles..(h + 1) * styles])
            {
                *m += p * density;
            }
        }
        multiply(&mut self.product, &mut self.style, message);
        max
    }

    /// Adds the expected statistics of the row just inferred, `weight` times.
    pub(crate) fn accumulate(
        &mut self,
        shape: &Shape,
        params: &Params,
        real: &[f64],
        codes: &[u32],
        weight: f64,
        stats: &mut Stats,
    ) {
        let styles = shape.structure.styles;
        for r in &mut self.style {
            *r *= weight;
        }
        for (n, r) in stats.style.iter_mut().zip(&self.style) {
            *n += r;
        }
        for (c, &code) in codes.iter().enumerate().filter(|(_, v)| **v != MISSING) {
            let parents = &shape.structure.code_parents[c];
            let row = configuration(parents, &shape.sizes, codes) * shape.sizes[c] + code as usize;
            let counts = &mut stats.codes[c][row * styles..(row + 1) * styles];
            for (n, r) in counts.iter_mut().zip(&self.style) {
                *n += r;
            }
        }
        for &g in &self.pattern.plain {
            let columns = &shape.columns[g];
            let q = columns.len() + 1;
            for (u, &c) in self.u[1..].iter_mut().zip(columns) {
                *u = real[c];
            }
            let u = &self.u[..q];
            if shape.hidden(g) {
                for (m, r) in self.messages[g].iter_mut().zip(&self.style) {
                    *m = if *m > 0.0 { r / *m } else { 0.0 };
                }
            }
            for (h, scatter) in stats.scatter[g].iter_mut().enumerate() {
                let r = match shape.structure.selectors[g] {
                    Selector::Style => self.style[h],
                    Selector::Codes(_) => self.dens[g][h] * weight,
                    Selector::Hidden(_) => {
                        let dens = self.dens[g][h];
                        let row = h * styles..(h + 1) * styles;
                        let mut sum = 0.0;
                        for ((n, p), m) in stats.tables[g][row.clone()]
                            .iter_mut()
                            .zip(&params.tables[g][row])
                            .zip(&self.messages[g])
                        {
                            let joint = p * dens * m;
                            *n += joint;
                            sum += joint;
                        }
                        sum
                    }
                };
                // What the background explains says nothing of the regression.
                let r = r * self.own[g][h];
                if r > 1e-15 {
                    // Indicators of categories are mostly 0.
                    for i in (0..q).filter(|&i| u[i] != 0.0) {
                        let ru = r * u[i];
                        for (a, v) in scatter[i * q..i * q + i + 1].iter_mut().zip(u) {
                            *a += ru * v;
                        }
                    }
                }
            }
        }
        for component in &self.components {
            let joint = joint(component, &self.style);
            for (particle, joint) in component.particles.iter().zip(joint.chunks(styles)) {
                let w: f64 = joint.iter().sum();
                if w < 1e-15 {
                    continue;
                }
                for (&g, &state) in component.groups.iter().zip(particle.states) {
                    let (h, background) = shape.read(g, state);
                    if background {
                        if shape.hidden(g) {
                            let table = stats.tables[g].iter_mut().zip(&params.tables[g]);
                            let every = joint.iter().cycle();
                            table.zip(every).for_each(|((n, p), j)| *n += p * j);
                        }
                        continue;
                    }
                    let (columns, scatter) = (&shape.columns[g], &mut stats.scatter[g][h]);
                    add_scatter(particle, &component.missing, columns, real, w, scatter);
                    if shape.hidden(g) {
                        let row = &mut stats.tables[g][h * styles..(h + 1) * styles];
                        for (n, j) in row.iter_mut().zip(joint) {
                            *n += j;
                        }
                    }
                }
            }
        }
    }
}

/// `P(s, particle | x)` given `P(s | x)`, particle by particle.
pub(crate) fn joint(component: &Component, style: &[f64]) -> Vec<f64> {
    let (mut joint, _) = component.by_style(style.len());
    let mut totals = vec![0.0; style.len()];
    for row in joint.chunks(style.len()) {
        totals.iter_mut().zip(row).for_each(|(t, j)| *t += j);
    }
    let factors = totals.iter().zip(style);
    let factors: Vec<f64> = factors
        .map(|(t, r)| if *t > 0.0 { r / t } else { 0.0 })
        .collect();
    for row in joint.chunks_mut(style.len()) {
        row.iter_mut().zip(&factors).for_each(|(j, f)| *j *= f);
    }
    joint
}

/// Multiplies factors into running products, moving them into logarithms before they underflow.
fn multiply(product: &mut [f64], log: &mut [f64], factors: &[f64]) {
    for ((p, l), f) in product.iter_mut().zip(log).zip(factors) {
        *p *= f;
        if *p < 1e-150 {
            *l += p.ln();
            *p = 1.0;
        }
    }
}

/// All completions of the missing categories that are parents; the row itself when there are none.
///
/// # Errors
/// [`ModelError::Parameter`] when there are too many to enumerate.
pub(crate) fn assignments(
    shape: &Shape,
    names: impl Fn(usize) -> String,
    codes: &[u32],
) -> Result<Vec<Vec<u32>>, ModelError> {
    let mut all = vec![codes.to_vec()];
    for &c in shape.regressors.iter().filter(|&&c| codes[c] == MISSING) {
        if all.len() * shape.sizes[c] > MOST_ASSIGNMENTS {
            return Err(ModelError::parameter(
                names(c),
                "one of too many missing parent categories in one row",
            ));
        }
        all = (0..shape.sizes[c] as u32)
            .flat_map(|v| {
                all.iter().map(move |a| {
                    let mut a = a.clone();
                    a[c] = v;
                    a
                })
            })
            .collect();
    }
    Ok(all)
}
