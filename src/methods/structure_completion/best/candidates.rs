//! Candidate elements: every distinct element of the pool, how much of the pool supports it, and its features.

use super::fill::typical_gap;
use super::observation::{Observation, of};
use super::pool::{Draw, Origin};
use super::votes::Votes;
use crate::completion::Reason;
use crate::layout::lines::LatticeLine;
use crate::layout::{Class, Element};
use edifice_model::boosting::Boosting;

/// Elements of the pool this alike are one candidate.
const SAME: f64 = 0.8;
/// Number of features of a candidate.
pub const FEATURES: usize = 46;
/// The same in model files of before votes were counted: the first ones of a candidate.
pub const FEATURES_BEFORE: usize = 44;

/// A candidate element.
#[derive(Debug, Clone)]
pub struct Candidate {
    /// The element.
    pub element: Element,
    /// Share of the layouts of each origin that have an element like it (in the order of [`Origin::ALL`]).
    pub support: [f64; Origin::ALL.len()],
    /// Why most layouts have it.
    pub reason: Reason,
    /// Features for its probability.
    pub features: Vec<f64>,
}

/// The candidates of a pool, and which candidates each layout has.
pub struct Candidates {
    /// All candidates.
    pub all: Vec<Candidate>,
    /// For each layout of the pool, its candidates.
    pub of_draw: Vec<Vec<usize>>,
    /// For each candidate those like it (itself among them), with how alike they are, 0 to 1.
    pub alike: Vec<Vec<(usize, f64)>>,
    index: Index,
}

/// Likeness of two elements: from 0 at an intersection over union of 0.35 to 1 at 0.65.
fn likeness(iou: f64) -> f64 {
    ((iou - 0.35) / 0.3).clamp(0.0, 1.0)
}

impl Candidates {
    /// Collects the candidates of a pool.
    pub fn new(observation: &Observation, draws: &[Draw]) -> Self {
        let (mut elements, mut reasons): (Vec<Element>, Vec<Reason>) = (Vec::new(), Vec::new());
        let mut index = Index::new(observation);
        let mut of_draw = Vec::with_capacity(draws.len());
        for draw in draws {
            let mut own = Vec::with_capacity(draw.added.len());
            for (element, reason) in &draw.added {
                let near = index.near(element);
                let same = near.into_iter().find(|&c| {
                    elements[c].class == element.class && elements[c].rect.iou(&element.rect) > SAME
                });
                let candidate = same.unwrap_or_else(|| {
                    elements.push(*element);
                    reasons.push(*reason);
                    index.insert(element, elements.len() - 1);
                    elements.len() - 1
                });
                own.push(candidate);
            }
            own.sort_unstable();
            own.dedup();
            of_draw.push(own);
        }
        let alike: Vec<Vec<(usize, f64)>> = elements
            .iter()
            .map(|a| {
                let near = index.near(a).into_iter();
                let alike = near.filter(|&c| elements[c].class == a.class);
                let pairs = alike.map(|c| (c, likeness(elements[c].rect.iou(&a.rect))));
                pairs.filter(|(_, alike)| *alike > 0.0).collect()
            })
            .collect();
        let mut support = vec![[0.0; Origin::ALL.len()]; elements.len()];
        let mut best = vec![0.0; elements.len()];
        for (draw, own) in draws.iter().zip(&of_draw) {
            let origin = draw.origin as usize;
            for (candidate, share) in supported(own, &alike, &mut best) {
                support[candidate][origin] += draw.weight * share;
            }
        }
        let all = elements
            .iter()
            .zip(support)
            .zip(&reasons)
            .map(|((element, support), reason)| Candidate {
                element: *element,
                support,
                reason: *reason,
                features: Vec::new(),
            });
        let mut candidates = Self {
            all: all.collect(),
            of_draw,
            alike,
            index,
        };
        candidates.add_features(observation);
        candidates
    }

    /// Candidates that may overlap an element.
    pub fn near(&self, element: &Element) -> Vec<usize> {
        self.index.near(element)
    }

    /// Probability of each candidate by boosted trees over all features, or over those of before.
    pub fn probabilities(&self, learnt: &Boosting) -> Vec<f64> {
        let all = self.all.iter();
        all.map(|c| learnt.probability(&c.features)).collect()
    }

    /// Adds a candidate that no draw has.
    pub fn add(&mut self, element: Element, reason: Reason) {
        self.alike.push(vec![(self.all.len(), 1.0)]);
        self.index.insert(&element, self.all.len());
        self.all.push(Candidate {
            element,
            support: [0.0; Origin::ALL.len()],
            reason,
            features: Vec::new(),
        });
    }

    fn add_features(&mut self, observation: &Observation) {
        let context = Context::new(observation);
        let total = |c: &Candidate| c.support[..5].iter().sum::<f64>();
        let rows: Vec<Vec<f64>> = self
            .all
            .iter()
            .map(|candidate| {
                // The strongest candidate that cannot stand beside it, unless it is much the same.
                let rivals = self
                    .index
                    .near(&candidate.element)
                    .into_iter()
                    .filter(|&other| {
                        let other = &self.all[other].element;
                        other.excludes(&candidate.element)
                            && other.rect.iou(&candidate.element.rect) < 0.5
                    });
                let rival = rivals
                    .map(|other| total(&self.all[other]))
                    .fold(0.0, f64::max);
                context.features(candidate, rival)
            })
            .collect();
        for (candidate, features) in self.all.iter_mut().zip(rows) {
            candidate.features = features;
        }
    }
}

/// Candidates like one of a layout's own, each with the largest likeness; `best` is all zeros before and after.
pub fn supported(
    own: &[usize],
    alike: &[Vec<(usize, f64)>],
    best: &mut [f64],
) -> Vec<(usize, f64)> {
    let mut touched = Vec::new();
    for &candidate in own {
        for &(other, share) in &alike[candidate] {
            if best[other] == 0.0 {
                touched.push(other);
            }
            best[other] = best[other].max(share);
        }
    }
    touched
        .into_iter()
        .map(|c| (c, std::mem::take(&mut best[c])))
        .collect()
}

/// Elements by the place of their centre.
struct Index {
    cell: (f64, f64),
    columns: usize,
    rows: usize,
    cells: Vec<Vec<usize>>,
    /// Elements wider or higher than a cell, which may be far from those they overlap.
    large: Vec<usize>,
}

impl Index {
    fn new(observation: &Observation) -> Self {
        let (width, height) = (observation.partial.width, observation.partial.height);
        // At most 128 cells along an axis, however small a window is.
        let cell = (
            (1.2 * observation.size.0).max(width / 128.0),
            (1.2 * observation.size.1).max(height / 128.0),
        );
        let columns = (width / cell.0) as usize + 1;
        let rows = (height / cell.1) as usize + 1;
        Self {
            cell,
            columns,
            rows,
            cells: vec![Vec::new(); columns * rows],
            large: Vec::new(),
        }
    }

    fn place(&self, element: &Element) -> (usize, usize) {
        let (x, y) = element.rect.centre();
        let column = (x / self.cell.0).max(0.0) as usize;
        let row = (y / self.cell.1).max(0.0) as usize;
        (column.min(self.columns - 1), row.min(self.rows - 1))
    }

    fn is_large(&self, element: &Element) -> bool {
        element.rect.width > 1.6 * self.cell.0 || element.rect.height > 1.6 * self.cell.1
    }

    fn insert(&mut self, element: &Element, number: usize) {
        if self.is_large(element) {
            self.large.push(number);
        } else {
            let (column, row) = self.place(element);
            self.cells[row * self.columns + column].push(number);
        }
    }

    /// Elements that may overlap this one.
    fn near(&self, element: &Element) -> Vec<usize> {
        let mut near = self.large.clone();
        let (column, row) = self.place(element);
        let (dx, dy) = match self.is_large(element) {
            true => {
                let across = (element.rect.width / self.cell.0 / 2.0) as usize + 2;
                (
                    across,
                    (element.rect.height / self.cell.1 / 2.0) as usize + 2,
                )
            }
            false => (1, 1),
        };
        for r in row.saturating_sub(dy)..=(row + dy).min(self.rows - 1) {
            for c in column.saturating_sub(dx)..=(column + dx).min(self.columns - 1) {
                near.extend(&self.cells[r * self.columns + c]);
            }
        }
        near
    }
}

/// The quantities of an observation that the features of all its candidates have in common.
struct Context<'a> {
    observation: &'a Observation<'a>,
    /// Observed elements by class, for each observed window.
    per_window: [f64; 4],
    hidden: f64,
    masked: f64,
    /// Typical distance of rows.
    gap: f64,
    votes: Votes,
}

impl<'a> Context<'a> {
    fn new(observation: &'a Observation<'a>) -> Self {
        let windows = of(&observation.elements, Class::Window).count().max(1) as f64;
        let per_window =
            Class::ALL.map(|class| of(&observation.elements, class).count() as f64 / windows);
        let facade = observation.partial.width * observation.partial.height;
        let hidden = observation
            .partial
            .unknown
            .as_ref()
            .map(|unknown| unknown.iter().map(|r| r.area()).sum::<f64>() / facade);
        Self {
            observation,
            per_window,
            hidden: hidden.unwrap_or(1.0),
            masked: f64::from(u8::from(hidden.is_some())),
            gap: typical_gap(&observation.rows).unwrap_or(1.8 * observation.size.1),
            votes: Votes::new(observation),
        }
    }

    fn features(&self, candidate: &Candidate, rival: f64) -> Vec<f64> {
        let observation = self.observation;
        let (class, r) = (candidate.element.class, candidate.element.rect);
        let (x, y) = r.centre();
        let (width, height) = (observation.partial.width, observation.partial.height);
        let (column, row) = (
            nearest(&observation.columns, x, observation.size.0),
            nearest(&observation.rows, y, observation.size.1),
        );
        let same: Vec<(f64, f64)> = of(&observation.elements, class)
            .map(|e| e.rect.centre())
            .collect();
        let in_row = same.iter().filter(|c| (c.1 - y).abs() < 0.35 * r.height);
        let in_column = same.iter().filter(|c| (c.0 - x).abs() < 0.35 * r.width);
        let nearest_in_row = in_row
            .clone()
            .map(|c| (c.0 - x).abs() / r.width)
            .fold(20.0, f64::min);
        let nearest_in_column = in_column
            .clone()
            .map(|c| (c.1 - y).abs() / r.height)
            .fold(20.0, f64::min);
        let (columns, rows) = (
            observation.columns.len().max(1) as f64,
            observation.rows.len().max(1) as f64,
        );
        let (row_share, column_share) = (
            in_row.clone().count() as f64 / columns,
            in_column.clone().count() as f64 / rows,
        );
        let lowest = observation.rows.first().map_or(height / 2.0, |l| l.at);
        let windows_beside =
            of(&observation.elements, Class::Window).filter(|w| w.rect.overlap(&r) > 0.0);
        let mean = candidate.support[..5].iter().sum::<f64>() / 5.0;
        let mut features = candidate.support.to_vec();
        features.extend([
            mean,
            rival / 5.0,
            f64::from(class as u8),
            self.masked,
            self.hidden,
            column.0,
            column.1,
            row.0,
            row.1,
            in_row.count() as f64,
            in_column.count() as f64,
            nearest_in_row,
            nearest_in_column,
            y / height,
            y / observation.size.1,
            (x - width / 2.0).abs() / width,
            r.width / observation.size.0,
            r.height / observation.size.1,
            observation.seen,
            observation.elements.len() as f64,
            self.per_window[class.index()],
            windows_beside.count() as f64,
            r.y / r.height,
            observation.columns.len() as f64,
            observation.rows.len() as f64,
            row_share,
            column_share,
            row_share * column_share / observation.seen.max(0.05),
            (lowest - y) / self.gap,
            lowest / self.gap,
            self.per_window[Class::Door.index()],
            self.per_window[Class::Balcony.index()],
            self.per_window[Class::Shop.index()],
            observation.size.0 / observation.size.1,
            observation.size.0 / width,
            observation.size.1 / height,
            candidate.support.iter().copied().fold(0.0, f64::max),
        ]);
        features.extend(self.votes.at(x, y));
        debug_assert_eq!(features.len(), FEATURES);
        features
    }
}

/// Distance to the nearest line in units of `size`, at most 5, and the number of elements on it.
fn nearest(lines: &[LatticeLine], at: f64, size: f64) -> (f64, f64) {
    let near = lines
        .iter()
        .min_by(|a, b| (a.at - at).abs().total_cmp(&(b.at - at).abs()));
    near.map_or((5.0, 0.0), |line| {
        (((line.at - at).abs() / size).min(5.0), line.count as f64)
    })
}
