//! Studies of the generic layers, for sweeps: models and optimizers without buildings.

pub(crate) mod annealing;
mod density;
pub(crate) mod genetic;
pub(crate) mod gmm;
mod knapsack;
pub(crate) mod network;
