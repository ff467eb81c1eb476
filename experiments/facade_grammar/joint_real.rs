//! Beside Fig. 13: one grammar for several real facades.

use std::collections::BTreeMap;

use rand::seq::SliceRandom;
use serde::{Deserialize, Serialize};

use super::data::{self, Instance};
use super::runs::{Question, Solver, mean, solve};
use super::{BEST, iterations};
use edifice_base::rng::stream;
use edifice_base::{Error, Result};
use edifice_frame::Context;
use edifice_grammar::{Costs, Grammar, derivation};
use edifice_report::{Align, Row, Table};
use edifice_shape::Facade;

/// Facades in a set.
const SIZES: [usize; 4] = [2, 3, 4, 5];

/// Lengths within this part of the longer side are equal.
const NOISE: f64 = 1e-7;

/// The costs found for one set of facades.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
struct Answer {
    /// Sum of the costs of the separate grammars.
    separate: f64,
    /// Cost of their union, in which equal regions share a rule.
    union: f64,
    joint: f64,
    /// Processor seconds of the separate and of the joint inference.
    seconds: (f64, f64),
}

/// Joint extraction from random sets of real facades, each set from one data set, beside the separate grammars.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let (_, many) = iterations(ctx.budget());
    let (facades, sets) = ctx
        .budget()
        .choose((6, 2), (usize::MAX, 200), (usize::MAX, 200));
    let instances = data::real(ctx, facades)?;
    if instances.is_empty() {
        return Ok(());
    }
    ctx.setting("real_sets", sets);
    let mut by_dataset: BTreeMap<&str, Vec<&Instance>> = BTreeMap::new();
    for instance in &instances {
        by_dataset
            .entry(instance.dataset)
            .or_default()
            .push(instance);
    }
    let datasets: Vec<(&str, Vec<&Instance>)> = by_dataset.into_iter().collect();
    let units: Vec<(&str, Vec<Facade>)> = (0..sets)
        .map(|index| {
            let (dataset, instances) = &datasets[index % datasets.len()];
            let mut rng = stream(ctx.seed(), "joint real sets", index as u64);
            let mut drawn = instances.clone();
            drawn.shuffle(&mut rng);
            drawn.truncate(SIZES[index / datasets.len() % SIZES.len()]);
            let facades = drawn.iter().map(|i| i.facade.clone()).collect();
            (*dataset, facades)
        })
        .collect();
    let seed = ctx.seed();
    let answers = ctx.units(
        &units,
        |(dataset, facades)| format!("{dataset}/{}", names(facades)),
        |(_, facades)| compare(facades, Question::new(Solver::Infer(BEST, many), seed)),
    )?;
    let mut table = Table::new("Random sets of real facades, jointly and separately")
        .column("dataset", Align::Left)
        .numbers([
            "sets",
            "above the union",
            "mean saving (%)",
            "largest saving (%)",
            "of it sharing of equal regions (%)",
        ])
        .times(["time, joint / separate"]);
    let everything = units.iter().map(|(dataset, _)| *dataset);
    let found: Vec<(&str, &Answer)> = everything.zip(&answers).collect();
    let rows = datasets.iter().map(|(dataset, _)| *dataset).chain(["all"]);
    for dataset in rows {
        let mine = found
            .iter()
            .filter(|(d, _)| dataset == "all" || *d == dataset);
        let mine: Vec<&Answer> = mine.map(|(_, answer)| *answer).collect();
        let savings: Vec<f64> = mine.iter().map(|a| saving(a.separate, a.joint)).collect();
        let shared: Vec<f64> = mine.iter().map(|a| saving(a.separate, a.union)).collect();
        let above = mine.iter().filter(|a| a.joint > a.union + 1e-6).count();
        let seconds = |of: fn(&Answer) -> f64| mine.iter().map(|a| of(a)).sum::<f64>();
        let time = seconds(|a| a.seconds.1) / seconds(|a| a.seconds.0);
        table.row([
            dataset.to_string(),
            mine.len().to_string(),
            above.to_string(),
            format!("{:.2}", mean(&savings)),
            format!("{:.2}", savings.iter().copied().fold(0.0, f64::max)),
            format!("{:.2}", mean(&shared)),
            format!("{time:.1}"),
        ]);
        if dataset == "all" {
            ctx.compare(
                "real facades: sets whose joint grammar costs more than the union of the separate ones",
                "–",
                format!("{above} of {}", mine.len()),
            );
            ctx.compare(
                "real facades: per cent cheaper on average",
                "– (\"no meaningful results\" for different element sizes)",
                format!("{:.2}", mean(&savings)),
            );
        }
    }
    ctx.table(&table);
    for ((dataset, facades), answer) in units.iter().zip(&answers) {
        for (metric, value) in [
            ("separate_cost", answer.separate),
            ("union_cost", answer.union),
            ("joint_cost", answer.joint),
            ("saving_per_cent", saving(answer.separate, answer.joint)),
        ] {
            ctx.observe(Row {
                dataset: (*dataset).into(),
                method: Solver::Infer(BEST, many).name(),
                instance: names(facades),
                seed: Some(seed),
                metric: metric.into(),
                value,
                unit: if metric == "saving_per_cent" { "%" } else { "" }.into(),
                ..Row::default()
            });
        }
    }
    ctx.note(
        "Random sets of two to five real facades of one data set. *Union* writes the rules of the separate grammars once for each \
         region that several facades have; the joint search starts from it. Real facades are drawn at different scales and \
         have few sizes in common (Sec. 6: \"our current framework only works for facades with approximately identical \
         element sizes\"), so that there is little to share.",
    );
    Ok(())
}

fn names(facades: &[Facade]) -> String {
    let names: Vec<&str> = facades.iter().map(|f| f.name.as_str()).collect();
    names.join("+")
}

/// The saving of `cost` against `sum`, in per cent.
fn saving(sum: f64, cost: f64) -> f64 {
    100.0 * (1.0 - cost / sum)
}

fn compare(facades: &[Facade], question: Question) -> Result<Answer> {
    let mut grammars = Vec::new();
    let (mut separate, mut seconds) = (0.0, 0.0);
    for facade in facades {
        let (grammar, answer) = solve(std::slice::from_ref(facade), &question)?;
        separate += answer.cost;
        seconds += answer.seconds;
        grammars.push(grammar);
    }
    let (_, joint) = solve(facades, &question)?;
    Ok(Answer {
        separate,
        union: union_cost(&grammars, &question.costs)?,
        joint: joint.cost,
        seconds: (seconds, joint.seconds),
    })
}

/// The content of a non-terminal region: labels, offsets and sizes, in order.
type Contents = Vec<(String, [i64; 4])>;

/// Cost of the union of deterministic grammars: of each region, whatever its symbol, the cheapest rule that one of them
/// has, as far as the facades need it.
fn union_cost(grammars: &[Grammar], costs: &Costs) -> Result<f64> {
    let sides = grammars.iter().flat_map(|g| &g.starts);
    let unit = NOISE * sides.map(|s| s.width.max(s.height)).fold(0.0, f64::max);
    let mut rules: BTreeMap<Contents, (f64, Vec<Contents>)> = BTreeMap::new();
    let mut needed = Vec::new();
    for grammar in grammars {
        let derived = derivation(grammar, 0).map_err(Error::method)?;
        let mut contents: BTreeMap<&str, Contents> = BTreeMap::new();
        for region in &derived.non_terminals {
            let symbol = grammar.rules[region.rule].symbol.as_str();
            contents.entry(symbol).or_insert_with(|| {
                let inside = derived.facade.regions.iter().filter(|terminal| {
                    let rect = &terminal.rect;
                    let (x, y) = (rect.x + rect.width / 2.0, rect.y + rect.height / 2.0);
                    (region.rect.x..region.rect.right()).contains(&x)
                        && (region.rect.y..region.rect.top()).contains(&y)
                });
                let whole = |v: f64| (v / unit).round() as i64;
                let written = inside.map(|terminal| {
                    let r = &terminal.rect;
                    let place = [r.y - region.rect.y, r.x - region.rect.x, r.height, r.width];
                    (terminal.label.clone(), place.map(whole))
                });
                let mut contents: Contents = written.collect();
                contents.sort_by_key(|content| content.1);
                contents
            });
        }
        for rule in &grammar.rules {
            let Some(key) = contents.get(rule.symbol.as_str()) else {
                continue;
            };
            let symbols = rule.operation.symbols().into_iter();
            let parts = symbols.filter_map(|s| contents.get(s).cloned()).collect();
            let cost = costs.rule(&rule.operation);
            let known = rules
                .entry(key.clone())
                .or_insert((f64::INFINITY, Vec::new()));
            if cost < known.0 {
                *known = (cost, parts);
            }
        }
        needed.extend(contents.get(grammar.starts[0].symbol.as_str()).cloned());
    }
    let mut total = 0.0;
    while let Some(contents) = needed.pop() {
        // A region that was met before is written already.
        if let Some((cost, parts)) = rules.remove(&contents) {
            total += cost;
            needed.extend(parts);
        }
    }
    Ok(total)
}
