//! The counts of repeats: numbers of floors and columns.
//!
//! A mixture of the count of the same repeat in this facade, any count of the axis in this facade, the
//! library's counts of the repeat, its counts of the axis, and a geometric distribution; its weights are learnt as those of
//! sizes are.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

use super::coder::Coder;
use super::tree::index;
use edifice_shape::Axis;

const PREDICTORS: usize = 5;

const PRIOR: [f64; PREDICTORS] = [4.0, 1.0, 1.0, 0.5, 0.1];

/// Largest count.
pub(super) const MOST: u32 = 4096;

type Counts = BTreeMap<u32, u32>;

/// A repeat: its rule and item.
pub(super) type Repeat = (u32, u32);

/// Counts that were seen.
#[derive(Debug, Clone, Default)]
pub struct CountTable {
    repeat: FxHashMap<Repeat, Counts>,
    axis: [Counts; 2],
}

impl CountTable {
    /// Adds a count, or takes it away.
    pub fn change(&mut self, repeat: Repeat, axis: Axis, count: u32, more: bool) {
        for counts in [
            self.repeat.entry(repeat).or_default(),
            &mut self.axis[index(axis)],
        ] {
            let seen = counts.entry(count).or_default();
            *seen = if more {
                *seen + 1
            } else {
                seen.saturating_sub(1)
            };
        }
    }

    /// The counts of a repeat with how often they were seen.
    pub fn of(&self, repeat: Repeat) -> impl Iterator<Item = (u32, u32)> {
        let counts = self.repeat.get(&repeat).into_iter().flatten();
        counts
            .map(|(&count, &seen)| (count, seen))
            .filter(|seen| seen.1 > 0)
    }
}

/// The weights of the predictors, for each set of them that speaks.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct CountTrust {
    counts: BTreeMap<u32, [f64; PREDICTORS]>,
}

/// Chooses a count from 2 to `max`, and learns from it.
pub(super) fn choose<C: Coder>(
    coder: &mut C,
    table: &CountTable,
    memory: &mut CountTable,
    trust: &mut CountTrust,
    (repeat, axis, max): (Repeat, Axis, u32),
    value: Option<u32>,
) -> Option<u32> {
    let range = max.clamp(2, MOST) as usize - 1;
    let of = |counts: Option<&Counts>| {
        let mut out = vec![0.0; range];
        for (&count, &seen) in counts? {
            if let Some(place) = out.get_mut(count as usize - 2) {
                *place += f64::from(seen);
            }
        }
        let sum: f64 = out.iter().sum();
        (sum > 0.0).then(|| out.into_iter().map(|w| w / sum).collect::<Vec<f64>>())
    };
    let mut geometric: Vec<f64> = (0..range).map(|k| 0.6f64.powi(k.min(60) as i32)).collect();
    let sum: f64 = geometric.iter().sum();
    geometric.iter_mut().for_each(|w| *w /= sum);
    let predictions = [
        of(memory.repeat.get(&repeat)),
        of(Some(&memory.axis[index(axis)])),
        of(table.repeat.get(&repeat)),
        of(Some(&table.axis[index(axis)])),
        Some(geometric),
    ];
    let speakers = (0..PREDICTORS)
        .filter(|&k| predictions[k].is_some())
        .fold(0, |set, k| set | 1 << k);
    let own = trust.counts.entry(speakers).or_insert(PRIOR);
    let mixed: Vec<f64> = (0..range)
        .map(|v| {
            let terms = predictions.iter().zip(own.iter());
            terms
                .map(|(p, w)| p.as_ref().map_or(0.0, |p| w * p[v]))
                .sum()
        })
        .collect();
    let at = coder.choose(&mixed, value.map(|v| (v as usize).wrapping_sub(2)))?;
    let weights = *own;
    for ((count, prediction), weight) in own.iter_mut().zip(&predictions).zip(weights) {
        *count += prediction
            .as_ref()
            .map_or(0.0, |p| weight * p[at] / mixed[at]);
    }
    let count = at as u32 + 2;
    memory.change(repeat, axis, count, true);
    Some(count)
}
