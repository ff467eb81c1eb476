//! Generic optimizers, run by argmin's `Executor` where they iterate: no models, no buildings.
//!
//! - [`adp`]: approximate dynamic programming with exploration and exploitation.
//! - [`annealing`]: Metropolis simulated annealing on a landscape that changes in place.
//! - [`genetic`]: a genetic algorithm on genomes of any kind, ranked and elitist.
//! - [`grid`]: exhaustive search over a grid of values.
//! - [`least_squares`]: nonlinear least squares, damped Gauss-Newton steps.
//! - [`qp`]: convex quadratic programming, the mathematics being Clarabel's.
//! - [`projection`]: onto one equality and bounds, exactly.
//!
//! Each returns a [`Run`]: the best solution, its cost, why the run ended ([`Outcome`]) and every
//! iteration. The problem is borrowed. A seed names all randomness of a run.

pub mod adp;
pub mod annealing;
pub mod genetic;
pub mod grid;
pub mod least_squares;
pub mod projection;
pub mod qp;
pub mod qp_problem;
mod run;

pub use run::{Outcome, Run, Step};
