//! Generic optimizers, run by argmin's `Executor` where they iterate: no models, no buildings.
//!
//! - [`adp`]: approximate dynamic programming with exploration and exploitation.
//! - [`annealing`]: Metropolis simulated annealing on a landscape that changes in place.
//! - [`cmaes`]: covariance matrix adaptation, of real functions without derivatives.
//! - [`genetic`]: a genetic algorithm on genomes of any kind, ranked and elitist.
//! - [`grid`]: exhaustive search over a grid of values.
//! - [`least_squares`]: nonlinear least squares, damped Gauss-Newton steps.
//! - [`nsga`]: NSGA-II, several costs at once.
//! - [`qp`]: convex quadratic programming, the mathematics being Clarabel's.
//! - [`projection`]: onto one equality and bounds, exactly.
//! - [`tempering`]: replica exchange on the landscapes of [`annealing`], temperatures found.
//!
//! Each returns a [`Run`]: the best solution, its cost, why the run ended ([`Outcome`]) and every
//! iteration. The problem is borrowed. A seed names all randomness of a run.

pub mod adp;
pub mod annealing;
pub mod cmaes;
pub mod genetic;
pub mod grid;
pub mod least_squares;
mod limits;
pub mod nsga;
pub mod projection;
pub mod qp;
mod qp_form;
pub mod qp_problem;
mod qp_warm;
mod run;
pub mod tempering;
mod triplets;

/// The version of `nalgebra` whose matrices are in signatures here.
pub use nalgebra;
/// The version of `rand` whose generators the functions here take.
pub use rand;

pub use limits::{Answer, Limits};
pub use run::{Outcome, Run, Step, tell};
