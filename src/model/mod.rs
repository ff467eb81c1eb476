//! Generic probability: models with hidden structure, without buildings and without optimizers.
//!
//! | module | what | learned by |
//! | --- | --- | --- |
//! | [`hierarchy`] | root style, second-level hidden variables, lateral edges (Fan and Wonka 2016, Sec. 5) | EM, Cheeseman-Stutz search |
//! | [`network`] | discrete, softmax and linear Gaussian networks: exact inference, BIF, XMLBIF, JSON | EM; [`network::structure`]: BDeu, BIC |
//! | [`elimination`] | sums and maxima over products of tables | – |
//! | [`gmm`] | Gaussian mixtures, number of components by MDL or BIC | EM |
//! | [`density`] | mixtures, smoothed histograms, kernels, conditional densities | EM, counting |
//! | [`boosting`] | probabilities from features by oblivious trees | gradient boosting |
//! | [`low_rank`] | matrix completion | soft-impute |
//! | [`factor_graph`] | log-linear features with shared weights, hidden variables, inputs | contrastive divergence, or exactly |
//! | [`program`] | models as code: choices, observations, factors | – (posteriors of their choices) |
//! | [`log_linear`] | the same for a user's features and negative sampler | contrastive divergence |
//!
//! # Which model when
//! | you have, you want | here | peers |
//! | --- | --- | --- |
//! | a network with its tables; posteriors, explanations, draws | [`network`]: exact by [`elimination`], approximate on request | pyAgrum, pgmpy |
//! | a network without numbers, rows with missing cells, hidden variables | [`network::Network::fit`] | pyAgrum, pgmpy (complete rows) |
//! | a table of categories; the graph of a network | [`network::structure::search`] | pyAgrum, pgmpy |
//! | a table of mixed columns, and no idea of its structure | [`hierarchy::learn`]; with repeated values, bounds or heavy tails, of a table encoded first (`tables::encoding`) | StepMix (latent classes), scikit-learn's `GaussianMixture` |
//! | points of one kind of number; clusters, a density | [`gmm`] | scikit-learn, linfa |
//! | one number, bounded, multimodal or given another | [`density`] | rv, SciPy |
//! | states of any kind with features that you can compute, but no sum over states | [`factor_graph`], [`log_linear`] | – |
//! | a model that is easily written as a function that draws; posteriors of what it draws | [`program`], whose page says which engine when | Stan, Gen, Pyro |
//! | a probability of yes or no from features | [`boosting`] | CatBoost, scikit-learn |
//! | a matrix with holes | [`low_rank`] | softImpute |
//!
//! # Which inference when
//! | of | exactly | where that is too wide | how good that is |
//! | --- | --- | --- | --- |
//! | a network | [`network::Network::marginal`], `explain`, `log_probability`: elimination, exponential in the width of the graph | `likelihood_weighting` where evidence is probable, `gibbs` where tables have no zeros, `loopy` where loops are long | standard errors of [`network::Estimate`]; of `loopy` none: compare with one of the others |
//! | a factor graph | [`factor_graph::Question`]: marginals, explanation, log Z | `loopy`; `annealed` for log Z | error bars of [`factor_graph::LogPartition`] |
//! | a program of finite choices | [`program::exact`] up to a million ways, [`program::compile`] for choices that depend on few others | [`program::importance`], [`program::smc`], [`program::metropolis`] | effective sample size and Pareto's k, R-hat and Monte Carlo errors; [`program::Posterior::beside`] prints true errors beside them |
//! | a program of real choices | – | `program::nuts` where each run makes the same ones, else [`program::metropolis`]; [`program::smc`] where data come in turn | R-hat below 1.01 of four chains, few divergences |
//! | a model of a table | [`hierarchy::Hierarchy::complete`], `style_posterior`: exact up to 2048 assignments of hidden kinds in a row | the most probable assignments, by itself | – |
//!
//! Elimination first, always: it has no error to be estimated. Width is what counts, not the number of variables: a chain of a
//! thousand is easy, a full grid of 20 x 20 is not.
//!
//! A hierarchy is a network ([`hierarchy::Hierarchy::to_network`]): learn it as the one, ask it as the other.
//!
//! One verb for one idea: *fit* estimates parameters of a given structure, *learn* structure and
//! parameters, *select* a size by a criterion; *sample* draws, *complete* draws what is missing.
//! `log_density` is of complete real points, `log_probability` of evidence, `log_likelihood` of the
//! rows of a table with missing values integrated out. What draws takes a generator; what runs with
//! restarts and streams of its own takes a seed ([`edifice_base::rng`]).
//!
//! Common ground: [`Table`] (data with missing values), [`em`] (the one EM loop), [`conjugate`]
//! (priors with closed-form evidence), [`ModelError`] (what can be wrong, where). Everything works
//! in log space, natural logarithms. Hidden variables and missing values are summed or integrated
//! out, never imputed.

pub mod boosting;
pub(crate) mod chunks;
mod column;
pub mod conjugate;
pub mod density;
pub mod elimination;
pub mod em;
mod error;
pub mod factor_graph;
pub(crate) mod gaussian;
pub mod gmm;
pub(crate) mod graph;
pub mod hierarchy;
mod information;
pub(crate) mod linalg;
pub mod log_linear;
pub mod low_rank;
pub mod network;
pub mod program;
pub(crate) mod standardize;
mod table;
pub mod tables;
mod translate;

/// The version of `nalgebra` whose matrices are in signatures here.
pub use nalgebra;
/// The version of `rand` whose generators the functions here take.
pub use rand;

pub use error::ModelError;
pub use table::{Cell, Column, Table};
