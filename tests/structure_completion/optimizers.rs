//! Other optimizers where the paper has a genetic algorithm (Sec. 5.2): covariance matrix adaptation with the same number of candidates.

use edifice::methods::structure_completion::model::shipped_model;
use edifice::methods::structure_completion::policy::{
    Budget, CompletionProblem, PARAMETERS, Policy, grow, optimize, paper_model,
};
use edifice::methods::structure_completion::task::Task;
use edifice::optim::{Limits, cmaes};
use edifice::rng::stream;
use edifice::unwatched;

/// Layouts compared are one more than this; the numbers in `policy::optimize` are with 8 and three seeds.
const STEPS: usize = 2;

const BUDGET: Budget = Budget {
    population: 10,
    generations: 24,
    draws: 5,
};

/// A parameter reflected into 0 to 1.
fn reflected(x: f64) -> f64 {
    let x = x.rem_euclid(2.0);
    if x > 1.0 { 2.0 - x } else { x }
}

/// The best score of a candidate by covariance matrix adaptation over policies, from the mean of the model's initial policies.
fn adapted(problem: &CompletionProblem, seed: u64) -> f64 {
    let known = &problem.model.policies;
    let mean = |i: usize| match known.len() {
        0 => 0.5,
        n => known.iter().map(|p| p.0[i]).sum::<f64>() / n as f64,
    };
    let start: Vec<f64> = (0..PARAMETERS).map(mean).collect();
    let settings = cmaes::Settings {
        step: 0.3,
        restarts: 100,
        population: Some(10),
        limits: Limits {
            evaluations: Some((BUDGET.candidates() / BUDGET.draws) as u64),
            ..Limits::default()
        },
        ..cmaes::Settings::default()
    };
    let (mut best, mut rng) = (f64::NEG_INFINITY, stream(seed, "adapted", 0));
    let cost = |x: &[f64]| {
        let policy = Policy(std::array::from_fn(|i| reflected(x[i])));
        let scores = (0..BUDGET.draws).map(|_| problem.score(&grow(problem, &policy, &mut rng)));
        let scores: Vec<f64> = scores.collect();
        best = scores.iter().copied().fold(best, f64::max);
        -scores.iter().sum::<f64>() / BUDGET.draws as f64
    };
    cmaes::minimize(cost, &start, &settings, seed, |_| {}).unwrap();
    best
}

#[test]
fn the_genetic_algorithm_is_as_good_as_covariance_adaptation() {
    let model = shipped_model().unwrap();
    let paper = paper_model(&model).unwrap();
    let layouts = model.layouts();
    let (mut wins, mut losses, mut gain) = (0, 0, 0.0);
    for (i, layout) in layouts.iter().step_by(layouts.len() / STEPS).enumerate() {
        for (task, seed) in [(Task::Side50, 1), (Task::R50, 2)] {
            let (partial, _) = task.hide(layout, &mut stream(i as u64, "hide", 0));
            let problem = CompletionProblem::new(&paper, &partial);
            let bred = optimize(&problem, &BUDGET, 1, seed, &unwatched).unwrap();
            let bred = bred
                .candidates
                .first()
                .map_or(f64::NEG_INFINITY, |c| c.score);
            let adapted = adapted(&problem, seed);
            wins += u32::from(bred > adapted + 1e-9);
            losses += u32::from(adapted > bred + 1e-9);
            gain += bred - adapted;
        }
    }
    println!("bred better {wins}, adapted better {losses}, mean gain {gain:.3} in all");
    assert!(gain > -10.0, "{gain}");
}
