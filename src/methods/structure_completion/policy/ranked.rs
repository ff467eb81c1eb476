//! Weights that rank completions.
//!
//! Eq. 20 takes completions of facades of the database as negatives. As an ascent it has no fixed point where the truth is
//! beaten by its best completion (a maximum is no sample). Here the same negatives are the alternatives of a choice: of a facade, a part of
//! which is hidden, the candidates C are completions by random policies, by policies optimized under the weights so far, and by
//! simulated annealing under them, which finds the holes and heaps that a score should not prefer. The weights maximize
//!
//! ```text
//! mean over facades and tasks of  w · f(x) - ln(exp(w · f(x)) + Σ_{c in C} exp(w · f(c)))  -  λ / 2 Σ_k (s_k (w_k - 1))²,   w >= 0
//! ```
//!
//! with f and w of ten values, s_k the standard deviation of feature k over the whole layouts, and λ = 0.2. The first part is the
//! logarithm of Eq. 15 restricted to the whole layout x and its candidates. The sum is concave; it is climbed by Newton steps whose
//! expectations are sampled. Densities that
//! score a facade are learnt without it and its neighbours in the order of names, often of one street: in the densities of all, each facade is
//! typical in every respect, and terms would count that only remember the facades.

use rand::RngExt;
use rand::seq::SliceRandom;
use rand_distr::Distribution;
use rand_distr::weighted::WeightedIndex;
use rayon::prelude::*;

use super::grow::grow;
use super::optimize::{Budget, optimize};
use super::{CompletionProblem, PaperModel, Policy};
use crate::annealing::{self, anneal};
use crate::layout::{Element, Layout};
use crate::partial::PartialLayout;
use crate::score::{TERMS, from_prior};
use crate::task::Task;
use edifice_base::rng::{Stream, stream};
use edifice_base::{Progress, Watch, Watched};
use edifice_model::ModelError;
use edifice_model::factor_graph::Settings;
use edifice_model::log_linear::LogLinear;

/// Parts of the database whose densities are learnt from the others.
const FOLDS: usize = 5;
/// Facades with a task that weights are learnt from.
const CHOICES: usize = 150;
/// Candidates of random policies.
const RANDOM: usize = 40;
/// Rounds in which candidates are sought under the weights so far; candidates of optimized policies that each adds.
const ROUNDS: usize = 3;
const OPTIMIZED: usize = 10;
/// Evaluations of an annealing.
const ANNEALED: u64 = 2000;
/// Settings of the ascent.
const ASCENT: Settings = Settings {
    rounds: 200,
    moves: 1,
    persistent: false,
    rate: 0.3,
    decay: 30.0,
    penalty: 0.2,
    newton: true,
    temperatures: 1,
};

/// A facade of which a part is hidden, with the features of its candidates, the whole layout first.
struct Choice<'a> {
    problem: CompletionProblem<'a>,
    partial: PartialLayout,
    candidates: Vec<[f64; TERMS]>,
}

impl Choice<'_> {
    fn add(&mut self, elements: &[Element]) {
        let model = &self.problem.model.score;
        let evaluation = model.evaluate(self.problem.facade, elements);
        self.candidates.push(evaluation.features);
    }

    fn add_completion(&mut self, added: Vec<Element>) {
        let mut elements = self.partial.observed.clone();
        elements.extend(added);
        self.add(&elements);
    }

    /// Adds candidates of random policies.
    fn draw(&mut self, rng: &mut Stream) {
        for _ in 0..RANDOM {
            let elements = grow(&self.problem, &Policy::random(rng), rng);
            self.add(&elements);
        }
    }

    /// Adds the candidates that score best under some weights.
    fn seek(&mut self, weights: [f64; TERMS], rng: &mut Stream, watch: &Watch) {
        self.problem.weights = weights;
        let settings = annealing::Settings {
            evaluations: ANNEALED,
            ..annealing::Settings::default()
        };
        let annealed = anneal(&self.problem, &self.partial, &settings, rng.random());
        let found = optimize(
            &self.problem,
            &Budget::SMALL,
            OPTIMIZED,
            rng.random(),
            watch,
        );
        let found = found.map(|found| found.candidates).unwrap_or_default();
        let added = found.into_iter().map(|candidate| candidate.added);
        for added in annealed.map(|(added, _)| added).into_iter().chain(added) {
            self.add_completion(added);
        }
    }

    /// Draws a candidate with a probability that is proportional to `exp(w · f)`.
    fn sample(&self, weights: &[f64; TERMS], rng: &mut Stream) -> usize {
        let score = |f: &[f64; TERMS]| weights.iter().zip(f).map(|(w, f)| w * f).sum::<f64>();
        let scores: Vec<f64> = self.candidates.iter().map(score).collect();
        let most = scores.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let probabilities = scores.iter().map(|score| (score - most).exp());
        // Scores are finite, so that the greatest has a probability.
        WeightedIndex::new(probabilities).map_or(0, |all| all.sample(rng))
    }
}

/// Number of the part of the database that a facade belongs to.
fn fold(facade: usize, facades: usize) -> usize {
    facade * FOLDS.min(facades) / facades
}

/// Learns the weights from whole layouts, as the page of the module says; of one layout alone they are 1. Stopped by `watch`, they are
/// those of the rounds until then.
///
/// # Errors
/// As [`PaperModel::of_densities`]; [`ModelError::Parameter`] where weights diverge.
pub fn ranked_weights(
    layouts: &[&Layout],
    seed: u64,
    watch: &Watch,
) -> Result<[f64; TERMS], ModelError> {
    let mut weights = [1.0; TERMS];
    let mut chosen = layouts.to_vec();
    chosen.truncate(CHOICES);
    chosen.sort_by(|a, b| a.name.cmp(&b.name));
    if chosen.len() < 2 {
        return Ok(weights);
    }
    let watched = Watched::new(watch);
    // None once it was stopped.
    let others = |out: usize| {
        if !watched.goes_on(Progress::stage("densities of folds")) {
            return Ok(None);
        }
        let rest = (0..chosen.len()).filter(|&i| fold(i, chosen.len()) != out);
        let rest: Vec<Layout> = rest.map(|i| chosen[i].clone()).collect();
        PaperModel::of_densities(&rest, seed).map(Some)
    };
    let models = (0..FOLDS.min(chosen.len())).map(others);
    let models = models.collect::<Result<Option<Vec<PaperModel>>, ModelError>>()?;
    let Some(models) = models else {
        return Ok(weights);
    };
    // Each facade with as many of the tasks as there is room for.
    let mut pairs: Vec<(usize, Task)> = (0..chosen.len())
        .flat_map(|i| Task::ALL.map(|task| (i, task)))
        .collect();
    pairs.shuffle(&mut stream(seed, "choices", 0));
    pairs.truncate(CHOICES);
    let choice = |(number, &(i, task)): (usize, &(usize, Task))| {
        let mut rng = stream(seed, "choice", number as u64);
        let (partial, _) = task.hide(chosen[i], &mut rng);
        let mut choice = Choice {
            problem: CompletionProblem::new(&models[fold(i, chosen.len())], &partial),
            partial,
            candidates: Vec::new(),
        };
        choice.add(&chosen[i].elements);
        if watched.goes_on(Progress::stage("random candidates")) {
            choice.draw(&mut rng);
        }
        choice
    };
    let mut choices: Vec<Choice> = pairs.par_iter().enumerate().map(choice).collect();
    for round in 0..ROUNDS {
        if !watched.goes_on(Progress::of("weights", round as u64, ROUNDS as u64)) {
            break;
        }
        choices
            .par_iter_mut()
            .enumerate()
            .for_each(|(number, choice)| {
                let mut rng = stream(seed, "candidates", (round * CHOICES + number) as u64);
                if watched.goes_on(Progress::of("weights", round as u64, ROUNDS as u64)) {
                    choice.seek(weights, &mut rng, &watched.inner());
                }
            });
        if watched.is_stopped() {
            break;
        }
        weights = fitted(&choices, seed, &watched.inner())?;
    }
    Ok(weights)
}

/// The weights of the greatest likelihood of the whole layouts among their candidates.
fn fitted(choices: &[Choice], seed: u64, watch: &Watch) -> Result<[f64; TERMS], ModelError> {
    // A choice, and the candidate that is chosen.
    let data: Vec<(usize, usize)> = (0..choices.len()).map(|at| (at, 0)).collect();
    let features = |state: &(usize, usize)| choices[state.0].candidates[state.1].to_vec();
    let step = |state: &mut (usize, usize), weights: &[f64], rng: &mut Stream| {
        state.1 = choices[state.0].sample(&from_prior(weights), rng);
    };
    let fitted = LogLinear::new(TERMS, features, step)
        .at_least(-1.0)
        .fit(&data, &ASCENT, seed, watch)?;
    Ok(from_prior(&fitted.weights))
}
