//! Structure search (Sec. 5.3): cardinalities of the hidden variables, then of S, lateral edges at
//! every step, by the Cheeseman-Stutz score.

use rand::Rng;
use rayon::prelude::*;

use super::super::em::Stopping;
use super::super::error::ModelError;
use super::Priors;
use super::edges::propose;
use super::fit::{Problem, Scored};
use super::params::{MOST, MOST_SEARCHED, Params};
use super::schema::{Rows, Schema};
use super::search_step::SearchStep;
use super::structure::{Selector, Structure};
use super::watch::Watch;
use super::wide::{Wide, wide};
use super::{Settings, Sweep, Variant};
use edifice_base::rng::stream;

/// Values of real columns up to which all |S| are searched from the start.
pub(crate) const SMALL: usize = 10_000;

/// Rounds of EM in a short run.
const SHORT: usize = 10;
/// Nats a row that a search may lie behind its rival when all |S| swept are done; one further behind is not gone on with.
const BEHIND: f64 = 1.0;
/// The same when an |S| has its first edges, before any cardinality is raised.
const FAR_BEHIND: f64 = 2.0;

/// A model of the same rows and columns in other groups.
#[derive(Clone, Copy)]
pub(crate) struct Rival {
    /// Its score on the rows searched.
    pub score: f64,
    /// The part of the usual distances, of [`BEHIND`] and [`FAR_BEHIND`], at which the search is given up.
    pub patience: f64,
}

/// The inputs that every part of a search needs.
pub(crate) struct Search<'a> {
    pub schema: &'a Schema,
    pub rows: &'a Rows,
    pub settings: &'a Settings,
    /// True if edges from categories are searched.
    pub categories: bool,
    /// A model of the same rows that this one is to surpass.
    pub rival: Option<Rival>,
    pub watch: &'a Watch<'a>,
}

impl<'a> Search<'a> {
    /// True if the table is so large that work is saved by default.
    pub(super) fn large(&self) -> bool {
        self.rows.rows * self.rows.d > SMALL
    }

    /// Runs the search for every cardinality of S and keeps the first of highest score.
    pub(super) fn run(&self, seed: u64) -> Result<(Scored, Vec<SearchStep>), ModelError> {
        let styles = self.styles();
        type Found = Option<(Scored, Vec<SearchStep>)>;
        let swept = self.swept(&styles);
        let found: Result<Vec<Found>, ModelError> = swept
            .par_iter()
            .map(|&s| {
                // The first is searched even if the search has been ended: there is always a model.
                if s != swept[0] && self.watch.ended() {
                    return Ok(None);
                }
                let mut rng = stream(seed, "hierarchy", s as u64);
                self.for_styles(s, &mut rng).map(Some)
            })
            .collect();
        let mut best: Option<Scored> = None;
        let mut trace = Vec::new();
        for (scored, steps) in found?.into_iter().flatten() {
            trace.extend(steps);
            best = Some(better(best, scored));
        }
        // Whatever |S| found the best second level, every other |S| may have it as well.
        let goes_on = self.layered() && !best.as_ref().is_some_and(|b| self.behind(b, BEHIND));
        if let Some(leader) = best.clone().filter(|_| goes_on) {
            for scored in self.restyle_all(&leader, &styles, seed, "restyle")? {
                self.accept(&scored, &mut trace);
                best = Some(better(best, scored));
            }
        }
        let mut best = best.ok_or(ModelError::Empty { what: "styles" })?;
        if goes_on && !self.watch.ended() {
            best = self.with_edges(self.grow(best, &mut trace)?)?;
            best = self.polish(best, &styles, seed, &mut trace)?;
        }
        if self.behind(&best, BEHIND) {
            return Ok((best, trace));
        }
        Ok((self.settled(best)?, trace))
    }

    /// True if a fit lies further behind the rival than `most` nats a row.
    fn behind(&self, scored: &Scored, most: f64) -> bool {
        let rows = self.rows.rows as f64;
        self.rival
            .is_some_and(|r| scored.score + r.patience * most * rows < r.score)
    }

    /// Goes on from a structure and its parameters.
    pub(super) fn improve(
        &self,
        structure: Structure,
        params: Params,
        seed: u64,
    ) -> Result<(Scored, Vec<SearchStep>), ModelError> {
        let problem = self.problem(structure)?;
        let mut best = self.fit(&problem, params, &self.settings.search)?;
        let mut trace = Vec::new();
        self.accept(&best, &mut trace);
        if self.layered() {
            best = self.with_edges(self.grow(best, &mut trace)?)?;
            best = self.polish(best, &self.styles(), seed, &mut trace)?;
        }
        Ok((self.settled(best)?, trace))
    }

    /// Cardinalities of S to try.
    fn styles(&self) -> Vec<usize> {
        match self.settings.variant {
            Variant::Directed => vec![1],
            _ => self.settings.styles.clone().collect(),
        }
    }

    /// True if work is saved: by the settings, or by default on large tables.
    pub(super) fn few(&self) -> bool {
        match self.settings.sweep {
            Sweep::Auto => self.large(),
            Sweep::All => false,
            Sweep::Few => true,
        }
    }

    /// Those of them for which the second level is searched from the start.
    fn swept(&self, styles: &[usize]) -> Vec<usize> {
        let (Some(&least), Some(&most)) = (styles.first(), styles.last()) else {
            return Vec::new();
        };
        if !self.few() || styles.len() <= 2 || !self.layered() {
            return styles.to_vec();
        }
        let ratio = most as f64 / least as f64;
        let at = |share: f64| (least as f64 * ratio.powf(share)).round() as usize;
        vec![at(0.25), at(0.75)]
    }

    /// EM run to its end; where the search was ended, what there is.
    fn settled(&self, mut best: Scored) -> Result<Scored, ModelError> {
        if self.watch.ended() {
            best.shape.alive = MOST;
            return Ok(best);
        }
        let mut problem = self.problem(best.shape.structure.clone())?;
        problem.shape.alive = MOST;
        self.fit(&problem, best.params, &self.settings.stopping)
    }

    /// EM as long as the search goes on.
    pub(super) fn fit(
        &self,
        problem: &Problem,
        start: Params,
        stopping: &Stopping,
    ) -> Result<Scored, ModelError> {
        problem.fit_while(start, stopping, &|| self.watch.goes_on())
    }

    /// When a short run of EM stops.
    pub(super) fn short(&self) -> Stopping {
        Stopping {
            max_rounds: SHORT,
            ..self.settings.search
        }
    }

    pub(super) fn problem(&self, mut structure: Structure) -> Result<Problem<'a>, ModelError> {
        structure.background = self.settings.background;
        let priors: &'a Priors = &self.settings.priors;
        let mut problem = Problem::new(self.schema, self.rows, priors, structure)?;
        problem.shape.alive = MOST_SEARCHED;
        Ok(problem)
    }

    /// The search of the paper for one cardinality of S.
    fn for_styles<R: Rng>(
        &self,
        styles: usize,
        rng: &mut R,
    ) -> Result<(Scored, Vec<SearchStep>), ModelError> {
        let selector = match self.settings.variant {
            Variant::Full | Variant::NoLateral => Selector::Hidden(2),
            Variant::NoSecondLevel => Selector::Style,
            Variant::Directed => Selector::Codes(Vec::new()),
        };
        let (groups, codes) = (self.schema.groups.len(), self.schema.codes.len());
        let first = Structure::new(styles, &selector, groups, codes);
        if self.settings.variant == Variant::Directed {
            let structure =
                super::directed::propose((self.schema, self.rows), self.settings, first);
            let best = self.restart(structure, rng)?;
            let mut trace = Vec::new();
            self.accept(&best, &mut trace);
            return Ok((best, trace));
        }
        let mut best = self.restart(first, rng)?;
        best = self.with_edges(best)?;
        let mut trace = Vec::new();
        self.accept(&best, &mut trace);
        if self.layered() && !self.watch.ended() && !self.behind(&best, FAR_BEHIND) {
            best = self.grow(best, &mut trace)?;
            if self.watch.ended() {
                return Ok((best, trace));
            }
            let fresh = self.restyle(&best, styles, &self.settings.search, rng)?;
            if fresh.score > best.score {
                best = self.grow(fresh, &mut trace)?;
            }
        }
        Ok((best, trace))
    }

    /// The best of several short runs of EM, run on.
    pub(super) fn restart<R: Rng>(
        &self,
        structure: Structure,
        rng: &mut R,
    ) -> Result<Scored, ModelError> {
        let problem = self.problem(structure)?;
        let short = self.short();
        let mut best: Option<Scored> = None;
        for _ in 0..self.settings.restarts.max(1) {
            if best.is_some() && self.watch.ended() {
                break;
            }
            let scored = self.fit(&problem, problem.start(rng)?, &short)?;
            best = Some(better(best, scored));
        }
        let best = best.ok_or(ModelError::Empty { what: "starts" })?;
        if self.watch.ended() {
            return Ok(best);
        }
        self.fit(&problem, best.params, &self.settings.search)
    }

    /// Raises the cardinality of each hidden variable in turn while the score rises.
    pub(super) fn grow(
        &self,
        mut best: Scored,
        trace: &mut Vec<SearchStep>,
    ) -> Result<Scored, ModelError> {
        for g in 0..self.schema.groups.len() {
            while best.shape.states(g) < self.settings.most_states && !self.watch.ended() {
                let grown = self.raised(&best, g)?;
                let Some(grown) = grown.filter(|grown| grown.score > best.score) else {
                    break;
                };
                best = self.with_edges(grown)?;
                self.accept(&best, trace);
            }
        }
        Ok(best)
    }

    /// Expected statistics over all columns, of categories as well where edges from these are searched or there.
    /// `None` if the search was ended meanwhile.
    pub(super) fn wide(
        &self,
        problem: &Problem,
        scored: &Scored,
    ) -> Result<Option<Wide>, ModelError> {
        let there = scored.shape.structure.shifts.iter().any(|l| !l.is_empty());
        let goes_on = || self.watch.goes_on();
        wide(problem, scored, self.categories || there, &goes_on)
    }

    /// Searches lateral edges around a fit; the better of the fits with the old and the new ones.
    pub(super) fn with_edges(&self, mut best: Scored) -> Result<Scored, ModelError> {
        if self.settings.variant == Variant::NoLateral {
            return Ok(best);
        }
        for _ in 0..self.settings.edge_rounds {
            if self.watch.ended() {
                break;
            }
            let problem = self.problem(best.shape.structure.clone())?;
            let Some(wide) = self.wide(&problem, &best)? else {
                break;
            };
            let goes_on = || self.watch.goes_on();
            let structure = propose(&problem, &best, &wide, self.settings, &goes_on);
            if self.watch.ended() || structure == best.shape.structure {
                break;
            }
            let problem = self.problem(structure)?;
            // The M step for the new edges, from the posteriors of the old model.
            let start = problem.reparent(&best, &wide)?;
            let scored = self.fit(&problem, start, &self.settings.search)?;
            if scored.score <= best.score {
                break;
            }
            best = scored;
        }
        Ok(best)
    }

    /// True if the model has a second level of hidden variables.
    pub(super) fn layered(&self) -> bool {
        matches!(self.settings.variant, Variant::Full | Variant::NoLateral)
    }

    /// Notes a configuration in the trace, and tells of it.
    pub(super) fn accept(&self, scored: &Scored, trace: &mut Vec<SearchStep>) {
        let step = self.step(scored);
        self.watch.accepted(&step);
        trace.push(step);
    }

    fn step(&self, scored: &Scored) -> SearchStep {
        let structure = &scored.shape.structure;
        SearchStep {
            styles: structure.styles,
            cardinalities: (0..scored.shape.groups())
                .map(|g| scored.shape.states(g))
                .collect(),
            lateral_edges: structure.edges(),
            score: scored.score,
        }
    }
}

/// The first of highest score.
pub(super) fn better(best: Option<Scored>, other: Scored) -> Scored {
    match best {
        Some(best) if best.score >= other.score => best,
        _ => other,
    }
}
