//! E and M steps.

use rand::Rng;
use rustc_hash::FxHashMap;

use super::super::chunks;
use super::super::em::Em;
use super::super::error::ModelError;
use super::super::linalg::log_sum_exp;
use super::block::{BLOCK, Work};
use super::missing::Pattern;
use super::mixture::Mixture;
use super::problem::{Moments, Steps, add_row};
use super::settings::Covariance;
use edifice_cluster::kmeans_unweighted;

/// Rows of one parallel piece of work.
const CHUNK: usize = 2048;

impl Steps<'_> {
    /// One k-means++ start.
    pub(super) fn start<R: Rng>(&self, rng: &mut R) -> Result<Mixture, ModelError> {
        let d = self.points.dimension();
        let n = self.points.len();
        // Many rows are represented by a systematic sample.
        let stride = n.div_ceil(20_000);
        let sample: Vec<usize> = (0..n).step_by(stride).collect();
        let mut scaled = Vec::with_capacity(sample.len() * d);
        for &i in &sample {
            let row = self.points.row(i).iter().zip(&self.centre).zip(&self.scale);
            // A missing value counts as the overall mean.
            scaled.extend(row.map(|((v, c), s)| if v.is_nan() { 0.0 } else { (v - c) / s }));
        }
        let labels = kmeans_unweighted(&scaled, d, self.k, 5, rng).labels;
        let mut moments = self.empty();
        let mut u = vec![1.0; d + 1];
        for (&i, label) in sample.iter().zip(labels) {
            let x = self.points.row(i);
            for ((u, v), c) in u[1..].iter_mut().zip(x).zip(&self.centre) {
                *u = if v.is_nan() { 0.0 } else { v - c };
            }
            let (w, kind) = (self.points.weight(i), self.settings.covariance);
            let sums = &mut moments.sums[label];
            add_row(sums, &u, w, kind);
            // ... with the overall variance.
            for (i, s) in self
                .scale
                .iter()
                .enumerate()
                .filter(|(i, _)| x[*i].is_nan())
            {
                let at = match kind {
                    Covariance::Diagonal => 1 + d + i,
                    _ => (i + 1) * (d + 2),
                };
                sums[at] += w * s * s;
            }
        }
        self.maximize(&moments)
    }

    /// Rows grouped by the coordinates that they lack, in the order of the first of each group.
    fn by_pattern(&self, rows: &[usize]) -> Vec<Vec<usize>> {
        let mut place: FxHashMap<Pattern, usize> = FxHashMap::default();
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for &i in rows {
            let at = *place
                .entry(Pattern::of(self.points.row(i)))
                .or_insert(groups.len());
            if at == groups.len() {
                groups.push(Vec::new());
            }
            groups[at].push(i);
        }
        groups
    }
}

impl Em for Steps<'_> {
    type Model = Mixture;
    type Stats = Moments;

    fn expect(&self, model: &Mixture) -> Result<(Moments, f64), ModelError> {
        let d = model.d;
        let moments = chunks::fold(
            self.points.len(),
            CHUNK,
            |range| {
                let mut moments = self.empty();
                let mut work = Work::new(d, self.k);
                let (incomplete, complete): (Vec<usize>, Vec<usize>) =
                    range.partition(|&i| self.points.lacks(i));
                for rows in complete.chunks(BLOCK) {
                    self.block(model, rows, &mut work, &mut moments);
                }
                for rows in self.by_pattern(&incomplete) {
                    self.incomplete(model, &rows, &mut moments);
                }
                Ok(moments)
            },
            |total: &mut Moments, part| {
                for (a, b) in total
                    .sums
                    .iter_mut()
                    .flatten()
                    .zip(part.sums.iter().flatten())
                {
                    *a += b;
                }
                total.log_likelihood += part.log_likelihood;
            },
        )?;
        let log_likelihood = moments.log_likelihood;
        if !log_likelihood.is_finite() {
            let row = (0..self.points.len()).find(|&i| {
                let x: Vec<f64> = self
                    .points
                    .row(i)
                    .iter()
                    .zip(&self.centre)
                    .map(|(v, c)| v - c)
                    .collect();
                !log_sum_exp(&model.log_joint(&x)).is_finite()
            });
            return Err(ModelError::Contradiction {
                row,
                variable: "mixture".to_owned(),
            });
        }
        Ok((moments, log_likelihood))
    }

    fn maximize(&self, moments: &Moments) -> Result<Mixture, ModelError> {
        let d = self.points.dimension();
        let prior = &self.settings.prior;
        let kind = self.settings.covariance;
        let total: f64 = moments.sums.iter().map(|s| s[0]).sum();
        let weights: Vec<f64> = moments.sums.iter().map(|s| s[0] / total).collect();
        let mut means = Vec::with_capacity(self.k * d);
        let tied = kind == Covariance::Tied;
        let mut covariances = vec![0.0; if tied { 1 } else { self.k } * d * d];
        let mut pooled = 0.0;
        for (k, sums) in moments.sums.iter().enumerate() {
            let n = sums[0];
            let at = |i: usize, j: usize| match kind {
                Covariance::Diagonal if i == j => sums[1 + d + i],
                Covariance::Diagonal => 0.0,
                _ => sums[(i.max(j) + 1) * (d + 1) + i.min(j) + 1],
            };
            let first = |i: usize| match kind {
                Covariance::Diagonal => sums[1 + i],
                _ => sums[(i + 1) * (d + 1)],
            };
            let mean: Vec<f64> = (0..d).map(|i| first(i) / (n + prior.mean)).collect();
            let m = if tied { 0 } else { k };
            let covariance = &mut covariances[m * d * d..(m + 1) * d * d];
            let share = if tied { 1.0 } else { 1.0 / (n + prior.freedom) };
            for i in 0..d {
                for j in 0..d {
                    if kind == Covariance::Diagonal && i != j {
                        continue;
                    }
                    let ridge = match i == j {
                        true => prior.scatter * self.scale[i] * self.scale[i],
                        false => 0.0,
                    };
                    let scatter = at(i, j) - (n + prior.mean) * mean[i] * mean[j];
                    covariance[i * d + j] += share * (ridge + scatter);
                }
            }
            pooled += n + prior.freedom;
            means.extend(mean);
        }
        if tied {
            covariances.iter_mut().for_each(|v| *v /= pooled);
        }
        Mixture::new(d, kind, weights, means, covariances)
    }

    fn log_prior(&self, model: &Mixture) -> f64 {
        let d = model.d;
        let prior = &self.settings.prior;
        (0..self.k)
            .map(|k| {
                let w = model.whitening_of(k);
                let mean = model.mean(k);
                let scale = self.scale.iter().cycle();
                let trace: f64 = w.iter().zip(scale).map(|(v, s)| (v * s) * (v * s)).sum();
                let quad: f64 = (0..d)
                    .map(|i| (0..=i).map(|j| w[i * d + j] * mean[j]).sum::<f64>().powi(2))
                    .sum();
                let log_det: f64 = -2.0 * (0..d).map(|i| w[i * d + i].ln()).sum::<f64>();
                -0.5 * (prior.scatter * trace + prior.mean * quad + prior.freedom * log_det)
            })
            .sum()
    }

    fn movement(&self, before: &Mixture, after: &Mixture) -> f64 {
        let (d, s) = (before.d, &self.scale);
        let far = |a: &[f64], b: &[f64], unit: &dyn Fn(usize) -> f64| {
            let moved = a.iter().zip(b).enumerate();
            moved
                .map(|(i, (x, y))| (x - y).abs() / unit(i))
                .fold(0.0, f64::max)
        };
        far(&before.weights, &after.weights, &|_| 1.0)
            .max(far(&before.means, &after.means, &|i| s[i % d]))
            .max(far(&before.covariances, &after.covariances, &|i| {
                s[i / d % d] * s[i % d]
            }))
    }
}
