//! # Edifice
//!
//! A probabilistic-programming and optimization toolkit for buildings.
//!
//! Generic models ([`model`]) and generic optimizers ([`optim`]) are siblings that know nothing of
//! each other; the methods of published papers ([`methods`]) join them, over the shared nouns of
//! [`shape`] and [`grammar`]. Experiments reproduce each paper's tables and figures.
//!
//! | paper | module | experiment |
//! | --- | --- | --- |
//! | Wu et al. 2014, *Inverse Procedural Modeling of Facade Layouts* | [`methods::facade_grammar`] | `experiments/facade_grammar.rs` |
//! | Weissenberg et al. 2013, *Is there a Procedural Logic to Architecture?* | [`methods::procedural_logic`] | `experiments/procedural_logic.rs` |
//! | Fan et al. 2014, *Structure Completion for Facade Layouts* | [`methods::structure_completion`] | `experiments/structure_completion.rs` |
//! | Demir et al. 2014, *Proceduralization of Buildings at City Scale* | [`methods::city_proceduralization`] | `experiments/city_proceduralization.rs` |
//! | Fan and Wonka 2016, *A Probabilistic Model for Exteriors of Residential Buildings* | [`methods::building_exteriors`] | `experiments/building_exteriors.rs` |
//!
//! ## Conventions
//! - Origin at the lower left, x to the right, y up; lengths in the facade's own unit.
//! - Randomness is an argument: see [`rng`]. Same seed, same bytes, whatever the number of threads.
//! - Library code neither prints nor touches paths, except in [`io`], [`report`] and [`experiments`].
//!
//! ## Features
//! The default is everything. With `default-features = false` the crate is its models, optimizers,
//! clustering, shapes, grammars and methods, without a crate for files, figures or commands.
//!
//! | feature | adds |
//! | --- | --- |
//! | `io` | [`io`]: file formats of facades, grammars, buildings and scenes |
//! | `report` | [`report`]: tables and figures |
//! | `linfa` (default) | [linfa]'s traits for Gaussian mixtures: [`model::gmm::linfa`] |
//! | `cli` (default) | [`experiments`], [`editing`] and the programs; includes `io` and `report` |
//! | `studio` (default) | [`studio`]: documents in the browser, `edifice studio`; includes `cli` |
//!
//! [linfa]: https://docs.rs/linfa

pub use edifice_base::{Error, Result, error, rng};
pub use edifice_cluster as cluster;
pub use edifice_grammar as grammar;
#[cfg(feature = "io")]
pub use edifice_io as io;
pub use edifice_layout as layout;
pub use edifice_model as model;
pub use edifice_optim as optim;
#[cfg(feature = "report")]
pub use edifice_report as report;
pub use edifice_scene as scene;
pub use edifice_shape as shape;
pub use nalgebra;
pub use rand;

/// The papers' methods, one crate for each paper; no method imports another.
pub mod methods {
    pub use edifice_building_exteriors as building_exteriors;
    pub use edifice_city_proceduralization as city_proceduralization;
    pub use edifice_facade_grammar as facade_grammar;
    pub use edifice_procedural_logic as procedural_logic;
    pub use edifice_structure_completion as structure_completion;
}

/// The examples of the README, compiled and run with the documentation tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
