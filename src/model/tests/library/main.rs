//! The generic model layer against enumeration, truths that share no code with it, other packages, and its own invariances.

mod density;
mod elimination;
mod encoding;
mod factor_graph;
mod factor_graphs;
mod gmm;
mod gmm_missing;
mod gmm_round;
mod hierarchy;
mod hierarchy_fits;
mod learning;
mod network;
mod program;
mod scores;
mod softmax;
mod structure;
mod translate;
mod units;
