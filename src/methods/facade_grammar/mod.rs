//! Facade grammars (Wu et al. 2014).

pub mod synthetic;

pub mod regularize;
