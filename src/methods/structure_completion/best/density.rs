//! One-dimensional densities of the spacing of grid lines, as tables.

use serde::{Deserialize, Serialize};

/// Range of the logarithms of ratios that are told apart.
const RANGE: f64 = 2.5;
/// Cells of a table.
const CELLS: usize = 250;
/// Share of the uniform density in every table, so that nothing is impossible.
const FLOOR: f64 = 0.03;

/// A kernel density of the logarithm of a ratio, on [-2.5, 2.5].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RatioDensity {
    cells: Vec<f64>,
}

impl RatioDensity {
    /// The Gaussian kernel density of logarithms, mixed with 3 % of the uniform one.
    pub fn learn(logs: &[f64], bandwidth: f64) -> Self {
        let width = 2.0 * RANGE / CELLS as f64;
        let mut cells = vec![0.0; CELLS];
        for log in logs {
            let log = log.clamp(-RANGE, RANGE);
            for (cell, value) in cells.iter_mut().enumerate() {
                let z = (-RANGE + (cell as f64 + 0.5) * width - log) / bandwidth;
                *value += (-0.5 * z * z).exp();
            }
        }
        let total: f64 = cells.iter().sum::<f64>() * width;
        for value in &mut cells {
            let kernel = if total > 0.0 { *value / total } else { 0.0 };
            *value = (1.0 - FLOOR) * kernel + FLOOR / (2.0 * RANGE);
        }
        Self { cells }
    }

    /// Density of the logarithm of `ratio`.
    pub fn at(&self, ratio: f64) -> f64 {
        let place = (ratio.ln().clamp(-RANGE, RANGE) + RANGE) / (2.0 * RANGE) * CELLS as f64;
        self.cells[(place as usize).min(CELLS - 1)]
    }

    /// True if a table read from a file has the right number of positive finite cells.
    pub fn is_valid(&self) -> bool {
        self.cells.len() == CELLS && self.cells.iter().all(|v| v.is_finite() && *v > 0.0)
    }
}

/// Steps of the remaining space, as a logarithm of its ratio to the last gap.
const STEP: f64 = 0.1;
/// Lowest logarithm that is told apart.
const LOWEST: f64 = -2.0;
/// Number of steps.
const STEPS: usize = 45;

/// Probability that a line is the last one, given the remaining space in units of the last gap.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Ending {
    probability: Vec<f64>,
}

impl Ending {
    /// Learns from pairs (remaining space / last gap, whether the line was the last): a kernel average over
    /// the logarithm, with half an observation of each kind added. More space never makes an end more
    /// probable.
    pub fn learn(seen: &[(f64, bool)]) -> Self {
        let mut probability = Vec::with_capacity(STEPS);
        for step in 0..STEPS {
            let at = LOWEST + (step as f64 + 0.5) * STEP;
            // Beyond what was seen: little space ends, much goes on.
            let mut sums = if at < 0.0 { (0.5, 0.5) } else { (0.0, 0.5) };
            for (ratio, last) in seen {
                let z = (ratio.max(1e-6).ln() - at) / 0.12;
                let weight = (-0.5 * z * z).exp();
                sums.0 += weight * f64::from(u8::from(*last));
                sums.1 += weight;
            }
            let p: f64 = sums.0 / sums.1;
            let before = probability.last().copied().unwrap_or(1.0);
            probability.push(p.clamp(1e-6, 1.0 - 1e-4_f64).min(before));
        }
        Self { probability }
    }

    /// Probability of the end.
    pub fn at(&self, ratio: f64) -> f64 {
        let place = (ratio.max(1e-6).ln() - LOWEST) / STEP;
        self.probability[(place.max(0.0) as usize).min(STEPS - 1)]
    }

    /// True if a table read from a file has the right number of probabilities.
    pub fn is_valid(&self) -> bool {
        let probability = |p: &f64| (0.0..=1.0).contains(p);
        self.probability.len() == STEPS && self.probability.iter().all(probability)
    }
}

/// The distribution of the distances of lines along one axis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Spacing {
    /// First gap in units of the elements' extent.
    pub first: RatioDensity,
    /// Space before the first line in units of the first gap.
    pub border: RatioDensity,
    /// A gap in units of the one before.
    pub ratio: RatioDensity,
    /// Probability that a line is the last one.
    pub ending: Ending,
}

impl Spacing {
    /// Learns from the positions of lines on `[0, length]` and the extent of their elements.
    pub fn learn(examples: &[(Vec<f64>, f64, f64)]) -> Self {
        let (mut first, mut border, mut ratio, mut seen) = (vec![], vec![], vec![], vec![]);
        for (lines, size, length) in examples.iter().filter(|(l, ..)| l.len() > 1) {
            let gaps: Vec<f64> = lines.windows(2).map(|w| w[1] - w[0]).collect();
            first.push((gaps[0] / size).ln());
            border.push((lines[0] / gaps[0]).max(1e-6).ln());
            ratio.extend(gaps.windows(2).map(|w| (w[1] / w[0]).ln()));
            for (k, gap) in gaps.iter().enumerate() {
                let left = length - lines[k + 1];
                seen.push((left / gap, k + 1 == gaps.len()));
            }
        }
        Self {
            first: RatioDensity::learn(&first, 0.12),
            border: RatioDensity::learn(&border, 0.10),
            ratio: RatioDensity::learn(&ratio, 0.05),
            ending: Ending::learn(&seen),
        }
    }

    /// True if tables read from a file have the right sizes and ranges.
    pub fn is_valid(&self) -> bool {
        self.first.is_valid()
            && self.border.is_valid()
            && self.ratio.is_valid()
            && self.ending.is_valid()
    }
}
