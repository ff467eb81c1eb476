//! Tests of the code that all methods share: optimizers, clusters and shapes against independent checks, grammars, readers and writers.

mod cluster_hierarchy;
mod coplanar;
mod grammar;
mod io;
mod optim_genetic;
mod optim_projection;
mod shape_triangles;
mod stopping;
