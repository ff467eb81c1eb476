//! Completions from a pool: the best one, and the best one of each mode.

use std::collections::BTreeMap;

use super::candidates::{Candidates, supported};
use super::pool::{Draw, Origin, pool};
use super::scene::Scene;
use super::select::select;
use crate::completion::{Completed, Completion};
use crate::layout::Class;
use crate::model::Model;
use crate::partial::PartialLayout;
use edifice_base::rng::Stream;

/// Share of each origin in the pool as a whole, in the order of [`Origin::ALL`].
const SHARES: [f64; 7] = [0.15, 0.25, 0.2, 0.3, 0.1, 0.0, 0.0];
/// Shares of the origins in the distribution of the number of windows, where the unknown part is known; set so that true
/// numbers lie within its 10 to 90 % interval about as often as they should.
const COUNTED: [f64; 7] = [0.0, 0.35, 0.15, 0.45, 0.05, 0.0, 0.0];
/// Least probability of a door that is added because there is none.
const LEAST_DOOR: f64 = 0.08;
/// Share of a mode's own support in the probabilities that choose its elements.
const OWN: f64 = 0.6;

/// Completions of a partial layout, and what the pool says of the number of windows.
#[derive(Debug, Clone)]
pub struct Answer {
    /// The best completion first, then one for each further mode, by falling mass.
    pub completions: Vec<Completion>,
    /// Number of added windows of each layout of the pool, with its weight.
    pub windows: Vec<(usize, f64)>,
}

/// Completes a partial layout in up to `count` ways.
pub fn complete(partial: &PartialLayout, model: &Model, count: usize, rng: &mut Stream) -> Answer {
    let draws = pool(partial, model, &[], rng);
    let fallback = model.window_size(partial.width, partial.height);
    let scene = Scene::new(partial, partial.observed.clone(), fallback);
    let candidates = Candidates::new(&scene, &draws);
    let weights = weights(&draws);
    let probability: Vec<f64> = candidates
        .all
        .iter()
        .map(|c| match &model.elements {
            Some(learnt) => learnt.probability(&c.features),
            // The shares sum to 1, up to rounding.
            None => (c.support.iter().zip(SHARES))
                .map(|(s, share)| s * share)
                .sum::<f64>()
                .min(1.0),
        })
        .collect();
    let windows = |draw: &Draw| {
        draw.added
            .iter()
            .filter(|(e, _)| e.class == Class::Window)
            .count()
    };
    let of_count = match partial.unknown {
        Some(_) => COUNTED,
        None => SHARES,
    };
    let answer_windows = (draws.iter())
        .map(|d| (windows(d), d.weight * of_count[d.origin as usize]))
        .collect();
    let all: Vec<usize> = (0..draws.len()).collect();
    let expected = expected(&draws, &weights, &all);
    let (mut chosen, score) = select(&candidates, &probability, expected);
    chosen.extend(door(&scene, &candidates, &probability, &chosen));
    let modes = modes(&draws, &weights);
    let mut completions = vec![completion(&candidates, &probability, &chosen, score)];
    let mut seen = vec![(chosen, modes.first().map_or(1.0, |m| m.1))];
    for (members, mass) in &modes {
        if seen.len() >= count.max(1) {
            break;
        }
        let own = support_of(&candidates, &draws, &weights, members, *mass);
        let mixed: Vec<f64> = own
            .iter()
            .zip(&probability)
            .map(|(own, p)| OWN * own + (1.0 - OWN) * p)
            .collect();
        let (chosen, score) = select(
            &candidates,
            &mixed,
            self::expected(&draws, &weights, members),
        );
        if seen
            .iter()
            .any(|(other, _)| alike(&candidates, other, &chosen))
        {
            continue;
        }
        let mut next = completion(&candidates, &probability, &chosen, score);
        next.mass = *mass;
        completions.push(next);
        seen.push((chosen, *mass));
    }
    let named: f64 = completions[1..].iter().map(|c| c.mass).sum();
    completions[0].mass = (1.0 - named).max(0.0);
    Answer {
        completions,
        windows: answer_windows,
    }
}

/// The most probable door, where there is none yet: a facade without a door is not plausible, though no single place of
/// it may be probable enough to be chosen for the expected score.
fn door(
    scene: &Scene,
    candidates: &Candidates,
    probability: &[f64],
    chosen: &[usize],
) -> Option<usize> {
    let is_door = |c: &usize| candidates.all[*c].element.class == Class::Door;
    if chosen.iter().any(is_door) || scene.elements.iter().any(|e| e.class == Class::Door) {
        return None;
    }
    let free = |c: &usize| {
        let element = &candidates.all[*c].element;
        !chosen
            .iter()
            .any(|o| candidates.all[*o].element.excludes(element))
    };
    let doors = (0..probability.len()).filter(is_door).filter(free);
    let best = doors.max_by(|&a, &b| probability[a].total_cmp(&probability[b]).then(b.cmp(&a)))?;
    (probability[best] > LEAST_DOOR).then_some(best)
}

/// Weight of each layout in the whole pool.
fn weights(draws: &[Draw]) -> Vec<f64> {
    let present = |o: &Origin| draws.iter().any(|d| d.origin == *o);
    let shares = Origin::ALL.iter().zip(SHARES);
    let total: f64 = shares
        .filter(|(o, _)| present(o))
        .map(|(_, share)| share)
        .sum();
    draws
        .iter()
        .map(|d| d.weight * SHARES[d.origin as usize] / total)
        .collect()
}

/// Mean number of added elements.
fn expected(draws: &[Draw], weights: &[f64], members: &[usize]) -> f64 {
    let total: f64 = members.iter().map(|&m| weights[m]).sum();
    let sum: f64 = members
        .iter()
        .map(|&m| weights[m] * draws[m].added.len() as f64)
        .sum();
    if total > 0.0 { sum / total } else { 0.0 }
}

/// Layouts of the pool by the size of their lattice and whether they are mirrored, with their mass, largest first.
fn modes(draws: &[Draw], weights: &[f64]) -> Vec<(Vec<usize>, f64)> {
    let mut groups: BTreeMap<(usize, usize, bool), (Vec<usize>, f64)> = BTreeMap::new();
    for (index, draw) in draws
        .iter()
        .enumerate()
        .filter(|(_, d)| d.origin.is_whole())
    {
        let mirrored = matches!(draw.origin, Origin::Mirrored | Origin::MirroredBelow);
        let group = groups
            .entry((draw.lattice.0, draw.lattice.1, mirrored))
            .or_default();
        group.0.push(index);
        group.1 += weights[index];
    }
    let mut modes: Vec<(Vec<usize>, f64)> = groups.into_values().collect();
    modes.sort_by(|a, b| b.1.total_cmp(&a.1));
    modes
}

/// Share of a mode's layouts that have each candidate.
fn support_of(
    candidates: &Candidates,
    draws: &[Draw],
    weights: &[f64],
    members: &[usize],
    mass: f64,
) -> Vec<f64> {
    let mut support = vec![0.0; candidates.all.len()];
    let mut best = vec![0.0; candidates.all.len()];
    debug_assert_eq!(draws.len(), candidates.of_draw.len());
    for &member in members {
        for (c, share) in supported(&candidates.of_draw[member], &candidates.alike, &mut best) {
            support[c] += weights[member] * share / mass.max(1e-12);
        }
    }
    support
}

/// True if two choices show much the same: nine tenths of each have a like one in the other.
fn alike(candidates: &Candidates, a: &[usize], b: &[usize]) -> bool {
    let covered = |a: &[usize], b: &[usize]| {
        let like = |&&c: &&usize| {
            candidates.alike[c]
                .iter()
                .any(|(o, s)| *s > 0.5 && b.contains(o))
        };
        a.iter().filter(like).count() as f64 >= 0.9 * a.len() as f64
    };
    covered(a, b) && covered(b, a)
}

fn completion(
    candidates: &Candidates,
    probability: &[f64],
    chosen: &[usize],
    score: f64,
) -> Completion {
    let added = chosen.iter().map(|&c| Completed {
        element: candidates.all[c].element,
        probability: probability[c],
        reason: candidates.all[c].reason,
    });
    Completion {
        added: added.collect(),
        score,
        mass: 0.0,
    }
}
