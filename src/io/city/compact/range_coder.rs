//! Adaptive binary range coding: Martin (1979), with carries as LZMA propagates them.
//!
//! [`Coder`] is one interface for both directions: code that is generic over it states a format once. The encoder
//! writes the bit it is given; the decoder ignores that bit, and returns the one that was written.

/// Estimate of the probability that a bit is 0, in 1/65536: the share of zeros seen, older bits fading.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bit {
    zero: u16,
    seen: u8,
}

/// Bits seen after which old ones begin to fade.
const MEMORY: u8 = 160;

impl Default for Bit {
    fn default() -> Self {
        Self {
            zero: 1 << 15,
            seen: 0,
        }
    }
}

impl Bit {
    /// The probability in 1/4096, never 0 or 1.
    fn share(self) -> u32 {
        u32::from(self.zero >> 4).clamp(1, 4095)
    }

    fn learn(&mut self, bit: bool) {
        // Krichevsky and Trofimov's estimate while few bits were seen.
        let target = if bit { 0.0 } else { 65_535.0 };
        let step = (target - f64::from(self.zero)) / (f64::from(self.seen) + 1.6);
        self.zero = (f64::from(self.zero) + step) as u16;
        self.seen = (self.seen + 1).min(MEMORY);
    }
}

/// Writes bits, or reads them.
pub(super) trait Coder {
    /// A bit whose probability is learnt.
    fn bit(&mut self, model: &mut Bit, bit: bool) -> bool;
    /// A bit that is 0 as often as 1.
    fn even(&mut self, bit: bool) -> bool;
    /// True if more was read than was written.
    fn exhausted(&self) -> bool;
}

/// Below this the range takes another byte.
const LEAST: u32 = 1 << 24;

/// Writes.
pub(super) struct Encoder {
    low: u64,
    range: u32,
    cache: u8,
    pending: u64,
    bytes: Vec<u8>,
}

impl Encoder {
    pub(super) fn new() -> Self {
        Self {
            low: 0,
            range: u32::MAX,
            cache: 0,
            pending: 1,
            bytes: Vec::new(),
        }
    }

    /// The bytes of all bits written.
    pub(super) fn finish(mut self) -> Vec<u8> {
        (0..5).for_each(|_| self.shift());
        self.bytes
    }

    fn split(&mut self, bound: u32, bit: bool) -> bool {
        if bit {
            self.low += u64::from(bound);
            self.range -= bound;
        } else {
            self.range = bound;
        }
        while self.range < LEAST {
            self.range <<= 8;
            self.shift();
        }
        bit
    }

    /// Moves the highest byte out; bytes that a carry may still change wait.
    fn shift(&mut self) {
        if self.low < 0xff00_0000 || self.low > 0xffff_ffff {
            let carry = (self.low >> 32) as u8;
            let mut byte = self.cache;
            for _ in 0..self.pending {
                self.bytes.push(byte.wrapping_add(carry));
                byte = 0xff;
            }
            self.pending = 0;
            self.cache = (self.low >> 24) as u8;
        }
        self.pending += 1;
        self.low = (self.low & 0x00ff_ffff) << 8;
    }
}

impl Coder for Encoder {
    fn bit(&mut self, model: &mut Bit, bit: bool) -> bool {
        let bound = (self.range >> 12) * model.share();
        model.learn(bit);
        self.split(bound, bit)
    }

    fn even(&mut self, bit: bool) -> bool {
        self.split(self.range >> 1, bit)
    }

    fn exhausted(&self) -> bool {
        false
    }
}

/// Reads.
pub(super) struct Decoder<'a> {
    bytes: &'a [u8],
    at: usize,
    code: u32,
    range: u32,
}

impl<'a> Decoder<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        let mut decoder = Self {
            bytes,
            at: 0,
            code: 0,
            range: u32::MAX,
        };
        // The first byte is the encoder's empty cache.
        (0..5).for_each(|_| decoder.take());
        decoder
    }

    fn take(&mut self) {
        let byte = self.bytes.get(self.at).copied().unwrap_or(0);
        self.code = (self.code << 8) | u32::from(byte);
        self.at += 1;
    }

    fn split(&mut self, bound: u32) -> bool {
        let bit = self.code >= bound;
        if bit {
            self.code -= bound;
            self.range -= bound;
        } else {
            self.range = bound;
        }
        while self.range < LEAST {
            self.range <<= 8;
            self.take();
        }
        bit
    }
}

impl Coder for Decoder<'_> {
    fn bit(&mut self, model: &mut Bit, _: bool) -> bool {
        let bit = self.split((self.range >> 12) * model.share());
        model.learn(bit);
        bit
    }

    fn even(&mut self, _: bool) -> bool {
        self.split(self.range >> 1)
    }

    fn exhausted(&self) -> bool {
        self.at > self.bytes.len()
    }
}
