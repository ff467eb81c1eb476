//! Completion as a decision process (Eq. 21 and 22) for approximate dynamic programming.
//!
//! States are layouts, actions add an element or end the walk, and the cost of ending is the score, less. The
//! policy is the heuristic; the value of a state is approximated by rollouts: the best of some
//! actions, each followed by a few walks of the policy.

use rand::Rng;

use super::grow::next;
use super::growing::Growing;
use super::problem::Item;
use super::tried::Tried;
use super::{CompletionProblem, Policy};
use crate::layout::Element;
use edifice_base::rng::{Stream, stream};
use edifice_optim::adp::{Adp, AdpError, Approximation, Epsilon, Heuristic, Process};

/// Completion of one partial layout.
pub struct Growth<'a>(pub &'a CompletionProblem<'a>);

/// An action: a new element or empty place, or the end.
#[derive(Debug, Clone)]
pub struct Action(Option<Item>);

/// A layout, and whether it is complete.
pub struct Walk {
    growing: Growing,
    complete: bool,
}

impl Growth<'_> {
    fn loss(&self, growing: &Growing) -> f64 {
        -self.0.score(&growing.elements())
    }
}

impl Process for Growth<'_> {
    type State = Walk;
    type Action = Action;

    fn initial(&self) -> Walk {
        Walk {
            growing: Growing::new(self.0),
            complete: false,
        }
    }

    fn is_final(&self, state: &Walk) -> bool {
        state.complete
    }

    fn cost(&self, state: &Walk, action: &Action) -> f64 {
        match action.0 {
            Some(_) => 0.0,
            None => self.loss(&state.growing),
        }
    }

    fn apply(&self, state: &mut Walk, action: &Action) {
        match action.0 {
            Some(item) => state.growing.add(item),
            None => state.complete = true,
        }
    }
}

impl Heuristic<Growth<'_>> for Policy {
    fn sample<R: Rng>(&mut self, process: &mut Growth<'_>, state: &Walk, rng: &mut R) -> Action {
        let tried = &mut Tried::default();
        Action(next(process.0, &state.growing, tried, self, rng))
    }
}

/// The value of a state by rollouts of a policy.
struct Rollouts {
    policy: Policy,
    actions: usize,
    walks: usize,
    rng: Stream,
}

impl Approximation<Growth<'_>> for Rollouts {
    fn best(&mut self, process: &mut Growth<'_>, state: &Walk) -> Option<Action> {
        let mut best: Option<(f64, Action)> = None;
        for _ in 0..self.actions {
            let step = self.policy.sample(process, state, &mut self.rng);
            let Some(item) = step.0 else {
                return Some(step);
            };
            for _ in 0..self.walks {
                let (mut growing, mut tried) = (state.growing.clone(), Tried::default());
                growing.add(item);
                let (problem, policy, rng) = (process.0, &self.policy, &mut self.rng);
                while let Some(item) = next(problem, &growing, &mut tried, policy, rng) {
                    growing.add(item);
                }
                let loss = process.loss(&growing);
                if best.as_ref().is_none_or(|(least, _)| loss < *least) {
                    best = Some((loss, step.clone()));
                }
            }
        }
        best.map(|(_, step)| step)
    }

    /// Rollouts start anew in every state.
    fn learn(&mut self, _: &mut Growth<'_>, _: &[Action], _: &[f64]) {}
}

/// Completes by `iterations` walks of approximate dynamic programming, which explore by the policy and exploit
/// rollouts of it; returns the added elements and the score.
///
/// # Errors
/// [`AdpError`] without iterations.
pub fn rollouts(
    problem: &CompletionProblem,
    policy: Policy,
    iterations: u64,
    seed: u64,
) -> Result<(Vec<Element>, f64), AdpError> {
    let approximation = Rollouts {
        policy,
        actions: 3,
        walks: 2,
        rng: stream(seed, "rollouts", 0),
    };
    let adp = Adp::new(policy, approximation, Epsilon::default(), iterations, seed);
    let run = adp.run(&mut Growth(problem), |_| {})?;
    let items = run.best.iter().filter_map(|step| step.0.as_ref());
    let added = items.filter(|i| !i.empty).map(|i| i.element);
    Ok((added.collect(), -run.cost))
}
