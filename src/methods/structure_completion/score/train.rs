//! Learning the densities from whole layouts.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::compatibility::Compatibility;
use super::grid::Grid;
use super::{Ratio, ScoreModel, Share, TERMS, global, grids, pair};
use crate::layout::Layout;
use edifice_model::ModelError;
use edifice_model::density::{Conditional, ScalarMixture, SmoothHistogram, Typical};

/// Ranges of the gap, or of the door position, that have their own density.
const RANGES: usize = 4;
/// Least standard deviations of the ratios' densities.
const FLOOR: f64 = 0.01;
/// Least standard deviation of a density of regularity.
const REGULARITY_FLOOR: f64 = 0.005;

/// Values seen in the database, those of grids with the number of their elements.
#[derive(Default)]
struct Seen {
    aspect: [Vec<(f64, f64)>; 4],
    spacing: [Vec<(f64, f64)>; 2],
    regularity: [Vec<(f64, f64)>; 2],
    completeness: Vec<(f64, f64)>,
    patterns: BTreeMap<pair::Pattern, f64>,
    alignment: [Vec<(f64, f64)>; 2],
    coverage: Vec<(f64, f64)>,
    border: [Vec<(f64, f64)>; 2],
    symmetry: Vec<(f64, f64)>,
}

impl Seen {
    fn add(&mut self, grids: &[Arc<Grid>], facade: [f64; 2]) {
        for (i, g) in grids.iter().enumerate() {
            let count = g.members.len() as f64;
            self.aspect[g.class.index()].push((g.size[1] / g.size[0], count));
            for axis in 0..2 {
                self.spacing[axis].extend(g.spacing[axis].map(|d| (g.size[axis] / d, count)));
                self.regularity[axis]
                    .extend(g.deviation[axis].map(|s| (s / g.extent(axis), count)));
            }
            for (axis, extent) in facade.iter().enumerate() {
                let share = count / (2 * g.ends[axis].len()) as f64;
                for [low, high] in &g.ends[axis] {
                    let border = [*low, extent - high];
                    self.border[axis].extend(border.map(|b| (b / g.size[axis], share)));
                }
            }
            self.completeness.push((g.completeness(), count));
            for other in &grids[i + 1..] {
                for axis in 0..2 {
                    if let Some(pattern) = pair::pattern(g, other, axis) {
                        *self.patterns.entry(pattern).or_default() += 1.0;
                    }
                    self.alignment[axis].extend(pair::alignment(g, other, axis, facade));
                }
            }
        }
        self.coverage.push((global::coverage(grids, facade), 1.0));
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
fn mixture(values: &[(f64, f64)], floor: f64, settings: &Training) -> Result<Ratio, ModelError> {
    let density = match values {
        [] => ScalarMixture::new(vec![1.0], vec![1.0], vec![1.0])?,
        values => ScalarMixture::fit_weighted(values, floor, settings.seed)?,
    };
    let rows = values.iter().map(|(v, w)| (std::slice::from_ref(v), *w));
    Ok(Typical::new(density, rows, settings.typical))
}

/// Densities of a share given a value, or uniform ones.
fn shares(pairs: &[(f64, f64)], bins: usize, settings: &Training) -> Result<Share, ModelError> {
    let fit = |values: &[f64]| {
        let smoothing = bins as f64 / 20.0;
        let density = SmoothHistogram::fit(vec![0.0], vec![1.0], vec![bins], smoothing, values)?;
        let rows = values.iter().map(|v| (std::slice::from_ref(v), 1.0));
        Ok(Typical::new(density, rows, settings.typical))
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

/// Settings of [`ScoreModel::train`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Training {
    /// Share of the database's values that are less probable than what counts as typical; at 1 only the
    /// most probable value of all scores 0.
    pub typical: f64,
    /// Seed of the mixtures' starts.
    pub seed: u64,
}

impl Default for Training {
    fn default() -> Self {
        Self {
            typical: 0.5,
            seed: 1,
        }
    }
}

impl ScoreModel {
    /// Learns all densities from whole layouts; every weight is 1. Layouts without elements are left out.
    ///
    /// # Errors
    /// [`ModelError::Empty`] without a layout that has elements; values that are not finite.
    pub fn train(layouts: &[Layout], settings: &Training) -> Result<Self, ModelError> {
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
        let pooled: Vec<(f64, f64)> = seen.aspect.iter().flatten().copied().collect();
        let aspect = |class: usize| {
            let own = &seen.aspect[class];
            mixture(if own.is_empty() { &pooled } else { own }, FLOOR, settings)
        };
        let both = |values: &[Vec<(f64, f64)>; 2], floor| -> Result<[Ratio; 2], ModelError> {
            Ok([
                mixture(&values[0], floor, settings)?,
                mixture(&values[1], floor, settings)?,
            ])
        };
        Ok(Self {
            aspect: [aspect(0)?, aspect(1)?, aspect(2)?, aspect(3)?],
            spacing: both(&seen.spacing, FLOOR)?,
            regularity: both(&seen.regularity, REGULARITY_FLOOR)?,
            completeness: mixture(&seen.completeness, FLOOR, settings)?,
            patterns: seen.patterns(),
            alignment: [
                shares(&seen.alignment[0], 8, settings)?,
                shares(&seen.alignment[1], 8, settings)?,
            ],
            compatibility: Compatibility::train(facades.iter().map(|(g, a)| (g.as_slice(), *a)))?,
            coverage: mixture(&seen.coverage, FLOOR, settings)?,
            border: both(&seen.border, FLOOR)?,
            symmetry: shares(&seen.symmetry, 20, settings)?,
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
