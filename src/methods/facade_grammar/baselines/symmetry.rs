//! Symmetry maximization: the splitting heuristic of Zhang et al. 2013.

use std::rc::Rc;

use super::top_down;
use crate::regions::{Offsets, Strips, TypeId, Types};
use crate::rules::{AddRule, Arrangement, RuleCandidate};
use edifice_shape::Axis;

/// The binary split that leaves the most symmetric parts.
pub(crate) fn symmetry_maximization(types: &mut Types) -> Vec<AddRule> {
    let mut measured: Vec<Option<f64>> = Vec::new();
    top_down(types, |types, id| {
        let mut best: Option<(f64, Axis, u16)> = None;
        for axis in Axis::BOTH {
            let strips = types.strips(id, axis);
            let n = strips.intervals();
            for line in 1..n {
                let sum = integral_symmetry(types, &mut measured, strips.strip(0, line))
                    + integral_symmetry(types, &mut measured, strips.strip(line, n));
                if best.is_none_or(|(most, ..)| sum > most + 1e-12) {
                    best = Some((sum, axis, line as u16));
                }
            }
        }
        best.map(|(_, axis, line)| {
            let strips = types.strips(id, axis);
            let lines = vec![0, line, strips.intervals() as u16];
            Rc::new(RuleCandidate::between(
                Arrangement::Split(axis),
                lines,
                &strips,
            ))
        })
    })
}

/// Integral symmetry of a type, 0 to 1, the better of the two directions.
fn integral_symmetry(types: &mut Types, measured: &mut Vec<Option<f64>>, id: TypeId) -> f64 {
    if types.is_terminal(id) {
        return 1.0;
    }
    let slot = id as usize;
    if measured.len() <= slot {
        measured.resize(types.len().max(slot + 1), None);
    }
    if let Some(symmetry) = measured[slot] {
        return symmetry;
    }
    let region = types.region(id);
    let symmetry = Axis::BOTH
        .map(|axis| {
            let strips = types.strips(id, axis);
            mirror_sum(&strips, &types.offsets(region, axis, &strips.cuts))
        })
        .into_iter()
        .fold(0.0, f64::max);
    measured[slot] = Some(symmetry);
    symmetry
}

/// `(sum_c r(c)) / (sum_c min(c, w - c))` along one direction; 0 when no line splits the region.
fn mirror_sum(strips: &Strips, offsets: &Offsets) -> f64 {
    let n = strips.intervals();
    if n < 2 {
        return 0.0;
    }
    let (mut reached, mut possible) = (0.0, 0.0);
    let position = &offsets.at;
    // Twice the centre: even on lines, odd in the middle of intervals.
    for center in 1..2 * n {
        let (mut left, mut right) = (center / 2, center.div_ceil(2));
        let doubled = position[left] + position[right];
        while left > 0 && right < n {
            let equal = strips.strip(left - 1, left) == strips.strip(right, right + 1);
            if !equal || offsets.interval(left - 1) != offsets.interval(right) {
                break;
            }
            left -= 1;
            right += 1;
        }
        reached += position[right] - position[left];
        possible += doubled.min(2.0 * position[n] - doubled);
    }
    reached / possible
}
