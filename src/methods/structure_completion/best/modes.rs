//! Completions from a pool: the best coherent layout, and the best one of each mode.
//!
//! A mode is a number of columns and rows. Its mass is the learnt probability that the facade has these numbers
//! ([`masses`]); a model that has not learnt it takes the share of the draws that have them. It depends on the pool
//! alone, so that an answer has the same mass however many answers are asked for.

use std::collections::BTreeMap;

use super::candidates::{Candidate, Candidates};
use super::categorical;
use super::doors;
use super::exact;
use super::judge::{Judge, Layout};
use super::masses;
use super::observation::{Observation, of};
use super::pool::{Draw, SHARES, pool, weights};
use super::regular::regular;
use super::rhythm::{self, Continued};
use super::scattered;
use crate::completion::{Completed, Completion, Reason};
use crate::layout::{Class, Element};
use crate::model::Model;
use crate::partial::PartialLayout;
use edifice_base::rng::Stream;

/// Shares of the origins in the distribution of the number of windows, where the unknown part is known; set so that true
/// numbers lie within its 10 to 90 % interval about as often as they should.
const COUNTED: [f64; 7] = [0.0, 0.35, 0.15, 0.45, 0.05, 0.0, 0.0];
/// Probability of the exact lattice where the seen windows are cells of one: it is also the mass of that answer.
const EXACT: f64 = 0.9;
/// Learnt masses may sum to less than 1. Of what is left, this share belongs to the answers in equal parts, the rest to numbers that no
/// answer has: facades of other sets than those of the database surprise, and an answer of a small share is right more often than there.
const UNFORESEEN: f64 = 0.5;
/// Least probability of a door that is added because there is none.
const LEAST_DOOR: f64 = 0.08;
/// Probabilities of an element that continues a row with a rhythm of its own, within a half and three quarters: 182 and 153 of 262 on
/// the facades of CMP, behind five kinds of frozen masks.
const CONTINUED: [f64; 2] = [0.69, 0.58];
/// Of an element that is as probable within a half as of one, this share is so within three quarters, where no model of
/// the latter was learnt.
const TIGHT: f64 = 0.5;

/// Completions of a partial layout, and what the pool says of the number of windows.
#[derive(Debug, Clone)]
pub struct Answer {
    /// The best completion first, then one for each further mode, by falling mass.
    pub completions: Vec<Completion>,
    /// Number of added windows of each layout of the pool, with its weight.
    pub windows: Vec<(usize, f64)>,
    /// One layout of the pool, drawn by its weight: what it adds.
    pub drawn: Vec<Element>,
}

/// Completes a partial layout in up to `count` ways.
pub fn complete(partial: &PartialLayout, model: &Model, count: usize, rng: &mut Stream) -> Answer {
    let draws = pool(partial, model, &[], rng);
    let fallback = model.window_size(partial.width, partial.height);
    let observation = Observation::new(partial, partial.observed.clone(), fallback);
    let mut candidates = Candidates::new(&observation, &draws);
    let weights = weights(&draws);
    let mut loose = probabilities(model, &candidates);
    let mut tight: Vec<f64> = match &model.tight {
        Some(learnt) => candidates.probabilities(learnt),
        None => loose.iter().map(|p| TIGHT * p).collect(),
    };
    let least = scattered::weigh(&observation, &candidates, [&mut loose, &mut tight]);
    let door = door(model, &observation, &draws, &mut candidates, &mut loose);
    tight.resize(loose.len(), 0.0);
    if let Some(door) = door {
        tight[door] = TIGHT * loose[door];
    }
    let own = rows_of_own(&observation, &mut candidates, [&mut loose, &mut tight]);
    // What lies within three quarters lies within a half.
    let value = loose.iter().zip(&tight);
    let value: Vec<f64> = value.map(|(l, t)| (l + t.min(*l)) / 2.0).collect();
    let judge = Judge::new(
        &observation,
        &candidates,
        value,
        least,
        door,
        own,
        expected(&draws, &weights),
    );
    let windows = windows(partial, &draws);
    let mut modes = Modes::default();
    for (draw, weight) in draws
        .iter()
        .zip(&weights)
        .filter(|(d, _)| d.origin.is_whole())
    {
        modes.add(judge.on_lattice(&draw.lines), *weight, draw.numbers);
    }
    let freely = judge.freely();
    let numbers = freely.numbers;
    modes.add(freely, 0.0, numbers);
    let probability = |c: usize| loose[c].clamp(0.0, 1.0);
    let learnt = model.masses.as_ref().map(|learnt| {
        let shares = masses::shares(&draws, &weights);
        masses::probabilities(learnt, &observation, &shares)
    });
    let mut completions = modes.completions(probability, learnt.as_ref());
    if let Some(hidden) = exact::hidden(&observation) {
        completions.iter_mut().for_each(|c| c.mass *= 1.0 - EXACT);
        let added = hidden.into_iter().map(|element| Completed {
            element,
            probability: EXACT,
            reason: Reason::Lattice,
        });
        let best = completions.iter().map(|c| c.score).fold(EXACT, f64::max);
        let first = Completion {
            added: added.collect(),
            score: best,
            mass: EXACT,
        };
        completions.insert(0, first);
    }
    completions.truncate(count.max(1));
    let drawn = &draws[categorical(&weights, rng)].added;
    Answer {
        completions,
        windows,
        drawn: drawn.iter().map(|(e, _)| *e).collect(),
    }
}

/// Continuations of rows with a rhythm of their own, as further candidates.
fn rows_of_own(
    observation: &Observation,
    candidates: &mut Candidates,
    [loose, tight]: [&mut Vec<f64>; 2],
) -> Vec<(Continued, Vec<usize>)> {
    let mut candidate = |element: &Element| {
        candidates.add(*element, Reason::Lattice);
        loose.push(CONTINUED[0]);
        tight.push(CONTINUED[1]);
        loose.len() - 1
    };
    let rows = rhythm::continued(observation).into_iter();
    rows.map(|row| {
        let own = row.elements.iter().map(&mut candidate).collect();
        (row, own)
    })
    .collect()
}

/// Elements put on lines that they share with the observed ones and among themselves, as every layout of the pool is.
pub fn on_lines(partial: &PartialLayout, model: &Model, elements: &[Element]) -> Vec<Element> {
    let fallback = model.window_size(partial.width, partial.height);
    let observation = Observation::new(partial, partial.observed.clone(), fallback);
    let given: Vec<(Element, Reason)> = elements.iter().map(|e| (*e, Reason::Lattice)).collect();
    regular(&observation, &given)
        .added
        .into_iter()
        .map(|a| a.0)
        .collect()
}

/// Probability of each candidate within an intersection over union of a half.
fn probabilities(model: &Model, candidates: &Candidates) -> Vec<f64> {
    if let Some(learnt) = &model.elements {
        return candidates.probabilities(learnt);
    }
    // The shares sum to 1, up to rounding.
    let probability = |c: &Candidate| {
        let terms = c.support.iter().zip(SHARES).map(|(s, share)| s * share);
        terms.sum::<f64>().min(1.0)
    };
    candidates.all.iter().map(probability).collect()
}

/// The door that a facade without one gets, as a candidate; `None` where a door is seen, or none is likely enough.
fn door(
    model: &Model,
    observation: &Observation,
    draws: &[Draw],
    candidates: &mut Candidates,
    loose: &mut Vec<f64>,
) -> Option<usize> {
    if of(&observation.elements, Class::Door).next().is_some() {
        return None;
    }
    if let Some(learnt) = &model.doors {
        let places = doors::places(observation, draws, candidates);
        let each = places
            .into_iter()
            .map(|p| (learnt.probability(&p.features), p.element));
        let (probability, element) = each.reduce(|a, b| if b.0 > a.0 { b } else { a })?;
        candidates.add(element, Reason::Database);
        loose.push(probability);
    }
    let is_door = |c: &usize| candidates.all[*c].element.class == Class::Door;
    let doors = (0..loose.len()).rev().filter(is_door);
    let best = match &model.doors {
        Some(_) => loose.len().checked_sub(1),
        None => doors.max_by(|&a, &b| loose[a].total_cmp(&loose[b])),
    };
    best.filter(|&d| loose[d] > LEAST_DOOR)
}

/// Number of added windows of each layout of the pool, with its weight.
fn windows(partial: &PartialLayout, draws: &[Draw]) -> Vec<(usize, f64)> {
    let shares = match partial.unknown {
        Some(_) => COUNTED,
        None => SHARES,
    };
    let count = |draw: &Draw| {
        let windows = draw.added.iter().filter(|(e, _)| e.class == Class::Window);
        windows.count()
    };
    let each = draws
        .iter()
        .map(|d| (count(d), d.weight * shares[d.origin as usize]));
    each.collect()
}

/// Mean number of added elements.
fn expected(draws: &[Draw], weights: &[f64]) -> f64 {
    let terms = draws.iter().zip(weights);
    terms.map(|(d, w)| w * d.added.len() as f64).sum()
}

/// The best layout of each mode, and its mass.
#[derive(Default)]
struct Modes(BTreeMap<(usize, usize), (Option<Layout>, f64)>);

impl Modes {
    /// Adds the weight of a draw to the mode of its numbers, and the layout that was chosen on its lattice to that of the layout's.
    fn add(&mut self, layout: Layout, weight: f64, numbers: (usize, usize)) {
        self.0.entry(numbers).or_default().1 += weight;
        let own = &mut self.0.entry(layout.numbers).or_default().0;
        if own.as_ref().is_none_or(|best| layout.score > best.score) {
            *own = Some(layout);
        }
    }

    /// The best layout first, then those of the other modes by falling mass, which is `learnt` where that is given. A share of the
    /// draws that belongs to a mode without a layout of its own goes to the nearest mode with one.
    fn completions(
        self,
        probability: impl Fn(usize) -> f64,
        learnt: Option<&BTreeMap<masses::Lattice, f64>>,
    ) -> Vec<Completion> {
        let (mut kept, mut lost) = (Vec::new(), Vec::new());
        for (lattice, (layout, mass)) in self.0 {
            match layout {
                Some(layout) => kept.push((lattice, layout, mass)),
                None => lost.push((lattice, mass)),
            }
        }
        for (lattice, mass) in lost {
            let distance =
                |other: &(usize, usize)| lattice.0.abs_diff(other.0) + lattice.1.abs_diff(other.1);
            if let Some(nearest) = kept.iter_mut().min_by_key(|k| distance(&k.0)) {
                nearest.2 += mass;
            }
        }
        if let Some(learnt) = learnt {
            for (lattice, _, mass) in &mut kept {
                *mass = learnt.get(lattice).copied().unwrap_or(0.0);
            }
            let left = 1.0 - kept.iter().map(|k| k.2).sum::<f64>();
            let each = UNFORESEEN * left.max(0.0) / kept.len().max(1) as f64;
            kept.iter_mut().for_each(|k| k.2 += each);
        }
        kept.sort_by(|a, b| b.1.score.total_cmp(&a.1.score).then(a.0.cmp(&b.0)));
        if let Some(others) = kept.get_mut(1..) {
            others.sort_by(|a, b| b.2.total_cmp(&a.2).then(a.0.cmp(&b.0)));
        }
        let completion = |(_, layout, mass): ((usize, usize), Layout, f64)| Completion {
            added: (layout.added.iter())
                .map(|&(element, reason, c)| Completed {
                    element,
                    reason,
                    probability: probability(c),
                })
                .collect(),
            score: layout.score,
            mass: mass.min(1.0),
        };
        kept.into_iter().map(completion).collect()
    }
}
