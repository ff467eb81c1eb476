//! Buildings that rules may be made from, and what they cost for others.

use super::stacks::Stack;

/// Bases at least as square as this may be turned by a quarter.
const SQUARE: f64 = 0.75;

/// A building that a rule may be made from: its class, which of its members it is, and which of the distinct ones.
pub(super) struct Candidate {
    pub(super) class: usize,
    pub(super) member: usize,
    pub(super) row: usize,
    pub(super) maps: Vec<f32>,
    /// Price of the derived triangles of an instance, in cubic metres.
    pub(super) price: f64,
}

/// A candidate near a building: its number, the best quarter turn, the mismatched volume with the price of its triangles.
#[derive(Clone, Copy)]
pub(super) struct Near {
    pub(super) candidate: usize,
    pub(super) quarter: u8,
    pub(super) cost: f64,
}

/// The best quarter turn of a candidate for a stack.
pub(super) fn best(stack: &Stack, candidate: usize, of: &Candidate) -> Near {
    let quarters: &[u8] = match stack.aspect >= SQUARE {
        true => &[0, 1, 2, 3],
        false => &[0, 2],
    };
    let mut best = Near {
        candidate,
        quarter: 0,
        cost: f64::INFINITY,
    };
    for &quarter in quarters {
        let cost = of.price + stack.mismatch(&of.maps, quarter);
        if cost < best.cost {
            best = Near {
                quarter,
                cost,
                ..best
            };
        }
    }
    best
}
