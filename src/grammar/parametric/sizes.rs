//! The size of a part, as a mixture of what the facade and the library say about it.
//!
//! A part of the rule `r` at slot `(item, place, repetition)` starts at a cut and may reach from 1 to `max` steps.
//! Each *predictor* is a distribution over these sizes:
//!
//! | in this facade | in the library |
//! | --- | --- |
//! | the same slot and repetition of `r` | the same slot of `r`: exact sizes; kernels of 1.5 and 6 steps |
//! | the next cuts of the axis, halving from one to the next | the same slot as a share of its region, kernel of 3 steps |
//! | the same slot in any repetition | the symbol on this axis, kernel of 3 steps |
//! | the mirrored slot | the axis, kernel of 3 steps |
//! | the symbol on this axis | |
//! | any part of the axis | all sizes alike |
//! | | the same slot of `r`: a normal distribution, which speaks in [`SizeModel::Normal`] alone |
//!
//! so that equal, repeated, mirrored and aligned sizes share a parameter. The weights of the mixture are counts of
//! how well each predictor did (its share in the probability of what came), kept apart for each set of
//! predictors that have something to say.

use std::collections::{BTreeMap, BTreeSet};

use rustc_hash::FxHashMap;

use super::coder::Coder;
use super::rules::Symbol;
use super::tree::{Slot, index};
use edifice_shape::Axis;

/// Number of predictors.
const PREDICTORS: usize = 14;

/// The weight of each predictor before anything was seen.
const PRIOR: [f64; PREDICTORS] = [
    2.0, 1.0, 0.5, 0.5, 0.3, 0.1, 0.5, 0.5, 0.3, 0.3, 0.2, 0.1, 0.05, 2.0,
];

/// The number of times that each size was seen.
pub(super) type Sizes = BTreeMap<u32, u32>;

/// A slot of a rule in any repetition.
pub(super) type SlotKey = (u32, u32, u32);

/// The least standard deviation of a normal distribution of sizes, in steps.
const LEAST_DEVIATION: f64 = 1.0;

/// The predictors that may speak.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SizeModel {
    /// All but the normal distribution: sizes are tied within a facade, and distributed as they were seen.
    #[default]
    Shared,
    /// Mean and standard deviation of each slot, and all sizes alike: every size is told for itself (the rules of
    /// Weissenberg et al. 2013).
    Normal,
}

/// Sizes that were seen, by what they belong to.
#[derive(Debug, Clone, Default)]
pub struct SizeTable {
    pub(super) model: SizeModel,
    place: FxHashMap<SlotKey, Sizes>,
    /// Sizes with the extent of their region.
    share: FxHashMap<SlotKey, BTreeMap<(u32, u32), u32>>,
    symbol: FxHashMap<(Axis, Symbol), Sizes>,
    axis: [Sizes; 2],
}

fn change<K: Ord>(counts: &mut BTreeMap<K, u32>, key: K, more: bool) {
    let count = counts.entry(key).or_default();
    *count = if more {
        *count + 1
    } else {
        count.saturating_sub(1)
    };
}

impl SizeTable {
    /// Adds one size, or takes it away.
    pub fn change(&mut self, at: &Question, size: u32, more: bool) {
        change(self.place.entry(at.place()).or_default(), size, more);
        change(
            self.share.entry(at.place()).or_default(),
            (size, at.extent),
            more,
        );
        change(
            self.symbol.entry((at.axis, at.slot.symbol)).or_default(),
            size,
            more,
        );
        change(&mut self.axis[index(at.axis)], size, more);
    }
}

/// The part whose size is asked for.
#[derive(Debug, Clone, Copy)]
pub struct Question {
    /// Rule of the region.
    pub rule: u32,
    /// Its direction.
    pub axis: Axis,
    /// Extent of the region along it.
    pub extent: u32,
    /// The slot.
    pub slot: Slot,
    /// The start of the part, in the facade.
    pub start: u32,
    /// Greatest size.
    pub max: u32,
    /// Size of the mirrored slot of the same symbol, where it is known.
    pub mirrored: Option<u32>,
}

impl Question {
    fn place(&self) -> SlotKey {
        (self.rule, self.slot.item, self.slot.place)
    }
}

/// The sizes and cuts of the facade at hand so far.
#[derive(Debug, Clone, Default)]
pub(super) struct SizeMemory {
    slot: FxHashMap<(SlotKey, u32), Sizes>,
    place: FxHashMap<SlotKey, Sizes>,
    symbol: FxHashMap<(Axis, Symbol), Sizes>,
    axis: [Sizes; 2],
    cuts: [BTreeSet<u32>; 2],
}

impl SizeMemory {
    /// Remembers a size.
    pub(super) fn add(&mut self, at: &Question, size: u32) {
        change(
            self.slot
                .entry((at.place(), at.slot.repetition))
                .or_default(),
            size,
            true,
        );
        change(self.place.entry(at.place()).or_default(), size, true);
        change(
            self.symbol.entry((at.axis, at.slot.symbol)).or_default(),
            size,
            true,
        );
        change(&mut self.axis[index(at.axis)], size, true);
        self.cuts[index(at.axis)].insert(at.start + size);
    }
}

/// The weights of the predictors for each set of them that speaks.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Trust {
    counts: BTreeMap<u32, [f64; PREDICTORS]>,
}

impl Trust {
    fn weights(&self, speakers: u32) -> [f64; PREDICTORS] {
        self.counts.get(&speakers).copied().unwrap_or(PRIOR)
    }

    fn learn(&mut self, speakers: u32, shares: &[f64; PREDICTORS]) {
        let counts = self.counts.entry(speakers).or_insert(PRIOR);
        for (count, share) in counts.iter_mut().zip(shares) {
            *count += share;
        }
    }
}

/// A predictor's distribution over `1..=max`, by index from 0; none where it has nothing to say.
type Prediction = Option<Vec<f64>>;

/// In proportion to counts, exact sizes.
fn exact(sizes: Option<&Sizes>, max: u32) -> Prediction {
    let mut out = vec![0.0; max as usize];
    for (&size, &count) in sizes? {
        if let Some(place) = out.get_mut(size as usize - 1) {
            *place += f64::from(count);
        }
    }
    normalized(out)
}

/// Kernels `exp(-|d| / width)` around weighted sizes. Sizes above `max` count where the range ends.
fn kernels(sizes: impl Iterator<Item = (f64, u32)>, width: f64, max: u32) -> Prediction {
    let mut out = vec![0.0; max as usize];
    for (size, count) in sizes {
        if count > 0 && size < 2.0 * f64::from(max) + 4.0 * width {
            let at = (size.round().max(1.0) as usize - 1).min(max as usize - 1);
            out[at] += f64::from(count);
        }
    }
    let ratio = (-1.0 / width).exp();
    let mut carried = 0.0;
    let mut ahead = vec![0.0; out.len()];
    for k in (0..out.len()).rev() {
        ahead[k] = carried;
        carried = (carried + out[k]) * ratio;
    }
    carried = 0.0;
    for (place, ahead) in out.iter_mut().zip(&ahead) {
        let own = *place;
        *place += carried + ahead;
        carried = (carried + own) * ratio;
    }
    normalized(out)
}

/// The normal distribution with the mean and deviation of what was seen.
fn normal(seen: &[(f64, u32)], max: u32) -> Prediction {
    let count: f64 = seen.iter().map(|&(_, n)| f64::from(n)).sum();
    if count == 0.0 {
        return None;
    }
    let over = |f: &dyn Fn(f64) -> f64| -> f64 {
        seen.iter().map(|&(size, n)| f64::from(n) * f(size)).sum()
    };
    let mean = over(&|size| size) / count;
    let deviation = (over(&|size| (size - mean).powi(2)) / count).sqrt();
    let deviation = deviation.max(LEAST_DEVIATION);
    let weight = |size: u32| (-0.5 * ((f64::from(size) - mean) / deviation).powi(2)).exp();
    normalized((1..=max).map(weight).collect())
}

fn normalized(mut weights: Vec<f64>) -> Prediction {
    let sum: f64 = weights.iter().sum();
    if sum <= 0.0 {
        return None;
    }
    weights.iter_mut().for_each(|w| *w /= sum);
    Some(weights)
}

/// All predictions, in the order of the table above.
fn predictions(table: &SizeTable, memory: &SizeMemory, at: &Question) -> [Prediction; PREDICTORS] {
    let max = at.max;
    let place = at.place();
    let along = index(at.axis);
    let seen = |sizes: &Sizes| -> Vec<(f64, u32)> {
        sizes
            .iter()
            .map(|(&size, &count)| (f64::from(size), count))
            .collect()
    };
    let of_place = table.place.get(&place).map(seen).unwrap_or_default();
    let alike = Some(vec![1.0 / f64::from(max); max as usize]);
    if table.model == SizeModel::Normal {
        let mut only: [Prediction; PREDICTORS] = Default::default();
        only[PREDICTORS - 2] = alike;
        only[PREDICTORS - 1] = normal(&of_place, max);
        return only;
    }
    let mut next = vec![0.0; max as usize];
    let mut weight = 1.0;
    for &cut in memory.cuts[along]
        .range(at.start + 1..=at.start + max)
        .take(24)
    {
        next[(cut - at.start) as usize - 1] = weight;
        weight *= 0.5;
    }
    let mirrored = at.mirrored.filter(|&size| size <= max).map(|size| {
        let mut one = vec![0.0; max as usize];
        one[size as usize - 1] = 1.0;
        one
    });
    let shares = table
        .share
        .get(&place)
        .into_iter()
        .flatten()
        .map(|(&(size, extent), &count)| {
            (
                f64::from(size) * f64::from(at.extent) / f64::from(extent),
                count,
            )
        });
    let of_symbol = table
        .symbol
        .get(&(at.axis, at.slot.symbol))
        .map(seen)
        .unwrap_or_default();
    [
        exact(memory.slot.get(&(place, at.slot.repetition)), max),
        normalized(next),
        exact(memory.place.get(&place), max),
        mirrored,
        exact(memory.symbol.get(&(at.axis, at.slot.symbol)), max),
        exact(Some(&memory.axis[along]), max),
        exact(table.place.get(&place), max),
        kernels(of_place.iter().copied(), 1.5, max),
        kernels(of_place.into_iter(), 6.0, max),
        kernels(shares, 3.0, max),
        kernels(of_symbol.into_iter(), 3.0, max),
        kernels(seen(&table.axis[along]).into_iter(), 3.0, max),
        alike,
        None,
    ]
}

/// Chooses the size of a part, and learns from it.
pub(super) fn choose<C: Coder>(
    coder: &mut C,
    table: &SizeTable,
    memory: &mut SizeMemory,
    trust: &mut Trust,
    at: &Question,
    value: Option<u32>,
) -> Option<u32> {
    let predictions = predictions(table, memory, at);
    let speakers = (0..PREDICTORS)
        .filter(|&k| predictions[k].is_some())
        .fold(0, |set, k| set | 1 << k);
    let weights = trust.weights(speakers);
    let mut mixed = vec![0.0; at.max as usize];
    for (prediction, weight) in predictions.iter().zip(&weights) {
        if let Some(prediction) = prediction {
            for (sum, p) in mixed.iter_mut().zip(prediction) {
                *sum += weight * p;
            }
        }
    }
    let size = coder.choose(&mixed, value.map(|v| (v as usize).wrapping_sub(1)))?;
    let mut shares = [0.0; PREDICTORS];
    for ((share, prediction), weight) in shares.iter_mut().zip(&predictions).zip(&weights) {
        if let Some(prediction) = prediction {
            *share = weight * prediction[size] / mixed[size];
        }
    }
    trust.learn(speakers, &shares);
    let size = size as u32 + 1;
    memory.add(at, size);
    Some(size)
}
