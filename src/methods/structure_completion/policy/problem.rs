//! The problem that a policy solves: the observed layout, its spacings, labels and grids.

use rand::seq::IndexedRandom;
use rand::{Rng, RngExt};
use rand_distr::Distribution;
use rand_distr::weighted::WeightedIndex;

use super::growing::Growing;
use super::model::{Exemplar, PaperModel};
use crate::layout::{Class, Element};
use crate::partial::PartialLayout;
use crate::score::grid::SIZE_STEP;
use crate::score::{TERMS, grids};

/// Bounding box of a grid as it grows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Extent {
    pub low: [f64; 2],
    pub high: [f64; 2],
}

/// An element of a candidate, or a place that stays empty.
#[derive(Debug, Clone, Copy)]
pub(super) struct Item {
    pub element: Element,
    pub centre: [f64; 2],
    /// Index of its grid.
    pub grid: u32,
    pub empty: bool,
}

/// A partial layout, prepared for candidates.
#[derive(Debug, Clone)]
pub struct CompletionProblem<'a> {
    /// The model that rewards and that knows the database.
    pub model: &'a PaperModel,
    /// Weights of the scoring functions; the model's unless changed.
    pub weights: [f64; TERMS],
    /// Extent of the facade.
    pub facade: [f64; 2],
    /// The part of the facade where elements may be added; without the observed elements, which are among the items.
    pub(super) open: PartialLayout,
    /// The observed layout.
    pub(super) start: Growing,
    /// Observed spacings along each axis.
    pub(super) spacings: [Vec<f64>; 2],
    /// Observed elements as (class, width, height), those of the database scaled to this facade.
    pub(super) observed: Vec<Exemplar>,
    database: Vec<Exemplar>,
    /// Probability of each label of the database beside what is observed, up to a constant; none of an empty database.
    weights_of_labels: Option<WeightedIndex<f64>>,
}

impl Extent {
    pub(super) fn of(element: &Element) -> Self {
        let r = element.rect;
        Self {
            low: [r.x, r.y],
            high: [r.right(), r.top()],
        }
    }

    pub(super) fn include(&mut self, element: &Element) {
        let other = Self::of(element);
        for axis in 0..2 {
            self.low[axis] = self.low[axis].min(other.low[axis]);
            self.high[axis] = self.high[axis].max(other.high[axis]);
        }
    }

    pub(super) fn area(&self) -> f64 {
        (self.high[0] - self.low[0]) * (self.high[1] - self.low[1])
    }

    /// True if an element is inside, and not on the boundary.
    pub(super) fn surrounds(&self, element: &Element) -> bool {
        let other = Self::of(element);
        (0..2).all(|axis| self.low[axis] < other.low[axis] && other.high[axis] < self.high[axis])
    }

    /// True if a point is inside.
    pub(super) fn holds(&self, at: [f64; 2]) -> bool {
        (0..2).all(|axis| self.low[axis] < at[axis] && at[axis] < self.high[axis])
    }
}

impl Item {
    pub(super) fn new(element: Element, grid: u32, empty: bool) -> Self {
        let (x, y) = element.rect.centre();
        Self {
            element,
            centre: [x, y],
            grid,
            empty,
        }
    }

    pub(super) fn size(&self) -> [f64; 2] {
        [self.element.rect.width, self.element.rect.height]
    }
}

impl CompletionProblem<'_> {
    /// The reward of a candidate.
    pub fn score(&self, elements: &[Element]) -> f64 {
        let features = self.model.score.evaluate(self.facade, elements).features;
        self.weights.iter().zip(features).map(|(w, f)| w * f).sum()
    }

    /// Class and size of an observed element or of one of the database, each with probability one half.
    pub fn random_label<R: Rng>(&self, rng: &mut R) -> Option<(Class, [f64; 2])> {
        let label = match rng.random::<bool>() && !self.observed.is_empty() {
            true => self.observed_label(rng),
            false => self.database_label(rng),
        };
        label.map(|e| (e.class, e.size))
    }

    /// A label that is observed.
    pub(super) fn observed_label<R: Rng>(&self, rng: &mut R) -> Option<&Exemplar> {
        self.observed.choose(rng)
    }

    /// A label of the database, from the global consistency set of what is observed (Sec. 4.3).
    pub(super) fn database_label<R: Rng>(&self, rng: &mut R) -> Option<&Exemplar> {
        let at = self.weights_of_labels.as_ref()?.sample(rng);
        self.database.get(at)
    }
}

impl<'a> CompletionProblem<'a> {
    /// Prepares a partial layout. Without observed elements nothing can be extended: candidates are empty.
    pub fn new(model: &'a PaperModel, partial: &PartialLayout) -> Self {
        let mut items = Vec::new();
        let mut spacings = [Vec::new(), Vec::new()];
        let facade = [partial.width, partial.height];
        let seen = grids(partial.width, &partial.observed);
        for (index, grid) in seen.iter().enumerate() {
            for &member in &grid.members {
                let element = partial.observed[member as usize];
                items.push(Item::new(element, index as u32, false));
            }
            for (axis, spacings) in spacings.iter_mut().enumerate() {
                spacings.extend(grid.lines[axis].windows(2).map(|w| w[1] - w[0]));
            }
        }
        let exemplar = |e: &Element| Exemplar {
            class: e.class,
            size: [e.rect.width, e.rect.height],
        };
        let observed: Vec<Exemplar> = partial.observed.iter().map(exemplar).collect();
        let windows = observed.iter().filter(|e| e.class == Class::Window);
        let of: Vec<&Exemplar> = match windows.clone().next() {
            Some(_) => windows.collect(),
            None => observed.iter().collect(),
        };
        let mean =
            |axis: usize| of.iter().map(|e| e.size[axis]).sum::<f64>() / of.len().max(1) as f64;
        let unit = [mean(0), mean(1)];
        let scaled = |e: &Exemplar| {
            let size = [e.size[0] * unit[0], e.size[1] * unit[1]];
            like_observed(e.class, size, &observed)
        };
        let database: Vec<Exemplar> = model.exemplars.iter().map(scaled).collect();
        let labels = database.iter().map(|e| (e.class, e.size));
        let weights = model.score.label_weights(facade, &seen, labels);
        // With no label of the set in the database, any.
        let any = vec![1.0; database.len()];
        let weights_of_labels = WeightedIndex::new(weights).or_else(|_| WeightedIndex::new(any));
        Self {
            model,
            weights: model.score.weights,
            facade,
            open: PartialLayout {
                observed: Vec::new(),
                ..partial.clone()
            },
            start: Growing::of_items(facade, items),
            spacings,
            observed,
            database,
            weights_of_labels: weights_of_labels.ok(),
        }
    }
}

/// A label of the database, with the size of the observed element that would be in a grid with it, if there is one: both are one
/// label. Of several it is the one of the nearest size.
fn like_observed(class: Class, size: [f64; 2], observed: &[Exemplar]) -> Exemplar {
    let step = |o: &Exemplar| {
        let along = |axis: usize| (o.size[axis] / size[axis]).ln().abs();
        along(0).max(along(1))
    };
    let near = observed
        .iter()
        .filter(|o| o.class == class && step(o) <= SIZE_STEP.ln());
    let near = near.min_by(|a, b| step(a).total_cmp(&step(b)));
    near.copied().unwrap_or(Exemplar { class, size })
}
