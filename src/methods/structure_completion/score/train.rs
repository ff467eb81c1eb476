//! Learning the densities from whole layouts.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::compatibility::Compatibility;
use super::grid::Grid;
use super::{Ratio, ScoreModel, Share, TERMS, global, grids, pair};
use crate::layout::Layout;
use edifice_model::ModelError;
use edifice_model::density::{Conditional, LogDensity, ScalarMixture, SmoothHistogram, Typical};

/// Ranges of the gap, or of the door position, that have their own density.
const RANGES: usize = 4;
/// Least standard deviations of densities: of aspect ratios and completeness.
const FLOOR: f64 = 0.01;
/// Least standard deviations of densities of size over spacing and of the covered share. A facade gives few values of these, and
/// a mixture of some tens of values would have a peak at each.
const SPACING_FLOOR: f64 = 0.1;
const COVERAGE_FLOOR: f64 = 0.1;
/// Least standard deviation of a density of borders, in sizes of an element.
const BORDER_FLOOR: f64 = 0.3;
/// Least standard deviation of a density of regularity. A deviation is divided by the extent of a whole grid, so that one element
/// that is visibly off its line gives some thousandths.
const REGULARITY_FLOOR: f64 = 0.0005;
/// Level at which only the most probable value of the database scores 0 ([`Training::typical`]).
const MODE: f64 = 1.0;

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
    /// Position of the doors, and symmetric share.
    symmetry: Vec<(f64, f64)>,
    /// Symmetric shares of facades without a door.
    doorless: Vec<f64>,
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
        match door {
            Some(door) => self.symmetry.push((door, area)),
            None => self.doorless.push(area),
        }
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
fn mixture(
    values: &[(f64, f64)],
    floor: f64,
    typical: f64,
    seed: u64,
) -> Result<Ratio, ModelError> {
    let density = match values {
        [] => ScalarMixture::new(vec![1.0], vec![1.0], vec![1.0])?,
        values => ScalarMixture::fit_weighted(values, floor, seed)?,
    };
    let rows = values.iter().map(|(v, w)| (std::slice::from_ref(v), *w));
    Ok(Typical::new(density, rows, typical))
}

/// The most probable of some values, 0 of none.
fn mode(density: &Ratio, values: &[(f64, f64)]) -> f64 {
    let logs = values.iter().map(|(v, _)| (*v, density.log_density(&[*v])));
    logs.max_by(|a, b| a.1.total_cmp(&b.1)).map_or(0.0, |l| l.0)
}

/// Density of a share, a uniform one without values.
fn share(values: &[f64], bins: usize, typical: f64) -> Result<Share, ModelError> {
    let spread: Vec<f64> = (0..bins).map(|i| (i as f64 + 0.5) / bins as f64).collect();
    let values = if values.is_empty() { &spread } else { values };
    let smoothing = bins as f64 / 20.0;
    let density = SmoothHistogram::fit(vec![0.0], vec![1.0], vec![bins], smoothing, values)?;
    let rows = values.iter().map(|v| (std::slice::from_ref(v), 1.0));
    Ok(Typical::new(density, rows, typical))
}

/// Densities of a share given a value, or a uniform one.
fn shares(
    pairs: &[(f64, f64)],
    bins: usize,
    typical: f64,
) -> Result<Conditional<Share>, ModelError> {
    match pairs {
        [] => Conditional::fit(&[(0.0, 0.5)], 1, |_| share(&[], bins, typical)),
        pairs => Conditional::fit(pairs, RANGES, |values| share(values, bins, typical)),
    }
}

/// Settings of [`ScoreModel::train`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Training {
    /// Share of the database's values that are less probable than what counts as typical; at 1 only the
    /// most probable value of all scores 0. Regularity and completeness are relative to their modes in any case.
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
        let Training { typical, seed } = *settings;
        let aspect = |class: usize| {
            let own = &seen.aspect[class];
            let values = if own.is_empty() { &pooled } else { own };
            mixture(values, FLOOR, typical, seed)
        };
        let both = |values: &[Vec<(f64, f64)>; 2], floor, typical| {
            let one = |axis: usize| mixture(&values[axis], floor, typical, seed);
            Ok::<_, ModelError>([one(0)?, one(1)?])
        };
        let regularity = both(&seen.regularity, REGULARITY_FLOOR, MODE)?;
        let doorless: Vec<f64> = match seen.doorless.is_empty() {
            // Without a facade that has none, as with any door.
            true => seen.symmetry.iter().map(|s| s.1).collect(),
            false => seen.doorless.clone(),
        };
        Ok(Self {
            aspect: [aspect(0)?, aspect(1)?, aspect(2)?, aspect(3)?],
            spacing: both(&seen.spacing, SPACING_FLOOR, typical)?,
            regular: [0, 1].map(|axis| mode(&regularity[axis], &seen.regularity[axis])),
            regularity,
            completeness: mixture(&seen.completeness, FLOOR, MODE, seed)?,
            patterns: seen.patterns(),
            alignment: [
                shares(&seen.alignment[0], 8, typical)?,
                shares(&seen.alignment[1], 8, typical)?,
            ],
            compatibility: Compatibility::train(facades.iter().map(|(g, a)| (g.as_slice(), *a)))?,
            coverage: mixture(&seen.coverage, COVERAGE_FLOOR, typical, seed)?,
            border: both(&seen.border, BORDER_FLOOR, typical)?,
            symmetry: shares(&seen.symmetry, 20, typical)?,
            doorless: Some(share(&doorless, 20, typical)?),
            weights: [1.0; TERMS],
        })
    }

    /// Checks what a file may hold wrongly.
    ///
    /// # Errors
    /// [`ModelError::Parameter`].
    pub fn check(&self) -> Result<(), ModelError> {
        let weights = self.weights.iter().all(|w| w.is_finite());
        let regular = self.regular.iter().all(|r| *r >= 0.0);
        let logs = self.patterns.0.iter().map(|p| p.1);
        let patterns = logs.chain([self.patterns.1]).all(|log| log <= 0.0);
        let conditionals = [&self.alignment[0], &self.alignment[1], &self.symmetry];
        let whole = conditionals.iter().all(|c| c.is_whole());
        match weights && regular && patterns && whole {
            true => Ok(()),
            false => Err(ModelError::parameter("score", "is out of range")),
        }
    }
}
