//! Structure search (Sec. 5.3): cardinalities of the hidden variables, then of S, lateral edges at
//! every step, by the Cheeseman-Stutz score.

use rand::Rng;
use rayon::prelude::*;

use super::super::em::Stopping;
use super::super::error::ModelError;
use super::super::kmeans::kmeans;
use super::Priors;
use super::component::{MOST, MOST_SEARCHED};
use super::edges::propose;
use super::fit::{Problem, Scored};
use super::infer::Scratch;
use super::params::Params;
use super::schema::{Rows, Schema};
use super::structure::{Selector, Structure};
use super::watch::Watching;
use super::wide::{Wide, states, wide};
use super::{Settings, Step, Sweep, Variant};
use edifice_base::rng::stream;

/// Values of real columns up to which all |S| are searched from the start.
const SMALL: usize = 10_000;

/// Cardinalities of S that are fitted to the end on large tables, after short runs for all.
const FINALISTS: usize = 3;
/// Rounds of EM in a short run.
const SHORT: usize = 10;

/// The inputs that every part of a search needs.
pub(crate) struct Search<'a> {
    pub schema: &'a Schema,
    pub rows: &'a Rows,
    pub settings: &'a Settings,
    /// True if edges from categories are searched.
    pub categories: bool,
    pub watch: &'a Watching<'a>,
}

impl<'a> Search<'a> {
    /// True if the table is so large that work is saved by default.
    pub fn large(&self) -> bool {
        self.rows.rows * self.rows.d > SMALL
    }

    /// Runs the search for every cardinality of S and keeps the first of highest score.
    pub fn run(&self, seed: u64) -> Result<(Scored, Vec<Step>), ModelError> {
        let styles = self.styles();
        type Found = Option<(Scored, Vec<Step>)>;
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
        if let Some(leader) = best.clone().filter(|_| self.layered()) {
            for scored in self.restyle_all(&leader, &styles, seed, "restyle")? {
                self.accept(&scored, &mut trace);
                best = Some(better(best, scored));
            }
        }
        let mut best = best.ok_or(ModelError::Empty { what: "styles" })?;
        if self.layered() {
            best = self.with_edges(self.grow(best, &mut trace)?)?;
            best = self.polish(best, &styles, seed, &mut trace)?;
        }
        Ok((self.settled(best)?, trace))
    }

    /// Goes on from a structure and its parameters.
    pub fn improve(
        &self,
        structure: Structure,
        params: Params,
        seed: u64,
    ) -> Result<(Scored, Vec<Step>), ModelError> {
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

    /// EM run to its end.
    fn settled(&self, best: Scored) -> Result<Scored, ModelError> {
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

    /// [`Self::restyle`] for each |S|, as long as the search goes on; on large tables only the best few are fitted to the
    /// end.
    pub(super) fn restyle_all(
        &self,
        given: &Scored,
        styles: &[usize],
        seed: u64,
        name: &str,
    ) -> Result<Vec<Scored>, ModelError> {
        let stopping = match self.few() {
            true => self.short(),
            false => self.settings.search,
        };
        let found: Result<Vec<Option<Scored>>, ModelError> = styles
            .par_iter()
            .map(|&s| {
                if self.watch.ended() {
                    return Ok(None);
                }
                let mut rng = stream(seed, name, s as u64);
                self.restyle(given, s, &stopping, &mut rng).map(Some)
            })
            .collect();
        let mut found: Vec<Scored> = found?.into_iter().flatten().collect();
        if self.few() {
            found.sort_by(|a, b| b.score.total_cmp(&a.score));
            found.truncate(FINALISTS);
            let fitted: Result<Vec<Scored>, ModelError> = found
                .into_par_iter()
                .map(|scored| {
                    let problem = self.problem(scored.shape.structure.clone())?;
                    self.fit(&problem, scored.params, &self.settings.search)
                })
                .collect();
            found = fitted?;
        }
        Ok(found)
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
    ) -> Result<(Scored, Vec<Step>), ModelError> {
        let selector = match self.settings.variant {
            Variant::Full | Variant::NoLateral => Selector::Hidden(2),
            Variant::NoSecondLevel => Selector::Style,
            Variant::Directed => Selector::Codes(Vec::new()),
        };
        let (groups, codes) = (self.schema.groups.len(), self.schema.codes.len());
        let first = Structure::new(styles, &selector, groups, codes);
        if self.settings.variant == Variant::Directed {
            let structure = super::directed::propose(self, first);
            let best = self.restart(structure, rng)?;
            let mut trace = Vec::new();
            self.accept(&best, &mut trace);
            return Ok((best, trace));
        }
        let mut best = self.restart(first, rng)?;
        best = self.with_edges(best)?;
        let mut trace = Vec::new();
        self.accept(&best, &mut trace);
        if self.layered() && !self.watch.ended() {
            best = self.grow(best, &mut trace)?;
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
            let scored = self.fit(&problem, problem.start(rng)?, &short)?;
            best = Some(better(best, scored));
        }
        let best = best.ok_or(ModelError::Empty { what: "starts" })?;
        self.fit(&problem, best.params, &self.settings.search)
    }

    /// Raises the cardinality of each hidden variable in turn while the score rises.
    pub(super) fn grow(
        &self,
        mut best: Scored,
        trace: &mut Vec<Step>,
    ) -> Result<Scored, ModelError> {
        for g in 0..self.schema.groups.len() {
            while best.shape.states(g) < self.settings.most_states && !self.watch.ended() {
                let grown = self.raised(&best, g)?;
                if grown.score <= best.score {
                    break;
                }
                best = self.with_edges(grown)?;
                self.accept(&best, trace);
            }
        }
        Ok(best)
    }

    /// Expected statistics over all columns, of categories as well where edges from these are searched or there.
    pub(super) fn wide(&self, problem: &Problem, scored: &Scored) -> Result<Wide, ModelError> {
        let there = scored.shape.structure.shifts.iter().any(|l| !l.is_empty());
        wide(problem, scored, self.categories || there)
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
            let wide = self.wide(&problem, &best)?;
            let structure = propose(&problem, &best, &wide, self.settings);
            if structure == best.shape.structure {
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

    /// New starts for S alone, with `styles` values, above the second level of `given`: rows are
    /// clustered by the posteriors of their hidden variables. The best of several.
    pub(super) fn restyle<R: Rng>(
        &self,
        given: &Scored,
        styles: usize,
        stopping: &Stopping,
        rng: &mut R,
    ) -> Result<Scored, ModelError> {
        let problem = self.problem(given.shape.structure.clone())?;
        let shape = &given.shape;
        let mut scratch = Scratch::new(shape);
        let mut features: Vec<f64> = Vec::new();
        let mut assigned = vec![Vec::with_capacity(self.rows.rows); shape.groups()];
        let offsets: Vec<usize> = (0..=shape.groups())
            .map(|g| (0..g).map(|g| shape.states(g)).sum())
            .collect();
        let real_width = offsets[shape.groups()];
        let width = real_width + shape.sizes.iter().sum::<usize>();
        for i in 0..self.rows.rows {
            let mut point = vec![0.0; width];
            let mut top = vec![0; shape.groups()];
            problem.visit(&given.params, i, &mut scratch, |scratch, _, codes, _| {
                for (g, r) in states(scratch, given) {
                    point[offsets[g]..offsets[g] + r.len()].copy_from_slice(&r);
                    top[g] = (0..r.len())
                        .max_by(|&a, &b| r[a].total_cmp(&r[b]))
                        .unwrap_or(0);
                }
                let mut at = real_width;
                for (&code, &size) in codes.iter().zip(&shape.sizes) {
                    if (code as usize) < size {
                        point[at + code as usize] = 1.0;
                    }
                    at += size;
                }
            })?;
            features.extend(point);
            for (list, top) in assigned.iter_mut().zip(top) {
                list.push(top);
            }
        }
        let problem = self.problem(Structure {
            styles,
            ..shape.structure.clone()
        })?;
        let all: Vec<usize> = (0..self.rows.rows).collect();
        let mut best = None;
        for _ in 0..self.settings.restarts.max(1) {
            let labels = kmeans(&features, width, styles, 12, rng);
            let start = problem.assigned(&all, &labels, &assigned)?;
            let start = Params {
                linear: given.params.linear.clone(),
                ..start
            };
            let scored = self.fit(&problem, start, stopping)?;
            best = Some(better(best, scored));
        }
        best.ok_or(ModelError::Empty { what: "starts" })
    }

    /// Notes a configuration in the trace, and tells of it.
    pub(super) fn accept(&self, scored: &Scored, trace: &mut Vec<Step>) {
        let step = self.step(scored);
        self.watch.accepted(&step);
        trace.push(step);
    }

    fn step(&self, scored: &Scored) -> Step {
        let structure = &scored.shape.structure;
        Step {
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
