//! The score of a structure, and the settings of a search.

/// The score that is maximised: BIC or BDeu, as in [the module](super), both in nats and the greater the better.
///
/// [`score`](super::score) computes it for a given structure, [`search`](super::search) looks for the structure of most. Of the two, BDeu is the exact
/// log marginal likelihood under its prior; BIC approximates it for many rows.
///
/// # Examples
/// ```
/// use edifice_model::{Table, network::structure::{Score, score}};
/// // Four times yes of eight: Beta(1, 1) gives 4! 4! / 9! = 1 / 630.
/// let data = Table::new().binary("garage", (0..8).map(|i| Some(i % 2 == 0)))?;
/// let bdeu = score(&data, &[vec![]], Score::Bdeu(2.0))?;
/// assert!((bdeu + 630.0_f64.ln()).abs() < 1e-9);
/// let bic = score(&data, &[vec![]], Score::Bic)?;
/// assert!((bic - (8.0 * 0.5_f64.ln() - 0.5 * 8.0_f64.ln())).abs() < 1e-9);
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Score {
    /// Log likelihood less `log N / 2` for each free parameter.
    Bic,
    /// Log marginal likelihood under Dirichlet priors with this equivalent sample size, in rows.
    Bdeu(f64),
}

/// Settings of [`search`](super::search): the score, constraints on edges, and how long to search.
///
/// A table has `r Π_p r_p` cells for r categories and parents of r_p categories each, so that [`SearchSettings::most_parents`] bounds the
/// cost of a family. Constraints are names of columns; they cut down the moves, and directions that data cannot tell apart
/// (one equivalence class) they can decide.
///
/// # Examples
/// ```
/// use edifice_model::{Table, network::structure::{SearchSettings, search}};
/// let rain: Vec<Option<bool>> = (0..200).map(|i| Some(i % 3 == 0)).collect();
/// let wet: Vec<Option<bool>> = (0..200).map(|i| Some(i % 3 == 0 || i % 50 == 1)).collect();
/// let data = Table::new().binary("wet", wet)?.binary("rain", rain)?;
/// let own = |name: &str| name.to_owned();
/// let tiers = vec![vec![own("rain")], vec![own("wet")]];
/// let found = search(&data, &SearchSettings { tiers, ..SearchSettings::default() }, 1)?;
/// assert_eq!(found.edges, [(own("rain"), own("wet"))]);
/// let forbidden = vec![(own("rain"), own("wet")), (own("wet"), own("rain"))];
/// let none = search(&data, &SearchSettings { forbidden, ..SearchSettings::default() }, 1)?;
/// assert!(none.edges.is_empty() && none.score < found.score);
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SearchSettings {
    /// The score that is maximised.
    pub score: Score,
    /// Most parents of one variable.
    pub most_parents: usize,
    /// Edges (parent, child) that the structure must have.
    pub required: Vec<(String, String)>,
    /// Edges that it must not have.
    pub forbidden: Vec<(String, String)>,
    /// Variables in order of time: none has a parent in a later tier. Variables in no tier are free.
    pub tiers: Vec<Vec<String>>,
    /// Moves for which a move is not undone.
    pub tabu: usize,
    /// Moves without a new best after which a climb ends.
    pub patience: usize,
    /// Climbs from other structures of the best one's equivalence class.
    pub restarts: usize,
}

impl Default for SearchSettings {
    fn default() -> Self {
        Self {
            score: Score::Bdeu(1.0),
            most_parents: 6,
            required: Vec::new(),
            forbidden: Vec::new(),
            tiers: Vec::new(),
            tabu: 20,
            patience: 20,
            restarts: 40,
        }
    }
}
