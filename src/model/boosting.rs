//! Probabilities from features: gradient boosting of oblivious trees with logistic loss.
//!
//! An oblivious tree asks one question `x[feature] > threshold` on each of its levels; the answers are the
//! bits of a leaf's index (Prokhorenkova et al. 2018). With `F(x)` the log odds of the mean target plus the sum of the trees'
//! leaves, `p(y = 1 | x) = 1 / (1 + exp(-F(x)))`. Each tree is a Newton step: with gradient `g = y - p` and curvature
//! `h = p (1 - p)`, a leaf has the value `rate * sum g / (sum h + ridge)`, and each level takes the question that
//! gains most in `sum over leaves (sum g)^2 / (sum h + ridge)`.
//!
//! Features are cut at quantiles, at most [`BINS`] values each; O(features * (rows * levels + BINS * 2^levels)) a tree.

use edifice_base::{Progress, Watch, Watched};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Most values of a feature that are told apart in learning.
pub const BINS: usize = 32;

/// Settings of [`Boosting::learn`]; the example of [`Boosting`] uses them. A tree has `2^levels` leaves; `ridge` is added to a
/// sum of curvatures, each at most 1/4: at 4 it holds a leaf of 16 rows to half a step or less.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Number of trees.
    pub trees: usize,
    /// Questions of a tree.
    pub levels: usize,
    /// Share of a Newton step that is taken.
    pub rate: f64,
    /// Added to the curvature of a leaf.
    pub ridge: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            trees: 60,
            levels: 5,
            rate: 0.15,
            ridge: 4.0,
        }
    }
}

/// A tree: questions, and the value of each combination of answers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Tree {
    features: Vec<usize>,
    thresholds: Vec<f64>,
    leaves: Vec<f64>,
}

/// A learnt function from d features to a probability, `1 / (1 + exp(-F(x)))` as in the [module](self).
///
/// Features may have any units: only their order counts. Learning takes O(d n log n) for the cuts and O(n d levels) a tree for
/// n rows, where these are more than the leaves, and memory for n d bytes of bins; [`Boosting::probability`] is
/// O(trees levels). Sources: Friedman 2001 for boosting, Prokhorenkova et al. 2018 for oblivious trees.
///
/// # Examples
/// Exclusive or, which no sum of functions of one feature can represent:
/// ```
/// use edifice_base::unwatched;
/// use edifice_model::boosting::{Boosting, BoostingError, Settings};
/// let corners = [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0]].repeat(50);
/// let rows: Vec<Vec<f64>> = corners.into_iter().map(Vec::from).collect();
/// let targets: Vec<f64> = rows.iter().map(|x| if x[0] == x[1] { 0.0 } else { 1.0 }).collect();
/// // Unequal numbers: of balanced ones no first question gains anything.
/// let (rows, targets) = (&rows[1..], &targets[1..]);
/// let learnt = Boosting::learn(rows, targets, Settings { levels: 2, ..Settings::default() }, &unwatched)?;
/// assert!(learnt.probability(&[0.0, 1.0]) > 0.9 && learnt.probability(&[1.0, 1.0]) < 0.1);
/// assert!(matches!(Boosting::learn(&[], &[], Settings::default(), &unwatched), Err(BoostingError::Empty)));
/// # Ok::<(), BoostingError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Boosting {
    features: usize,
    prior: f64,
    trees: Vec<Tree>,
}

/// Why a [`Boosting`] cannot be learnt, or read: the first three from [`Boosting::learn`], the last from [`Boosting::check`].
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BoostingError {
    /// There is no row.
    #[error("no rows to learn from")]
    Empty,
    /// A row of another length than the first.
    #[error("row {row} has {found} features, expected {expected}")]
    Length {
        /// Index of the row.
        row: usize,
        /// Its length.
        found: usize,
        /// Length of the first row.
        expected: usize,
    },
    /// A number that is not finite, or a target outside 0 to 1.
    #[error("row {row} has a value that cannot serve")]
    Value {
        /// Index of the row.
        row: usize,
    },
    /// A stored tree whose parts do not fit together.
    #[error("tree {tree} is not a tree over {features} features")]
    Tree {
        /// Index of the tree.
        tree: usize,
        /// Number of features.
        features: usize,
    },
}

impl Boosting {
    /// Learns from rows of features and the probability of each (0 or 1 where it is known), one target for each row. Stopped by
    /// `watch`, it has the trees that were grown until then.
    ///
    /// # Errors
    /// [`BoostingError`] for no rows, rows of different length, and values that are not finite.
    pub fn learn(
        rows: &[Vec<f64>],
        targets: &[f64],
        settings: Settings,
        watch: &Watch,
    ) -> Result<Self, BoostingError> {
        let watched = Watched::new(watch);
        let features = check(rows, targets)?;
        let cuts: Vec<Vec<f64>> = (0..features).map(|f| quantiles(rows, f)).collect();
        // Column by column, so that a level reads each feature in order.
        let binned: Vec<Vec<u8>> = (0..features)
            .map(|f| {
                let bin = |row: &Vec<f64>| cuts[f].partition_point(|&cut| cut < row[f]) as u8;
                rows.iter().map(bin).collect()
            })
            .collect();
        let mean = targets.iter().sum::<f64>() / targets.len() as f64;
        let prior = logit(mean.clamp(1e-4, 1.0 - 1e-4));
        let mut sums = vec![prior; rows.len()];
        let mut trees = Vec::with_capacity(settings.trees);
        for tree in 0..settings.trees {
            let told = Progress::of("trees", tree as u64, settings.trees as u64);
            if !watched.goes_on(told) {
                break;
            }
            let steps: Vec<(f64, f64)> = sums
                .iter()
                .zip(targets)
                .map(|(&sum, &y)| {
                    let p = logistic(sum);
                    (y - p, p * (1.0 - p))
                })
                .collect();
            let (tree, leaf_of) = grow(&binned, &cuts, &steps, settings);
            for (sum, &leaf) in sums.iter_mut().zip(&leaf_of) {
                *sum += tree.leaves[leaf];
            }
            trees.push(tree);
        }
        Ok(Self {
            features,
            prior,
            trees,
        })
    }

    /// Checks a boosting that was read from a file: that its trees are over `features` features, have at most 15 levels, and that
    /// all their numbers are finite.
    ///
    /// # Errors
    /// [`BoostingError::Tree`].
    pub fn check(&self, features: usize) -> Result<(), BoostingError> {
        for (tree, t) in self.trees.iter().enumerate() {
            let levels = t.features.len();
            let fits = levels < 16
                && t.thresholds.len() == levels
                && t.leaves.len() == 1 << levels
                && t.features.iter().all(|&f| f < features)
                && t.leaves.iter().chain(&t.thresholds).all(|v| v.is_finite());
            if !fits || self.features != features || !self.prior.is_finite() {
                return Err(BoostingError::Tree { tree, features });
            }
        }
        Ok(())
    }

    /// Number of features that were learnt from.
    pub fn features(&self) -> usize {
        self.features
    }

    /// The probability of a row of as many features as were learnt from; further ones are not looked at.
    pub fn probability(&self, row: &[f64]) -> f64 {
        let value = |tree: &Tree| {
            let questions = tree.features.iter().zip(&tree.thresholds);
            let leaf = questions
                .enumerate()
                .map(|(level, (&f, &cut))| usize::from(row[f] > cut) << level)
                .sum::<usize>();
            tree.leaves[leaf]
        };
        logistic(self.prior + self.trees.iter().map(value).sum::<f64>())
    }
}

fn check(rows: &[Vec<f64>], targets: &[f64]) -> Result<usize, BoostingError> {
    let expected = rows.first().ok_or(BoostingError::Empty)?.len();
    if targets.len() > rows.len() {
        return Err(BoostingError::Value { row: rows.len() });
    }
    for (row, values) in rows.iter().enumerate() {
        let found = values.len();
        if found != expected {
            return Err(BoostingError::Length {
                row,
                found,
                expected,
            });
        }
        let target = targets.get(row).copied().unwrap_or(f64::NAN);
        if !values.iter().all(|v| v.is_finite()) || !(0.0..=1.0).contains(&target) {
            return Err(BoostingError::Value { row });
        }
    }
    Ok(expected)
}

/// Cuts of a feature between its quantiles, increasing.
fn quantiles(rows: &[Vec<f64>], feature: usize) -> Vec<f64> {
    let mut values: Vec<f64> = rows.iter().map(|row| row[feature]).collect();
    values.sort_by(f64::total_cmp);
    let last = values.len() - 1;
    let mut cuts: Vec<f64> = (1..BINS).map(|k| values[k * last / BINS]).collect();
    cuts.dedup();
    // A cut at the largest value would leave one side empty.
    cuts.retain(|&cut| cut < values[last]);
    cuts
}

/// One tree on gradients and curvatures, and the leaf of each row. Features are looked at on all threads; the question is chosen in
/// their order.
fn grow(
    binned: &[Vec<u8>],
    cuts: &[Vec<f64>],
    steps: &[(f64, f64)],
    settings: Settings,
) -> (Tree, Vec<usize>) {
    let mut leaf_of = vec![0usize; steps.len()];
    let (mut features, mut thresholds) = (Vec::new(), Vec::new());
    for level in 0..settings.levels {
        let leaves = 1 << level;
        let sums = || vec![(0.0, 0.0); leaves * BINS];
        let columns = binned.par_iter().zip(cuts);
        let gains: Vec<Vec<f64>> = columns
            .map_init(sums, |sums, (bins, cuts)| {
                // A feature of one value has no cut.
                if cuts.is_empty() {
                    return Vec::new();
                }
                sums.fill((0.0, 0.0));
                for ((&leaf, &bin), step) in leaf_of.iter().zip(bins).zip(steps) {
                    let sum = &mut sums[leaf * BINS + usize::from(bin)];
                    sum.0 += step.0;
                    sum.1 += step.1;
                }
                gains(sums, cuts.len(), settings.ridge)
            })
            .collect();
        let mut best = (0.0, None);
        for (feature, gains) in gains.into_iter().enumerate() {
            for (cut, gain) in gains.into_iter().enumerate() {
                if gain > best.0 + 1e-12 {
                    best = (gain, Some((feature, cut)));
                }
            }
        }
        let Some((feature, cut)) = best.1 else { break };
        for (leaf, &bin) in leaf_of.iter_mut().zip(&binned[feature]) {
            *leaf |= usize::from(usize::from(bin) > cut) << level;
        }
        features.push(feature);
        thresholds.push(cuts[feature][cut]);
    }
    let mut sums = vec![(0.0, 0.0); 1 << features.len()];
    for (&leaf, step) in leaf_of.iter().zip(steps) {
        sums[leaf].0 += step.0;
        sums[leaf].1 += step.1;
    }
    let leaves = sums
        .iter()
        .map(|(g, h)| settings.rate * g / (h + settings.ridge))
        .collect();
    let tree = Tree {
        features,
        thresholds,
        leaves,
    };
    (tree, leaf_of)
}

/// The gain of each cut of a feature, summed over all leaves, relative to no cut.
fn gains(sums: &[(f64, f64)], cuts: usize, ridge: f64) -> Vec<f64> {
    let value = |g: f64, h: f64| g * g / (h + ridge);
    let mut gains = vec![0.0; cuts];
    for leaf in sums.chunks(BINS) {
        let (g, h) = leaf.iter().fold((0.0, 0.0), |(g, h), s| (g + s.0, h + s.1));
        // A leaf without rows gains nothing.
        if (g, h) == (0.0, 0.0) {
            continue;
        }
        let uncut = value(g, h);
        let (mut gl, mut hl) = (0.0, 0.0);
        for (gain, sum) in gains.iter_mut().zip(leaf) {
            gl += sum.0;
            hl += sum.1;
            *gain += value(gl, hl) + value(g - gl, h - hl) - uncut;
        }
    }
    gains
}

fn logistic(x: f64) -> f64 {
    1.0 / (1.0 + (-x).exp())
}

fn logit(p: f64) -> f64 {
    (p / (1.0 - p)).ln()
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use edifice_base::rng::stream;
    use edifice_base::unwatched;

    #[test]
    fn recovers_the_probabilities_of_a_known_function() {
        let mut rng = stream(1, "boosting", 0);
        let mut truth = Vec::new();
        let (mut rows, mut targets) = (Vec::new(), Vec::new());
        for _ in 0..20_000 {
            let row: Vec<f64> = (0..3).map(|_| rng.random::<f64>()).collect();
            // An exclusive or, which no sum of functions of one feature can say.
            let p = if (row[0] > 0.5) != (row[1] > 0.3) {
                0.9
            } else {
                0.2
            };
            targets.push(f64::from(u8::from(rng.random::<f64>() < p)));
            truth.push(p);
            rows.push(row);
        }
        let learnt = Boosting::learn(&rows, &targets, Settings::default(), &unwatched).unwrap();
        let errors = rows
            .iter()
            .zip(&truth)
            .map(|(r, p)| (learnt.probability(r) - p).abs());
        let mean = errors.sum::<f64>() / rows.len() as f64;
        assert!(mean < 0.04, "{mean}");
        learnt.check(3).unwrap();
        assert!(learnt.check(2).is_err());
    }

    #[test]
    fn bad_rows_are_named() {
        let settings = Settings::default();
        assert_eq!(
            Boosting::learn(&[], &[], settings, &unwatched),
            Err(BoostingError::Empty)
        );
        let rows = [vec![1.0], vec![1.0, 2.0]];
        let length = Boosting::learn(&rows, &[0.0, 1.0], settings, &unwatched);
        assert!(matches!(length, Err(BoostingError::Length { row: 1, .. })));
        let value = Boosting::learn(&[vec![f64::NAN]], &[0.0], settings, &unwatched);
        assert_eq!(value, Err(BoostingError::Value { row: 0 }));
        let more = Boosting::learn(
            &[vec![1.0], vec![2.0]],
            &[0.0, 1.0, 0.5],
            settings,
            &unwatched,
        );
        assert_eq!(more, Err(BoostingError::Value { row: 2 }));
        let fewer = Boosting::learn(&[vec![1.0], vec![2.0]], &[0.0], settings, &unwatched);
        assert_eq!(fewer, Err(BoostingError::Value { row: 1 }));
        // One value only: the prior.
        let constant = Boosting::learn(
            &vec![vec![1.0]; 10],
            &[0.0, 1.0].repeat(5),
            settings,
            &unwatched,
        );
        assert!((constant.unwrap().probability(&[1.0]) - 0.5).abs() < 1e-9);
    }
}
