//! The exteriors of houses (Fan and Wonka 2016, *A Probabilistic Model for Exteriors of Residential
//! Buildings*): from houses to attributes to a learned hierarchical model.
//!
//! A building of any number of boxes and facade pieces ([`edifice_shape::Building`]) becomes a
//! vector of 49 [`attributes`] (Sec. 4.2, Appendix A).

pub mod agreement;
pub mod attributes;
pub mod coding;
pub mod data;
pub mod design;
pub mod dress;
pub mod facade;
pub mod house;
pub mod mass;
pub mod model_file;
pub mod network;
pub mod observations;
pub mod survey;

/// The version of `rand` whose generators the functions here take.
pub use rand;
