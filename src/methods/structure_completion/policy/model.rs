//! The model that the paper's method learns from a database: densities, weights, policies, labels and spacings.

use rand::RngExt;
use rand::seq::SliceRandom;
use serde::{Deserialize, Serialize};

use super::optimize::{Budget, optimize};
use super::ranked::ranked_weights;
use super::{CompletionProblem, PARAMETERS, Policy, grow};
use crate::layout::{Class, Layout};
use crate::partial::PartialLayout;
use crate::score::{ScoreModel, Sites, TERMS, Training, grids, learn_weights};
use crate::task::Task;
use edifice_base::rng::{Stream, stream};
use edifice_base::{Progress, Watch, Watched};
use edifice_model::ModelError;
use edifice_model::factor_graph::Settings;

/// Facades that policies are learnt on.
const POLICY_FACADES: usize = 12;
/// Larger facades are left out of these two where there are smaller ones.
const LARGEST: usize = 150;
/// Policies that each optimization starts from (Sec. 5.2).
const POLICIES: usize = 10;
/// Sweeps over a block of a negative.
const SWEEPS: usize = 2;
/// Settings of [`PaperModel::unbiased_weights`] for a database of facades. It stops early, near the prior: the
/// facades of a database are more regular than any draw, so that weights that fit them best run off.
pub const WEIGHTS: Settings = Settings {
    rounds: 60,
    moves: 1,
    persistent: false,
    rate: 0.3,
    decay: 30.0,
    penalty: 1e-3,
    newton: false,
    temperatures: 1,
};
/// Labels with sizes, and ratios of spacing to size, that are kept.
const EXEMPLARS: usize = 400;

/// A label with a size: relative to the mean window in the model, absolute in a problem.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(super) struct Exemplar {
    pub class: Class,
    pub size: [f64; 2],
}

/// The learnt model of the paper's method.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PaperModel {
    /// Densities and weights of the scoring functions.
    pub score: ScoreModel,
    /// Policies to start from.
    pub policies: Vec<Policy>,
    pub(super) exemplars: Vec<Exemplar>,
    /// Spacing over size, along each axis.
    pub(super) spacings: [Vec<f64>; 2],
}

/// The states that weights are learnt from: whole layouts with their spurious sites.
pub fn weight_states(layouts: &[&Layout], seed: u64) -> Vec<Sites> {
    let states = layouts.iter().enumerate();
    let state =
        |(i, l): (usize, &&Layout)| Sites::of_layout(l, &mut stream(seed, "sites", i as u64));
    states.map(state).collect()
}

impl PaperModel {
    /// Learns densities, weights and initial policies from whole layouts. Stopped by `watch`, the weights are those so far, and
    /// the policies those of the facades that were finished.
    ///
    /// # Errors
    /// As [`ScoreModel::train`]; [`ModelError`] where weights diverge.
    pub fn train(layouts: &[Layout], seed: u64, watch: &Watch) -> Result<Self, ModelError> {
        let watched = Watched::new(watch);
        let mut model = Self::of_densities(layouts, seed)?;
        if !watched.goes_on(Progress::stage("weights")) {
            return Ok(model);
        }
        let mut chosen: Vec<&Layout> = layouts.iter().filter(|l| !l.elements.is_empty()).collect();
        if chosen.iter().any(|l| l.elements.len() <= LARGEST) {
            chosen.retain(|l| l.elements.len() <= LARGEST);
        }
        chosen.shuffle(&mut stream(seed, "database", 0));
        model.score.weights = ranked_weights(&chosen, seed, &watched.inner())?;
        model.learn_policies(&chosen, seed, &watched);
        Ok(model)
    }

    /// Weights by contrastive divergence whose negatives are layouts of which a block was resampled given the rest: those of the
    /// distribution of Eq. 15, by maximum likelihood. [`PaperModel::train`] learns others, which rank completions.
    ///
    /// # Errors
    /// As [`learn_weights`].
    pub fn unbiased_weights(
        score: &ScoreModel,
        data: &[Sites],
        settings: &Settings,
        seed: u64,
        watch: &Watch,
    ) -> Result<[f64; TERMS], ModelError> {
        let sampler = |x: &mut Sites, weights: &[f64; TERMS], rng: &mut Stream| {
            x.resample_block(score, weights, SWEEPS, rng);
        };
        learn_weights(score, data, sampler, settings, seed, watch)
    }

    /// Weights by the update of Eq. 20: the negative is the completion of the layout without a tenth of its elements, the
    /// best of `candidates` ones of the model's policies (or of fixed ones where it has none) under the weights so far. It
    /// is no sample of the model, so that even weights of layouts drawn from the model do not come back.
    ///
    /// # Errors
    /// As [`learn_weights`].
    pub fn printed_weights(
        &self,
        data: &[Layout],
        candidates: usize,
        settings: &Settings,
        seed: u64,
        watch: &Watch,
    ) -> Result<[f64; TERMS], ModelError> {
        let sampler = |x: &mut Layout, weights: &[f64; TERMS], rng: &mut Stream| {
            x.elements.shuffle(rng);
            let kept = x.elements.len() - x.elements.len().div_ceil(10);
            let partial = PartialLayout {
                width: x.width,
                height: x.height,
                observed: x.elements[..kept].to_vec(),
                unknown: None,
                forbidden: Vec::new(),
            };
            let mut problem = CompletionProblem::new(self, &partial);
            problem.weights = *weights;
            let candidate = |rng: &mut Stream| {
                let known = self.policies.len();
                let policy = match known {
                    0 => Policy::FIXED,
                    n => self.policies[rng.random_range(0..n)],
                };
                let elements = grow(&problem, &policy, rng);
                (problem.score(&elements), elements)
            };
            let all = (0..candidates.max(1)).map(|_| candidate(rng));
            if let Some((_, best)) = all.max_by(|a, b| a.0.total_cmp(&b.0)) {
                x.elements = best;
            }
        };
        learn_weights(&self.score, data, sampler, settings, seed, watch)
    }

    /// Densities only: weights of 1, and no initial policies.
    ///
    /// # Errors
    /// As [`ScoreModel::train`].
    pub fn of_densities(layouts: &[Layout], seed: u64) -> Result<Self, ModelError> {
        let training = Training {
            seed,
            ..Training::default()
        };
        let score = ScoreModel::train(layouts, &training)?;
        let (mut exemplars, mut spacings) = (Vec::new(), [Vec::new(), Vec::new()]);
        for layout in layouts {
            let windows = layout.count(Class::Window).max(1) as f64;
            let sum = |f: &dyn Fn(&edifice_shape::Rect) -> f64| {
                layout.of(Class::Window).map(|e| f(&e.rect)).sum::<f64>() / windows
            };
            let (width, height) = (sum(&|r| r.width), sum(&|r| r.height));
            if width > 0.0 {
                exemplars.extend(layout.elements.iter().map(|e| Exemplar {
                    class: e.class,
                    size: [e.rect.width / width, e.rect.height / height],
                }));
            }
            for grid in grids(layout.width, &layout.elements) {
                for (axis, ratios) in spacings.iter_mut().enumerate() {
                    ratios.extend(grid.spacing[axis].map(|d| d / grid.size[axis]));
                }
            }
        }
        let mut rng = stream(seed, "exemplars", 0);
        exemplars.shuffle(&mut rng);
        exemplars.truncate(EXEMPLARS);
        for ratios in &mut spacings {
            ratios.shuffle(&mut rng);
            ratios.truncate(EXEMPLARS);
        }
        Ok(Self {
            score,
            policies: Vec::new(),
            exemplars,
            spacings,
        })
    }

    /// Optimizes a policy for some facades of the database, parts of which are hidden, and keeps the most
    /// different ones (Sec. 5.2): the first, then always the one farthest from those kept.
    fn learn_policies(&mut self, layouts: &[&Layout], seed: u64, watched: &Watched) {
        let mut learnt = Vec::new();
        for (i, layout) in layouts.iter().take(POLICY_FACADES).enumerate() {
            let told = Progress::of("policies", i as u64, POLICY_FACADES as u64);
            if !watched.goes_on(told) {
                break;
            }
            let mut rng = stream(seed, "policies", i as u64);
            let task = Task::ALL[rng.random_range(0..Task::ALL.len())];
            let (partial, _) = task.hide(layout, &mut rng);
            let problem = CompletionProblem::new(self, &partial);
            let found = optimize(&problem, &Budget::SMALL, 1, rng.random(), &watched.inner());
            learnt.extend(found.map(|f| f.policy));
        }
        while self.policies.len() < POLICIES && !learnt.is_empty() {
            let distance = |p: &Policy| {
                let to = |q: &Policy| -> f64 {
                    (0..PARAMETERS).map(|i| (p.0[i] - q.0[i]).powi(2)).sum()
                };
                self.policies.iter().map(to).fold(f64::INFINITY, f64::min)
            };
            let all = learnt.iter().enumerate();
            let farthest =
                all.max_by(|a, b| distance(a.1).total_cmp(&distance(b.1)).then(b.0.cmp(&a.0)));
            let at = farthest.map_or(0, |(i, _)| i);
            self.policies.push(learnt.swap_remove(at));
        }
    }

    /// Checks what a file may hold wrongly.
    ///
    /// # Errors
    /// [`ModelError::Parameter`].
    pub fn check(&self) -> Result<(), ModelError> {
        self.score.check()?;
        let sizes = self.exemplars.iter().flat_map(|e| e.size);
        let mut lengths = sizes.chain(self.spacings.iter().flatten().copied());
        let policies = self.policies.iter().flat_map(|p| p.0);
        let fine = lengths.all(|v| v.is_finite() && v > 0.0)
            && policies.into_iter().all(|v| (0.0..=1.0).contains(&v));
        match fine {
            true => Ok(()),
            false => Err(ModelError::parameter("policies", "are out of range")),
        }
    }
}
