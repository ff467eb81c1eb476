//! A hierarchical model with hidden styles: learning how attribute vectors are made.
//!
//! Rows of mixed attributes x are explained by a root style S (hidden, `s = 1..|S|`). Each real
//! attribute group g (a vector C_g) has its own hidden variable H_g below S; categorical columns
//! E_k (bits of a binary vector, or one category) hang on S directly. Lateral edges make a real
//! group depend linearly on others, its parents π(C_g):
//!
//! ```text
//! P(x) = Σ_s P(s) Π_k P(E_k | s) Π_g Σ_h P(H_g = h | s) N(C_g; B_ghᵀ (1, π(C_g)), Σ_gh)     (Eq. 1)
//! ```
//!
//! Learning ([`learn`]) is the search of Sec. 5.3: for every |S|, every |H_g| is raised from 2
//! while the Cheeseman-Stutz score (Eq. 2) rises, with lateral edges searched greedily at every
//! step; parameters are MAP by EM. Real columns are standardised inside; log-likelihoods, samples
//! and answers are in the columns' own units. A column that a question leaves out, and any missing
//! value, is integrated out exactly.
//!
//! | variant | paper | what it is |
//! | --- | --- | --- |
//! | [`Variant::Full`] | ours, Fig. 4(c, d) | S, H_g and lateral edges |
//! | [`Variant::NoLateral`] | Model 1 | no lateral edges |
//! | [`Variant::NoSecondLevel`] | Model 2, Fig. 4(b) | C_g depends on S itself |
//! | [`Variant::Directed`] | Model 3, Fig. 4(a) | no hidden variables |
//!
//! [`learn`] finds structure and parameters, [`refine`] goes on from a model, [`fit`] estimates parameters alone; what comes out
//! is a [`Hierarchy`], which answers questions about rows, draws and completes them ([`Draws`]), and can be stored.
//!
//! # Shapes and cost
//! A real group of d columns with p inputs `(1, π(C_g))` has for each of its k_g states a B of p x d and a Σ of d x d; H_g has a
//! table of k_g x |S|, a categorical column of r categories one of r x |S|. With q_g = p + d and K categorical columns, a round
//! of EM on n complete rows takes `O(n (Σ_g k_g (q_g² + |S|) + K |S|) + Σ_g k_g q_g³)`, and a question to a model its share of
//! the first term for each row.
//!
//! A row that lacks values costs more. The states of groups that missing values link are enumerated together: exactly up to
//! 2048 assignments, of more the most probable (while structures are searched, 64). Missing categories that have children are
//! enumerated as well; a row with more than 4096 assignments of them is refused.
//!
//! # Deviations and readings
//! - Sigmoid CPDs of bits given the one discrete parent S are saturated: a table says the same.
//! - All variables of a binary vector are independent given S.
//! - Lateral edges run between real groups, as in Eq. 1; all columns of the parent enter. On request
//!   ([`Settings::category_edges`]) also from categorical columns, by the same score.
//! - Model 3: real groups may depend on real groups (linearly) and on categorical columns (one
//!   Gaussian for each configuration), categorical columns on categorical columns (tables); edges
//!   greedily by closed-form evidence. A categorical column never depends on a real one.
//! - Priors: P(B, Σ) matrix-normal inverse-Wishart on standardised columns, Dirichlet on tables.
//! - One more value of H_g starts from the current fit with one state cut in two, instead of from
//!   scratch; while searching, EM stops at a small gain of the log posterior ([`Settings::search`]),
//!   and only the winner is run to the paper's 1e-6.
//! - Lateral edges are proposed from the expected statistics of a fit (structural EM) and kept when
//!   the Cheeseman-Stutz score after EM is higher; they are searched anew around every accepted
//!   configuration, while a candidate inherits those of the configuration it grows from.
//! - Lateral edges are added, removed and reversed, not only added. The upward search is then
//!   revised: an edge is removed and its child's cardinality raised instead, two states are
//!   merged, and a second start raises all cardinalities before it searches edges, all by the same
//!   score. Without this, edges added at low cardinality compensate for missing latent states and
//!   are never removed.
//! - The prior of an intercept is worth a hundredth of an observation. The prior is conjugate, so
//!   that it counts in units of the residual: where an attribute is constant within a state (no
//!   second floor), a stronger one lowers the density of every row, and uninformative edges that
//!   share the intercept raise the score.
//! - On request ([`Settings::background`]) a wide background contaminates the Gaussian of every state, so that one row of
//!   an unforeseen kind costs a few nats.
//! - Of more rows than [`Settings::searched`] the structure is searched on a sample of those that lack fewest values, and only
//!   the parameters are fitted to all: the search costs hundreds of EM runs, each linear in rows.
//! - On large tables the second level is searched for two |S| only ([`Sweep`]), since every other |S| is then tried above
//!   the best second level anyway.
//! - After a sweep S gets new starts from the posteriors of all H_g. At the end every |S| is also
//!   combined with the best second level found for any |S|, so that the choice of |S| does not
//!   depend on the local optimum that the search of one |S| ended in.
//!
//! Source: Fan and Wonka 2016, Sec. 5; Koller and Friedman 2009, Ch. 19.

mod background;
pub(crate) mod component;
mod directed;
mod draw;
mod edges;
mod fit;
mod infer;
mod learn;
mod params;
mod query;
mod restyle;
mod revise;
mod schema;
mod search;
mod search_step;
mod split;
mod store;
pub(crate) mod structure;
mod watch;
pub(crate) mod wide;

use std::ops::RangeInclusive;

pub use super::conjugate::Priors;
use super::em::Stopping;
pub use super::standardize::Constant;
pub use draw::Draws;
pub(crate) use learn::learn_against;
pub use learn::{Fitted, Learned, fit, fit_observed, learn, learn_observed, refine};
pub use query::Hierarchy;
pub use schema::Group;
pub(crate) use search::{Rival, SMALL};
pub use search_step::SearchStep;
pub use watch::Observer;

/// Which of the paper's models to learn: the table in [the module](self).
///
/// Without lateral edges π(C_g) is empty in Eq. 1. Without second level the sum over h is left out, and the state of every group
/// is s. Without hidden variables, `P(x) = Π_k P(E_k | π(E_k)) Π_g N(C_g; B_gcᵀ (1, π(C_g)), Σ_gc)` with c the configuration of
/// the group's categorical parents: its score is a sum over children, so that each edge added costs the evidence of `O(m)`
/// families of m groups and columns, and the first `O(m²)`, each linear in rows. Sources: Fan and Wonka 2016, Fig. 4 and Sec. 7.
///
/// # Examples
/// ```
/// use edifice_model::{Table, hierarchy::{Group, Settings, Variant, learn}};
/// let width = |i: usize| 6.0 + (i % 7) as f64;
/// let houses = Table::new()
///     .real("width", (0..70).map(|i| Some(width(i))))?
///     .real("area", (0..70).map(|i| Some(10.0 * width(i) + (i % 3) as f64)))?
///     .real("age", (0..70).map(|i| Some((i % 10) as f64)))?;
/// let groups = ["width", "area", "age"].map(|name| Group::new(name, &[name]));
/// let settings = Settings { variant: Variant::Directed, ..Settings::default() };
/// let model = learn(&houses, &groups, &settings, 1)?.model;
/// assert_eq!(model.styles(), 1);
/// let edges = model.lateral_edges();
/// assert_eq!(edges.len(), 1);
/// assert!(edges[0].0 != "age" && edges[0].1 != "age");
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Variant {
    /// Style, second-level hidden variables, lateral edges.
    #[default]
    Full,
    /// Model 1: no lateral edges.
    NoLateral,
    /// Model 2: no second-level hidden variables.
    NoSecondLevel,
    /// Model 3: no hidden variables, directed edges only.
    Directed,
}

/// For which cardinalities of S the second level is searched from the start; every other one gets the best second level
/// that was found, and new starts for S above it. A choice of [`Settings::sweep`]; the paper searches each (Sec. 5.3).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Sweep {
    /// All (paper), unless the real columns of the rows searched have more than 10,000 values: then [`Sweep::Few`].
    #[default]
    Auto,
    /// All cardinalities (paper).
    All,
    /// Two, spread evenly in ratio: `a (b/a)^(1/4)` and `a (b/a)^(3/4)` of a to b, rounded, so 4 and 13 of 2 to 25. Of all |S|
    /// tried above the second level so found, only the best three are fitted to the end.
    Few,
}

/// Settings of [`learn`], and in part of [`fit_observed`]. The defaults are those of the paper where it has any; gains and
/// movements are as in [`Stopping`].
///
/// # Examples
/// The gain of a background on a row ten deviations away, in nats:
/// ```
/// use std::ops::ControlFlow;
/// use edifice_model::{ModelError, Table, hierarchy::{Group, Settings, fit_observed}};
/// let seen = Table::new().real("width", (0..70).map(|i| Some(10.0 + (i % 7) as f64)))?;
/// let strange = Table::new().real("width", [Some(33.0)])?;
/// let groups = [Group::new("size", &["width"])];
/// let go_on = |_: Option<&_>| ControlFlow::Continue(());
/// let told = |background: f64| -> Result<f64, ModelError> {
///     let settings = Settings { background, ..Settings::default() };
///     let fitted = fit_observed(&seen, &groups, 1, &[1], &settings, 1, &go_on)?;
///     Ok(fitted.model.log_likelihood(&strange)?[0])
/// };
/// assert!(told(0.0)? < -45.0 && told(0.01)? > -15.0);
/// # Ok::<(), ModelError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The model to learn.
    pub variant: Variant,
    /// Cardinalities of S to try (paper: 2 to 25).
    pub styles: RangeInclusive<usize>,
    /// Highest cardinality of a second-level variable (paper: 25).
    pub most_states: usize,
    /// Most lateral parents of one group.
    pub most_parents: usize,
    /// True if lateral edges may also run from categorical columns: to real groups, whose means the category shifts
    /// (`N(C_g; B_ghᵀ (1, π(C_g), 1[E_k = 1], 1[E_k = 2], ..), Σ_gh)`), and to categorical columns (paper: no).
    pub category_edges: bool,
    /// ε: share of a wide background in every Gaussian of a real group, in [0, 1): `(1 - ε) N(C_g; ..) + ε N(C_g; 0, 9 I)`
    /// on standardised columns. One row of an unforeseen kind then costs a few nats instead of hundreds (paper: 0).
    pub background: f64,
    /// Rounds of edge search around one configuration.
    pub edge_rounds: usize,
    /// Starts for the smallest model of each |S|, and new starts for S afterwards.
    pub restarts: usize,
    /// Priors.
    pub priors: Priors,
    /// When EM stops while searching; its gain is at least 1e-4 nats a row.
    pub search: Stopping,
    /// When EM of the final model stops.
    pub stopping: Stopping,
    /// The treatment of constant columns.
    pub constant: Constant,
    /// For which cardinalities of S the second level is searched from the start.
    pub sweep: Sweep,
    /// Most rows that the structure is searched on: of more, this number is drawn from those that lack fewest values, and the
    /// parameters of the structure found are then fitted to all of them, until a round gains less than 1e-4 nats a row.
    pub searched: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            variant: Variant::Full,
            styles: 2..=25,
            most_states: 25,
            most_parents: 3,
            category_edges: false,
            background: 0.0,
            edge_rounds: 2,
            restarts: 4,
            priors: Priors::default(),
            search: Stopping {
                movement: 1e-4,
                gain: 0.05,
                max_rounds: 100,
            },
            stopping: Stopping::default(),
            constant: Constant::Refuse,
            sweep: Sweep::default(),
            searched: 3000,
        }
    }
}
