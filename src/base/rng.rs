//! One seeded generator per named stream.
//!
//! A stream is found by `(seed, name, index)`, never by the order in which threads ask, so the same
//! seed gives the same numbers with one thread or with many.
//!
//! Who takes a seed and who a generator: a *run* that owns all its randomness (an optimizer, learning with restarts, an
//! experiment) takes a seed and names its own streams; a *draw* (sampling, a random start, a proposal) takes `&mut impl Rng`,
//! so that the caller says which stream it comes from.

use rand::{Rng, RngExt};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::SeedableRng;

/// The project's generator: small, fast, portable, serializable.
pub type Stream = Pcg64Mcg;

/// The generator of stream `name`, item `index`, under the user's `seed`.
///
/// # Examples
/// ```
/// use edifice_base::rng::stream;
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

/// An index drawn in proportion to `weights`, which are not negative; the last of positive weight where rounding runs out,
/// and 0 where none is positive.
///
/// # Examples
/// ```
/// use edifice_base::rng::{categorical, stream};
/// assert_eq!(categorical(&[0.0, 2.0, 0.0], &mut stream(7, "index", 0)), 1);
/// ```
pub fn categorical<R: Rng + ?Sized>(weights: &[f64], rng: &mut R) -> usize {
    let total: f64 = weights.iter().sum();
    let mut at = rng.random::<f64>() * total;
    let mut last = 0;
    for (i, w) in weights.iter().enumerate().filter(|(_, w)| **w > 0.0) {
        last = i;
        at -= w;
        if at < 0.0 {
            break;
        }
    }
    last
}

/// Finalizer of SplitMix64 (Steele et al. 2014): a bijection that spreads every bit.
fn mix(mut z: u64) -> u64 {
    z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
