//! Structure candidate generation (Sec. 5): policies that add one element at a time, optimized by a genetic
//! algorithm.
//!
//! A state is a layout; an action extends a seed element by a new one; nothing is moved or deleted. A
//! [`Policy`] λ0..λ10 draws actions ([`grow`]); a candidate is complete when [`FAILURES`] actions in a row find
//! no place. Its reward is its score ([`super::score`]). For each facade [`optimize`] evolves λ so that the mean
//! reward (Eq. 24) is greatest, from policies learnt on the database, and returns the best candidates of all.
//!
//! | λ | meaning |
//! | --- | --- |
//! | 0 | probability of a random seed; else one of highest rank `λ1 [inside its grid] + (1 - λ1)(1 - A(g) / A(F))` (Eq. 23) |
//! | 2 | probability of a random direction; else in the order of permutation λ3 of left, right, up, down, concave fill |
//! | 4 | probability of the seed's label; else an observed one (λ5), one of the database (λ6) or an empty place |
//! | 7, 8 | probability of the opposite neighbour's spacing, of an observed one; else observed plus an offset |
//! | 9 | probability of snapping to other elements; 10: of a mirror image of the seed in place of an extension |
//!
//! # Deviations and readings
//! - λ3 is one gene of 120 values; λ5 + λ6 and λ7 + λ8 are divided by their sum where it is above 1.
//! - Ties in rank are broken at random. A direction that fails falls to the next of its order.
//! - Concave fill: any of the four directions, as long as the new centre is inside the grid's box.
//! - A copied label copies the seed's size; other labels come with the size of an observed element, or of one of the
//!   database relative to the mean window. One of the database that would be in a grid with an observed element is the same
//!   label and has its size. Labels of the database are drawn with the probabilities of the global consistency set of what is
//!   observed (Sec. 4.3). Without observed spacings the database's ratio of spacing to
//!   size serves. The random offset has a standard deviation of a tenth of the spacing; snapping
//!   reaches 0.3 of the size. An empty place blocks, and may be extended.
//! - γ = 1 and a reward only at the end: its value does not matter.
//!
//! Complexity of a candidate of n elements: items are found by place, so that an action costs about the same
//! however many there are; its score n log n.

mod grow;
mod growing;
mod model;
mod optimize;
mod problem;
mod process;
mod ranked;
mod tried;

pub use grow::grow;
pub use model::{PaperModel, WEIGHTS, weight_states};
pub use optimize::{Budget, Found, optimize};
pub use problem::CompletionProblem;
pub use process::{Growth, rollouts};
pub use ranked::ranked_weights;

use std::borrow::Cow;

use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

use super::completion::{Completed, Completion, Reason};
use super::layout::Element;
use super::model::Model;
use super::partial::PartialLayout;
use edifice_base::rng::Stream;
use edifice_base::unwatched;

/// Consecutive failed actions that end a candidate.
pub const FAILURES: usize = 40;
/// Number of parameters.
pub const PARAMETERS: usize = 11;
/// Standard deviation of a mutation.
const MUTATION: f64 = 0.2;

/// The parameters λ0..λ10, each from 0 to 1; λ3 counts permutations in 120ths.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Policy(pub [f64; PARAMETERS]);

/// The direction in which an action extends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// Along an axis (0: x, 1: y), forward or backward.
    Along(usize, bool),
    /// Within the box of the seed's grid.
    Concave,
}

impl Policy {
    /// A policy that a user might write down (Fig. 8, right): continue grids with their own spacing.
    pub const FIXED: Self = Self([0.5, 0.5, 0.5, 0.0, 0.9, 0.5, 0.3, 0.6, 0.3, 0.5, 0.05]);

    /// A policy with every parameter drawn uniformly from 0 to 1.
    pub fn random<R: Rng>(rng: &mut R) -> Self {
        Self(std::array::from_fn(|_| rng.random()))
    }

    /// Each parameter from one of the parents (Sec. 5.2).
    pub fn cross<R: Rng>(&self, other: &Self, rng: &mut R) -> Self {
        Self(std::array::from_fn(|i| {
            if rng.random() { self.0[i] } else { other.0[i] }
        }))
    }

    /// A Gaussian offset of one parameter (Sec. 5.2), reflected into 0 to 1.
    pub fn mutate<R: Rng>(&mut self, rng: &mut R) {
        let value = &mut self.0[rng.random_range(0..PARAMETERS)];
        let moved = (*value + MUTATION * rng.sample::<f64, _>(StandardNormal)).rem_euclid(2.0);
        *value = if moved > 1.0 { 2.0 - moved } else { moved };
    }

    /// The order in which directions are tried.
    fn directions<R: Rng>(&self, rng: &mut R) -> [Direction; 5] {
        let mut left = [
            Direction::Along(0, false),
            Direction::Along(0, true),
            Direction::Along(1, true),
            Direction::Along(1, false),
            Direction::Concave,
        ];
        let mut code = match rng.random::<f64>() < self.0[2] {
            true => rng.random_range(0..120),
            false => ((self.0[3] * 120.0) as usize).min(119),
        };
        for i in 0..4 {
            let rest = 5 - i;
            left.swap(i, i + code % rest);
            code /= rest;
        }
        left
    }

    /// Draws one of three options: 0 with probability λ_i, 1 with λ_j (both divided by their sum where that is
    /// above 1), else 2.
    fn option<R: Rng>(&self, i: usize, j: usize, rng: &mut R) -> usize {
        let sum = (self.0[i] + self.0[j]).max(1.0);
        let at = rng.random::<f64>() * sum;
        if at < self.0[i] {
            0
        } else if at < self.0[i] + self.0[j] {
            1
        } else {
            2
        }
    }
}

/// The paper's part of a model. One that was not learnt is learnt from the model's layouts as far as it is
/// quick: densities, with weights of 1 and no initial policies.
pub fn paper_model(model: &Model) -> Option<Cow<'_, PaperModel>> {
    match &model.paper {
        Some(paper) => Some(Cow::Borrowed(paper)),
        None => {
            let paper = PaperModel::of_densities(&model.layouts(), 0);
            paper.ok().map(Cow::Owned)
        }
    }
}

/// Completions by the paper's method, 10,000 candidates, the best `count` of different score; the mass of each
/// is the share of candidates that have its score. Without a database nothing is added.
pub fn complete(
    partial: &PartialLayout,
    model: &Model,
    count: usize,
    rng: &mut Stream,
) -> Vec<Completion> {
    let found = paper_model(model).and_then(|paper| {
        let problem = CompletionProblem::new(&paper, partial);
        optimize(
            &problem,
            &Budget::PAPER,
            count.max(1),
            rng.random(),
            &unwatched,
        )
        .ok()
    });
    let Some(found) = found else {
        return vec![added(Vec::new(), Reason::Policy, 0.0, 1.0)];
    };
    let share = |times: usize| times as f64 / found.made as f64;
    let candidates = found.candidates.into_iter();
    let completions = candidates.map(|c| added(c.added, Reason::Policy, c.score, share(c.times)));
    completions.collect()
}

/// A completion without probabilities.
pub(super) fn added(elements: Vec<Element>, reason: Reason, score: f64, mass: f64) -> Completion {
    let completed = elements.into_iter().map(|element| Completed {
        element,
        probability: 1.0,
        reason,
    });
    Completion {
        added: completed.collect(),
        score,
        mass,
    }
}
