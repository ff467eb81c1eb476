//! The run of `model learn` and `building learn`: with progress, a time limit, and an end on request that keeps the
//! best so far.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use edifice_base::{Error, Result};
use edifice_model::em::Outcome;
use edifice_model::hierarchy::{
    Hierarchy, Learned, SearchStep, Settings, fit_observed, learn_observed, refine,
};
use edifice_model::tables::Dataset;
use edifice_model::tables::joined::{Joined, Tried, learn_joined};
use edifice_model::{ModelError, Table};

use super::search::{SearchOptions, warnings};
use crate::print;

/// Time between two lines of progress.
const TELL: Duration = Duration::from_secs(10);

/// Ctrl-C was pressed.
static STOP: AtomicBool = AtomicBool::new(false);

/// Options of learning one model.
#[derive(clap::Args)]
pub(crate) struct Learning {
    #[command(flatten)]
    pub search: SearchOptions,
    /// Seconds after which to end with the best model so far (as Ctrl-C does).
    #[arg(long, value_name = "SECONDS")]
    time_limit: Option<f64>,
    /// Go on from a model that was learned before from such a table, for example one that was interrupted.
    #[arg(long, value_name = "MODEL", conflicts_with = "fit_only")]
    pub from: Option<PathBuf>,
    /// Do not search: fit `--styles` styles and `--kinds` kinds of each attribute, without lateral edges.
    #[arg(long, requires = "styles", requires = "kinds")]
    fit_only: bool,
    /// Styles of `--fit-only`.
    #[arg(long, requires = "fit_only")]
    styles: Option<usize>,
    /// Kinds of each continuous attribute of `--fit-only`.
    #[arg(long, requires = "fit_only")]
    kinds: Option<usize>,
}

/// The result of learning.
pub(crate) struct Found {
    /// The model.
    pub model: Hierarchy,
    /// Cheeseman-Stutz score, nats.
    pub score: f64,
    /// Rows that the score is of.
    pub rows: usize,
    /// BIC score, nats, where a structure was searched.
    pub bic: Option<f64>,
    /// True if a limit or Ctrl-C ended it.
    pub interrupted: bool,
    /// Seconds that it took.
    pub seconds: f64,
}

impl Learning {
    /// Learns from `data`, going on from `start` if there is one. `path` names the table in errors; the limit of time
    /// counts from `begun`.
    pub(crate) fn learn(
        &self,
        data: &Dataset,
        settings: &Settings,
        start: Option<&Hierarchy>,
        path: &Path,
        begun: Instant,
    ) -> Result<Found> {
        if let Some(limit) = self.time_limit.filter(|l| l.is_nan() || *l <= 0.0) {
            let problem = format!("{limit} is not a positive number of seconds");
            return Err(Error::option("--time-limit", problem));
        }
        heed_interrupts();
        let rows = data.table.rows().min(settings.searched);
        let watch = Watch::new(begun, self.time_limit.map(seconds), rows);
        let found = self.found(data, start, settings, &watch);
        let mut found = found.map_err(|e| Error::content(path, e))?;
        found.seconds = watch.start.elapsed().as_secs_f64();
        if found.interrupted {
            let of = match found.rows < data.table.rows() {
                true => format!(", fitted to {} of the rows", found.rows),
                false => String::new(),
            };
            print::message(&format!(
                "ended after {:.1} s: this is the best model so far{of}; `--from` goes on from it",
                found.seconds
            ));
        }
        self.warn(&data.table, &found.model);
        Ok(found)
    }

    /// True while there is time to prepare columns: half of the limit is left to the search.
    pub(crate) fn prepares(&self, begun: Instant) -> bool {
        let limit = self.time_limit.filter(|l| *l > 0.0).map(seconds);
        !interrupted() && limit.is_none_or(|limit| begun.elapsed() < limit / 2)
    }

    fn found(
        &self,
        data: &Dataset,
        start: Option<&Hierarchy>,
        settings: &Settings,
        watch: &Watch,
    ) -> std::result::Result<Found, ModelError> {
        let seed = self.search.seed;
        let observer = |step: Option<&SearchStep>| watch.tell(step);
        if let (Some(styles), Some(kinds)) = (self.styles, self.kinds) {
            let states = vec![kinds; data.real_groups()];
            let (table, groups) = (&data.table, &data.groups);
            let fitted = fit_observed(table, groups, styles, &states, settings, seed, &observer)?;
            return Ok(Found {
                model: fitted.model,
                score: fitted.score,
                rows: table.rows(),
                bic: None,
                interrupted: fitted.outcome == Outcome::Interrupted,
                seconds: 0.0,
            });
        }
        let learned: Learned = match start {
            Some(model) => refine(model, &data.table, settings, seed, &observer)?,
            // The extended model: real columns may share hidden variables.
            None if settings.category_edges => {
                let (table, groups) = (&data.table, &data.groups);
                let found = learn_joined(table, groups, settings, seed, &observer)?;
                if found.tried.len() > 1 {
                    print::message(&told(&found));
                }
                found.learned
            }
            None => learn_observed(&data.table, &data.groups, settings, seed, &observer)?,
        };
        Ok(Found {
            model: learned.model,
            score: learned.score,
            rows: learned.rows,
            bic: Some(learned.bic),
            interrupted: learned.interrupted,
            seconds: 0.0,
        })
    }

    fn warn(&self, table: &Table, model: &Hierarchy) {
        for warning in warnings(table, model.free_parameters()) {
            print::message(&format!("warning: {warning}"));
        }
    }
}

/// The groupings of real columns that were tried, in words.
fn told(found: &Joined) -> String {
    let one = |tried: &Tried| format!("{:.3} with {}", tried.score, tried.groups);
    let all: Vec<String> = found.tried.iter().map(one).collect();
    let kept = match found.real_groups() {
        1 => "share one hidden variable".to_owned(),
        count => format!("have {count} hidden variables"),
    };
    let all = all.join(", ");
    format!("real columns {kept}; score in nats a row, as far as each was learned: {all}")
}

/// Ctrl-C ends what is running with the best so far; a second one ends the process.
pub(crate) fn heed_interrupts() {
    // Set once per process; a second command in the same process keeps the first handler, which does the same.
    let _ = ctrlc::set_handler(|| {
        if STOP.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
        print::message("stopping with the best so far; Ctrl-C again stops at once");
    });
}

/// True once Ctrl-C was pressed.
pub(crate) fn interrupted() -> bool {
    STOP.load(Ordering::Relaxed)
}

/// A time limit; one beyond what a clock counts is none.
pub(crate) fn seconds(limit: f64) -> Duration {
    Duration::try_from_secs_f64(limit).unwrap_or(Duration::MAX)
}

/// Tells of progress from time to time, and when to end.
struct Watch {
    start: Instant,
    limit: Option<Duration>,
    /// Rows that are searched on.
    rows: usize,
    state: Mutex<State>,
}

#[derive(Default)]
struct State {
    tried: usize,
    best: Option<SearchStep>,
    told: Duration,
}

impl Watch {
    fn new(start: Instant, limit: Option<Duration>, rows: usize) -> Self {
        Self {
            start,
            limit,
            rows,
            state: Mutex::default(),
        }
    }

    fn tell(&self, step: Option<&SearchStep>) -> ControlFlow<()> {
        let elapsed = self.start.elapsed();
        if let Ok(mut state) = self.state.lock() {
            state.accept(step);
            if elapsed >= state.told + TELL {
                state.told = elapsed;
                print::message(&state.line(elapsed, self.rows));
            }
        }
        match interrupted() || self.limit.is_some_and(|limit| elapsed >= limit) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }
}

impl State {
    fn accept(&mut self, step: Option<&SearchStep>) {
        let Some(step) = step else { return };
        self.tried += 1;
        if self.best.as_ref().is_none_or(|b| step.score > b.score) {
            self.best = Some(step.clone());
        }
    }

    fn line(&self, elapsed: Duration, rows: usize) -> String {
        let seconds = elapsed.as_secs();
        match &self.best {
            None => format!("{seconds} s: fitting"),
            Some(best) => format!(
                "{seconds} s: {} configurations accepted, best so far {} styles, {} lateral edges, score {:.1} ({:.3} nats a row) on {rows} rows",
                self.tried,
                best.styles,
                best.lateral_edges,
                best.score,
                best.score / rows as f64
            ),
        }
    }
}
