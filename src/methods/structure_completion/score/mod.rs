//! The statistical model of grid layouts (Sec. 4): ten scoring functions and their factor graph.
//!
//! Elements become [`Grid`]s ([`grid`]). Each grid has unary functions, each pair of grids two
//! binary ones, and the facade global ones ([`Term`]); a feature `f_k` is the mean of function k over
//! all grids or pairs, and the score is `w · f`, the log of Eq. 15 without its partition function:
//!
//! ```text
//! as  ln p(height / width), a density per class            ed  ln pH(width / dH) + ln pV(height / dV)
//! gr  ln pH(σH / grid width) + ln pV(σV / grid height)      gc  ln p(elements / (rows columns))
//! gp  ln P(pattern of two interleaved grids)               ga  ln pH(acH | gapH) + ln pV(acV | gapV)
//! ec  ln(1 - (#GCS - 1) / #OE)                             gv  ln p(area of the grids' boxes / area of the facade)
//! fb  ln pH(left) + ln pH(right) + ln pV(below) + ln pV(above), border over mean element size
//! fs  ln p(symmetric area | position of the doors)
//! ```
//!
//! # Deviations and readings
//! - Equations 1 to 11 define ten functions; two are called `f_gc`. Coverage is `gv` here and has its own weight.
//! - Sums of log densities are unbounded: each further grid with p > 1 would pay. Each density is taken relative to
//!   that of a typical value of the database (the median, [`Training::typical`]), and is at most 0 and at
//!   least [`LEAST`]: no function pays for grids that are more typical than real ones. Regularity and completeness, which tell a hole, are
//!   relative to their most probable values, and a grid more regular than the most probable one counts as that.
//! - Weights are at least 0, and those that a model is learnt with rank completions ([`ranked_weights`](super::policy::ranked_weights)).
//! - Eq. 16 sums a function over all grids. The partition function then depends on the number of grids, and layouts
//!   with other grids cannot be compared: a facade would gain by losing a grid. Here a feature is the mean over
//!   grids (pairs), each counted by its elements; the densities are learnt with the same weights.
//! - A grid: one class, sizes linked by ratios up to e^0.3, lines split at 0.35 of the size. Its mean size stands for
//!   "an element e". Spacings are centre to centre, between neighbours in a row or column.
//!   With one line `ed` and `gr` are left out, with one spacing `gr`.
//! - Eq. 8 is ln 0 for facades of one coherence set of one type; one set scores 0 here.
//! - Patterns count along both axes, for grids that share a line across; half a count for unseen ones.
//! - Alignment is a smoothed histogram for each of four ranges of the gap; symmetry likewise given the
//!   doors, and one of its own for facades without (the paper has v = 0 there, a door at the left).
//! - Symmetry is about the facade's vertical axis; mirror images are sought in the same grid.
//! - Borders: the distances of both ends of each row and column of a grid from the facade's boundary, over the
//!   grid's mean size; a mean over rows and columns. (With the border of the whole facade, one element at each
//!   side would do.)
//! - The deviation of a grid adds that of the elements about their lines to that of the spacings.
//!
//! Complexity: n log n for n elements, and m² for m grids.

mod compatibility;
mod explain;
mod global;
pub mod grid;
mod learn;
mod pair;
mod state;
mod train;

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use self::compatibility::Compatibility;
use self::grid::{Grid, clusters};
use self::pair::Pattern;
use super::layout::{Class, Element};
use edifice_model::density::{Conditional, LogDensity, ScalarMixture, SmoothHistogram, Typical};
pub use explain::TermExplanation;
pub(crate) use learn::from_prior;
pub use learn::{Sites, State, learn_weights};
pub use state::{Change, Scored};
pub use train::Training;

/// Least value of the logarithm of one relative density.
pub const LEAST: f64 = -30.0;

/// The scoring functions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Term {
    /// Element aspect ratio (Eq. 1).
    Aspect,
    /// Element spacing (Eq. 2).
    Spacing,
    /// Grid regularity (Eq. 3).
    Regularity,
    /// Grid completeness (Eq. 4).
    Completeness,
    /// Pattern of interleaved grids (Eq. 5).
    Pattern,
    /// Grid alignment (Eq. 6).
    Alignment,
    /// Element compatibility (Eq. 8).
    Compatibility,
    /// Grid coverage (Eq. 9).
    Coverage,
    /// Facade border (Eq. 10).
    Border,
    /// Facade symmetry (Eq. 11).
    Symmetry,
}

/// Functions that are computed grid by grid.
const UNARY: usize = 5;
/// Number of scoring functions.
pub const TERMS: usize = 10;

impl Term {
    /// All, in the order of features and weights.
    pub const ALL: [Term; TERMS] = [
        Term::Aspect,
        Term::Spacing,
        Term::Regularity,
        Term::Completeness,
        Term::Pattern,
        Term::Alignment,
        Term::Compatibility,
        Term::Coverage,
        Term::Border,
        Term::Symmetry,
    ];

    /// Its name in tables and files.
    pub fn name(self) -> &'static str {
        match self {
            Term::Aspect => "aspect",
            Term::Spacing => "spacing",
            Term::Regularity => "regularity",
            Term::Completeness => "completeness",
            Term::Pattern => "pattern",
            Term::Alignment => "alignment",
            Term::Compatibility => "compatibility",
            Term::Coverage => "coverage",
            Term::Border => "border",
            Term::Symmetry => "symmetry",
        }
    }
}

/// Density of a ratio.
type Ratio = Typical<ScalarMixture>;
/// Density of a share.
type Share = Typical<SmoothHistogram>;

/// The densities of the scoring functions and their weights.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ScoreModel {
    aspect: [Ratio; 4],
    spacing: [Ratio; 2],
    regularity: [Ratio; 2],
    /// The most probable regularity along each axis: what is more regular counts as this. 0 in files of before.
    #[serde(default)]
    regular: [f64; 2],
    completeness: Ratio,
    /// Log probability of each seen pattern relative to the most frequent one, and of others.
    patterns: (Vec<(Pattern, f64)>, f64),
    alignment: [Conditional<Share>; 2],
    compatibility: Compatibility,
    coverage: Ratio,
    border: [Ratio; 2],
    /// The symmetric share of a facade, given where its doors are.
    symmetry: Conditional<Share>,
    /// That of a facade without a door; none in files of before, in which it has a door at the left.
    #[serde(default)]
    doorless: Option<Share>,
    /// w, in the order of [`Term::ALL`].
    pub weights: [f64; TERMS],
}

/// Grids of a layout and what each function makes of them.
#[derive(Debug, Clone)]
pub struct Evaluation {
    /// The grids.
    pub grids: Vec<Arc<Grid>>,
    /// The unary functions of each grid, its border last.
    unary: Vec<[f64; UNARY]>,
    /// The binary functions of each pair of grids (i, j), i < j, row by row.
    pairs: Vec<[f64; 2]>,
    /// f, in the order of [`Term::ALL`].
    pub features: [f64; TERMS],
}

fn dot(weights: &[f64; TERMS], features: &[f64; TERMS]) -> f64 {
    weights.iter().zip(features).map(|(w, f)| w * f).sum()
}

fn floored(log: f64) -> f64 {
    // The least also stands for what is not a number.
    if log > LEAST { log } else { LEAST }
}

fn relative(density: &impl LogDensity, x: f64) -> f64 {
    floored(density.relative(&[x]))
}

impl ScoreModel {
    /// `w · f`.
    pub fn score(&self, features: &[f64; TERMS]) -> f64 {
        dot(&self.weights, features)
    }

    /// Of each label, a class with a size, in a facade where some grids are seen: its probability by the global consistency set
    /// (Sec. 4.3), up to a constant.
    pub(super) fn label_weights(
        &self,
        facade: [f64; 2],
        grids: &[Arc<Grid>],
        labels: impl Iterator<Item = (Class, [f64; 2])>,
    ) -> Vec<f64> {
        let area = facade[0] * facade[1];
        let probabilities = self.compatibility.element_types(grids, area);
        let types = labels.map(|(class, size)| self.compatibility.element_type(class, size, area));
        let types: Vec<usize> = types.collect();
        let alike = |t: usize| types.iter().filter(|o| **o == t).count() as f64;
        types.iter().map(|&t| probabilities[t] / alike(t)).collect()
    }

    /// Extracts the grids of a layout and computes all functions.
    pub fn evaluate(&self, facade: [f64; 2], elements: &[Element]) -> Evaluation {
        let grids = grids(facade[0], elements);
        self.evaluate_grids(facade, grids, |_| None, |_, _| None)
    }

    /// All functions of grids, those excepted that are known: unary ones of grid i, binary ones of grids i, j.
    fn evaluate_grids(
        &self,
        facade: [f64; 2],
        grids: Vec<Arc<Grid>>,
        known_unary: impl Fn(usize) -> Option<[f64; UNARY]>,
        known_pair: impl Fn(usize, usize) -> Option<[f64; 2]>,
    ) -> Evaluation {
        let mut features = [0.0; TERMS];
        let unary: Vec<[f64; UNARY]> = (grids.iter().enumerate())
            .map(|(i, g)| known_unary(i).unwrap_or_else(|| self.unary(g, facade)))
            .collect();
        let mut pairs = Vec::with_capacity(grids.len() * grids.len() / 2);
        for i in 0..grids.len() {
            for j in i + 1..grids.len() {
                let known = known_pair(i, j);
                pairs.push(known.unwrap_or_else(|| self.binary(&grids[i], &grids[j], facade)));
            }
        }
        // Means over elements: a grid counts by its elements, a pair by those of both grids.
        let count = |i: usize| grids[i].members.len() as f64;
        let total: f64 = (0..grids.len()).map(count).sum();
        for (i, values) in unary.iter().enumerate() {
            (0..4).for_each(|k| features[k] += values[k] * count(i) / total);
            features[Term::Border as usize] += values[4] * count(i) / total;
        }
        // Each grid is in m - 1 pairs.
        let of_pairs = total * (grids.len() as f64 - 1.0);
        let indices = (0..grids.len()).flat_map(|i| (i + 1..grids.len()).map(move |j| (i, j)));
        for (values, (i, j)) in pairs.iter().zip(indices) {
            let share = (count(i) + count(j)) / of_pairs;
            (0..2).for_each(|k| features[4 + k] += values[k] * share);
        }
        if grids.is_empty() {
            features[6..].fill(LEAST);
        } else {
            let [compatibility, coverage, symmetry] = self.global(&grids, facade);
            features[Term::Compatibility as usize] = compatibility;
            features[Term::Coverage as usize] = coverage;
            features[Term::Symmetry as usize] = symmetry;
        }
        Evaluation {
            grids,
            unary,
            pairs,
            features,
        }
    }

    /// Equations 1 to 4 and 10.
    fn unary(&self, grid: &Grid, facade: [f64; 2]) -> [f64; UNARY] {
        let per_axis = |f: &dyn Fn(usize) -> Option<f64>| (0..2).filter_map(f).sum::<f64>();
        [
            relative(
                &self.aspect[grid.class.index()],
                grid.size[1] / grid.size[0],
            ),
            per_axis(&|axis| {
                let ratio = grid.size[axis] / grid.spacing[axis]?;
                Some(relative(&self.spacing[axis], ratio))
            }),
            per_axis(&|axis| {
                let ratio = grid.deviation[axis]? / grid.extent(axis);
                let ratio = ratio.max(self.regular[axis]);
                Some(relative(&self.regularity[axis], ratio))
            }),
            relative(&self.completeness, grid.completeness()),
            (0..2).map(|axis| self.borders(grid, axis, facade)).sum(),
        ]
    }

    /// Mean of the two border functions over the grid's rows (axis 0) or columns (axis 1).
    fn borders(&self, grid: &Grid, axis: usize, facade: [f64; 2]) -> f64 {
        let ends = grid.ends[axis].iter();
        let both = ends.map(|&[low, high]| {
            let far = facade[axis] - high;
            relative(&self.border[axis], low / grid.size[axis])
                + relative(&self.border[axis], far / grid.size[axis])
        });
        both.sum::<f64>() / grid.ends[axis].len() as f64
    }

    /// Equations 5 and 6.
    fn binary(&self, a: &Grid, b: &Grid, facade: [f64; 2]) -> [f64; 2] {
        let mut values = [0.0; 2];
        for axis in 0..2 {
            if let Some(pattern) = pair::pattern(a, b, axis) {
                values[0] += self.pattern(pattern);
            }
            if let Some((gap, share)) = pair::alignment(a, b, axis, facade) {
                values[1] += relative(self.alignment[axis].given(gap), share);
            }
        }
        values
    }

    fn pattern(&self, pattern: Pattern) -> f64 {
        let (known, unseen) = &self.patterns;
        let found = known.iter().find(|(p, _)| *p == pattern);
        floored(found.map_or(*unseen, |(_, log)| *log))
    }

    /// Equations 8, 9 and 11; of at least one grid.
    fn global(&self, grids: &[Arc<Grid>], facade: [f64; 2]) -> [f64; 3] {
        let (sets, types) = self.compatibility.cover(grids, facade[0] * facade[1]);
        let (area, door) = global::symmetry(grids, facade);
        let symmetry = match (door, &self.doorless) {
            (None, Some(density)) => density,
            _ => self.symmetry.given(door.unwrap_or(0.0)),
        };
        [
            (1.0 - (sets as f64 - 1.0) / types as f64).ln(),
            relative(&self.coverage, global::coverage(grids, facade)),
            relative(symmetry, area),
        ]
    }
}

/// The grids of a layout in a facade of so much width, class by class.
pub fn grids(width: f64, elements: &[Element]) -> Vec<Arc<Grid>> {
    let mut all = Vec::new();
    for class in Class::ALL {
        let of_class: Vec<u32> = (0..elements.len() as u32)
            .filter(|&i| elements[i as usize].class == class)
            .collect();
        for members in clusters(elements, &of_class) {
            all.push(Arc::new(Grid::new(elements, members, class, width)));
        }
    }
    all
}
