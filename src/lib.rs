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

pub mod cluster;
#[cfg(feature = "cli")]
pub mod editing;
pub mod error;
#[cfg(feature = "cli")]
#[path = "../experiments/mod.rs"]
pub mod experiments;
#[cfg(feature = "file")]
pub mod file;
pub mod grammar;
#[cfg(feature = "io")]
pub mod io;
pub mod layout;
pub mod methods;
pub mod model;
pub mod optim;
#[cfg(feature = "report")]
pub mod report;
pub mod rng;
pub mod scene;
pub mod shape;
#[cfg(feature = "studio")]
pub mod studio;
pub mod tables;

pub use error::{Error, Result};

/// The examples of the README, compiled and run with the documentation tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
