//! Layouts made regular: annotated ones, and those derived at another size.

pub mod regularize;
pub mod resize;
pub mod retile;
