//! The generic model layer against enumeration, other packages and its own invariances.

mod commands;
mod density;
mod elimination;
mod encoding;
mod factor_graph;
mod files;
mod fitted;
mod gmm;
mod gmm_missing;
mod hierarchy;
mod learning;
mod linfa;
mod network;
mod relations;
mod scores;
mod softmax;
mod structure;
mod tables;
mod translate;
mod units;
