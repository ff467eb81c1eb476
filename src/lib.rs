//! # Edifice
//!
//! A probabilistic-programming and optimization toolkit for buildings.
//!
//! Generic models ([`model`]) and generic optimizers ([`optim`]) are siblings that know nothing of
//! each other; the methods of published papers ([`methods`]) join them, over the shared nouns of
//! [`shape`] and [`grammar`]. Experiments reproduce each paper's tables and figures.
//!
//! # By task
//! | you want to | start at |
//! | --- | --- |
//! | turn a facade into a short split grammar | [`methods::facade_grammar::infer`] |
//! | share rules among many real facades, score and draw new ones | [`grammar::parametric`] |
//! | derive, resize, evaluate a grammar | [`grammar::derive`], [`grammar::evaluate`], [`layout`] |
//! | learn rules from labelled images and retrieve facades | [`methods::procedural_logic`] |
//! | complete a facade of which a part is seen | [`methods::structure_completion`] |
//! | learn attributes of houses and generate houses | [`methods::building_exteriors`] |
//! | turn a city into a grammar, edit it, derive it | [`methods::city_proceduralization`] |
//! | write a probabilistic program and draw from its posterior | [`model::program`] |
//! | ask a Bayesian network, learn one from rows | [`model::network`], [`model::hierarchy`] |
//! | model any table, with missing cells | [`model::tables`] |
//! | train and ask a factor graph | [`model::factor_graph`] |
//! | fit a Gaussian mixture | [`model::gmm`] |
//! | minimize something | [`optim`] |
//! | cluster, find communities, measure retrieval | [`cluster`] |
//!
//! # By paper
//! | paper | module | experiment |
//! | --- | --- | --- |
//! | Wu et al. 2014, *Inverse Procedural Modeling of Facade Layouts* | [`methods::facade_grammar`] | `experiments/facade_grammar` |
//! | Weissenberg et al. 2013, *Is there a Procedural Logic to Architecture?* | [`methods::procedural_logic`] | `experiments/procedural_logic` |
//! | Fan et al. 2014, *Structure Completion for Facade Layouts* | [`methods::structure_completion`] | `experiments/structure_completion` |
//! | Demir et al. 2014, *Proceduralization of Buildings at City Scale* | [`methods::city_proceduralization`] | `experiments/city_proceduralization` |
//! | Fan and Wonka 2016, *A Probabilistic Model for Exteriors of Residential Buildings* | [`methods::building_exteriors`] | `experiments/building_exteriors` |
//!
//! # Conventions
//! - Origin at the lower left, x to the right, y up; lengths in the facade's own unit.
//! - Randomness is an argument: see [`rng`]. Same seed, same bytes, whatever the number of threads.
//! - Library code neither prints nor touches paths, except in `io` and `report`.
//!
//! # Features
//! Each part is a crate of its own (`edifice-model`, `edifice-optim`, ...); this crate gives them one name. The default
//! is everything. With `default-features = false` it is its models, optimizers, clustering, shapes, grammars and methods,
//! without a crate for file formats, figures or commands.
//!
//! | feature | adds |
//! | --- | --- |
//! | `io` | `io`: file formats of facades, grammars, buildings, cities and scenes |
//! | `report` | `report`: tables and figures |
//! | `linfa` | [linfa]'s traits for Gaussian mixtures: `model::gmm::linfa` |
//! | `nuts` | the No-U-Turn Sampler for probabilistic programs |
//! | `cli` (default) | the program `edifice`; includes `io` and `report` |
//! | `studio` (default) | `edifice studio`: documents in the browser; includes `cli` |
//!
//! [linfa]: https://docs.rs/linfa

pub use edifice_base::{Ended, Error, Progress, Result, Watch, Watched, error, rng, unwatched};
pub use edifice_cluster as cluster;
pub use edifice_grammar as grammar;
pub use edifice_layout as layout;
pub use edifice_model as model;
pub use edifice_optim as optim;
#[cfg(feature = "report")]
pub use edifice_report as report;
pub use edifice_scene as scene;
pub use edifice_shape as shape;
pub use nalgebra;
pub use rand;

/// File formats of facades, grammars, buildings, cities and scenes.
#[cfg(feature = "io")]
pub mod io {
    pub use edifice_io::*;
    pub use edifice_io_city as city;
}

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
