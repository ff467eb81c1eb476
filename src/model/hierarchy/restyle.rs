//! New starts for S alone, above a second level that was found before.

use rand::Rng;
use rayon::prelude::*;

use super::super::em::Stopping;
use super::super::error::ModelError;
use super::fit::Scored;
use super::infer::Scratch;
use super::params::Params;
use super::search::{Search, better};
use super::structure::Structure;
use super::wide::states;
use edifice_base::rng::stream;
use edifice_cluster::kmeans_unweighted;

/// Cardinalities of S that are fitted to the end on large tables, after short runs for all.
const FINALISTS: usize = 3;

impl Search<'_> {
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
                    if self.watch.ended() {
                        return Ok(scored);
                    }
                    let problem = self.problem(scored.shape.structure.clone())?;
                    self.fit(&problem, scored.params, &self.settings.search)
                })
                .collect();
            found = fitted?;
        }
        Ok(found)
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
            if !self.watch.goes_on() {
                return Ok(given.clone());
            }
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
            if best.is_some() && self.watch.ended() {
                break;
            }
            let labels = kmeans_unweighted(&features, width, styles, 12, rng).labels;
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
}
