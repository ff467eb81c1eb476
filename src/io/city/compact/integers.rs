//! Integers as bits with learnt probabilities.

use super::range_coder::{Bit, Coder};

/// Numbers of a fixed count of bits, each with its own probability.
#[derive(Debug, Clone)]
pub(super) struct BitTree {
    nodes: Vec<Bit>,
    bits: u32,
}

impl BitTree {
    pub(super) fn new(bits: u32) -> Self {
        Self {
            nodes: vec![Bit::default(); 1 << bits],
            bits,
        }
    }

    /// A tree for the numbers below `count`.
    pub(super) fn below(count: usize) -> Self {
        Self::new(usize::BITS - count.saturating_sub(1).leading_zeros())
    }

    pub(super) fn code(&mut self, coder: &mut impl Coder, value: usize) -> usize {
        let mut node = 1;
        for k in (0..self.bits).rev() {
            let bit = coder.bit(&mut self.nodes[node], value >> k & 1 == 1);
            node = 2 * node + usize::from(bit);
        }
        node - (1 << self.bits)
    }
}

/// Numbers below 2^63: how many bits they have, then those after the first, of which the highest are learnt.
#[derive(Debug, Clone)]
pub(super) struct Natural {
    length: BitTree,
    leading: Vec<Bit>,
}

/// Leading parts below this have probabilities of their own.
const LEADING: u64 = 16;

impl Default for Natural {
    fn default() -> Self {
        Self {
            length: BitTree::new(6),
            leading: vec![Bit::default(); 64 * LEADING as usize],
        }
    }
}

impl Natural {
    pub(super) fn code(&mut self, coder: &mut impl Coder, value: u64) -> u64 {
        let length = self.length.code(coder, bits_of(value));
        if length < 2 {
            return length as u64;
        }
        let mut found = 1;
        for k in (0..length - 1).rev() {
            let bit = value >> k & 1 == 1;
            let bit = match found < LEADING {
                true => coder.bit(&mut self.leading[length * 16 + found as usize], bit),
                false => coder.even(bit),
            };
            found = (found << 1) | u64::from(bit);
        }
        found
    }
}

/// Bits of a number without leading zeros, at most 63.
pub(super) fn bits_of(value: u64) -> usize {
    (64 - value.leading_zeros() as usize).min(63)
}

/// Numbers of either sign, beyond -2^62 and 2^62.
#[derive(Debug, Clone, Default)]
pub(super) struct Whole {
    size: Natural,
    negative: Bit,
}

impl Whole {
    pub(super) fn code(&mut self, coder: &mut impl Coder, value: i64) -> i64 {
        let size = self.size.code(coder, value.unsigned_abs()) as i64;
        match size != 0 && coder.bit(&mut self.negative, value < 0) {
            true => -size,
            false => size,
        }
    }
}

/// The 64 bits of a number.
pub(super) fn plain(coder: &mut impl Coder, value: f64) -> f64 {
    let bits = value.to_bits();
    let found = (0..64).fold(0, |f, k| {
        (f << 1) | u64::from(coder.even(bits >> (63 - k) & 1 == 1))
    });
    f64::from_bits(found)
}
