//! The studies of this paper, for sweeps.

use std::path::{Path, PathBuf};
use std::sync::Mutex;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::likeness::likeness;
use crate::sweep::{Better, Given, Outcome, Study};
use edifice_base::{Error, Progress, Result};
use edifice_facade_grammar as facade_grammar;
use edifice_facade_grammar::{Exploit, Method, Operations, Protect, Readings, infer};
use edifice_grammar::{Costs, Grammar, evaluate};
use edifice_io::{ReadOptions, read_facade, read_grammar};

/// The method of search.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
enum MethodName {
    Best,
    AdpPaper,
    Importance,
    Greedy,
    Bayesian,
    Symmetry,
}

/// Operations of rules beside the split.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum Operation {
    Repeat,
    RepeatAba,
    SymSplit,
    GridSplit,
}

/// The protection of important regions (Sec. 4.7).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum Protection {
    Never,
    Walk,
    Run,
}

/// Settings of grammar inference.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
struct Infer {
    /// Method of inference.
    method: MethodName,
    /// Walks, of the methods that repeat them; of `best` a measure of work.
    iterations: u64,
    /// Runs with different chance, of which the cheapest grammar counts.
    restarts: u64,
    /// Operations that rules may use beside the split.
    ops: Vec<Operation>,
    /// Cost of a split.
    split_cost: f64,
    /// Cost of a repeat.
    repeat_cost: f64,
    /// Cost of each symbol of a rule.
    successor_cost: f64,
    /// `lambda_1` of Eq. 5.
    lambda_rule: f64,
    /// `lambda_2` of Eq. 5.
    lambda_lines: f64,
    /// Protection of important regions (Sec. 4.7), of `adp-paper` and `importance`: drawn for each walk, once for a run, or never.
    protection: Protection,
    /// Most draws of protected regions for a walk.
    draws: usize,
    /// Exploitation from this many rules tried before, of `adp-paper`; 0 for all reasonable rules (Eq. 4).
    remembered: usize,
    /// Probability of exploring in the last iteration, of `adp-paper`; the first has 0.9.
    last_epsilon: f64,
}

impl Default for Infer {
    fn default() -> Self {
        let settings = facade_grammar::Settings::default();
        Self {
            method: MethodName::Best,
            iterations: settings.iterations,
            restarts: 1,
            ops: vec![Operation::Repeat],
            split_cost: settings.costs.split,
            repeat_cost: settings.costs.repeat,
            successor_cost: settings.costs.successor,
            lambda_rule: settings.lambda_rule,
            lambda_lines: settings.lambda_lines,
            protection: Protection::Walk,
            draws: Protect::DRAWS,
            remembered: 0,
            last_epsilon: settings.readings.last_epsilon,
        }
    }
}

/// Grammar inference on one facade.
pub fn infer() -> Study {
    const METRICS: &[(&str, Better)] = &[
        ("cost", Better::Lower),
        ("rules", Better::Lower),
        ("precision", Better::Higher),
        ("recall", Better::Higher),
        ("f_score", Better::Higher),
    ];
    let about = "grammar inference on facade layouts (Wu et al. 2014); precision, recall and F where a grammar `NAME.grammar.json` or `NAME.cga` lies beside the facade";
    Study::new(
        "facade_grammar/infer",
        about,
        "facade_grammar",
        METRICS,
        run,
    )
}

fn run(settings: &Infer, given: &Given) -> Result<Outcome> {
    let facade = read_facade(given.path, &ReadOptions::default())?;
    let reference = reference(given.path)?;
    let costs = Costs {
        split: settings.split_cost,
        repeat: settings.repeat_cost,
        successor: settings.successor_cost,
        ..Costs::default()
    };
    let mut found = Outcome::default();
    let mut best = f64::INFINITY;
    let mut evaluations = 0.0;
    for restart in 0..settings.restarts.max(1) {
        let trace: Mutex<Vec<[f64; 2]>> = Mutex::default();
        let watch = |progress: Progress| {
            if let (Some(best), Ok(mut trace)) = (progress.best, trace.lock()) {
                trace.push([(progress.done - 1) as f64, best]);
            }
            given.watched.tell(progress)
        };
        let seed = given
            .seed
            .wrapping_mul(settings.restarts.max(1))
            .wrapping_add(restart);
        let asked = asked(settings, costs, seed);
        let outcome =
            infer(std::slice::from_ref(&facade), &asked, &watch).map_err(Error::method)?;
        // The one evaluator, not the method, says what the grammar costs.
        let report = evaluate(&outcome.grammar, std::slice::from_ref(&facade), &costs)
            .map_err(Error::method)?;
        for &[steps, value] in trace.into_inner().unwrap_or_default().iter() {
            if found.trace.last().is_none_or(|last| value < last[1]) {
                found.trace.push([evaluations + steps, value]);
            }
        }
        evaluations += asked.steps() as f64;
        if report.cost < best {
            best = report.cost;
            found.metrics.insert("cost".into(), report.cost);
            found
                .metrics
                .insert("rules".into(), outcome.grammar.rules.len() as f64);
            if let Some(reference) = &reference {
                let like = likeness(&outcome.grammar, reference)?;
                for (name, value) in [
                    ("precision", like.precision),
                    ("recall", like.recall),
                    ("f_score", like.f_score),
                ] {
                    found.metrics.insert(name.into(), value);
                }
            }
        }
        found.bound = outcome.lower_bound.or(found.bound);
    }
    Ok(found)
}

/// The grammar that lies beside a facade, where there is one.
fn reference(path: &Path) -> Result<Option<Grammar>> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let stem = name.split('.').next().unwrap_or_default();
    let beside =
        ["grammar.json", "cga"].map(|ending| path.with_file_name(format!("{stem}.{ending}")));
    let found: Option<PathBuf> = beside.into_iter().find(|p| p.is_file());
    found.map(|path| read_grammar(&path)).transpose()
}

fn asked(settings: &Infer, costs: Costs, seed: u64) -> facade_grammar::Settings {
    let has = |operation| settings.ops.contains(&operation);
    facade_grammar::Settings {
        method: match settings.method {
            MethodName::Best => Method::AdpBest,
            MethodName::AdpPaper => Method::AdpPaper,
            MethodName::Importance => Method::Importance,
            MethodName::Greedy => Method::Greedy,
            MethodName::Bayesian => Method::Bayesian,
            MethodName::Symmetry => Method::Symmetry,
        },
        iterations: settings.iterations,
        seed,
        costs,
        operations: Operations {
            repeat: has(Operation::Repeat),
            repeat_aba: has(Operation::RepeatAba),
            sym_split: has(Operation::SymSplit),
            grid_split: has(Operation::GridSplit),
        },
        lambda_rule: settings.lambda_rule,
        lambda_lines: settings.lambda_lines,
        readings: Readings {
            protection: match settings.protection {
                Protection::Never => Protect::Never,
                Protection::Walk => Protect::Walk {
                    draws: settings.draws,
                },
                Protection::Run => Protect::Run,
            },
            exploitation: match settings.remembered {
                0 => Exploit::AllRules,
                most => Exploit::Remembered(most),
            },
            last_epsilon: settings.last_epsilon,
        },
    }
}
