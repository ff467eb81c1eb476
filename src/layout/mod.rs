//! Layouts made regular, for every method that reads annotated or resized facades.

pub mod regularize;
