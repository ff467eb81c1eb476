//! Engines of probabilistic programs against truths that they share no code with.

mod calibration;
mod densities;
mod diagnostics;
#[cfg(feature = "nuts")]
mod gym;
mod houses;
mod random;
