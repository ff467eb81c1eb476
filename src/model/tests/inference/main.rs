//! Inference against truths that share no code with it.

mod factor_graphs;
mod program;
