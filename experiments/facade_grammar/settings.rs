//! Settings of the studies of this paper.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use edifice_facade_grammar as facade_grammar;
use edifice_facade_grammar::{Exploit, Method, Operations, Protect, Readings};
use edifice_grammar::Costs;

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
pub(super) enum Operation {
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
pub(super) struct Infer {
    /// Method of inference.
    method: MethodName,
    /// Walks, of the methods that repeat them; of `best` a measure of work.
    iterations: u64,
    /// Runs with different chance, of which the cheapest grammar counts.
    pub restarts: u64,
    /// Operations that rules may use beside the split.
    pub ops: Vec<Operation>,
    /// Cost of a split.
    pub split_cost: f64,
    /// Cost of a repeat.
    pub repeat_cost: f64,
    /// Cost of each symbol of a rule.
    pub successor_cost: f64,
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

/// The settings of the method.
pub(super) fn asked(settings: &Infer, costs: Costs, seed: u64) -> facade_grammar::Settings {
    let has = |operation| settings.ops.contains(&operation);
    facade_grammar::Settings {
        method: match settings.method {
            MethodName::Best => Method::Lagrangian,
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
