//! The native part of the Python package `edifice`: values in, values out, errors as exceptions with the words of the command line.
//!
//! Long calls run in a thread of their own while the calling thread asks Python for signals ([`worker`]), so that Ctrl-C is answered at once.

mod arrays;
mod city;
mod comparison;
mod distribution;
mod errors;
mod facade;
mod grammar;
mod house;
mod house_model;
mod html;
mod logic;
mod mixture;
mod network;
mod posterior;
mod program;
mod table;
mod worker;

use pyo3::prelude::*;

/// The native part of `edifice`.
#[pymodule]
mod _native {
    #[pymodule_export]
    use super::city::{City, CityGrammar};
    #[pymodule_export]
    use super::distribution::Distribution;
    #[pymodule_export]
    use super::errors::EdificeError;
    #[pymodule_export]
    use super::facade::Facade;
    #[pymodule_export]
    use super::grammar::Grammar;
    #[pymodule_export]
    use super::house::House;
    #[pymodule_export]
    use super::house_model::HouseModel;
    #[pymodule_export]
    use super::logic::Logic;
    #[pymodule_export]
    use super::mixture::MixtureModel;
    #[pymodule_export]
    use super::network::Network;
    #[pymodule_export]
    use super::posterior::Posterior;
    #[pymodule_export]
    use super::program::{Effect, exact, factor, importance, metropolis, observe, sample, smc};
    #[pymodule_export]
    use super::table::FittedTable;
}
