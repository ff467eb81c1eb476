//! Gaussians over the missing values of a row: extended by a linear Gaussian, conditioned on what is
//! observed, summed into sufficient statistics, drawn from.

use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

use super::conjugate::Linear;
use super::linalg::{LN_2PI, cholesky};

/// An assignment of states to the groups of a component, with the Gaussian of its missing values.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Particle<'a> {
    /// `log p(observed values of the component | states)`.
    pub log_density: f64,
    /// States, in the order of [`Component::groups`].
    pub states: &'a [usize],
    /// Posterior mean of the missing values, in the order of [`Component::missing`].
    pub mean: &'a [f64],
    /// Their posterior covariance, row-major.
    pub cov: &'a [f64],
}

/// Particles over the same groups and the same missing values, in one piece of memory.
#[derive(Clone, Debug, Default)]
pub(crate) struct Particles {
    groups: usize,
    missing: usize,
    log_densities: Vec<f64>,
    states: Vec<usize>,
    means: Vec<f64>,
    covs: Vec<f64>,
}

impl Particles {
    /// An empty list of particles over `groups` groups and `missing` missing values.
    pub(crate) fn new(groups: usize, missing: usize) -> Self {
        Self {
            groups,
            missing,
            ..Self::default()
        }
    }

    /// One particle that has no states yet and no missing value.
    pub(crate) fn start() -> Self {
        Self {
            log_densities: vec![0.0],
            ..Self::default()
        }
    }

    /// An empty list over the same groups and missing values.
    pub(crate) fn like(&self) -> Self {
        Self::new(self.groups, self.missing)
    }

    /// An empty list over one group more, which `extension` adds.
    pub(crate) fn after(&self, extension: &Extension) -> Self {
        Self::new(self.groups + 1, extension.missing())
    }

    pub(crate) fn len(&self) -> usize {
        self.log_densities.len()
    }

    pub(crate) fn get(&self, i: usize) -> Particle<'_> {
        let (g, m) = (self.groups, self.missing);
        Particle {
            log_density: self.log_densities[i],
            states: &self.states[i * g..(i + 1) * g],
            mean: &self.means[i * m..(i + 1) * m],
            cov: &self.covs[i * m * m..(i + 1) * m * m],
        }
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = Particle<'_>> {
        (0..self.len()).map(|i| self.get(i))
    }

    /// Adds one over the same groups and missing values.
    pub(crate) fn push(&mut self, particle: Particle) {
        self.log_densities.push(particle.log_density);
        self.states.extend(particle.states);
        self.means.extend(particle.mean);
        self.covs.extend(particle.cov);
    }
}

/// E[u uᵀ] under `particle`, u = (1, columns), lower triangle added to `scatter` times `weight`;
/// `missing` are the columns the particle's Gaussian is over.
pub(crate) fn add_scatter(
    particle: Particle,
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

/// The extension of the particles of a row by one group: a linear Gaussian, conditioned on the group's own values. Only
/// the part that is the same for all particles and states.
pub(crate) struct Extension<'a> {
    real: &'a [f64],
    /// Inputs, and where among the missing values they are.
    inputs: Vec<(usize, Option<usize>)>,
    /// Columns of the group itself.
    own: &'a [usize],
    /// Which of them have a value, and which do not.
    seen: Vec<usize>,
    gone: Vec<usize>,
    /// Number of values that are missing before the extension.
    missing: usize,
}

/// Memory for one extension after the other; what [`Extension::density`] leaves for [`Extension::append`].
#[derive(Default)]
pub(crate) struct Workspace {
    mean: Vec<f64>,
    slopes: Vec<f64>,
    cross: Vec<f64>,
    cov: Vec<f64>,
    cholesky: Vec<f64>,
    residual: Vec<f64>,
    gains: Vec<f64>,
    log_density: f64,
}

impl<'a> Extension<'a> {
    /// The group of `columns`, inputs first, of which `d` are its own, after `missing`.
    pub(crate) fn new(missing: &[usize], columns: &'a [usize], d: usize, real: &'a [f64]) -> Self {
        let (inputs, own) = columns.split_at(columns.len() - d);
        let place = |c: &usize| (*c, missing.iter().position(|m| m == c));
        let (gone, seen) = (0..d).partition(|&j| real[own[j]].is_nan());
        Self {
            real,
            inputs: inputs.iter().map(place).collect(),
            own,
            seen,
            gone,
            missing: missing.len(),
        }
    }

    /// Number of values that are missing after the extension.
    pub(crate) fn missing(&self) -> usize {
        self.missing + self.gone.len()
    }

    /// The log density of the extended particle.
    pub(crate) fn density(&self, from: Particle, linear: &Linear, work: &mut Workspace) -> f64 {
        let (m, d) = (self.missing, linear.d);
        // Mean of y, and slopes on the values that are still missing.
        let mean = &mut work.mean;
        mean.clear();
        mean.extend(&linear.coefficients[..d]);
        zeros(&mut work.slopes, m * d);
        for (i, &(column, place)) in self.inputs.iter().enumerate() {
            let b = &linear.coefficients[(i + 1) * d..(i + 2) * d];
            let x = place.map_or(self.real[column], |k| from.mean[k]);
            for j in 0..d {
                mean[j] += b[j] * x;
                if let Some(k) = place {
                    work.slopes[k * d + j] = b[j];
                }
            }
        }
        // cross = C B (m x d), cov = Bᵀ C B + Σ.
        zeros(&mut work.cross, m * d);
        for a in 0..m {
            for k in 0..m {
                let c = from.cov[a * m + k];
                for j in 0..d {
                    work.cross[a * d + j] += c * work.slopes[k * d + j];
                }
            }
        }
        work.cov.clear();
        work.cov.extend(&linear.covariance);
        for a in 0..m {
            for i in 0..d {
                for j in 0..d {
                    work.cov[i * d + j] += work.slopes[a * d + i] * work.cross[a * d + j];
                }
            }
        }
        let o = self.seen.len();
        let l = &mut work.cholesky;
        l.clear();
        for &i in &self.seen {
            l.extend(self.seen.iter().map(|&j| work.cov[i * d + j]));
        }
        let mut log_density = from.log_density;
        if o > 0 && !cholesky(l, o) {
            log_density = f64::NEG_INFINITY;
        } else {
            let z = &mut work.residual;
            z.clear();
            let seen = self.seen.iter();
            z.extend(seen.map(|&j| self.real[self.own[j]] - work.mean[j]));
            whiten(l, z);
            log_density -= 0.5 * (o as f64 * LN_2PI + z.iter().map(|v| v * v).sum::<f64>());
            log_density -= (0..o).map(|i| l[i * o + i].ln()).sum::<f64>();
        }
        work.log_density = log_density;
        log_density
    }

    /// Appends the extended particle whose density was asked for last, with `state` if one is given.
    pub(crate) fn append(
        &self,
        from: Particle,
        state: Option<usize>,
        work: &mut Workspace,
        out: &mut Particles,
    ) {
        let (m, t, d, o) = (
            self.missing,
            self.missing(),
            self.own.len(),
            self.seen.len(),
        );
        out.log_densities.push(work.log_density);
        out.states.extend(from.states.iter().copied().chain(state));
        // Joint over the old and the new missing values, then conditioned on the seen ones.
        let first = out.means.len();
        out.means.extend(from.mean);
        out.means.extend(self.gone.iter().map(|&j| work.mean[j]));
        let mean = &mut out.means[first..];
        let first = out.covs.len();
        out.covs.resize(first + t * t, 0.0);
        let cov = &mut out.covs[first..];
        for a in 0..t {
            for b in 0..=a {
                let v = match (a < m, b < m) {
                    (true, _) => from.cov[a * m + b],
                    (false, true) => work.cross[b * d + self.gone[a - m]],
                    (false, false) => work.cov[self.gone[a - m] * d + self.gone[b - m]],
                };
                cov[a * t + b] = v;
                cov[b * t + a] = v;
            }
        }
        if work.log_density == f64::NEG_INFINITY || o == 0 {
            return;
        }
        // Rows: whitened covariances of each missing value with the seen ones.
        work.gains.clear();
        for a in 0..t {
            let row = match a.checked_sub(m) {
                None => &work.cross[a * d..(a + 1) * d],
                Some(k) => &work.cov[self.gone[k] * d..(self.gone[k] + 1) * d],
            };
            work.gains.extend(self.seen.iter().map(|&j| row[j]));
            whiten(&work.cholesky, &mut work.gains[a * o..]);
        }
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        for (a, gain) in work.gains.chunks(o).enumerate() {
            mean[a] += dot(gain, &work.residual);
            for (b, other) in work.gains.chunks(o).enumerate() {
                cov[a * t + b] -= dot(gain, other);
            }
        }
    }
}

/// Solves `l x = v` in place.
fn whiten(l: &[f64], v: &mut [f64]) {
    let o = v.len();
    for i in 0..o {
        let dot: f64 = (0..i).map(|k| l[i * o + k] * v[k]).sum();
        v[i] = (v[i] - dot) / l[i * o + i];
    }
}

fn zeros(v: &mut Vec<f64>, n: usize) {
    v.clear();
    v.resize(n, 0.0);
}

/// Extends one particle by a group with Gaussian `linear`, without a state.
pub(crate) fn extend(
    from: Particle,
    missing: &[usize],
    columns: &[usize],
    linear: &Linear,
    real: &[f64],
) -> Particles {
    let extension = Extension::new(missing, columns, linear.d, real);
    let mut work = Workspace::default();
    extension.density(from, linear, &mut work);
    let mut out = Particles::new(from.states.len(), extension.missing());
    extension.append(from, None, &mut work, &mut out);
    out
}

/// A draw from N(mean, cov); directions in which `cov` is singular stay at the mean.
pub(crate) fn gaussian<R: Rng>(mean: &[f64], cov: &[f64], rng: &mut R) -> Vec<f64> {
    let n = mean.len();
    let mut l = cov.to_vec();
    let mut raise = 1e-14;
    while !cholesky(&mut l, n) {
        l.copy_from_slice(cov);
        for i in 0..n {
            l[i * n + i] += raise * (1.0 + cov[i * n + i].abs());
        }
        raise *= 100.0;
    }
    let z: Vec<f64> = (0..n).map(|_| rng.sample(StandardNormal)).collect();
    (0..n)
        .map(|i| mean[i] + (0..=i).map(|j| l[i * n + j] * z[j]).sum::<f64>())
        .collect()
}
