//! Generic optimizers, all `impl Solver` run by argmin's `Executor`: no models, no buildings.
//!
//! - [`adp`]: approximate dynamic programming with exploration and exploitation.
//! - [`annealing`]: Metropolis simulated annealing on a landscape that changes in place.
//! - [`genetic`]: a genetic algorithm on genomes of any kind, ranked and elitist.
//! - [`grid`]: exhaustive search over a grid of values.
//! - [`qp`]: convex quadratic programming, the mathematics being Clarabel's.

pub mod adp;
pub mod annealing;
pub mod genetic;
pub mod grid;
pub mod qp;
pub mod qp_problem;
mod run;

pub use run::Step;
