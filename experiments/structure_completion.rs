//! Fan et al. 2014, *Structure Completion for Facade Layouts*.

pub mod data;
