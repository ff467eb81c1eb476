//! Lateral edges: greedy and acyclic, from the expected statistics of the current fit.
//!
//! With the hidden variables' posteriors held (O* of Eq. 2), the score of a structure is a sum
//! over groups, and an edge changes the term of its child only: the closed-form evidence of the
//! child's regression, summed over its states. All candidates are therefore read off one scatter
//! matrix over all real columns per state. Edges are added, taken out and turned round (Koller and
//! Friedman 2009, Sec. 18.4.3). The structure so proposed is fitted by EM and kept only if its
//! Cheeseman-Stutz score is higher.

use std::collections::HashMap;

use super::super::error::ModelError;
use super::fit::{Problem, Scored};
use super::infer::{Scratch, joint};
use super::structure::{Selector, Structure};

/// Per group, per state, lower triangle of `Σ w v vᵀ`, v = (1, all real columns).
pub(crate) type Wide = Vec<Vec<Vec<f64>>>;

/// The structure with lateral edges of highest evidence that greedy moves reach: from no edges and
/// from those of `scored`, an edge is added, taken out or turned round, whatever gains most, until
/// nothing gains. All else is as in `scored`.
pub(crate) fn propose(
    problem: &Problem,
    scored: &Scored,
    wide: &Wide,
    max_parents: usize,
) -> Structure {
    let mut families = Families {
        problem,
        wide,
        evidence: HashMap::new(),
    };
    let given = &scored.shape.structure;
    let nothing = Structure {
        parents: vec![Vec::new(); given.parents.len()],
        ..given.clone()
    };
    let (fresh, evidence) = families.climb(nothing, max_parents);
    let (kept, evidence_kept) = families.climb(given.clone(), max_parents);
    if evidence_kept >= evidence - LEAST_GAIN {
        kept
    } else {
        fresh
    }
}

/// Gains below this are rounding.
const LEAST_GAIN: f64 = 1e-6;

/// A change of one lateral edge, from parent to child.
#[derive(Clone, Copy, Debug)]
enum Move {
    Add(usize, usize),
    Remove(usize, usize),
    Reverse(usize, usize),
}

/// Evidence of the regression of a group on its parents, summed over its states; kept once known.
struct Families<'a> {
    problem: &'a Problem<'a>,
    wide: &'a Wide,
    evidence: HashMap<(usize, Vec<usize>), f64>,
}

impl Families<'_> {
    /// Greedy moves until none gains; the structure and the evidence of all its families.
    fn climb(&mut self, mut structure: Structure, max_parents: usize) -> (Structure, f64) {
        loop {
            let best = moves(&structure, max_parents)
                .into_iter()
                .map(|m| (self.gain(&structure, m), m))
                .max_by(|a, b| a.0.total_cmp(&b.0));
            match best {
                Some((gain, best)) if gain > LEAST_GAIN => apply(&mut structure, best),
                _ => break,
            }
        }
        let total = (0..structure.parents.len())
            .map(|g| self.of(g, &structure.parents[g]))
            .sum();
        (structure, total)
    }

    fn gain(&mut self, structure: &Structure, change: Move) -> f64 {
        let mut gain =
            |g: usize, parents: &[usize]| self.of(g, parents) - self.of(g, &structure.parents[g]);
        let parents = |g: usize| &structure.parents[g];
        match change {
            Move::Add(p, g) => gain(g, &with(parents(g), p)),
            Move::Remove(p, g) => gain(g, &without(parents(g), p)),
            Move::Reverse(p, g) => gain(g, &without(parents(g), p)) + gain(p, &with(parents(p), g)),
        }
    }

    fn of(&mut self, g: usize, parents: &[usize]) -> f64 {
        let key = (g, parents.to_vec());
        if let Some(&known) = self.evidence.get(&key) {
            return known;
        }
        let schema = self.problem.schema;
        let q = self.problem.rows.d + 1;
        let mut index = vec![0];
        for &p in parents {
            index.extend(schema.columns(p).map(|c| c + 1));
        }
        let p = index.len();
        index.extend(schema.columns(g).map(|c| c + 1));
        let n = index.len();
        let mut sub = vec![0.0; n * n];
        let prior = &self.problem.priors.linear;
        let states = self.wide[g].iter().map(|m| {
            for (a, &i) in index.iter().enumerate() {
                for (b, &j) in index[..=a].iter().enumerate() {
                    sub[a * n + b] = m[i.max(j) * q + i.min(j)];
                }
            }
            prior.evidence(&sub, p, n - p).unwrap_or(f64::NEG_INFINITY)
        });
        let evidence = states.sum();
        self.evidence.insert(key, evidence);
        evidence
    }
}

/// All changes of one edge that leave the graph acyclic and within the most parents.
fn moves(structure: &Structure, max_parents: usize) -> Vec<Move> {
    let groups = structure.parents.len();
    let full = |g: usize| structure.parents[g].len() >= max_parents;
    let mut all = Vec::new();
    for g in 0..groups {
        for p in (0..groups).filter(|&p| p != g) {
            if structure.parents[g].contains(&p) {
                all.push(Move::Remove(p, g));
                let mut rest = structure.clone();
                rest.parents[g].retain(|&other| other != p);
                if !full(p) && !rest.reaches(p, g) {
                    all.push(Move::Reverse(p, g));
                }
            } else if !full(g) && !structure.reaches(g, p) {
                all.push(Move::Add(p, g));
            }
        }
    }
    all
}

fn apply(structure: &mut Structure, change: Move) {
    match change {
        Move::Add(p, g) => structure.parents[g] = with(&structure.parents[g], p),
        Move::Remove(p, g) => structure.parents[g] = without(&structure.parents[g], p),
        Move::Reverse(p, g) => {
            structure.parents[g] = without(&structure.parents[g], p);
            structure.parents[p] = with(&structure.parents[p], g);
        }
    }
}

fn with(parents: &[usize], p: usize) -> Vec<usize> {
    let mut list = parents.to_vec();
    list.push(p);
    list.sort_unstable();
    list
}

fn without(parents: &[usize], p: usize) -> Vec<usize> {
    parents
        .iter()
        .copied()
        .filter(|&other| other != p)
        .collect()
}

/// Rows with missing values enter with their posterior means.
pub(crate) fn wide(problem: &Problem, scored: &Scored) -> Result<Wide, ModelError> {
    let shape = &scored.shape;
    let params = &scored.params;
    let q = problem.rows.d + 1;
    let mut wide: Wide = (0..shape.groups())
        .map(|g| vec![vec![0.0; q * q]; shape.states(g)])
        .collect();
    let mut scratch = Scratch::new(shape);
    let mut outer = vec![0.0; q * q];
    let mut v = vec![1.0; q];
    for i in 0..problem.rows.rows {
        let real = problem.rows.real(i);
        problem.visit(params, i, &mut scratch, |scratch, _, weight| {
            let states = states(scratch, scored);
            for (v, r) in v[1..].iter_mut().zip(real) {
                *v = if r.is_nan() { 0.0 } else { *r };
            }
            for component in &scratch.components {
                for (particle, j) in
                    component
                        .particles
                        .iter()
                        .zip(joint(component, shape, params, &scratch.style))
                {
                    let w: f64 = j.iter().sum();
                    for (&c, m) in component.missing.iter().zip(&particle.mean) {
                        v[c + 1] += w * m;
                    }
                }
            }
            for a in 0..q {
                for b in 0..=a {
                    outer[a * q + b] = v[a] * v[b];
                }
            }
            for (g, r) in states {
                for (m, r) in wide[g].iter_mut().zip(r) {
                    let r = r * weight;
                    if r > 1e-6 {
                        for (m, o) in m.iter_mut().zip(&outer) {
                            *m += r * o;
                        }
                    }
                }
            }
        })?;
    }
    Ok(wide)
}

/// P(state | row) of every group that the row says something about.
pub(crate) fn states(scratch: &Scratch, scored: &Scored) -> Vec<(usize, Vec<f64>)> {
    let shape = &scored.shape;
    let params = &scored.params;
    let styles = shape.structure.styles;
    let mut all = Vec::with_capacity(shape.groups());
    for &g in &scratch.pattern.plain {
        let r = match shape.structure.selectors[g] {
            Selector::Style => scratch.style.clone(),
            Selector::Codes(_) => scratch.dens[g].clone(),
            Selector::Hidden(k) => (0..k)
                .map(|h| {
                    let row = &params.tables[g][h * styles..(h + 1) * styles];
                    let messages = scratch.messages[g].iter().zip(&scratch.style);
                    let sum: f64 = row.iter().zip(messages).map(|(p, (m, r))| p * r / m).sum();
                    scratch.dens[g][h] * sum
                })
                .collect(),
        };
        all.push((g, r));
    }
    for component in &scratch.components {
        let joint = joint(component, shape, params, &scratch.style);
        for (at, &g) in component.groups.iter().enumerate() {
            let mut r = vec![0.0; shape.states(g)];
            for (particle, j) in component.particles.iter().zip(&joint) {
                r[particle.states[at]] += j.iter().sum::<f64>();
            }
            all.push((g, r));
        }
    }
    all
}

impl Problem<'_> {
    /// Parameters for this structure from the posteriors of the hidden variables in `scored`,
    /// which differs in lateral edges only: one M step of structural EM (Friedman 1998).
    pub(crate) fn reparent(
        &self,
        scored: &Scored,
        wide: &Wide,
    ) -> Result<super::params::Params, ModelError> {
        let q = self.rows.d + 1;
        let mut stats = scored.stats.clone();
        for (g, states) in wide.iter().enumerate() {
            let index: Vec<usize> = std::iter::once(0)
                .chain(self.shape.columns[g].iter().map(|c| c + 1))
                .collect();
            let n = index.len();
            stats.scatter[g] = states
                .iter()
                .map(|m| {
                    let mut sub = vec![0.0; n * n];
                    for (a, &i) in index.iter().enumerate() {
                        for (b, &j) in index[..=a].iter().enumerate() {
                            sub[a * n + b] = m[i.max(j) * q + i.min(j)];
                        }
                    }
                    sub
                })
                .collect();
        }
        self.shape.maximize(&stats, self.priors)
    }
}
