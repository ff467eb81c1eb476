//! Grammars of one set of facades as weighted draws.

use super::adp::search::Setup;
use super::infer::check;
use super::settings::{InferError, Settings};
use edifice_base::{Ended, Watch, Watched};
use edifice_grammar::Grammar;
use edifice_model::program::Evidence;
use edifice_shape::Facade;

/// A draw of [`weighted`].
#[derive(Debug, Clone, PartialEq)]
pub struct WeightedGrammar {
    /// The grammar.
    pub grammar: Grammar,
    /// Its cost by the walk that found it (Eq. 1).
    pub cost: f64,
    /// Its share of all draws' weight; the shares sum to 1.
    pub weight: f64,
}

/// Result of [`weighted`].
#[derive(Debug, Clone, PartialEq)]
pub struct Weighted {
    /// The draws in the order of the walks; equal grammars are not joined.
    pub draws: Vec<WeightedGrammar>,
    /// Effective number of draws by their weights, `1 / Σ w²`.
    pub effective: f64,
    /// Logarithm of `Σ_g q(g) exp(-cost(g))` and its standard error, in nats; the error is an understatement where few draws are effective.
    pub evidence: Option<Evidence>,
    /// Pareto's k of the weights; above 0.7 weighted means are not to be trusted.
    pub pareto_k: Option<f64>,
    /// The way in which the walks ended.
    pub ended: Ended,
}

/// Draws grammars of facades by the splitting heuristic, each weighted by `exp(-cost)`: draws of
/// `p(g) = q(g) exp(-cost(g)) / Z`, with q(g) the probability that a walk ends in the grammar g.
///
/// `settings` give the number of walks (the iterations), seed, costs, operations, the weights of Eq. 5 and protection; their method is
/// not read. The cheapest draw is what [`infer`](super::infer()) returns for [`Method::Importance`](super::Method::Importance) with the same
/// settings. The time is twice that of the walks, and one extraction of a grammar for each; all walks are kept. Source: Wu et al. 2014, Sec. 6.1 (the walks); Robert and
/// Casella 2004, Ch. 3 (the weights).
///
/// # Errors
/// As [`infer`](super::infer()).
///
/// # Examples
/// ```
/// use edifice_base::unwatched;
/// use edifice_facade_grammar::{Settings, weighted};
/// use edifice_shape::{Facade, Rect, Region};
/// // Three windows on a wall.
/// let parts = [("wall", 2.0), ("window", 1.0)].repeat(3);
/// let mut x = 0.0;
/// let regions = parts.into_iter().map(|(label, width)| {
///     x += width;
///     Region { label: label.into(), rect: Rect::new(x - width, 0.0, width, 3.0) }
/// });
/// let facade = Facade::new("row", "m", 9.0, 3.0, regions.collect())?;
/// let settings = Settings { iterations: 500, ..Settings::default() };
/// let found = weighted(&[facade], &settings, &unwatched)?;
/// let mean: f64 = found.draws.iter().map(|d| d.weight * d.cost).sum();
/// // A repeat of a wall with a window costs 2.5; other grammars are drawn as well.
/// let least = found.draws.iter().map(|d| d.cost).fold(f64::INFINITY, f64::min);
/// assert!((least - 2.5).abs() < 1e-9 && mean > least && found.effective > 100.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn weighted(
    facades: &[Facade],
    settings: &Settings,
    watch: &Watch,
) -> Result<Weighted, InferError> {
    settings.costs.check()?;
    check(facades)?;
    let watched = Watched::new(watch);
    let search = Setup::new(facades, settings, &watched)?;
    let walks = search.weighted_walks()?;
    let (effective, evidence, pareto_k) = (walks.ess(), walks.evidence, walks.pareto_k);
    let draws = walks.draws.into_iter().map(|draw| WeightedGrammar {
        grammar: search.grammar(facades, &draw.out.0),
        cost: draw.out.1,
        weight: draw.log_weight.exp(),
    });
    Ok(Weighted {
        draws: draws.collect(),
        effective,
        evidence,
        pareto_k,
        ended: watched.ended(),
    })
}
