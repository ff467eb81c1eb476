//! One run of one method on one facade, measured and checked.

use cpu_time::ThreadTime;

use serde::{Deserialize, Serialize};

use edifice_base::unwatched;
use edifice_base::{Error, Result};
use edifice_facade_grammar::{Method, Operations, Readings, Settings, infer};
use edifice_grammar::{Costs, Grammar, evaluate};
use edifice_peers as peers;
use edifice_shape::Facade;

/// A method with its number of iterations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Solver {
    /// A method of this paper, or one that its authors rebuilt.
    Infer(Method, u64),
    /// Weissenberg et al. 2013.
    ProceduralLogic,
}

impl Solver {
    /// Name in tables: `adp_best_10k`; without the iterations for methods that have none.
    pub(crate) fn name(self) -> String {
        match self {
            Solver::ProceduralLogic => "procedural_logic".into(),
            Solver::Infer(Method::Greedy, _) => "greedy".into(),
            Solver::Infer(Method::Bayesian, _) => "bayesian".into(),
            Solver::Infer(Method::Symmetry, _) => "symmetry".into(),
            Solver::Infer(method, iterations) => {
                let name = match method {
                    Method::Lagrangian => "adp_best",
                    Method::AdpPaper => "adp_paper",
                    _ => "importance",
                };
                match iterations {
                    n if n % 1000 == 0 => format!("{name}_{}k", n / 1000),
                    n => format!("{name}_{n}"),
                }
            }
        }
    }

    /// Its name in the paper's Tables 2 to 4; `None` when they do not have it.
    pub(crate) fn published(self) -> Option<&'static str> {
        match self {
            Solver::ProceduralLogic => Some("procedural_logic"),
            Solver::Infer(Method::Bayesian, _) => Some("bayesian"),
            Solver::Infer(Method::Symmetry, _) => Some("symmetry"),
            Solver::Infer(Method::Lagrangian | Method::AdpPaper, _) => Some("adp"),
            Solver::Infer(Method::Greedy | Method::Importance, _) => None,
        }
    }

    /// True if the result depends on the seed, so that more than one seed says more.
    pub(crate) fn random(self) -> bool {
        matches!(
            self,
            Solver::Infer(
                Method::Lagrangian | Method::AdpPaper | Method::Importance,
                _
            )
        )
    }
}

/// The question of a run: a method and its settings.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Question {
    /// The method.
    pub solver: Solver,
    /// Its seed.
    pub seed: u64,
    /// Costs of rules.
    pub costs: Costs,
    /// Operations allowed.
    pub operations: Operations,
    /// The readings of the points that the text leaves open.
    pub readings: Readings,
}

impl Question {
    /// A question with the paper's costs and basic operations, and this project's readings.
    pub(crate) fn new(solver: Solver, seed: u64) -> Self {
        Self {
            solver,
            seed,
            costs: Costs::default(),
            operations: Operations::default(),
            readings: Readings::default(),
        }
    }
}

/// The result of a run, by the independent evaluator.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(crate) struct Answer {
    /// Cost of the grammar (Eq. 1).
    pub cost: f64,
    /// Its rules.
    pub rules: usize,
    /// Terminal regions.
    pub terminals: usize,
    /// Processor seconds of inference, which runs on one thread.
    pub seconds: f64,
    /// Effective number of weighted walks, of importance sampling.
    pub effective: Option<f64>,
}

/// Runs a method on a facade, or on several for one joint grammar; the grammar derives back to
/// them, or this fails.
pub(crate) fn solve(facades: &[Facade], question: &Question) -> Result<(Grammar, Answer)> {
    let start = ThreadTime::now();
    let (grammar, effective) = match (question.solver, facades) {
        (Solver::ProceduralLogic, [facade]) => (peers::grammar("procedural_logic", facade)?, None),
        (Solver::ProceduralLogic, _) => {
            return Err(Error::method("procedural logic takes one facade"));
        }
        (Solver::Infer(method, iterations), _) => {
            let settings = Settings {
                method,
                iterations,
                seed: question.seed,
                costs: question.costs,
                operations: question.operations,
                readings: question.readings,
                ..Settings::default()
            };
            let found = infer(facades, &settings, &unwatched).map_err(Error::method)?;
            (found.grammar, found.effective)
        }
    };
    let seconds = start.elapsed().as_secs_f64();
    let found = evaluate(&grammar, facades, &question.costs).map_err(Error::method)?;
    let answer = Answer {
        cost: found.cost,
        rules: found.rules,
        terminals: found.terminals,
        seconds,
        effective,
    };
    Ok((grammar, answer))
}

/// Least of a list; zero when it is empty.
pub(crate) fn least(values: &[f64]) -> f64 {
    values.iter().copied().reduce(f64::min).unwrap_or_default()
}

/// Mean of a list; zero when it is empty.
pub(crate) fn mean(values: &[f64]) -> f64 {
    match values.len() {
        0 => 0.0,
        n => values.iter().sum::<f64>() / n as f64,
    }
}
