//! Variable elimination: sums and maxima over products of tables, exactly.
//!
//! Given factors `f_i(x_i)` over subsets of discrete variables, wanted are `log Σ_x Π_i f_i` (or the maximum), the marginals
//! of the distribution proportional to the product, its most probable assignments, and independent draws from it.
//!
//! The variables are eliminated one by one. The bucket of v holds the factors whose first eliminated variable is v and the
//! messages of earlier buckets; its message is their product, summed (or maximised) over v. The product
//! divided by the message is `P(v | rest of the bucket's scope)`: the buckets are a Bayesian network again, so that one
//! pass backward gives every marginal, and draws are ancestral.
//!
//! ```
//! use edifice_model::elimination::{BucketTree, Factor, Mode};
//! // Two coins that agree three times out of four, and evidence on the second.
//! let sizes = [2, 2];
//! let agree = Factor::new(vec![0, 1], [0.75_f64, 0.25, 0.25, 0.75].map(f64::ln).to_vec());
//! let seen = Factor::new(vec![1], [0.1_f64, 0.9].map(f64::ln).to_vec());
//! let tree = BucketTree::new(vec![agree, seen], &sizes, Mode::Sum)?;
//! let first = tree.beliefs().of(&[0]);
//! assert!((first[1] - 0.7).abs() < 1e-12 && (tree.total - 1.0_f64.ln()).abs() < 1e-12);
//! # Ok::<(), edifice_model::elimination::TooWide>(())
//! ```
//!
//! Cost is exponential in the number of variables of the largest bucket, which depends on the order ([`order`]); the
//! sizes of all tables are known from the order alone, and what is too large is refused before any table is made.
//!
//! Sources: Dechter 1999, *Bucket elimination*; Koller and Friedman 2009, Ch. 9 and 10.

mod beliefs;
mod factor;
mod messages;
pub mod order;
mod tree;

pub use beliefs::Beliefs;
pub use factor::Factor;
pub(crate) use factor::advance;
pub(crate) use messages::Messages;
pub use order::{Order, TooWide};
pub use tree::BucketTree;

/// The operation that eliminates a variable: `Σ_v f` (Koller and Friedman 2009, Sec. 9.3) or `max_v f` (Sec. 13.2), at
/// the same cost.
///
/// # Examples
/// ```
/// use edifice_model::elimination::{BucketTree, Factor, Mode};
/// let factor = || vec![Factor::new(vec![0, 1], [1.0_f64, 2.0, 3.0, 2.0].map(f64::ln).to_vec())];
/// let total = |mode| Ok::<f64, edifice_model::elimination::TooWide>(BucketTree::new(factor(), &[2, 2], mode)?.total.exp());
/// assert!((total(Mode::Sum)? - 8.0).abs() < 1e-12 && (total(Mode::Max)? - 3.0).abs() < 1e-12);
/// # Ok::<(), edifice_model::elimination::TooWide>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Summed out.
    Sum,
    /// Maximised out.
    Max,
}
