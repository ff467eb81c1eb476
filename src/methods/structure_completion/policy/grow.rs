//! One candidate: actions drawn from a policy until none finds a place (Sec. 5.1).

use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

use super::growing::{Growing, most};
use super::problem::{CompletionProblem, Extent, Item};
use super::tried::{SeedSpacing, Tried};
use super::{Direction, FAILURES, Policy};
use crate::layout::{Class, Element};
use edifice_shape::Rect;

/// The distance within which an element is snapped, relative to its size.
const SNAP: f64 = 0.3;
/// Standard deviation of the random offset, relative to the spacing.
const OFFSET: f64 = 0.1;

/// A candidate of a policy: all elements, the observed ones first.
pub fn grow<R: Rng>(problem: &CompletionProblem, policy: &Policy, rng: &mut R) -> Vec<Element> {
    let (mut growing, mut tried) = (Growing::new(problem), Tried::default());
    while let Some(item) = next(problem, &growing, &mut tried, policy, rng) {
        growing.add(item);
    }
    growing.elements()
}

/// The item that the policy adds next; `None` when the candidate is complete. `tried` belongs to this growing layout only.
pub(super) fn next<R: Rng>(
    problem: &CompletionProblem,
    growing: &Growing,
    tried: &mut Tried,
    policy: &Policy,
    rng: &mut R,
) -> Option<Item> {
    if growing.items.is_empty() || growing.items.len() >= most(problem.start.items.len()) {
        return None;
    }
    (0..FAILURES).find_map(|_| action(problem, growing, tried, policy, rng))
}

/// Seed, direction, label, spacing.
fn action<R: Rng>(
    problem: &CompletionProblem,
    growing: &Growing,
    tried: &mut Tried,
    policy: &Policy,
    rng: &mut R,
) -> Option<Item> {
    let lambda = &policy.0;
    let number = seed(problem, growing, policy, rng);
    let seed = &growing.items[number];
    if rng.random::<f64>() < lambda[10] {
        return mirrored(problem, growing, seed);
    }
    let (class, size, empty) = label(problem, seed, policy, rng);
    let alike = (class, size) == (seed.element.class, seed.size());
    let grid = match alike {
        true => seed.grid,
        false => growing.grid_of(&Element::new(class, Rect::new(0.0, 0.0, size[0], size[1]))),
    };
    let snap = rng.random::<f64>() < lambda[9];
    let mut extended = |direction: (usize, bool), inside: Option<&Extent>, rng: &mut R| {
        let step = spacing(problem, growing, tried, number, direction, policy, rng);
        if alike && tried.is_taken(growing, number, direction, step, snap) {
            return None;
        }
        let ((axis, forward), length) = (direction, step.length());
        let mut at = seed.centre;
        at[axis] += if forward { length } else { -length };
        if snap {
            at[axis] = growing.snapped(at[axis], axis, SNAP * size[axis]);
        }
        if inside.is_some_and(|inside| !inside.holds(at)) {
            return None;
        }
        let low = [0, 1].map(|axis| at[axis] - size[axis] / 2.0);
        let element = Element::new(class, Rect::new(low[0], low[1], size[0], size[1]));
        let fits = growing.fits(problem, &element);
        if alike && !fits {
            tried.take(growing, number, direction, step, snap);
        }
        fits.then_some(element)
    };
    let mut found = None;
    for direction in policy.directions(rng) {
        found = match direction {
            Direction::Along(axis, forward) => extended((axis, forward), None, rng),
            Direction::Concave => {
                let turn = rng.random_range(0..4);
                let inside = growing.extent(seed.grid);
                (0..4).find_map(|i| {
                    let side = (i + turn) % 4;
                    extended((side / 2, side % 2 == 0), Some(inside), rng)
                })
            }
        };
        if found.is_some() {
            break;
        }
    }
    found.map(|element| Item::new(element, grid, empty))
}

/// Number of a seed at random, or of one of highest rank (Eq. 23).
fn seed<R: Rng>(
    problem: &CompletionProblem,
    growing: &Growing,
    policy: &Policy,
    rng: &mut R,
) -> usize {
    if rng.random::<f64>() < policy.0[0] {
        return rng.random_range(0..growing.items.len());
    }
    growing.highest(policy.0[1], problem.facade[0] * problem.facade[1], rng)
}

/// Class and size of the new element, and whether it is an empty place.
fn label<R: Rng>(
    problem: &CompletionProblem,
    seed: &Item,
    policy: &Policy,
    rng: &mut R,
) -> (Class, [f64; 2], bool) {
    let own = (seed.element.class, seed.size());
    if rng.random::<f64>() < policy.0[4] {
        return (own.0, own.1, false);
    }
    let label = match policy.option(5, 6, rng) {
        0 => problem.observed_label(rng),
        1 => problem.database_label(rng),
        _ => return (own.0, own.1, true),
    };
    let (class, size) = label.map_or(own, |label| (label.class, label.size));
    (class, size, false)
}

/// Spacing between the seed and the new element.
fn spacing<R: Rng>(
    problem: &CompletionProblem,
    growing: &Growing,
    tried: &mut Tried,
    seed: usize,
    direction: (usize, bool),
    policy: &Policy,
    rng: &mut R,
) -> SeedSpacing {
    let axis = direction.0;
    let method = policy.option(7, 8, rng);
    if method == 0
        && let Some(length) = tried.opposite(growing, seed, direction)
    {
        return SeedSpacing::Opposite(length);
    }
    let observed = &problem.spacings[axis];
    let ratios = &problem.model.spacings[axis];
    let size = growing.items[seed].size()[axis];
    let step = if !observed.is_empty() {
        let number = rng.random_range(0..observed.len());
        SeedSpacing::Observed(number, observed[number])
    } else if !ratios.is_empty() {
        SeedSpacing::Other(ratios[rng.random_range(0..ratios.len())] * size)
    } else {
        SeedSpacing::Other(2.0 * size)
    };
    match method {
        2 => {
            let offset = OFFSET * rng.sample::<f64, _>(StandardNormal);
            SeedSpacing::Other(step.length() * (1.0 + offset))
        }
        _ => step,
    }
}

/// The mirror image of the seed about the middle of the facade.
fn mirrored(problem: &CompletionProblem, growing: &Growing, seed: &Item) -> Option<Item> {
    let r = seed.element.rect;
    let rect = Rect::new(problem.facade[0] - r.right(), r.y, r.width, r.height);
    let element = Element::new(seed.element.class, rect);
    let fits = growing.fits(problem, &element);
    fits.then(|| Item::new(element, seed.grid, seed.empty))
}
