//! One candidate: actions drawn from a policy until none finds a place (Sec. 5.1).

use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

use super::scene::{Extent, Item, Scene};
use super::{Direction, FAILURES, Policy};
use crate::methods::structure_completion::layout::{Class, Element};
use crate::shape::Rect;

/// Two elements are on one line where their centres differ by less than this share of the size.
const SAME_LINE: f64 = 0.35;
/// How far an element is snapped, relative to its size.
const SNAP: f64 = 0.3;
/// Standard deviation of the random offset, relative to the spacing.
const OFFSET: f64 = 0.1;
/// Ratio of sizes up to which a new element belongs to a grid of its class.
const SAME_SIZE: f64 = 1.35;
/// A candidate is complete at this many elements and empty places for each observed one, and some more.
const MOST: (usize, usize) = (8, 60);

/// A layout as it grows.
#[derive(Debug, Clone)]
pub struct Growing {
    pub(super) items: Vec<Item>,
    pub(super) grids: Vec<Extent>,
}

impl Growing {
    /// The observed layout.
    pub fn new(scene: &Scene) -> Self {
        Self {
            items: scene.items.clone(),
            grids: scene.grids.clone(),
        }
    }

    /// All elements, the observed ones first.
    pub fn elements(&self) -> Vec<Element> {
        let real = self.items.iter().filter(|i| !i.empty);
        real.map(|i| i.element).collect()
    }

    pub(super) fn add(&mut self, item: Item) {
        match self.grids.get_mut(item.grid as usize) {
            Some(extent) => extent.include(&item.element),
            None => self.grids.push(Extent::of(&item.element)),
        }
        self.items.push(item);
    }

    fn fits(&self, scene: &Scene, element: &Element) -> bool {
        scene.open.allows(element) && self.items.iter().all(|i| !i.element.excludes(element))
    }
}

/// A candidate of a policy: all elements, the observed ones first.
pub fn grow<R: Rng>(scene: &Scene, policy: &Policy, rng: &mut R) -> Vec<Element> {
    let mut growing = Growing::new(scene);
    while let Some(item) = next(scene, &growing, policy, rng) {
        growing.add(item);
    }
    growing.elements()
}

/// What the policy adds next; `None` when the candidate is complete.
pub(super) fn next<R: Rng>(
    scene: &Scene,
    growing: &Growing,
    policy: &Policy,
    rng: &mut R,
) -> Option<Item> {
    if growing.items.is_empty() || growing.items.len() >= MOST.0 * scene.items.len() + MOST.1 {
        return None;
    }
    (0..FAILURES).find_map(|_| action(scene, growing, policy, rng))
}

/// Seed, direction, label, spacing.
fn action<R: Rng>(scene: &Scene, growing: &Growing, policy: &Policy, rng: &mut R) -> Option<Item> {
    let lambda = &policy.0;
    let seed = seed(scene, growing, policy, rng);
    if rng.random::<f64>() < lambda[10] {
        return mirrored(scene, growing, seed);
    }
    let (class, size, empty) = label(scene, seed, policy, rng);
    let grid = match (class, size) == (seed.element.class, seed.size()) {
        true => seed.grid,
        false => grid_of(growing, class, size),
    };
    let snap = rng.random::<f64>() < lambda[9];
    let place = |axis: usize, forward: bool, rng: &mut R| {
        let step = spacing(scene, growing, seed, (axis, forward), policy, rng);
        let mut at = seed.centre;
        at[axis] += if forward { step } else { -step };
        if snap {
            at[axis] = snapped(growing, at[axis], axis, SNAP * size[axis]);
        }
        at
    };
    let element = |at: [f64; 2]| {
        let rect = Rect::new(
            at[0] - size[0] / 2.0,
            at[1] - size[1] / 2.0,
            size[0],
            size[1],
        );
        let element = Element::new(class, rect);
        growing.fits(scene, &element).then_some(element)
    };
    let mut found = None;
    for direction in policy.directions(rng) {
        found = match direction {
            Direction::Along(axis, forward) => element(place(axis, forward, rng)),
            Direction::Concave => {
                let turn = rng.random_range(0..4);
                let inside = growing.grids[seed.grid as usize];
                (0..4).find_map(|i| {
                    let side = (i + turn) % 4;
                    let at = place(side / 2, side % 2 == 0, rng);
                    if inside.holds(at) { element(at) } else { None }
                })
            }
        };
        if found.is_some() {
            break;
        }
    }
    found.map(|element| Item::new(element, grid, empty))
}

/// A seed at random, or one of highest rank (Eq. 23).
fn seed<'s, R: Rng>(scene: &Scene, growing: &'s Growing, policy: &Policy, rng: &mut R) -> &'s Item {
    let items = &growing.items;
    let start = rng.random_range(0..items.len());
    if rng.random::<f64>() < policy.0[0] {
        return &items[start];
    }
    let area = scene.facade[0] * scene.facade[1];
    let rank = |item: &Item| {
        let grid = &growing.grids[item.grid as usize];
        let r = &item.element.rect;
        let inside = grid.low[0] < r.x
            && r.right() < grid.high[0]
            && grid.low[1] < r.y
            && r.top() < grid.high[1];
        policy.0[1] * f64::from(u8::from(inside)) + (1.0 - policy.0[1]) * (1.0 - grid.area() / area)
    };
    // The first of the highest rank, counted from a random place.
    let mut best = (start, rank(&items[start]));
    for i in (start + 1..items.len()).chain(0..start) {
        let r = rank(&items[i]);
        if r > best.1 {
            best = (i, r);
        }
    }
    &items[best.0]
}

/// Class and size of the new element, and whether it is an empty place.
fn label<R: Rng>(
    scene: &Scene,
    seed: &Item,
    policy: &Policy,
    rng: &mut R,
) -> (Class, [f64; 2], bool) {
    let own = (seed.element.class, seed.size());
    if rng.random::<f64>() < policy.0[4] {
        return (own.0, own.1, false);
    }
    let from = match policy.option(5, 6, rng) {
        0 => &scene.observed,
        1 => &scene.database,
        _ => return (own.0, own.1, true),
    };
    match from.len() {
        0 => (own.0, own.1, false),
        n => {
            let exemplar = &from[rng.random_range(0..n)];
            (exemplar.class, exemplar.size, false)
        }
    }
}

/// The grid that a new element of another label joins, or a new one.
fn grid_of(growing: &Growing, class: Class, size: [f64; 2]) -> u32 {
    let similar = |item: &&Item| {
        let own = item.size();
        let near = |axis: usize| {
            let ratio = own[axis] / size[axis];
            ratio < SAME_SIZE && ratio > 1.0 / SAME_SIZE
        };
        item.element.class == class && near(0) && near(1)
    };
    let known = growing.items.iter().find(similar);
    known.map_or(growing.grids.len() as u32, |item| item.grid)
}

/// Spacing between the seed and the new element.
fn spacing<R: Rng>(
    scene: &Scene,
    growing: &Growing,
    seed: &Item,
    (axis, forward): (usize, bool),
    policy: &Policy,
    rng: &mut R,
) -> f64 {
    let method = policy.option(7, 8, rng);
    if method == 0
        && let Some(step) = opposite(growing, seed, axis, forward)
    {
        return step;
    }
    let observed = &scene.spacings[axis];
    let ratios = &scene.model.spacings[axis];
    let step = if !observed.is_empty() {
        observed[rng.random_range(0..observed.len())]
    } else if !ratios.is_empty() {
        ratios[rng.random_range(0..ratios.len())] * seed.size()[axis]
    } else {
        2.0 * seed.size()[axis]
    };
    match method {
        2 => step * (1.0 + OFFSET * rng.sample::<f64, _>(StandardNormal)),
        _ => step,
    }
}

/// Distance of the nearest element of the same grid on the seed's line, on the other side.
fn opposite(growing: &Growing, seed: &Item, axis: usize, forward: bool) -> Option<f64> {
    let across = 1 - axis;
    let tolerance = SAME_LINE * seed.size()[across];
    let mut least = f64::INFINITY;
    for item in growing.items.iter().filter(|i| i.grid == seed.grid) {
        let ahead = seed.centre[axis] - item.centre[axis];
        let distance = if forward { ahead } else { -ahead };
        let aligned = (item.centre[across] - seed.centre[across]).abs() < tolerance;
        if aligned && distance > SAME_LINE * seed.size()[axis] && distance < least {
            least = distance;
        }
    }
    least.is_finite().then_some(least)
}

/// The nearest centre of another element within reach, else the value itself.
fn snapped(growing: &Growing, value: f64, axis: usize, reach: f64) -> f64 {
    let mut best = (reach, value);
    for item in &growing.items {
        let distance = (item.centre[axis] - value).abs();
        if distance < best.0 {
            best = (distance, item.centre[axis]);
        }
    }
    best.1
}

/// The mirror image of the seed about the middle of the facade.
fn mirrored(scene: &Scene, growing: &Growing, seed: &Item) -> Option<Item> {
    let r = seed.element.rect;
    let rect = Rect::new(scene.facade[0] - r.right(), r.y, r.width, r.height);
    let element = Element::new(seed.element.class, rect);
    let fits = growing.fits(scene, &element);
    fits.then(|| Item::new(element, seed.grid, seed.empty))
}
