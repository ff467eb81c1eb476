//! One seeded generator per named stream.
//!
//! A stream is found by `(seed, name, index)`, never by the order in which threads ask, so the same
//! seed gives the same numbers with one thread or with many.

use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::SeedableRng;

/// The project's generator: small, fast, portable, serializable.
pub type Stream = Pcg64Mcg;

/// The generator of stream `name`, item `index`, under the user's `seed`.
///
/// # Examples
/// ```
/// use edifice::rng::stream;
/// use rand::RngExt;
/// let a: u64 = stream(7, "facade", 0).random();
/// let b: u64 = stream(7, "facade", 0).random();
/// let c: u64 = stream(7, "facade", 1).random();
/// assert_eq!(a, b);
/// assert_ne!(a, c);
/// ```
pub fn stream(seed: u64, name: &str, index: u64) -> Stream {
    let mut state = mix(seed ^ 0x9e37_79b9_7f4a_7c15);
    for byte in name.bytes() {
        state = mix(state ^ u64::from(byte));
    }
    state = mix(state ^ index);
    Stream::seed_from_u64(state)
}

/// Finalizer of SplitMix64 (Steele et al. 2014): a bijection that spreads every bit.
fn mix(mut z: u64) -> u64 {
    z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
