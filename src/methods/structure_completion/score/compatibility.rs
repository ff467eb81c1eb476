//! Compatibility: the element types that occur together (Eq. 7 and 8).
//!
//! An element type is a class, smaller or larger, and lower or taller than the median of that class in the
//! database: 16 types. A coherence set holds the types of one facade. The smallest cover of the types
//! of a layout by coherence sets is found for all 2^16 sets of types at once:
//! `cover(S) = min over sets C with the lowest type of S of 1 + cover(S \ C)`; a type that no set holds counts
//! as a set of its own.
//!
//! A label of the database is one of the global consistency set (GCS) of what is observed: of a smallest cover. Each set has the
//! probability of its facades, each type in it that of its grids among the grids of the set's facades. The paper samples one
//! cover where several are smallest, with the probabilities of their sets; [`Compatibility::element_types`] is the mean over all
//! of them, as if one were sampled for each label. Between the sets of a cover the paper does not choose: they are equal here.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::grid::Grid;
use crate::layout::Class;
use edifice_model::ModelError;

const TYPES: usize = 16;

/// The element types, and how many coherence sets cover any set of them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Parts", into = "Parts")]
pub(super) struct Compatibility {
    parts: Parts,
    cover: Vec<u8>,
}

/// The content of a file: medians of sizes, and coherence sets.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Parts {
    /// Per class: median of sqrt(element area / facade area), and of height / width.
    medians: [[f64; 2]; 4],
    /// Coherence sets, one bit for each type, each with the number of facades that have just this one.
    sets: Vec<(u16, u32)>,
    /// Number of grids of each type in the facades of each set; empty in files of before.
    #[serde(default)]
    grids: Vec<[u32; TYPES]>,
}

/// Sums over covers: of their probabilities, and of these times the probabilities of types in each set.
#[derive(Debug, Clone, Copy, Default)]
struct Covers {
    probability: f64,
    types: [f64; TYPES],
}

impl Compatibility {
    /// From the grids of facades, each with the facade's area.
    ///
    /// # Errors
    /// [`ModelError::Parameter`] when a median is not a number.
    pub(super) fn train<'a>(
        facades: impl Iterator<Item = (&'a [std::sync::Arc<Grid>], f64)> + Clone,
    ) -> Result<Self, ModelError> {
        let mut medians = [[1.0; 2]; 4];
        for class in Class::ALL {
            let grids = facades.clone().flat_map(|(grids, area)| {
                let same = grids.iter().filter(move |g| g.class == class);
                same.map(move |g| measures(g.size, area))
            });
            let all: Vec<[f64; 2]> = grids.collect();
            for (i, median) in medians[class.index()].iter_mut().enumerate() {
                let mut values: Vec<f64> = all.iter().map(|m| m[i]).collect();
                values.sort_by(f64::total_cmp);
                *median = values.get(values.len() / 2).copied().unwrap_or(1.0);
            }
        }
        let mut found: BTreeMap<u16, (u32, [u32; TYPES])> = BTreeMap::new();
        for (grids, area) in facades {
            let (count, of_types) = found.entry(types(&medians, grids, area)).or_default();
            *count += 1;
            for grid in grids {
                of_types[element_type(&medians, grid.class, grid.size, area)] += 1;
            }
        }
        let sets = found.iter().map(|(set, (count, _))| (*set, *count));
        let sets = sets.collect();
        let grids = found.into_values().map(|(_, grids)| grids).collect();
        Parts {
            medians,
            sets,
            grids,
        }
        .try_into()
    }

    /// The element type of a class and size in a facade of some area.
    pub(super) fn element_type(&self, class: Class, size: [f64; 2], area: f64) -> usize {
        element_type(&self.parts.medians, class, size, area)
    }

    /// Probability of each element type in the global consistency set of some grids; types that no facade of the database has do
    /// not count, and without others it is the mean over all facades.
    pub(super) fn element_types(&self, grids: &[std::sync::Arc<Grid>], area: f64) -> [f64; TYPES] {
        let known = self.parts.sets.iter().fold(0, |all, s| all | s.0);
        let observed = types(&self.parts.medians, grids, area) & known;
        let covers = match observed {
            0 => {
                let sets = (0..self.parts.sets.len()).map(|i| self.alone(i));
                sets.fold(Covers::default(), |all, set| all.or(&set))
            }
            _ => self.covers(observed),
        };
        let sum: f64 = covers.types.iter().sum();
        covers.types.map(|p| p / sum)
    }

    /// Probability of each type in a set, times that of the set (up to a constant).
    fn alone(&self, i: usize) -> Covers {
        let (set, count) = self.parts.sets[i];
        let count = f64::from(count);
        let own = self.parts.grids.get(i).filter(|g| g.iter().any(|n| *n > 0));
        let of_type = |t: usize| match own {
            Some(grids) => {
                let all: u32 = grids.iter().sum();
                f64::from(grids[t]) / f64::from(all)
            }
            None => f64::from(set >> t & 1) / f64::from(set.count_ones().max(1)),
        };
        Covers {
            probability: count,
            types: std::array::from_fn(|t| count * of_type(t)),
        }
    }

    /// Sums over the smallest covers of some types, each of which a set holds.
    fn covers(&self, observed: u16) -> Covers {
        // By the types that are left to cover, sums over the choices among the sets so far.
        let mut sums = BTreeMap::from([(observed, Covers::NONE)]);
        for (i, (set, _)) in self.parts.sets.iter().enumerate() {
            // The fewer are left, the smaller is the number: none gets a set twice.
            let open: Vec<u16> = sums.keys().copied().collect();
            for rest in open {
                let left = rest & !set;
                if self.cover[usize::from(left)] < self.cover[usize::from(rest)] {
                    let more = sums[&rest].and(&self.alone(i));
                    let own = sums.entry(left).or_default();
                    *own = own.or(&more);
                }
            }
        }
        sums.remove(&0).unwrap_or_default()
    }

    /// `#GCS` and `#OE`: how many coherence sets cover the types of the grids, and how many types there are.
    pub(super) fn cover(&self, grids: &[std::sync::Arc<Grid>], area: f64) -> (usize, usize) {
        let set = types(&self.parts.medians, grids, area);
        (
            usize::from(self.cover[usize::from(set)]),
            set.count_ones() as usize,
        )
    }
}

fn measures([width, height]: [f64; 2], area: f64) -> [f64; 2] {
    [(width * height / area).sqrt(), height / width]
}

fn element_type(medians: &[[f64; 2]; 4], class: Class, size: [f64; 2], area: f64) -> usize {
    let [typical_size, typical_aspect] = medians[class.index()];
    let [size, aspect] = measures(size, area);
    let kind = usize::from(size > typical_size) + 2 * usize::from(aspect > typical_aspect);
    4 * class.index() + kind
}

fn types(medians: &[[f64; 2]; 4], grids: &[std::sync::Arc<Grid>], area: f64) -> u16 {
    grids.iter().fold(0, |set, grid| {
        set | 1 << element_type(medians, grid.class, grid.size, area)
    })
}

impl Covers {
    /// The cover of nothing.
    const NONE: Self = Self {
        probability: 1.0,
        types: [0.0; TYPES],
    };

    /// The sums over the covers of both.
    fn or(&self, other: &Self) -> Self {
        Self {
            probability: self.probability + other.probability,
            types: std::array::from_fn(|t| self.types[t] + other.types[t]),
        }
    }

    /// Each cover with one more set.
    fn and(&self, set: &Self) -> Self {
        Self {
            probability: self.probability * set.probability,
            types: std::array::from_fn(|t| {
                self.types[t] * set.probability + self.probability * set.types[t]
            }),
        }
    }
}

impl TryFrom<Parts> for Compatibility {
    type Error = ModelError;

    fn try_from(parts: Parts) -> Result<Self, ModelError> {
        if !parts.medians.iter().flatten().all(|m| m.is_finite()) {
            return Err(ModelError::parameter("medians", "are not all numbers"));
        }
        if !(parts.grids.is_empty() || parts.grids.len() == parts.sets.len()) {
            return Err(ModelError::parameter(
                "grids",
                "are not one list for each set",
            ));
        }
        // Only sets that no other set holds matter, and those of one type only.
        let all = parts.sets.iter().map(|s| s.0);
        let mut greatest: Vec<u16> = all
            .clone()
            .filter(|&s| !all.clone().any(|t| s != t && s & t == s))
            .collect();
        greatest.sort_unstable();
        greatest.dedup();
        let mut cover = vec![0u8; 1 << TYPES];
        for set in 1..cover.len() {
            let lowest = set & set.wrapping_neg();
            let alone = cover[set & !lowest];
            let with = greatest
                .iter()
                .filter(|&&c| usize::from(c) & lowest != 0)
                .map(|&c| cover[set & !usize::from(c)]);
            cover[set] = 1 + with.min().unwrap_or(alone);
        }
        Ok(Self { parts, cover })
    }
}

impl From<Compatibility> for Parts {
    fn from(compatibility: Compatibility) -> Self {
        compatibility.parts
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::RngExt;

    /// All choices of so many of the sets, whether they cover or not.
    fn choices(sets: usize, count: usize) -> Vec<Vec<usize>> {
        let all = (0..1usize << sets).map(|chosen| (0..sets).filter(move |i| chosen >> i & 1 == 1));
        all.map(Iterator::collect)
            .filter(|chosen: &Vec<usize>| chosen.len() == count)
            .collect()
    }

    #[test]
    fn types_have_their_probabilities_in_the_smallest_covers() {
        let mut rng = edifice_base::rng::stream(4, "covers", 0);
        for round in 0..2000 {
            let types = rng.random_range(1..7);
            let mut found = BTreeMap::new();
            for _ in 0..rng.random_range(1..8) {
                let set = rng.random_range(1..1u16 << types);
                let grids = std::array::from_fn(|t| match set >> t & 1 {
                    1 => rng.random_range(1..5),
                    _ => 0,
                });
                found.insert(set, (rng.random_range(1..9u32), grids));
            }
            let sets: Vec<(u16, u32)> = found.iter().map(|(s, f)| (*s, f.0)).collect();
            let grids: Vec<[u32; TYPES]> = found.values().map(|f| f.1).collect();
            let known = sets.iter().fold(0, |all, s| all | s.0);
            let medians = [[1.0; 2]; 4];
            let parts = Parts {
                medians,
                sets: sets.clone(),
                grids: grids.clone(),
            };
            let compatibility = Compatibility::try_from(parts).unwrap();
            let observed = known & rng.random_range(0..1 << types);
            if observed == 0 {
                continue;
            }
            // By hand: the least number of sets that cover, all such covers, and the mean over their sets.
            let covers = (1..=sets.len()).find_map(|count| {
                let covers = choices(sets.len(), count).into_iter().filter(|chosen| {
                    chosen.iter().fold(observed, |left, i| left & !sets[*i].0) == 0
                });
                Some(covers.collect::<Vec<_>>()).filter(|covers| !covers.is_empty())
            });
            let covers = covers.unwrap();
            let mut expected = [0.0; TYPES];
            let weight = |cover: &Vec<usize>| -> f64 {
                cover.iter().map(|i| f64::from(sets[*i].1)).product()
            };
            let total: f64 = covers.iter().map(weight).sum();
            for cover in &covers {
                for i in cover {
                    let all: u32 = grids[*i].iter().sum();
                    for (t, p) in expected.iter_mut().enumerate() {
                        let share = f64::from(grids[*i][t]) / f64::from(all);
                        *p += weight(cover) / total * share / cover.len() as f64;
                    }
                }
            }
            let sums = compatibility.covers(observed);
            let sum: f64 = sums.types.iter().sum();
            for (t, (own, expected)) in sums.types.iter().zip(expected).enumerate() {
                assert!((own / sum - expected).abs() < 1e-9, "{round}: type {t}");
            }
            assert!((sums.probability / total - 1.0).abs() < 1e-9, "{round}");
        }
    }
}
