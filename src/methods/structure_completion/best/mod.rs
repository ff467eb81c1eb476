//! Completion by the choice of elements from a pool of exact draws, mirrored layouts and transfers.
//!
//! 1. [`pool`]: layouts by the exact [`chain`] over grid lines, the same with [`symmetry`], with [`transfer`] from the
//!    database below the lowest seen row, and database facades warped to the seen lines.
//! 2. [`candidates`]: every distinct element, with the share of the pool that supports it and features of its place.
//! 3. [`learn`]: the probability of a candidate, by boosted trees learnt on the database with parts hidden.
//!    Without a mask it is weighed by what the seen lines say (`scattered`) and the seen windows without a balcony (`bare`).
//! 4. `judge`: the whole layout of the pool with the largest expected F1 at .5 and .75, with balconies that are even
//!    within their rows (`rows`) and the one door that is likely ([`doors`]); rows with a `rhythm` of their own are continued,
//!    an empty `ground` floor is filled.

mod apart;
mod bare;
mod belong;
mod by_place;
pub mod candidates;
pub mod chain;
pub mod density;
pub mod doors;
mod exact;
pub mod fill;
mod ground;
mod judge;
pub mod learn;
pub mod masses;
pub mod modes;
pub mod observation;
pub mod pool;
mod regular;
mod rhythm;
mod rows;
mod scattered;
mod shared;
mod spacing;
pub mod symmetry;
pub mod transfer;
mod votes;

use rand::{Rng, RngExt};

/// Draws an index with the given weights; 0 where all are zero.
fn categorical<R: Rng>(weights: &[f64], rng: &mut R) -> usize {
    let total: f64 = weights.iter().sum();
    let mut left = rng.random::<f64>() * total;
    let mut last = 0;
    for (index, &weight) in weights.iter().enumerate().filter(|(_, w)| **w > 0.0) {
        last = index;
        left -= weight;
        if left < 0.0 {
            break;
        }
    }
    last
}

/// 1 up to the first limit, 0 from the second on, a straight line between them.
fn at_most(value: f64, limits: [f64; 2]) -> f64 {
    ((limits[1] - value) / (limits[1] - limits[0])).clamp(0.0, 1.0)
}
