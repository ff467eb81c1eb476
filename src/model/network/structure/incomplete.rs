//! Structure search where cells are missing: structural EM over drawn completions.
//!
//! With O the known cells of N rows, each round
//!
//! ```text
//! draws the missing cells of every row from P(· | o, G, Θ),
//! finds G' of highest score for the rows so completed,
//! fits Θ' = argmax log P(O | G', Θ') + log P(Θ') by EM,
//! ```
//! from a structure without edges. Kept is the round of highest
//! `log P(O | G, Θ) - (log N / 2) Σ_i (r_i - 1) q_i`, whatever the score that is searched by.
//!
//! # Deviations and readings
//! - Friedman takes expected counts of families over all completions; here they are the counts of one draw, as in stochastic EM
//!   (Celeux and Diebolt 1985), so that a family is counted as in complete rows. The rounds end when three in turn are no better.
//!
//! Source: Friedman 1997, *Learning belief networks in the presence of missing values and hidden variables*.

use super::super::super::em::Stopping;
use super::super::super::error::ModelError;
use super::super::super::table::Table;
use super::super::{FitSettings, Network, Variable};
use super::{Found, SearchSettings, search_while};
use edifice_base::rng::stream;

/// Most rounds.
const ROUNDS: usize = 20;
/// Rounds without a better one after which the search ends.
const PATIENCE: usize = 3;
/// Least gain of a round of EM, nats a row.
const SETTLED: f64 = 1e-4;
/// Most rounds of EM for one structure.
const EM_ROUNDS: usize = 100;

/// As [`search_while`](super::search_while), where cells may be missing at random; of complete rows the same. The score of what
/// is found is then that of the module, of the known cells alone.
///
/// Time: up to twenty searches, and as many runs of EM of an exact answer a row and round.
///
/// # Errors
/// As [`search`](super::search), but for missing cells; [`ModelError::AllMissing`] for a column without a known cell.
///
/// # Examples
/// ```
/// use edifice_model::{Table, network::structure::{SearchSettings, search_incomplete}};
/// let rain = (0..300).map(|i| (i % 7 != 0).then_some(i % 3 == 0));
/// let wet = (0..300).map(|i| (i % 5 != 0).then_some(i % 3 == 0 || i % 50 == 1));
/// let noise = (0..300).map(|i| Some(i / 7 % 2 == 0));
/// let data = Table::new().binary("rain", rain)?.binary("wet", wet)?.binary("noise", noise)?;
/// let found = search_incomplete(&data, &SearchSettings::default(), 1, &|| true)?;
/// assert_eq!(found.edges.len(), 1);
/// assert!(!found.edges[0].0.contains("noise") && !found.edges[0].1.contains("noise"));
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
pub fn search_incomplete(
    data: &Table,
    settings: &SearchSettings,
    seed: u64,
    goes_on: &(dyn Fn() -> bool + Sync),
) -> Result<Found, ModelError> {
    if !data.has_missing() {
        return search_while(data, settings, seed, goes_on);
    }
    let names: Vec<&str> = data.columns().iter().map(|c| c.name()).collect();
    let fit_settings = FitSettings {
        stopping: Stopping {
            gain: SETTLED * data.rows() as f64,
            max_rounds: EM_ROUNDS,
            ..Stopping::default()
        },
        ..FitSettings::default()
    };
    let variables = data.columns().iter().map(|column| {
        let categories = column.categories().ok_or_else(|| ModelError::Kind {
            column: column.name().to_owned(),
            got: "real",
            expected: "categorical",
        })?;
        let categories: Vec<&str> = categories.iter().map(String::as_str).collect();
        Ok(Variable::discrete(column.name(), &categories, &[]))
    });
    let apart = Network::new(variables.collect::<Result<_, ModelError>>()?)?;
    let mut current = apart.fit_from(data, &fit_settings)?.network;
    let mut rng = stream(seed, "network/structure/incomplete", 0);
    let mut best: Option<Found> = None;
    let (mut moves, mut families, mut idle) = (0, 0, 0);
    for _ in 0..ROUNDS {
        let completed = current.complete(data, 1, &mut rng)?.in_order(&names)?;
        let mut found = search_while(&completed, settings, seed, goes_on)?;
        let fitted = found.network.fit_from(data, &fit_settings)?;
        found.score = fitted.log_likelihood - penalty(&fitted.network, data.rows())?;
        found.network = fitted.network;
        current = found.network.clone();
        moves += found.moves;
        families += found.families;
        let interrupted = found.interrupted || !goes_on();
        if best.as_ref().is_none_or(|best| found.score > best.score) {
            idle = 0;
            best = Some(found);
        } else {
            idle += 1;
        }
        if let Some(best) = best.as_mut().filter(|_| interrupted) {
            best.interrupted = true;
            break;
        }
        if idle == PATIENCE {
            break;
        }
    }
    let best = best.ok_or(ModelError::Empty { what: "rounds" })?;
    Ok(Found {
        moves,
        families,
        ..best
    })
}

/// `(log N / 2) Σ_i (r_i - 1) q_i`.
fn penalty(network: &Network, rows: usize) -> Result<f64, ModelError> {
    let mut free = 0.0;
    for name in network.names() {
        let mut own = network.categories(name)?.len() as f64 - 1.0;
        for parent in network.parents(name)? {
            own *= network.categories(parent)?.len() as f64;
        }
        free += own;
    }
    Ok(0.5 * free * (rows as f64).ln())
}
