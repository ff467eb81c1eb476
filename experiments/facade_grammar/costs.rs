//! The cost of every facade with a bound that no grammar is below, to set other methods beside.

use std::fmt::Write;

use sha2::{Digest, Sha256};

use serde::{Deserialize, Serialize};

use super::data::{self, Instance};
use super::iterations;
use super::optimality::OPERATIONS;
use edifice_base::{Error, Result, unwatched};
use edifice_facade_grammar::{Operations, Settings, infer};
use edifice_frame::Context;
use edifice_io::facade_json;
use edifice_report::{Align, Row, Table};

/// The file that the leaderboard of `datasets/facade_grammar` is made of.
const BOARD: &str = "board.csv";

/// A facade's cost and bound under one set of operations.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
struct Answer {
    cost: f64,
    /// No grammar of the facade costs less; `None` where no bound was found.
    lower: Option<f64>,
}

impl Answer {
    fn is_proven(&self) -> bool {
        self.lower.is_some_and(|lower| self.cost <= lower + 1e-9)
    }
}

/// Infers a grammar of every facade by the default method, with and without repeats.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let (_, iterations) = iterations(ctx.budget());
    ctx.setting("iterations", iterations);
    let dataset = "shipped";
    let shipped = data::shipped(ctx)?.into_iter();
    let mut instances: Vec<Instance> = shipped.map(|facade| Instance { dataset, facade }).collect();
    instances.extend(data::real(ctx, usize::MAX)?);
    let both = |instance| [(instance, 0), (instance, 1)];
    let units: Vec<(&Instance, usize)> = instances.iter().flat_map(both).collect();
    let seed = ctx.seed();
    let name = |instance: &Instance| format!("{}/{}", instance.dataset, instance.facade.name);
    let found = ctx.units(
        &units,
        |(instance, operations)| format!("{}/{}", name(instance), OPERATIONS[*operations]),
        |&(instance, operations)| {
            let settings = Settings {
                iterations,
                seed,
                operations: match operations {
                    0 => Operations::split_only(),
                    _ => Operations::default(),
                },
                ..Settings::default()
            };
            let facades = std::slice::from_ref(&instance.facade);
            let found = infer(facades, &settings, &unwatched).map_err(Error::method)?;
            Ok(Answer {
                cost: settings.costs.grammar(&found.grammar),
                lower: found.lower_bound,
            })
        },
    )?;
    let rows: Vec<(&Instance, usize, Answer)> = units
        .iter()
        .zip(found)
        .map(|(&(instance, operations), answer)| (instance, operations, answer))
        .collect();
    tabulate(ctx, &rows);
    for (instance, operations, answer) in &rows {
        let cost = [("cost", answer.cost)].into_iter();
        for (metric, value) in cost.chain(answer.lower.map(|lower| ("lower_bound", lower))) {
            ctx.observe(Row {
                dataset: instance.dataset.into(),
                method: format!("adp_best/{}", OPERATIONS[*operations]),
                instance: instance.facade.name.clone(),
                metric: metric.into(),
                value,
                ..Row::default()
            });
        }
    }
    let text = board(&rows);
    ctx.attach(
        BOARD,
        text.as_bytes(),
        "rows for `datasets/facade_grammar/leaderboard.csv`",
    )?;
    ctx.note(
        "Not in the paper. *bound* is below every grammar whose symbols each derive one region type; where the cost is equal to it, \
         the grammar is optimal among these. A bound far below its cost is one that only counts labels: the facade has more \
         rules and places than the proof takes on. Another method is set beside by `edifice grammar evaluate GRAMMAR FACADE`.",
    );
    Ok(())
}

/// Means of each set.
fn tabulate(ctx: &mut Context, rows: &[(&Instance, usize, Answer)]) {
    let mut table = Table::new("Costs of all facades")
        .column("data", Align::Left)
        .column("operations", Align::Left)
        .numbers([
            "facades",
            "mean cost",
            "mean bound",
            "proven",
            "largest gap %",
        ]);
    for (operations, word) in OPERATIONS.iter().enumerate() {
        let mine: Vec<_> = rows.iter().filter(|row| row.1 == operations).collect();
        for set in mine.chunk_by(|a, b| a.0.dataset == b.0.dataset) {
            let mean = |numbers: &[f64]| numbers.iter().sum::<f64>() / numbers.len() as f64;
            let costs: Vec<f64> = set.iter().map(|row| row.2.cost).collect();
            let bounds: Vec<f64> = set.iter().filter_map(|row| row.2.lower).collect();
            let gaps = set.iter().filter_map(|(_, _, a)| {
                let lower = a.lower.filter(|lower| *lower > 0.0)?;
                Some(100.0 * (a.cost - lower).max(0.0) / lower)
            });
            let proven = set.iter().filter(|row| row.2.is_proven()).count();
            table.row([
                set[0].0.dataset.to_owned(),
                (*word).to_owned(),
                set.len().to_string(),
                format!("{:.2}", mean(&costs)),
                format!("{:.2}", mean(&bounds)),
                proven.to_string(),
                format!("{:.1}", gaps.fold(0.0, f64::max)),
            ]);
        }
    }
    ctx.table(&table);
}

/// The leaderboard's rows: numbers are written so that they are read back the same.
fn board(rows: &[(&Instance, usize, Answer)]) -> String {
    let mut text =
        "dataset,facade,digest,terminals,operations,cost,lower_bound,method,by\n".to_owned();
    for (instance, operations, answer) in rows {
        let Instance { dataset, facade } = instance;
        let digest = Sha256::digest(facade_json::to_string(facade));
        let digest: String = digest
            .iter()
            .take(8)
            .map(|byte| format!("{byte:02x}"))
            .collect();
        // Writing to a text cannot fail.
        let _ = writeln!(
            text,
            "{dataset},{},{digest},{},{},{},{},adp,edifice",
            facade.name,
            facade.regions.len(),
            OPERATIONS[*operations],
            // Sums of prices of a tenth: twelve digits are what they are.
            rounded(answer.cost),
            answer
                .lower
                .map_or(String::new(), |lower| rounded(lower).to_string()),
        );
    }
    text
}

/// The number without the noise of its sum.
fn rounded(value: f64) -> f64 {
    (value * 1e9).round() / 1e9
}
