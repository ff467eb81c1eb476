//! Grammar inference as question, candidate and judge.
//!
//! The question is a facade, the answer a grammar (JSON of the contract, or CGA). The judge derives the grammar, compares what it derives with the facade,
//! terminal by terminal, looks that no operation is used that the sweep does not allow, and counts the cost itself.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use super::likeness::likeness;
use super::settings::{Infer, Operation, asked};
use edifice_base::{Error, Progress, Result, Watched};
use edifice_facade_grammar::infer;
use edifice_grammar::{Costs, Grammar, evaluate};
use edifice_io::{ReadOptions, facade_json, grammar_cga, read_bytes, read_facade, read_grammar};
use edifice_shape::Facade;
use edifice_sweep::Given;
use edifice_sweep::trial::{Answered, Posed, Trial};

/// Grammar inference on one facade.
pub(super) struct Inference;

/// Why a grammar is no answer.
#[derive(Debug, thiserror::Error)]
enum AnswerError {
    #[error("the rule of `{symbol}` is a {operation}, which `ops` of the sweep does not allow")]
    Operation {
        symbol: String,
        operation: &'static str,
    },
}

impl Trial for Inference {
    type Settings = Infer;
    type Question = Facade;
    /// The grammar that lies beside the facade, where there is one.
    type Truth = Option<Grammar>;
    type Answer = Grammar;

    const OUTPUT: &'static str = "answer.grammar.json";
    const CLAIMS: &'static [&'static str] = &[];

    fn prepare(_: &Infer, given: &Given) -> Result<(Facade, Option<Grammar>)> {
        let facade = read_facade(given.path, &ReadOptions::default())?;
        Ok((facade, reference(given.path)?))
    }

    fn candidate(
        settings: &Infer,
        facade: &Facade,
        seed: u64,
        watched: &Watched,
    ) -> Result<Answered<Grammar>> {
        let costs = costs(settings);
        let restarts = settings.restarts.max(1);
        let mut best: Option<(f64, Grammar)> = None;
        let (mut bound, mut evaluations) = (None, 0.0);
        let mut steps_and_costs: Vec<[f64; 2]> = Vec::new();
        for restart in 0..restarts {
            let trace: Mutex<Vec<[f64; 2]>> = Mutex::default();
            let watch = |progress: Progress| {
                if let (Some(best), Ok(mut trace)) = (progress.best, trace.lock()) {
                    trace.push([progress.done.saturating_sub(1) as f64, best]);
                }
                watched.tell(progress)
            };
            let seed = seed.wrapping_mul(restarts).wrapping_add(restart);
            let asked = asked(settings, costs, seed);
            let facades = std::slice::from_ref(facade);
            let outcome = infer(facades, &asked, &watch).map_err(Error::method)?;
            // The one evaluator, not the method, says what the grammar costs.
            let report = evaluate(&outcome.grammar, facades, &costs).map_err(Error::method)?;
            for &[steps, value] in trace.into_inner().unwrap_or_default().iter() {
                if steps_and_costs.last().is_none_or(|last| value < last[1]) {
                    steps_and_costs.push([evaluations + steps, value]);
                }
            }
            evaluations += asked.steps() as f64;
            if best.as_ref().is_none_or(|(cost, _)| report.cost < *cost) {
                best = Some((report.cost, outcome.grammar));
            }
            bound = outcome.lower_bound.or(bound);
        }
        let (_, grammar) = best.ok_or_else(|| Error::method("no run was asked for"))?;
        Ok(Answered {
            trace: steps_and_costs,
            bound,
            ..Answered::plain(grammar)
        })
    }

    fn judge(
        settings: &Infer,
        facade: &Facade,
        reference: &Option<Grammar>,
        grammar: &Grammar,
    ) -> Result<BTreeMap<String, f64>> {
        for rule in &grammar.rules {
            let operation = rule.operation.name();
            let allowed = match operation {
                "repeat" => settings.ops.contains(&Operation::Repeat),
                "repeat_aba" => settings.ops.contains(&Operation::RepeatAba),
                "sym_split" => settings.ops.contains(&Operation::SymSplit),
                "grid_split" => settings.ops.contains(&Operation::GridSplit),
                _ => true,
            };
            if !allowed {
                let symbol = rule.symbol.clone();
                return Err(Error::method(AnswerError::Operation { symbol, operation }));
            }
        }
        let facades = std::slice::from_ref(facade);
        let report = evaluate(grammar, facades, &costs(settings)).map_err(Error::method)?;
        let mut metrics = BTreeMap::from([
            ("cost".to_owned(), report.cost),
            ("rules".to_owned(), report.rules as f64),
        ]);
        if let Some(reference) = reference {
            let like = likeness(grammar, reference)?;
            for (name, value) in [
                ("precision", like.precision),
                ("recall", like.recall),
                ("f_score", like.f_score),
            ] {
                metrics.insert(name.into(), value);
            }
        }
        Ok(metrics)
    }

    fn pose(facade: &Facade, folder: &Path) -> Result<Posed> {
        let input = folder.join("facade.facade.json");
        facade_json::write(facade, &input)?;
        Ok(Posed { input, learn: None })
    }

    fn posed(posed: &Posed) -> Result<Facade> {
        facade_json::read(&posed.input)
    }

    fn write(_: &Facade, grammar: &Grammar, path: &Path) -> Result<()> {
        edifice_io::write_grammar(grammar, path)
    }

    fn read(_: &Facade, path: &Path) -> Result<Grammar> {
        // JSON begins with a brace; what does not is CGA.
        let bytes = read_bytes(path)?;
        match bytes.iter().find(|b| !b.is_ascii_whitespace()) {
            Some(b'{') | None => read_grammar(path),
            Some(_) => grammar_cga::read(path),
        }
    }
}

fn costs(settings: &Infer) -> Costs {
    Costs {
        split: settings.split_cost,
        repeat: settings.repeat_cost,
        successor: settings.successor_cost,
        ..Costs::default()
    }
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
