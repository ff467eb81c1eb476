//! Optimizers, clusters and shapes against independent checks.

mod cluster_hierarchy;
mod optim_genetic;
mod optim_projection;
mod shape_triangles;
mod stopping;
