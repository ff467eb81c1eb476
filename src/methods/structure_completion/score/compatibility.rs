//! Compatibility: the element types that occur together (Eq. 7 and 8).
//!
//! An element type is a class, smaller or larger, and lower or taller than the median of that class in the
//! database: 16 types. A coherence set holds the types of one facade. The smallest cover of the types
//! of a layout by coherence sets is found for all 2^16 sets of types at once:
//! `cover(S) = min over sets C with the lowest type of S of 1 + cover(S \ C)`; a type that no set holds counts
//! as a set of its own.

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
                same.map(move |g| measures(g, area))
            });
            let all: Vec<[f64; 2]> = grids.collect();
            for (i, median) in medians[class.index()].iter_mut().enumerate() {
                let mut values: Vec<f64> = all.iter().map(|m| m[i]).collect();
                values.sort_by(f64::total_cmp);
                *median = values.get(values.len() / 2).copied().unwrap_or(1.0);
            }
        }
        let mut sets: Vec<(u16, u32)> = Vec::new();
        for (grids, area) in facades {
            let set = types(&medians, grids, area);
            match sets.iter_mut().find(|s| s.0 == set) {
                Some(known) => known.1 += 1,
                None => sets.push((set, 1)),
            }
        }
        sets.sort_unstable();
        Parts { medians, sets }.try_into()
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

fn measures(grid: &Grid, area: f64) -> [f64; 2] {
    let [width, height] = grid.size;
    [(width * height / area).sqrt(), height / width]
}

fn types(medians: &[[f64; 2]; 4], grids: &[std::sync::Arc<Grid>], area: f64) -> u16 {
    grids.iter().fold(0, |set, grid| {
        let class = grid.class.index();
        let [size, aspect] = measures(grid, area);
        let [typical_size, typical_aspect] = medians[class];
        let kind = usize::from(size > typical_size) + 2 * usize::from(aspect > typical_aspect);
        set | 1 << (4 * class + kind)
    })
}

impl TryFrom<Parts> for Compatibility {
    type Error = ModelError;

    fn try_from(parts: Parts) -> Result<Self, ModelError> {
        if !parts.medians.iter().flatten().all(|m| m.is_finite()) {
            return Err(ModelError::parameter("medians", "are not all numbers"));
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
