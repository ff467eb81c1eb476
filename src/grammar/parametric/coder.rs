//! One walk, four uses: count bits, encode, decode, draw.
//!
//! A model meets its choices one after another and gives for each the weights of what may come. Weights become
//! whole frequencies of a fixed total `2^TOTAL_BITS`, each at least 1 where the weight is above zero; the bits of
//! a choice are `TOTAL_BITS - log2 frequency`, and the arithmetic coder (Witten, Neal and Cleary 1987, on 64-bit
//! integers) spends them to within two bits a facade. Counting, writing and reading share these frequencies, so
//! that the bits that are reported are those of a decoder.

use rand::{Rng, RngExt};

/// The frequencies of one choice add up to `2^TOTAL_BITS`.
pub(super) const TOTAL_BITS: u32 = 28;

const TOTAL: u64 = 1 << TOTAL_BITS;

/// Whole frequencies that add up to [`TOTAL`]; zero exactly where the weight is zero.
fn frequencies(weights: &[f64]) -> Vec<u64> {
    let positive = weights.iter().filter(|w| **w > 0.0).count() as u64;
    let sum: f64 = weights.iter().sum();
    let share = (TOTAL - positive.min(TOTAL)) as f64 / sum;
    let mut frequencies: Vec<u64> = weights
        .iter()
        .map(|&w| if w > 0.0 { 1 + (w * share) as u64 } else { 0 })
        .collect();
    let used: u64 = frequencies.iter().sum();
    let largest = (0..weights.len()).fold(0, |a, b| if weights[b] > weights[a] { b } else { a });
    // Rounding down leaves at most one for each weight; rounding of the sum, a little more or less.
    frequencies[largest] = (frequencies[largest] + TOTAL).saturating_sub(used).max(1);
    frequencies
}

/// Meets the choices of a model in order.
pub trait Coder {
    /// Chooses an index in proportion to `weights` (finite, not negative, at least one above zero); `value` is
    /// the choice where it is known. None where the choice has no weight or is not known.
    fn choose(&mut self, weights: &[f64], value: Option<usize>) -> Option<usize>;
}

/// Counts bits.
#[derive(Debug, Clone, Copy, Default)]
pub struct Counter {
    /// Bits so far.
    pub bits: f64,
}

impl Coder for Counter {
    fn choose(&mut self, weights: &[f64], value: Option<usize>) -> Option<usize> {
        let value = value?;
        let frequency = *frequencies(weights).get(value)?;
        if frequency == 0 {
            return None;
        }
        self.bits += f64::from(TOTAL_BITS) - (frequency as f64).log2();
        Some(value)
    }
}

/// Draws.
pub struct Drawer<'r, R> {
    /// The source of chance.
    pub rng: &'r mut R,
}

impl<R: Rng> Coder for Drawer<'_, R> {
    fn choose(&mut self, weights: &[f64], value: Option<usize>) -> Option<usize> {
        if value.is_some() {
            return value;
        }
        let mut at = self.rng.random_range(0..TOTAL);
        frequencies(weights).iter().position(|&frequency| {
            let here = at < frequency;
            at = at.saturating_sub(frequency);
            here
        })
    }
}

const HALF: u64 = 1 << 62;
const QUARTER: u64 = 1 << 61;

/// Writes a code.
#[derive(Debug, Clone)]
pub struct Encoder {
    low: u64,
    high: u64,
    pending: u64,
    bits: Vec<bool>,
}

impl Default for Encoder {
    fn default() -> Self {
        Self {
            low: 0,
            high: 2 * HALF - 1,
            pending: 0,
            bits: Vec::new(),
        }
    }
}

impl Encoder {
    fn push(&mut self, bit: bool) {
        self.bits.push(bit);
        for _ in 0..std::mem::take(&mut self.pending) {
            self.bits.push(!bit);
        }
    }

    /// The code: its bits, most significant first, in whole bytes.
    pub fn finish(mut self) -> Vec<u8> {
        self.pending += 1;
        self.push(self.low >= QUARTER);
        let byte = |bits: &[bool]| {
            bits.iter()
                .enumerate()
                .fold(0, |byte, (k, &bit)| byte | (u8::from(bit) << (7 - k)))
        };
        self.bits.chunks(8).map(byte).collect()
    }
}

/// The part of an interval that a choice takes.
fn narrow(low: u64, high: u64, before: u64, frequency: u64) -> (u64, u64) {
    let range = high - low + 1;
    let at = |f: u64| ((u128::from(range) * u128::from(f)) >> TOTAL_BITS) as u64;
    (low + at(before), low + at(before + frequency) - 1)
}

impl Coder for Encoder {
    fn choose(&mut self, weights: &[f64], value: Option<usize>) -> Option<usize> {
        let value = value?;
        let all = frequencies(weights);
        let frequency = *all.get(value)?;
        if frequency == 0 {
            return None;
        }
        (self.low, self.high) = narrow(self.low, self.high, all[..value].iter().sum(), frequency);
        loop {
            if self.high < HALF {
                self.push(false);
            } else if self.low >= HALF {
                self.push(true);
                self.low -= HALF;
                self.high -= HALF;
            } else if self.low >= QUARTER && self.high < HALF + QUARTER {
                self.pending += 1;
                self.low -= QUARTER;
                self.high -= QUARTER;
            } else {
                return Some(value);
            }
            self.low *= 2;
            self.high = 2 * self.high + 1;
        }
    }
}

/// Reads a code.
#[derive(Debug, Clone)]
pub struct Decoder<'c> {
    low: u64,
    high: u64,
    value: u64,
    next: usize,
    code: &'c [u8],
}

impl<'c> Decoder<'c> {
    /// Starts to read; past its end a code is zeros.
    pub fn new(code: &'c [u8]) -> Self {
        let mut decoder = Self {
            low: 0,
            high: 2 * HALF - 1,
            value: 0,
            next: 0,
            code,
        };
        for _ in 0..63 {
            decoder.shift();
        }
        decoder
    }

    fn shift(&mut self) {
        let byte = self.code.get(self.next / 8).copied().unwrap_or(0);
        self.value = 2 * self.value + u64::from((byte >> (7 - self.next % 8)) & 1);
        self.next += 1;
    }
}

impl Coder for Decoder<'_> {
    fn choose(&mut self, weights: &[f64], _: Option<usize>) -> Option<usize> {
        let all = frequencies(weights);
        let mut before = 0;
        let mut found = None;
        for (index, &frequency) in all.iter().enumerate() {
            if frequency > 0 {
                let (low, high) = narrow(self.low, self.high, before, frequency);
                if (low..=high).contains(&self.value) {
                    found = Some((index, low, high));
                    break;
                }
            }
            before += frequency;
        }
        let (index, low, high) = found?;
        (self.low, self.high) = (low, high);
        loop {
            let shift = if self.high < HALF {
                0
            } else if self.low >= HALF {
                HALF
            } else if self.low >= QUARTER && self.high < HALF + QUARTER {
                QUARTER
            } else {
                return Some(index);
            };
            self.low -= shift;
            self.high -= shift;
            self.value -= shift;
            self.low *= 2;
            self.high = 2 * self.high + 1;
            self.shift();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn codes_are_read_as_written_and_as_long_as_counted(
            choices in prop::collection::vec((prop::collection::vec(0.0f64..9.0, 1..40), 0usize..40), 0..60)
        ) {
            let choices: Vec<(Vec<f64>, usize)> = choices
                .into_iter()
                .map(|(mut weights, at)| {
                    let at = at % weights.len();
                    weights[at] += 1e-12;
                    (weights, at)
                })
                .collect();
            let (mut counter, mut encoder) = (Counter::default(), Encoder::default());
            for (weights, at) in &choices {
                prop_assert_eq!(counter.choose(weights, Some(*at)), Some(*at));
                prop_assert_eq!(encoder.choose(weights, Some(*at)), Some(*at));
            }
            let code = encoder.finish();
            prop_assert!(code.len() as f64 * 8.0 <= counter.bits + 2.0 + 8.0);
            let mut decoder = Decoder::new(&code);
            for (weights, at) in &choices {
                prop_assert_eq!(decoder.choose(weights, None), Some(*at));
            }
        }
    }
}
