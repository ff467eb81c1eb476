//! Studies of the generic layers, for sweeps: models and optimizers without buildings.

pub mod annealing;
mod density;
pub mod genetic;
pub mod gmm;
mod knapsack;
pub mod network;
