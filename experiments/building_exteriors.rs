//! Fan and Wonka 2016, *A Probabilistic Model for Exteriors of Residential Buildings*.

pub mod houses;
