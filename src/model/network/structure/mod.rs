//! Structure search: the graph of a discrete network from rows, complete ([`search`]) or not ([`search_incomplete`]).
//!
//! A structure's score is a sum over families, a variable X_i with parents U_i, r_i categories and q_i configurations of
//! the parents; `N_ijk` rows have category k in configuration j:
//!
//! ```text
//! BIC   Σ_i [ Σ_jk N_ijk log(N_ijk / N_ij) - (r_i - 1) q_i / 2 log N ]                              (Schwarz 1978)
//! BDeu  Σ_i Σ_j [ log Γ(a_ij) - log Γ(a_ij + N_ij) + Σ_k log Γ(a_ijk + N_ijk) - log Γ(a_ijk) ],
//!       a_ijk = ess / (r_i q_i), a_ij = Σ_k a_ijk                                                   (Heckerman et al. 1995)
//! ```
//! The search adds, takes out and turns round one edge at a time, whichever gains most; moves that would undo one of the
//! last [`SearchSettings::tabu`] are left out unless they lead above all before (Glover 1989), it goes on through
//! [`SearchSettings::patience`] moves without a new best, and starts anew ([`SearchSettings::restarts`]) from a random structure of the best
//! one's equivalence class, which has other neighbours (repeated covered arc reversal, Castelo and Kočka 2003), every second
//! time with a few random moves besides. Families' scores are kept, so that each is counted once; a move changes the gains of moves into
//! one or two variables only. Edges may be required or forbidden, variables ordered in tiers. Of up to six variables all structures
//! are compared besides (`exact.rs`).
//!
//! Both scores are the same for structures of one equivalence class: only the skeleton and the v-structures can be learned,
//! and the direction of the other edges is the first found.
//!
//! Time: `O(n² N)` for the first gains of n variables and N rows, then `O(n N)` per move.
//!
//! Source: Koller and Friedman 2009, Sec. 18.3 and 18.4.

mod climb;
mod constraints;
mod exact;
mod families;
mod incomplete;
mod settings;

use super::super::error::ModelError;
use super::super::table::Table;
use super::{FitSettings, Network, Variable};
use climb::Climb;
use constraints::Allowed;
use edifice_base::rng::stream;
use families::Families;
pub use incomplete::search_incomplete;
pub use settings::{Score, SearchSettings};

/// Scores that differ by less are those of one equivalence class, nats.
const NOISE: f64 = 1e-9;

/// Result of [`search`], which has an example: of up to six variables the structure of highest score of all; of more, that of highest score
/// that was met, not with certainty the highest of all, as the problem is NP-hard (Koller and Friedman 2009, Sec. 18.4). [`score`] of its edges gives [`Found::score`] again.
#[derive(Clone, Debug)]
pub struct Found {
    /// The structure with tables: MAP under the prior of [`FitSettings`].
    pub network: Network,
    /// Edges (parent, child), by child, then by parent, in the order of the columns.
    pub edges: Vec<(String, String)>,
    /// Its score, nats.
    pub score: f64,
    /// Moves made.
    pub moves: usize,
    /// Families counted.
    pub families: usize,
    /// True if the caller of [`search_while`] ended the search: the structure is the best so far.
    pub interrupted: bool,
}

/// Searches the structure of highest score for the categorical columns of `data`.
///
/// The same seed gives the same structure with any number of threads.
///
/// # Errors
/// [`ModelError::Kind`] for a real column, [`ModelError::Missing`] for a missing cell, [`ModelError::Unknown`] for a name in
/// a constraint, [`ModelError::Cycle`] for required edges in a circle, [`ModelError::Parameter`] for constraints that
/// contradict each other or settings out of range.
///
/// # Examples
/// ```
/// use edifice_model::{Table, network::structure::{SearchSettings, search}};
/// let rain: Vec<Option<bool>> = (0..200).map(|i| Some(i % 3 == 0)).collect();
/// let wet: Vec<Option<bool>> = (0..200).map(|i| Some(i % 3 == 0 || i % 50 == 1)).collect();
/// let noise: Vec<Option<bool>> = (0..200).map(|i| Some(i / 7 % 2 == 0)).collect();
/// let data = Table::new().binary("rain", rain)?.binary("wet", wet)?.binary("noise", noise)?;
/// let found = search(&data, &SearchSettings::default(), 1)?;
/// assert_eq!(found.edges.len(), 1);
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
pub fn search(data: &Table, settings: &SearchSettings, seed: u64) -> Result<Found, ModelError> {
    search_while(data, settings, seed, &|| true)
}

/// As [`search`], as long as `goes_on`, which is asked before every move and every few thousand families.
///
/// # Errors
/// As [`search`].
pub fn search_while(
    data: &Table,
    settings: &SearchSettings,
    seed: u64,
    goes_on: &(dyn Fn() -> bool + Sync),
) -> Result<Found, ModelError> {
    let mut families = Families::new(data, settings.score)?;
    let allowed = Allowed::new(data, settings)?;
    let mut climb = Climb::new(&mut families, &allowed, settings, goes_on)?;
    climb.run(&mut stream(seed, "network/structure", 0));
    let interrupted = climb.ended();
    let (mut parents, mut score, moves) = climb.best();
    if families.variables() <= exact::MOST
        && !interrupted
        && let Some(best) = exact::best(&mut families, &allowed, settings.most_parents)
        && best.1 > score + NOISE
    {
        (parents, score) = best;
    }
    let columns = data.columns();
    let name = |i: usize| columns[i].name().to_owned();
    let mut edges = Vec::new();
    let mut variables = Vec::with_capacity(columns.len());
    for (child, parents) in parents.iter().enumerate() {
        edges.extend(parents.iter().map(|&p| (name(p), name(child))));
        let names: Vec<&str> = parents.iter().map(|&p| columns[p].name()).collect();
        let categories = columns[child].categories().unwrap_or_default();
        let categories: Vec<&str> = categories.iter().map(String::as_str).collect();
        // Complete rows: EM is one count.
        let table = families.table(child, parents, FitSettings::default().priors.dirichlet);
        variables.push(Variable::table(
            columns[child].name(),
            &categories,
            &names,
            &table,
        ));
    }
    Ok(Found {
        network: Network::new(variables)?,
        edges,
        score,
        moves,
        families: families.counted(),
        interrupted,
    })
}

/// The score of a given structure, nats: `parents[i]` are the columns that column i depends on. That they form no cycle is not
/// checked: the sum over families is one of a network only then.
///
/// Time: `O(N Σ_i (|U_i| + 1))` for N rows and parents U_i, besides the cells of the families' tables.
///
/// # Errors
/// As [`search`]; [`ModelError::Parameter`] for parents that are no columns.
///
/// # Examples
/// ```
/// use edifice_model::{Table, network::structure::{Score, score}};
/// let column = |m: usize| (0..120).map(move |i| Some(i % m == 0));
/// let data = Table::new().binary("a", column(2))?.binary("b", column(4))?.binary("c", column(8))?;
/// let bdeu = |parents: [Vec<usize>; 3]| score(&data, &parents, Score::Bdeu(1.0));
/// let chain = bdeu([vec![], vec![0], vec![1]])?;
/// let fork = bdeu([vec![1], vec![], vec![1]])?;
/// let apart = bdeu([vec![], vec![], vec![]])?;
/// // One equivalence class, one score; the columns are not independent.
/// assert!((chain - fork).abs() < 1e-9 && chain > apart + 10.0);
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
pub fn score(data: &Table, parents: &[Vec<usize>], score: Score) -> Result<f64, ModelError> {
    let mut families = Families::new(data, score)?;
    let columns = data.columns().len();
    if parents.len() != columns || parents.iter().flatten().any(|&p| p >= columns) {
        return Err(ModelError::parameter("parents", "do not fit the columns"));
    }
    let total = parents.iter().enumerate().map(|(child, parents)| {
        let mut parents = parents.clone();
        parents.sort_unstable();
        families.score(child, &parents)
    });
    Ok(total.sum())
}
