//! The structure of a region along one axis, as full lines can cut it: strips, periods, alternations, mirrored pairs.

use super::lengths::{minus, times};
use super::region::TypeId;

/// Distances of some cuts from the first of them: increasing lengths, and their residues, by which lengths are compared.
#[derive(Debug)]
pub(crate) struct Offsets {
    pub at: Vec<f64>,
    pub residues: Vec<u64>,
}

impl Offsets {
    /// The cut at a distance that is equal up to noise.
    fn find(&self, at: f64, residue: u64) -> Option<usize> {
        let after = self.at.partition_point(|&offset| offset < at);
        let near = after.saturating_sub(1)..(after + 1).min(self.at.len());
        near.into_iter().find(|&i| self.residues[i] == residue)
    }

    /// Length of the interval that starts at a cut.
    pub(crate) fn interval(&self, start: usize) -> u64 {
        minus(self.residues[start + 1], self.residues[start])
    }

    /// Distance and residue of the last cut.
    fn last(&self) -> (f64, u64) {
        let last = self.at.len() - 1;
        (self.at[last], self.residues[last])
    }
}

/// `repeats` equal periods of `intervals` elementary intervals each fill the region.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Period {
    pub intervals: u16,
    pub repeats: u16,
}

/// Everything that full lines along one axis can make of a region.
#[derive(Debug)]
pub(crate) struct Strips {
    /// Grid indices of the region's ends and of every full line that cuts no terminal.
    pub cuts: Vec<u16>,
    /// Type of the strip from `cuts[a]` to `cuts[b]` at `b (b - 1) / 2 + a`.
    types: Vec<TypeId>,
    /// Ways to see the region as a repetition.
    pub periods: Vec<Period>,
    /// Ways to see it as A B A ... B A, with one B or more: the ends of the first A and of the first B.
    pub alternations: Vec<(u16, u16)>,
    /// Pairs of cuts at equal distance from the two ends, from the outside in; the last pair is
    /// one cut when there is one in the middle.
    pub mirrors: Vec<(u16, u16)>,
}

impl Strips {
    /// The strips between some cuts, given the type of each and the offsets of the cuts.
    pub(crate) fn new(cuts: Vec<u16>, types: Vec<TypeId>, offsets: &Offsets) -> Self {
        let mut strips = Self {
            cuts,
            types,
            periods: Vec::new(),
            alternations: Vec::new(),
            mirrors: mirrors(offsets),
        };
        for (k, repeats, rest) in shifts(offsets, &strips) {
            match rest {
                0 => strips.periods.push(Period {
                    intervals: k as u16,
                    repeats,
                }),
                a => strips.alternations.push((a as u16, k as u16)),
            }
        }
        // A B A with one B.
        for &(a, b) in &strips.mirrors {
            let (outer, inner) = (usize::from(a), usize::from(b));
            let equal = |n| strips.strip(0, outer) == strips.strip(inner, n);
            if 0 < a && a < b && equal(strips.intervals()) {
                strips.alternations.push((a, b));
            }
        }
        strips
    }

    /// Number of elementary intervals, 1 when no line splits the region.
    pub(crate) fn intervals(&self) -> usize {
        self.cuts.len() - 1
    }

    /// Type of the strip between cuts `a < b`.
    pub(crate) fn strip(&self, a: usize, b: usize) -> TypeId {
        self.types[b * (b - 1) / 2 + a]
    }

    /// Types of the strips that end at cut `b`, by where they start.
    pub(crate) fn ending_at(&self, b: usize) -> &[TypeId] {
        let first = b * (b - 1) / 2;
        &self.types[first..first + b]
    }

    /// End of the first A of the alternation whose first B ends at cut `b`.
    pub(crate) fn alternation_inner(&self, b: usize) -> u16 {
        self.alternations
            .iter()
            .find(|(_, end)| usize::from(*end) == b)
            .map_or(0, |(a, _)| *a)
    }

    /// Types of all strips.
    pub(crate) fn all(&self) -> &[TypeId] {
        &self.types
    }
}

/// Shifts by the length of the first `k` intervals that map the region onto itself: `k`, how many
/// times that length fits, at least 2, and the cut at which what is left over ends (0 when nothing
/// is left over). A region has such a shift when what remains without its last `k` intervals equals
/// what remains without its first.
fn shifts(offsets: &Offsets, strips: &Strips) -> Vec<(usize, u16, usize)> {
    let n = strips.intervals();
    let (total, residue) = offsets.last();
    (1..n)
        .filter_map(|k| {
            let (length, own) = (offsets.at[k], offsets.residues[k]);
            let left_over = |repeats: f64| minus(residue, times(own, repeats as u64));
            // A whole number of times up to noise, else as often as it fits.
            let nearest = (total / length).round();
            let (repeats, rest) = match left_over(nearest) {
                0 => (nearest, 0),
                _ => {
                    let repeats = (total / length).floor();
                    let rest = total - repeats * length;
                    (repeats, offsets.find(rest, left_over(repeats))?)
                }
            };
            if repeats < 2.0 {
                return None;
            }
            let shifted = offsets.find(total - length, minus(residue, own))?;
            let equal = strips.strip(0, shifted) == strips.strip(k, n);
            equal.then_some((k, repeats as u16, rest))
        })
        .collect()
}

/// Pairs of cuts at equal distance from the two ends, from the outside in.
fn mirrors(offsets: &Offsets) -> Vec<(u16, u16)> {
    let (total, residue) = offsets.last();
    let all = offsets.at.iter().zip(&offsets.residues).enumerate();
    all.filter_map(|(left, (at, own))| {
        let right = offsets.find(total - at, minus(residue, *own))?;
        (left <= right).then_some((left as u16, right as u16))
    })
    .collect()
}
