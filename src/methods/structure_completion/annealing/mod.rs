//! Completion by simulated annealing, the baseline of Fig. 14.
//!
//! Moves (Sec. 6): add an element at a random place, delete an added element, move an added element by a
//! Gaussian offset. Classes and sizes are those of observed elements and of the database; observed
//! elements stay. The score is updated for the changed element only ([`Scored`]).

use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

use super::completion::{Completion, Reason};
use super::layout::Element;
use super::model::Model;
use super::partial::PartialLayout;
use super::policy::{CompletionProblem, added, paper_model};
use super::score::{Change, Scored};
use edifice_base::rng::Stream;
use edifice_optim::annealing::{Annealing, AnnealingError, Cooling, Landscape};
use edifice_shape::Rect;

/// Standard deviation of a move, in sizes of the element.
const OFFSET: f64 = 0.3;

/// Settings: tuned on facades of the database by the score reached.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Number of evaluations.
    pub evaluations: u64,
    /// First and last temperature, in units of the score.
    pub cooling: Cooling,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            evaluations: 100_000,
            cooling: Cooling {
                start: 2.0,
                end: 0.02,
            },
        }
    }
}

/// The landscape of completions: lower is better, the cost being the score, less.
struct Completions<'a> {
    problem: &'a CompletionProblem<'a>,
    partial: &'a PartialLayout,
    scored: Scored<'a>,
    observed: usize,
}

impl Completions<'_> {
    fn fits(&self, element: &Element, but: usize) -> bool {
        let others = self.scored.elements().iter().enumerate();
        self.partial.allows(element)
            && others
                .skip(self.observed)
                .all(|(i, e)| i == but || !e.excludes(element))
    }

    /// An element of an observed or known class and size at a random place.
    fn random_element<R: Rng>(&self, rng: &mut R) -> Option<Element> {
        let (class, size) = self.problem.random_label(rng)?;
        let x = rng.random::<f64>() * (self.partial.width - size[0]).max(0.0);
        let y = rng.random::<f64>() * (self.partial.height - size[1]).max(0.0);
        Some(Element::new(class, Rect::new(x, y, size[0], size[1])))
    }

    fn random_change<R: Rng>(&self, rng: &mut R) -> Option<Change> {
        let count = self.scored.elements().len();
        let added = count - self.observed;
        let any = |rng: &mut R| self.observed + rng.random_range(0..added);
        match rng.random_range(0..4) {
            0 => {
                let element = self.random_element(rng)?;
                let fits = self.fits(&element, usize::MAX);
                fits.then_some(Change::Add(element))
            }
            _ if added == 0 => None,
            1 => Some(Change::Remove(any(rng))),
            _ => {
                let at = any(rng);
                let mut element = self.scored.elements()[at];
                let r = &mut element.rect;
                r.x += OFFSET * r.width * rng.sample::<f64, _>(StandardNormal);
                r.y += OFFSET * r.height * rng.sample::<f64, _>(StandardNormal);
                self.fits(&element, at).then_some(Change::Set(at, element))
            }
        }
    }
}

impl Landscape for Completions<'_> {
    type Solution = Vec<Element>;

    fn cost(&self) -> f64 {
        -self.scored.score()
    }
    fn propose<R: Rng>(&mut self, rng: &mut R) -> Option<f64> {
        let change = self.random_change(rng)?;
        Some(-self.scored.apply(change))
    }
    fn accept(&mut self) {}
    fn reject(&mut self) {
        self.scored.undo();
    }
    fn solution(&self) -> Vec<Element> {
        self.scored.elements()[self.observed..].to_vec()
    }
}

/// Anneals from the observed layout; returns the added elements and the score.
///
/// # Errors
/// [`AnnealingError`] for temperatures out of range.
pub fn anneal(
    problem: &CompletionProblem,
    partial: &PartialLayout,
    settings: &Settings,
    seed: u64,
) -> Result<(Vec<Element>, f64), AnnealingError> {
    let (model, observed) = (&problem.model.score, partial.observed.clone());
    let scored = Scored::weighted(model, problem.weights, problem.facade, observed);
    let mut landscape = Completions {
        problem,
        partial,
        scored,
        observed: partial.observed.len(),
    };
    let rounds = settings.evaluations.div_ceil(100);
    let annealing = Annealing::new(settings.cooling, rounds, 100, seed)?;
    let run = annealing.run(&mut landscape, |_| {})?;
    Ok((run.best, -run.cost))
}

/// The completion by simulated annealing with 100,000 evaluations; without a database nothing is added.
pub fn complete(partial: &PartialLayout, model: &Model, rng: &mut Stream) -> Vec<Completion> {
    let found = paper_model(model).and_then(|paper| {
        let problem = CompletionProblem::new(&paper, partial);
        anneal(&problem, partial, &Settings::default(), rng.random()).ok()
    });
    let (elements, score) = found.unwrap_or_default();
    vec![added(elements, Reason::Annealing, score, 1.0)]
}
