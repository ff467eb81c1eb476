//! Genomes of bounded real numbers.

use rand::{Rng, RngExt};

use super::Breed;

/// Distribution index of crossover: larger keeps children nearer to their parents.
const CROSS: f64 = 15.0;
/// Distribution index of mutation.
const MUTATE: f64 = 20.0;

/// A problem over bounded real variables: simulated binary crossover and polynomial mutation, one variable in n
/// mutated on average, all within the bounds.
pub struct Reals<F, V = fn(&[f64]) -> f64> {
    bounds: Vec<(f64, f64)>,
    objectives: usize,
    costs: F,
    violation: V,
}

impl<F: FnMut(&[f64]) -> Vec<f64>> Reals<F> {
    /// A problem of so many costs, without constraints but the bounds, lower and upper of each variable.
    pub fn new(bounds: Vec<(f64, f64)>, objectives: usize, costs: F) -> Self {
        Self {
            bounds,
            objectives,
            costs,
            violation: |_| 0.0,
        }
    }

    /// The same with constraints: `violation` says by how much a point violates them, 0 where all hold.
    pub fn constrained<V: FnMut(&[f64]) -> f64>(self, violation: V) -> Reals<F, V> {
        Reals {
            bounds: self.bounds,
            objectives: self.objectives,
            costs: self.costs,
            violation,
        }
    }
}

impl<F, V> Breed for Reals<F, V>
where
    F: FnMut(&[f64]) -> Vec<f64>,
    V: FnMut(&[f64]) -> f64,
{
    type Genome = Vec<f64>;

    fn objectives(&self) -> usize {
        self.objectives
    }

    fn costs(&mut self, x: &Vec<f64>) -> Vec<f64> {
        (self.costs)(x)
    }

    fn violation(&mut self, x: &Vec<f64>) -> f64 {
        (self.violation)(x)
    }

    fn random<R: Rng>(&mut self, rng: &mut R) -> Vec<f64> {
        let each = self.bounds.iter();
        each.map(|(l, u)| l + (u - l) * rng.random::<f64>())
            .collect()
    }

    fn cross<R: Rng>(&mut self, a: &Vec<f64>, b: &Vec<f64>, rng: &mut R) -> Vec<f64> {
        let pairs = a.iter().zip(b).zip(&self.bounds);
        let one = |((&a, &b), &(low, high)): ((&f64, &f64), &(f64, f64))| {
            let (x, y) = if rng.random::<bool>() { (a, b) } else { (b, a) };
            if rng.random::<bool>() || (x - y).abs() < 1e-14 {
                return x;
            }
            // The spread that keeps both children within the bounds.
            let (least, most) = (x.min(y), x.max(y));
            let room = 1.0 + 2.0 * (least - low).min(high - most).max(0.0) / (most - least);
            let alpha = 2.0 - room.powf(-(CROSS + 1.0));
            let u: f64 = rng.random();
            let spread = match u <= 1.0 / alpha {
                true => (u * alpha).powf(1.0 / (CROSS + 1.0)),
                false => (1.0 / (2.0 - u * alpha)).powf(1.0 / (CROSS + 1.0)),
            };
            (0.5 * ((x + y) + spread * (x - y))).clamp(low, high)
        };
        pairs.map(one).collect()
    }

    fn mutate<R: Rng>(&mut self, x: &mut Vec<f64>, rng: &mut R) {
        let share = 1.0 / x.len().max(1) as f64;
        for (x, &(low, high)) in x.iter_mut().zip(&self.bounds) {
            if rng.random::<f64>() >= share || high <= low {
                continue;
            }
            let width = high - low;
            let power = 1.0 / (MUTATE + 1.0);
            let u: f64 = rng.random();
            let step = if u < 0.5 {
                let room = 1.0 - (*x - low) / width;
                (2.0 * u + (1.0 - 2.0 * u) * room.powf(MUTATE + 1.0)).powf(power) - 1.0
            } else {
                let room = 1.0 - (high - *x) / width;
                1.0 - (2.0 * (1.0 - u) + (2.0 * u - 1.0) * room.powf(MUTATE + 1.0)).powf(power)
            };
            *x = (*x + step * width).clamp(low, high);
        }
    }
}
