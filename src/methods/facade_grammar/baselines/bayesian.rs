//! Bayesian grammar learning: the initial step of Martinovic and Van Gool 2013.

use std::rc::Rc;

use super::top_down;
use crate::regions::Types;
use crate::rules::{AddRule, Arrangement, RuleCandidate};
use edifice_shape::Axis;

/// All full lines, floors first.
pub(crate) fn all_lines(types: &mut Types) -> Vec<AddRule> {
    top_down(types, |types, id| {
        [Axis::Y, Axis::X].into_iter().find_map(|axis| {
            let strips = types.strips(id, axis);
            let lines = 0..=strips.intervals() as u16;
            let all = || {
                Rc::new(RuleCandidate::between(
                    Arrangement::Split(axis),
                    lines.collect(),
                    &strips,
                ))
            };
            (strips.intervals() > 1).then(all)
        })
    })
}
