//! Learning from a table: structure and parameters, or parameters alone.

use std::ops::ControlFlow;

use rand::seq::SliceRandom;

use super::super::em::{Outcome, Stopping};
use super::super::error::ModelError;
use super::super::table::Table;
use super::fit::{Problem, Scored};
use super::schema::{Rows, Schema};
use super::search::{Rival, Search};
use super::search_step::SearchStep;
use super::structure::{Selector, Structure};
use super::watch::Watch;
use super::{Group, Hierarchy, Observer, Priors, Settings, Variant};
use edifice_base::rng::stream;

/// Least gain of a round of EM on many rows, nats a row: while a structure is searched, where what decides is far more, and
/// where the parameters of all rows are settled.
const SETTLED: f64 = 1e-4;

/// Result of [`learn`], [`learn_observed`] and [`refine`]; the example of [`learn`] reads one.
///
/// Scores are comparable, whatever the [`Variant`], between models of the same rows and groups that standardise columns alike,
/// as [`learn`] does and [`refine`] need not: the logarithms of the columns' deviations are not in them.
#[derive(Clone, Debug)]
pub struct Learned {
    /// The model of highest score.
    pub model: Hierarchy,
    /// Its Cheeseman-Stutz score, nats, on standardised columns of [`Learned::rows`] rows.
    pub score: f64,
    /// Its BIC score `log P(O | Θ) - k/2 log n`, nats, on standardised columns of the same rows.
    pub bic: f64,
    /// Every accepted configuration, by |S|, then those of the searches above and around the best ones.
    pub trace: Vec<SearchStep>,
    /// True if the observer ended the search: the model is the best so far.
    pub interrupted: bool,
    /// Rows that the parameters were fitted to and the scores are of: all, unless the observer ended a search on some of them.
    pub rows: usize,
}

/// Learns structure and parameters from `data`, whose columns `groups` assign to attributes.
///
/// The structure G (|S|, every |H_g|, lateral edges) is the one of highest Cheeseman-Stutz score that the search of
/// [the module](crate::hierarchy) meets, in nats,
/// `log P(O* | G) + log P(O | G, Θ) - log P(O* | G, Θ)`,
/// with Θ the parameters that EM finds and O* the rows O completed by their expected statistics, whose evidence `P(O* | G)` is a
/// product of the closed forms of [`conjugate`](crate::conjugate) (Fan and Wonka 2016, Eq. 2 with a uniform P(G);
/// Cheeseman and Stutz 1996).
///
/// Each value tried of |S|, of an |H_g| or of the lateral edges takes one run of EM, whose rounds are linear in rows; the same
/// seed gives the same bytes with any number of threads.
///
/// # Errors
/// A column that is unknown, constant, all missing or of mixed kind within its group; settings out
/// of range; [`ModelError`] names the column.
///
/// # Examples
/// ```
/// use edifice_model::{Table, hierarchy::{Group, Settings, learn}};
/// let n = 40;
/// let width = (0..n).map(|i| Some(if i % 2 == 0 { 5.0 } else { 12.0 } + (i % 5) as f64 * 0.1));
/// let houses = Table::new()
///     .real("width", width)?
///     .binary("garage", (0..n).map(|i| Some(i % 2 == 1)))?;
/// let groups = [Group::new("size", &["width"]), Group::new("parts", &["garage"])];
/// let settings = Settings { styles: 2..=3, ..Settings::default() };
/// let learned = learn(&houses, &groups, &settings, 1)?;
/// assert_eq!(learned.model.styles(), 2);
/// // All configurations score less than the model, but for what EM gained since.
/// assert!(learned.trace.iter().all(|step| step.score < learned.score + 0.5));
/// assert!(learned.trace.iter().any(|step| step.styles == 3) && !learned.interrupted);
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
pub fn learn(
    data: &Table,
    groups: &[Group],
    settings: &Settings,
    seed: u64,
) -> Result<Learned, ModelError> {
    learn_observed(data, groups, settings, seed, &|_| ControlFlow::Continue(()))
}

/// As [`learn`], watched: a search that is ended early returns the best model so far.
///
/// # Errors
/// As [`learn`].
///
/// # Examples
/// Ended at the first configuration, then gone on with:
/// ```
/// use std::ops::ControlFlow;
/// use edifice_model::{Table, hierarchy::{Group, Settings, learn_observed, refine}};
/// let width = (0..60).map(|i| Some([5.0, 12.0, 30.0][i % 3] + (i % 5) as f64 * 0.1));
/// let houses = Table::new().real("width", width)?;
/// let groups = [Group::new("size", &["width"])];
/// let settings = Settings { styles: 1..=2, ..Settings::default() };
/// let early = learn_observed(&houses, &groups, &settings, 1, &|step| match step {
///     Some(_) => ControlFlow::Break(()),
///     None => ControlFlow::Continue(()),
/// })?;
/// assert!(early.interrupted);
/// let on = refine(&early.model, &houses, &settings, 1, &|_| ControlFlow::Continue(()))?;
/// assert!(!on.interrupted && on.score > early.score + 1.0);
/// assert_eq!(on.model.cardinalities(), [3]);
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
pub fn learn_observed(
    data: &Table,
    groups: &[Group],
    settings: &Settings,
    seed: u64,
    observer: &Observer,
) -> Result<Learned, ModelError> {
    learn_against(data, groups, settings, seed, None, observer)
}

/// As [`learn_observed`], beside a model of the same rows and columns in other groups: a search that stays far behind is not gone on with to
/// its end, and what is behind in the end is not fitted to rows that were not searched.
pub(crate) fn learn_against(
    data: &Table,
    groups: &[Group],
    settings: &Settings,
    seed: u64,
    rival: Option<Rival>,
    observer: &Observer,
) -> Result<Learned, ModelError> {
    check(settings)?;
    let schema = Schema::learn(data, groups, settings.constant)?;
    let work = Work::new(&schema, data, settings, seed)?;
    work.learn(rival, observer, |search| {
        let mut found = search.run(seed)?;
        let edges = settings.category_edges && !schema.codes.is_empty();
        if edges && !search.large() && !search.watch.ended() {
            // Edges from categories compete with styles for the same dependencies: the search without them may end higher.
            let without = Search {
                categories: false,
                ..*search
            };
            let (scored, trace) = without.run(seed)?;
            found.1.extend(trace);
            if scored.score > found.0.score {
                found.0 = scored;
            }
        }
        Ok(found)
    })
}

/// Goes on from a model that was learned before, from the same kind of table: its attributes, cardinalities and edges are
/// where the search starts, and its columns stay standardised as they are. For a search that was interrupted, or new rows.
/// Every |S| of the settings is tried above its second level; [`learn_observed`] has an example.
///
/// # Errors
/// As [`learn`]; a category that the model does not know; [`ModelError::Parameter`] for a model of another variant.
pub fn refine(
    model: &Hierarchy,
    data: &Table,
    settings: &Settings,
    seed: u64,
    observer: &Observer,
) -> Result<Learned, ModelError> {
    check(settings)?;
    if model.variant != settings.variant {
        let problem = format!("the model given is {:?}", model.variant);
        return Err(ModelError::parameter("variant", problem));
    }
    let work = Work::new(&model.schema, data, settings, seed)?;
    let structure = model.shape.structure.clone();
    work.learn(None, observer, |search| {
        search.improve(structure, model.params.clone(), seed)
    })
}

fn check(settings: &Settings) -> Result<(), ModelError> {
    settings.priors.check()?;
    if *settings.styles.start() < 1 || settings.styles.is_empty() {
        return Err(ModelError::parameter(
            "styles",
            "must be a range from 1 or more",
        ));
    }
    if settings.most_states < 2 {
        return Err(ModelError::parameter("most_states", "must be at least 2"));
    }
    if !(0.0..1.0).contains(&settings.background) {
        return Err(ModelError::parameter(
            "background",
            "must be at least 0 and below 1",
        ));
    }
    if settings.searched == 0 {
        return Err(ModelError::parameter("searched", "must be at least 1"));
    }
    Ok(())
}

/// All rows, and those that are searched on.
struct Work<'a> {
    schema: &'a Schema,
    settings: &'a Settings,
    rows: Rows,
    /// The rows of the search; `None` for all rows.
    sample: Option<Rows>,
}

impl<'a> Work<'a> {
    fn new(
        schema: &'a Schema,
        data: &Table,
        settings: &'a Settings,
        seed: u64,
    ) -> Result<Self, ModelError> {
        let rows = schema.encode(data)?;
        let sample = (rows.rows > settings.searched).then(|| {
            let mut rng = stream(seed, "hierarchy/searched", 0);
            let mut chosen: Vec<usize> = (0..rows.rows).collect();
            chosen.shuffle(&mut rng);
            chosen.sort_by_key(|&row| rows.missing(row));
            chosen.truncate(settings.searched);
            chosen.sort_unstable();
            rows.select(&chosen)
        });
        Ok(Self {
            schema,
            settings,
            rows,
            sample,
        })
    }

    /// Searches, then fits what was found to all rows.
    fn learn(
        &self,
        rival: Option<Rival>,
        observer: &Observer,
        search: impl FnOnce(&Search) -> Result<(Scored, Vec<SearchStep>), ModelError>,
    ) -> Result<Learned, ModelError> {
        let watch = Watch::new(observer);
        let (settings, schema) = (self.settings, self.schema);
        let rows = self.sample.as_ref().unwrap_or(&self.rows);
        let mut searching = settings.clone();
        searching.search.gain = settings.search.gain.max(SETTLED * rows.rows as f64);
        let (mut scored, trace) = search(&Search {
            schema,
            rows,
            settings: &searching,
            categories: settings.category_edges,
            rival,
            watch: &watch,
        })?;
        let mut fitted = rows.rows;
        let behind = rival.is_some_and(|rival| scored.score < rival.score);
        if self.sample.is_some() && !watch.ended() && !behind {
            let structure = scored.shape.structure.clone();
            let goes_on = || watch.goes_on();
            let mut problem = Problem::new(schema, &self.rows, &settings.priors, structure)?;
            problem.within = Some(&goes_on);
            let stopping = Stopping {
                gain: settings.stopping.gain.max(SETTLED * self.rows.rows as f64),
                ..settings.stopping
            };
            // Ended within the first step, the parameters are those of the rows searched.
            match problem.fit_while(scored.params.clone(), &stopping, &goes_on) {
                Err(ModelError::Interrupted) => {}
                found => {
                    scored = found?;
                    fitted = self.rows.rows;
                }
            }
        }
        let penalty = 0.5 * scored.shape.free_parameters() as f64 * (fitted as f64).ln();
        Ok(Learned {
            score: scored.score,
            bic: scored.stats.log_likelihood - penalty,
            trace,
            interrupted: watch.ended(),
            rows: fitted,
            model: Hierarchy::new(
                schema.clone(),
                scored.shape,
                scored.params,
                settings.variant,
            ),
        })
    }
}

/// Result of [`fit`] and [`fit_observed`]; the example of [`fit`] reads one. Scores are as in [`learn`].
#[derive(Clone, Debug)]
pub struct Fitted {
    /// The model.
    pub model: Hierarchy,
    /// Cheeseman-Stutz score, nats, on standardised columns.
    pub score: f64,
    /// Why EM ended.
    pub outcome: Outcome,
}

/// One run of EM for given cardinalities (`states` per real group, in order) without lateral
/// edges, from k-means++ clusters of at most 10,000 of the rows: for data too large to search.
/// Time is linear in rows ([the module](crate::hierarchy) has the cost of a round); besides the data themselves one
/// standardised copy is held. EM: Fan and Wonka 2016, Sec. 5.3, *Parameter learning*; [`em`](crate::em).
///
/// # Errors
/// As [`learn`]; [`ModelError::Parameter`] for cardinalities that do not fit the groups.
///
/// # Examples
/// ```
/// use edifice_model::{Table, em::{Outcome, Stopping}, hierarchy::{Group, Priors, fit}};
/// // Twenty narrow houses, forty wide ones.
/// let width = (0..60).map(|i| Some(if i < 20 { 5.0 } else { 12.0 } + (i % 5) as f64 * 0.1));
/// let houses = Table::new().real("width", width)?;
/// let groups = [Group::new("size", &["width"])];
/// let fitted = fit(&houses, &groups, 1, &[2], &Priors::default(), &Stopping::default(), 1)?;
/// assert_eq!(fitted.outcome, Outcome::Converged);
/// let kinds = &fitted.model.state_probabilities("size")?[0];
/// // The mode under Dirichlet(1.2, 1.2).
/// assert!((kinds[0].min(kinds[1]) - 20.2 / 60.4).abs() < 1e-3);
/// # Ok::<(), edifice_model::ModelError>(())
/// ```
pub fn fit(
    data: &Table,
    groups: &[Group],
    styles: usize,
    states: &[usize],
    priors: &Priors,
    stopping: &Stopping,
    seed: u64,
) -> Result<Fitted, ModelError> {
    let settings = Settings {
        priors: *priors,
        stopping: *stopping,
        ..Settings::default()
    };
    let go_on = |_: Option<&SearchStep>| ControlFlow::Continue(());
    fit_observed(data, groups, styles, states, &settings, seed, &go_on)
}

/// As [`fit`], with priors, stopping and constant columns as in `settings`, watched before every round.
///
/// # Errors
/// As [`fit`].
pub fn fit_observed(
    data: &Table,
    groups: &[Group],
    styles: usize,
    states: &[usize],
    settings: &Settings,
    seed: u64,
    observer: &Observer,
) -> Result<Fitted, ModelError> {
    check(settings)?;
    let schema = Schema::learn(data, groups, settings.constant)?;
    if styles == 0 || states.len() != schema.groups.len() || states.contains(&0) {
        let problem = format!(
            "one cardinality for each of {} real groups",
            schema.groups.len()
        );
        return Err(ModelError::parameter("states", problem));
    }
    let rows = schema.encode(data)?;
    let selectors = states.iter().map(|&k| Selector::Hidden(k)).collect();
    let structure = Structure {
        selectors,
        background: settings.background,
        ..Structure::new(styles, &Selector::Style, states.len(), schema.codes.len())
    };
    let problem = Problem::new(&schema, &rows, &settings.priors, structure)?;
    let start = problem.start(&mut stream(seed, "fixed", 0))?;
    let watch = Watch::new(observer);
    let (scored, outcome) = problem.fit_told(start, &settings.stopping, &|| watch.goes_on())?;
    Ok(Fitted {
        score: scored.score,
        outcome,
        model: Hierarchy::new(
            schema.clone(),
            scored.shape,
            scored.params,
            Variant::NoLateral,
        ),
    })
}
