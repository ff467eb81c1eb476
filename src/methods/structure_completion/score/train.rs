//! Learning the densities from whole layouts.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::compatibility::Compatibility;
use super::grid::Grid;
use super::{ScoreModel, TERMS, global, grids, pair};
use crate::methods::structure_completion::layout::Layout;
use crate::model::ModelError;
use crate::model::density::{Conditional, ScalarMixture, SmoothHistogram};

/// Ranges of the gap, or of the door position, that have their own density.
const RANGES: usize = 4;
/// Least standard deviations of the ratios' densities.
const FLOOR: f64 = 0.01;
/// Least standard deviation of a density of regularity.
const REGULARITY_FLOOR: f64 = 0.005;

/// Values seen in the database.
#[derive(Default)]
struct Seen {
    aspect: [Vec<f64>; 4],
    spacing: [Vec<f64>; 2],
    regularity: [Vec<f64>; 2],
    completeness: Vec<f64>,
    patterns: BTreeMap<pair::Pattern, f64>,
    alignment: [Vec<(f64, f64)>; 2],
    coverage: Vec<f64>,
    border: [Vec<f64>; 2],
    symmetry: Vec<(f64, f64)>,
}

impl Seen {
    fn add(&mut self, grids: &[Arc<Grid>], facade: [f64; 2]) {
        for (i, g) in grids.iter().enumerate() {
            self.aspect[g.class.index()].push(g.size[1] / g.size[0]);
            for axis in 0..2 {
                self.spacing[axis].extend(g.spacing[axis].map(|d| g.size[axis] / d));
                self.regularity[axis].extend(g.deviation[axis].map(|s| s / g.extent(axis)));
            }
            self.completeness.push(g.completeness());
            for other in &grids[i + 1..] {
                for axis in 0..2 {
                    if let Some(pattern) = pair::pattern(g, other, axis) {
                        *self.patterns.entry(pattern).or_default() += 1.0;
                    }
                    self.alignment[axis].extend(pair::alignment(g, other, axis, facade));
                }
            }
        }
        self.coverage.push(global::coverage(grids, facade));
        for (side, border) in global::borders(grids, facade).into_iter().enumerate() {
            self.border[side / 2].push(border);
        }
        let (area, door) = global::symmetry(grids, facade);
        self.symmetry.push((door, area));
    }

    /// Log probabilities relative to the most frequent pattern, half a count added to each and to what was never seen.
    fn patterns(&self) -> (Vec<(pair::Pattern, f64)>, f64) {
        let most = self.patterns.values().copied().fold(0.0, f64::max) + 0.5;
        let logs = self
            .patterns
            .iter()
            .map(|(p, n)| (*p, ((n + 0.5) / most).ln()));
        (logs.collect(), (0.5 / most).ln())
    }
}

/// A mixture, or the widest possible guess where the database shows no such value.
fn mixture(values: &[f64], floor: f64, seed: u64) -> Result<ScalarMixture, ModelError> {
    match values {
        [] => ScalarMixture::new(vec![1.0], vec![1.0], vec![1.0]),
        values => ScalarMixture::fit(values, floor, seed),
    }
}

/// Densities of a share given a value, or uniform ones.
fn shares(pairs: &[(f64, f64)], bins: usize) -> Result<Conditional<SmoothHistogram>, ModelError> {
    let fit = |values: &[f64]| {
        SmoothHistogram::fit(vec![0.0], vec![1.0], vec![bins], bins as f64 / 20.0, values)
    };
    match pairs {
        [] => {
            let spread: Vec<(f64, f64)> = (0..bins)
                .map(|i| (0.0, (i as f64 + 0.5) / bins as f64))
                .collect();
            Conditional::fit(&spread, 1, fit)
        }
        pairs => Conditional::fit(pairs, RANGES, fit),
    }
}

impl ScoreModel {
    /// Learns all densities from whole layouts; every weight is 1. Layouts without elements are left out.
    ///
    /// # Errors
    /// [`ModelError::Empty`] without a layout that has elements; values that are not finite.
    pub fn train(layouts: &[Layout], seed: u64) -> Result<Self, ModelError> {
        let mut seen = Seen::default();
        let mut facades = Vec::new();
        for layout in layouts.iter().filter(|l| !l.elements.is_empty()) {
            let facade = [layout.width, layout.height];
            let grids = grids(layout.width, &layout.elements);
            seen.add(&grids, facade);
            facades.push((grids, layout.width * layout.height));
        }
        if facades.is_empty() {
            return Err(ModelError::Empty { what: "layouts" });
        }
        let pooled: Vec<f64> = seen.aspect.iter().flatten().copied().collect();
        let aspect = |class: usize| {
            let own = &seen.aspect[class];
            mixture(if own.is_empty() { &pooled } else { own }, FLOOR, seed)
        };
        let both = |values: &[Vec<f64>; 2], floor| -> Result<[ScalarMixture; 2], ModelError> {
            Ok([
                mixture(&values[0], floor, seed)?,
                mixture(&values[1], floor, seed)?,
            ])
        };
        Ok(Self {
            aspect: [aspect(0)?, aspect(1)?, aspect(2)?, aspect(3)?],
            spacing: both(&seen.spacing, FLOOR)?,
            regularity: both(&seen.regularity, REGULARITY_FLOOR)?,
            completeness: mixture(&seen.completeness, FLOOR, seed)?,
            patterns: seen.patterns(),
            alignment: [
                shares(&seen.alignment[0], 8)?,
                shares(&seen.alignment[1], 8)?,
            ],
            compatibility: Compatibility::train(facades.iter().map(|(g, a)| (g.as_slice(), *a)))?,
            coverage: mixture(&seen.coverage, FLOOR, seed)?,
            border: both(&seen.border, FLOOR)?,
            symmetry: shares(&seen.symmetry, 20)?,
            weights: [1.0; TERMS],
        })
    }

    /// Checks what a file may hold wrongly.
    ///
    /// # Errors
    /// [`ModelError::Parameter`].
    pub fn check(&self) -> Result<(), ModelError> {
        let weights = self.weights.iter().all(|w| w.is_finite());
        let logs = self.patterns.0.iter().map(|p| p.1);
        let patterns = logs.chain([self.patterns.1]).all(|log| log <= 0.0);
        let conditionals = [&self.alignment[0], &self.alignment[1], &self.symmetry];
        let whole = conditionals.iter().all(|c| c.is_whole());
        match weights && patterns && whole {
            true => Ok(()),
            false => Err(ModelError::parameter("score", "is out of range")),
        }
    }
}
