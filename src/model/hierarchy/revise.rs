//! Local search around a configuration: what the upward search of the paper cannot take back.
//!
//! While hidden variables have few states, a lateral edge may compensate for a state that is still
//! missing (which of two kinds a neighbour is says which of two kinds this one is), and the
//! evidence for that value is gone once the edge is there. So, by the same score: an edge is taken
//! out and its child given new values in its place; two values of a hidden variable are made one;
//! and a second start raises all cardinalities before it looks for edges.

use super::super::error::ModelError;
use super::fit::{Problem, Scored};
use super::params::Params;
use super::search::{Search, better};
use super::structure::{Selector, Structure};
use super::wide::Wide;
use super::{SearchStep, Variant};
use edifice_base::rng::stream;
use rand::Rng;

/// Nats a row by which a short run may still rise, and for which all moves are tried once more, where work is saved.
const WORTHWHILE: f64 = 0.01;

impl Search<'_> {
    /// Settles `best` and, where edges are allowed, a start that finds kinds before edges; then
    /// tries every |S| above the second level of the better one, and settles that.
    pub(super) fn polish(
        &self,
        best: Scored,
        styles: &[usize],
        seed: u64,
        trace: &mut Vec<SearchStep>,
    ) -> Result<Scored, ModelError> {
        let s = best.shape.structure.styles;
        let (settled, other) = rayon::join(
            || self.settle(best),
            || match self.settings.variant {
                Variant::Full if !self.watch.ended() => self
                    .kinds_first(s, &mut stream(seed, "kinds first", s as u64))
                    .map(Some),
                _ => Ok(None),
            },
        );
        let mut best = settled?;
        if let Some(other) = other?.filter(|other| other.score > best.score) {
            best = other;
        }
        self.accept(&best, trace);
        let before = best.score;
        for scored in self.restyle_all(&best, styles, seed, "restyle settled")? {
            self.accept(&scored, trace);
            best = better(Some(best), scored);
        }
        if best.score > before {
            best = self.settle(best)?;
            self.accept(&best, trace);
        }
        Ok(best)
    }

    /// Cardinalities raised without edges, then edges, then everything.
    fn kinds_first<R: Rng>(&self, styles: usize, rng: &mut R) -> Result<Scored, ModelError> {
        let (groups, codes) = (self.schema.groups.len(), self.schema.codes.len());
        let first = Structure::new(styles, &Selector::Hidden(2), groups, codes);
        let mut best = self.restart(first, rng)?;
        for g in 0..groups {
            best = self.raise(best, g)?;
        }
        if self.watch.ended() {
            return Ok(best);
        }
        let fresh = self.restyle(&best, styles, &self.settings.search, rng)?;
        if fresh.score > best.score {
            best = fresh;
            for g in 0..groups {
                best = self.raise(best, g)?;
            }
        }
        self.settle(self.with_edges(best)?)
    }

    /// Takes back and raises in turn until the score rises by no more than EM leaves open.
    fn settle(&self, mut best: Scored) -> Result<Scored, ModelError> {
        loop {
            let before = best.score;
            best = self.revise(best)?;
            best = self.with_edges(self.grow(best, &mut Vec::new())?)?;
            if self.watch.ended() || best.score <= before + self.worthwhile() {
                return Ok(best);
            }
        }
    }

    /// The gain for which all moves are tried once more.
    fn worthwhile(&self) -> f64 {
        match self.few() {
            true => WORTHWHILE * self.rows.rows as f64,
            false => self.settings.search.gain,
        }
    }

    /// A fit that may replace one of score `least`; where work is saved, it is given up after a short run that ends well below.
    fn trial(&self, problem: &Problem, start: Params, least: f64) -> Result<Scored, ModelError> {
        if !self.few() {
            return self.fit(problem, start, &self.settings.search);
        }
        let short = self.fit(problem, start, &self.short())?;
        if short.score + self.worthwhile() < least {
            return Ok(short);
        }
        self.fit(problem, short.params, &self.settings.search)
    }

    /// Takes out edges and joins values while the score rises.
    fn revise(&self, mut best: Scored) -> Result<Scored, ModelError> {
        loop {
            let before = best.score;
            let mut kept = None;
            for g in 0..best.shape.groups() {
                for p in best.shape.structure.parents[g].clone() {
                    if self.watch.ended() {
                        return Ok(best);
                    }
                    best = self.without(best, p, g, &mut kept)?;
                }
            }
            for g in 0..best.shape.groups() {
                best = self.join(best, g)?;
            }
            if self.watch.ended() || best.score <= before + self.worthwhile() {
                return Ok(best);
            }
        }
    }

    /// The better of `best` and a fit without the edge from `p` to `g`, values of `g` grown anew. `kept` are the statistics of
    /// `best` where they are known.
    fn without(
        &self,
        best: Scored,
        p: usize,
        g: usize,
        kept: &mut Option<Wide>,
    ) -> Result<Scored, ModelError> {
        if kept.is_none() {
            let problem = self.problem(best.shape.structure.clone())?;
            *kept = self.wide(&problem, &best)?;
        }
        let Some(wide) = kept.as_ref() else {
            return Ok(best);
        };
        let mut structure = best.shape.structure.clone();
        structure.parents[g].retain(|&parent| parent != p);
        let problem = self.problem(structure)?;
        let start = problem.reparent(&best, wide)?;
        let fit = self.trial(&problem, start, best.score)?;
        let grown = self.raise(fit, g)?;
        Ok(if grown.score > best.score {
            *kept = None;
            grown
        } else {
            best
        })
    }

    /// Raises the cardinality of the hidden variable of `g` while the score rises.
    fn raise(&self, mut best: Scored, g: usize) -> Result<Scored, ModelError> {
        while best.shape.states(g) < self.settings.most_states && !self.watch.ended() {
            match self.raised(&best, g)? {
                Some(grown) if grown.score > best.score => best = grown,
                _ => break,
            }
        }
        Ok(best)
    }

    /// A fit with one value more for the hidden variable of `g`; `None` if the search was ended meanwhile.
    pub(super) fn raised(&self, best: &Scored, g: usize) -> Result<Option<Scored>, ModelError> {
        let problem = self.problem(best.shape.structure.clone())?;
        let goes_on = || self.watch.goes_on();
        let Some(start) = super::split::start(&problem, best, g, &goes_on)? else {
            return Ok(None);
        };
        let mut structure = best.shape.structure.clone();
        structure.selectors[g] = Selector::Hidden(best.shape.states(g) + 1);
        let problem = self.problem(structure)?;
        self.trial(&problem, start, best.score).map(Some)
    }

    /// Joins values of the hidden variable of `g` while the score rises.
    fn join(&self, mut best: Scored, g: usize) -> Result<Scored, ModelError> {
        while best.shape.hidden(g) && best.shape.states(g) > 2 && !self.watch.ended() {
            let mut structure = best.shape.structure.clone();
            structure.selectors[g] = Selector::Hidden(best.shape.states(g) - 1);
            let problem = self.problem(structure)?;
            let Some(start) = joined(&problem, &best, g)? else {
                break;
            };
            match self.trial(&problem, start, best.score)? {
                fit if fit.score > best.score => best = fit,
                _ => break,
            }
        }
        Ok(best)
    }
}

/// Parameters for `problem`, which has one value of `g` less than `scored`: the two values whose
/// regressions lose least evidence as one are joined.
fn joined(problem: &Problem, scored: &Scored, g: usize) -> Result<Option<Params>, ModelError> {
    let shape = &scored.shape;
    let prior = &problem.priors.linear;
    let scatter = &scored.stats.scatter[g];
    let sum = |a: &[f64], b: &[f64]| -> Vec<f64> { a.iter().zip(b).map(|(a, b)| a + b).collect() };
    let evidence = |m: &[f64]| prior.evidence(m, shape.p[g], shape.d[g]);
    let mut best: Option<(f64, usize, usize)> = None;
    for a in 0..scatter.len() {
        for b in 0..a {
            let both = evidence(&sum(&scatter[a], &scatter[b]));
            let (Some(both), Some(ea), Some(eb)) =
                (both, evidence(&scatter[a]), evidence(&scatter[b]))
            else {
                continue;
            };
            let gain = both - ea - eb;
            if best.is_none_or(|(most, ..)| gain > most) {
                best = Some((gain, a, b));
            }
        }
    }
    let Some((_, a, b)) = best else {
        return Ok(None);
    };
    let mut stats = scored.stats.clone();
    let moved = stats.scatter[g].remove(a);
    stats.scatter[g][b] = sum(&stats.scatter[g][b], &moved);
    let styles = shape.structure.styles;
    let counts: Vec<f64> = stats.tables[g]
        .drain(a * styles..(a + 1) * styles)
        .collect();
    for (n, c) in stats.tables[g][b * styles..].iter_mut().zip(counts) {
        *n += c;
    }
    problem.shape.maximize(&stats, problem.priors).map(Some)
}
