//! A layout as it grows: its items, their grids, and what the steps of an action look up.

use rand::{Rng, RngExt};

use super::problem::{CompletionProblem, Extent, Item};
use crate::layout::Element;

use super::super::layout::places::Places;

/// Two elements are on one line where their centres differ by less than this share of the size.
const SAME_LINE: f64 = 0.35;
/// Ratio of sizes up to which a new element belongs to a grid of its class.
const SAME_SIZE: f64 = 1.35;

/// A grid as it grows. Its box only grows, so that an item that is inside stays inside.
#[derive(Debug, Clone)]
struct Group {
    extent: Extent,
    /// Its items on the boundary of its box, and those inside.
    boundary: Vec<u32>,
    inside: Vec<u32>,
}

/// Items of a candidate at which it is complete: for each observed one eight, and some more.
pub(super) fn most(observed: usize) -> usize {
    8 * observed + 60
}

/// A layout as it grows.
#[derive(Debug, Clone)]
pub(super) struct Growing {
    pub(super) items: Vec<Item>,
    groups: Vec<Group>,
    places: Places,
    /// Different centres along each axis, ascending.
    centres: [Vec<f64>; 2],
}

impl Group {
    /// Includes an item, which may bring others inside.
    fn include(&mut self, number: u32, items: &[Item]) {
        let before = self.extent;
        self.extent.include(&items[number as usize].element);
        self.boundary.push(number);
        if self.extent == before {
            // Only the new one is to be placed.
            if self.extent.surrounds(&items[number as usize].element) {
                self.boundary.pop();
                self.inside.push(number);
            }
            return;
        }
        let (extent, inside) = (self.extent, &mut self.inside);
        self.boundary.retain(|&i| {
            let surrounded = extent.surrounds(&items[i as usize].element);
            if surrounded {
                inside.push(i);
            }
            !surrounded
        });
    }
}

impl Growing {
    /// Observed items, whose grids are numbered without a gap.
    pub(super) fn of_items(facade: [f64; 2], items: Vec<Item>) -> Self {
        let count = items.len().max(1) as f64;
        let mean = |axis: usize| items.iter().map(|i| i.size()[axis]).sum::<f64>() / count;
        let mut growing = Self {
            places: Places::new(facade, [1.5 * mean(0), 1.5 * mean(1)], most(items.len())),
            items: Vec::with_capacity(items.len()),
            groups: Vec::new(),
            centres: [Vec::new(), Vec::new()],
        };
        items.into_iter().for_each(|item| growing.add(item));
        growing
    }

    /// The observed layout.
    pub(super) fn new(problem: &CompletionProblem) -> Self {
        problem.start.clone()
    }

    /// All elements, the observed ones first.
    pub(super) fn elements(&self) -> Vec<Element> {
        let real = self.items.iter().filter(|i| !i.empty);
        real.map(|i| i.element).collect()
    }

    /// Number of grids, and that of a new one.
    pub(super) fn grids(&self) -> u32 {
        self.groups.len() as u32
    }

    /// Box of a grid.
    pub(super) fn extent(&self, grid: u32) -> &Extent {
        &self.groups[grid as usize].extent
    }

    pub(super) fn add(&mut self, item: Item) {
        let number = self.items.len() as u32;
        self.places.insert(number, &item.element.rect);
        for (centres, at) in self.centres.iter_mut().zip(item.centre) {
            let place = centres.partition_point(|c| *c < at);
            if centres.get(place) != Some(&at) {
                centres.insert(place, at);
            }
        }
        self.items.push(item);
        if item.grid as usize >= self.groups.len() {
            self.groups.push(Group {
                extent: Extent::of(&item.element),
                boundary: Vec::new(),
                inside: Vec::new(),
            });
        }
        self.groups[item.grid as usize].include(number, &self.items);
    }

    /// True if an element may be added.
    pub(super) fn fits(&self, problem: &CompletionProblem, element: &Element) -> bool {
        let excluded = |i: u32| self.items[i as usize].element.excludes(element);
        problem.open.allows(element) && !self.places.any_near(&element.rect, excluded)
    }

    /// Number of an item of highest rank `λ1 [inside its grid] + (1 - λ1)(1 - A(g) / A(F))` (Eq. 23), at random among equals.
    pub(super) fn highest<R: Rng>(&self, lambda: f64, area: f64, rng: &mut R) -> usize {
        let ranks = self.groups.iter().flat_map(|g| {
            let small = (1.0 - lambda) * (1.0 - g.extent.area() / area);
            [(small + lambda, &g.inside), (small, &g.boundary)]
        });
        let ranks = ranks.filter(|(_, items)| !items.is_empty());
        let highest = (ranks.clone())
            .map(|r| r.0)
            .fold(f64::NEG_INFINITY, f64::max);
        let equal = ranks.filter(|r| r.0 == highest).map(|r| r.1);
        let count: usize = equal.clone().map(Vec::len).sum();
        let mut at = rng.random_range(0..count);
        for items in equal {
            match items.get(at) {
                Some(&item) => return item as usize,
                None => at -= items.len(),
            }
        }
        0
    }

    /// The grid that a new element of another label joins, or a new one.
    pub(super) fn grid_of(&self, element: &Element) -> u32 {
        let similar = |group: &Group| {
            let first = group.boundary.first().or(group.inside.first());
            first.is_some_and(|&i| {
                let (own, new) = (&self.items[i as usize].element, element);
                let near = |a: f64, b: f64| a / b < SAME_SIZE && b / a < SAME_SIZE;
                own.class == new.class
                    && near(own.rect.width, new.rect.width)
                    && near(own.rect.height, new.rect.height)
            })
        };
        let known = self.groups.iter().position(similar);
        known.map_or(self.grids(), |grid| grid as u32)
    }

    /// Distance of the nearest element of the same grid on the seed's line, on the side that is not `forward`.
    pub(super) fn opposite(&self, seed: &Item, axis: usize, forward: bool) -> Option<f64> {
        let (across, size) = (1 - axis, seed.size());
        let tolerance = SAME_LINE * size[across];
        let strip = (
            seed.centre[across] - tolerance,
            seed.centre[across] + tolerance,
        );
        let distance = |i: u32| {
            let item = &self.items[i as usize];
            let ahead = seed.centre[axis] - item.centre[axis];
            let distance = if forward { ahead } else { -ahead };
            let aligned = (item.centre[across] - seed.centre[across]).abs() < tolerance;
            let counts = item.grid == seed.grid && aligned && distance > SAME_LINE * size[axis];
            counts.then_some(distance)
        };
        let side = (axis, !forward);
        self.places.next(side, seed.centre[axis], strip, distance)
    }

    /// The nearest centre of an element within reach along an axis, else the value itself.
    pub(super) fn snapped(&self, value: f64, axis: usize, reach: f64) -> f64 {
        let centres = &self.centres[axis];
        let after = centres.partition_point(|c| *c < value);
        let below = after.checked_sub(1).map(|i| centres[i]);
        let near = below.into_iter().chain(centres.get(after).copied());
        let near = near.filter(|c| (c - value).abs() < reach);
        let nearest = near.min_by(|a, b| (a - value).abs().total_cmp(&(b - value).abs()));
        nearest.unwrap_or(value)
    }
}
