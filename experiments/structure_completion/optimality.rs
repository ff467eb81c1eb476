//! The chain over grid lines: equal to enumeration where that is possible, never below annealing.

use rand::RngExt;

use super::{data, row};
use edifice_base::Result;
use edifice_base::rng::stream;
use edifice_frame::Context;
use edifice_report::{Align, Table};
use edifice_shape::Axis;
use edifice_structure_completion::best::chain::{Chain, LineProblem, log_weight};
use edifice_structure_completion::best::density::Spacing;
use edifice_structure_completion::best::observation::Observation;
use edifice_structure_completion::best::pool::line_problem;
use edifice_structure_completion::layout::{Class, Layout};
use edifice_structure_completion::model::Model;
use edifice_structure_completion::task::Task;

/// Evaluations of annealing.
const EVALUATIONS: usize = 10_000;

/// Compares on the columns and rows of real facades.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let items = data::items(ctx)?;
    let layouts: Vec<Layout> = items.iter().map(|i| i.layout.clone()).collect();
    let model = Model::of_spacing(layouts);
    let count = ctx.budget().choose(3, 40, 200);
    ctx.setting("evaluations", EVALUATIONS);
    let usable: Vec<&data::Item> = items
        .iter()
        .filter(|i| i.layout.count(Class::Window) > 3)
        .take(count)
        .collect();
    let units: Vec<(usize, &data::Item)> = usable.into_iter().enumerate().collect();
    let seed = ctx.seed();
    let found: Vec<Vec<(f64, f64)>> = ctx.units(
        &units,
        |u| format!("{}/{}", u.1.dataset, u.1.layout.name),
        |(k, item)| {
            let mut rng = stream(seed, "optimality", *k as u64);
            let task = Task::ALL[k % Task::ALL.len()];
            let (partial, _) = task.hide(&item.layout, &mut rng);
            let observation = Observation::new(
                &partial,
                partial.observed.clone(),
                model.window_size(partial.width, partial.height),
            );
            let mut pairs = Vec::new();
            for (axis, spacing) in [(Axis::X, &model.columns), (Axis::Y, &model.rows)] {
                let (problem, _) = line_problem(&observation, axis);
                let best = Chain::new(&problem, spacing, true).log_value();
                if best.is_finite() {
                    pairs.push((best, anneal(&problem, spacing, &mut rng)));
                }
            }
            Ok(pairs)
        },
    )?;
    let (mut below, mut reached, mut total) = (0, 0, 0);
    for ((_, item), pairs) in units.iter().zip(&found) {
        for (axis, (best, annealed)) in pairs.iter().enumerate() {
            let instance = format!("{}/{}", item.layout.name, ["columns", "rows"][axis.min(1)]);
            ctx.observe(row(
                item.dataset,
                "chain",
                instance.clone(),
                None,
                "log_probability",
                *best,
            ));
            if annealed.is_finite() {
                ctx.observe(row(
                    item.dataset,
                    "annealing",
                    instance,
                    None,
                    "log_probability",
                    *annealed,
                ));
            }
            below += usize::from(*best < annealed - 1e-9);
            reached += usize::from((best - annealed).abs() <= 1e-9);
            total += 1;
        }
    }
    let mut table = Table::new("Most probable lines")
        .column("", Align::Left)
        .numbers(["problems"]);
    for (what, number) in [
        ("problems", total),
        ("annealing above the chain", below),
        ("annealing reaches the chain", reached),
    ] {
        table.row([what.to_string(), number.to_string()]);
    }
    ctx.table(&table);
    ctx.note("Equality with enumeration is kept by a test on thousands of small problems.");
    Ok(())
}

/// Annealing over sets of lines: add, remove or shift a line.
fn anneal(problem: &LineProblem, spacing: &Spacing, rng: &mut edifice_base::rng::Stream) -> f64 {
    // Start from any lines that the chain can draw.
    let start = Chain::new(problem, spacing, false)
        .draw(1, rng)
        .into_iter()
        .next();
    let Some(mut lines) = start else {
        return f64::NEG_INFINITY;
    };
    let mut value = log_weight(problem, spacing, &lines);
    let mut best = value;
    for step in 0..EVALUATIONS {
        let temperature = 3.0 * (1.0 - step as f64 / EVALUATIONS as f64) + 1e-3;
        let mut next = lines.clone();
        let bin = rng.random_range(0..problem.bins);
        match (rng.random_range(0..3u8), next.is_empty()) {
            (0, _) => next.push(bin),
            (_, true) => continue,
            (1, _) => {
                next.swap_remove(bin % lines.len());
            }
            _ => {
                let k = bin % lines.len();
                next[k] = (next[k] + rng.random_range(0..5))
                    .saturating_sub(2)
                    .min(problem.bins - 1);
            }
        }
        next.sort_unstable();
        next.dedup();
        let proposed = log_weight(problem, spacing, &next);
        if proposed > value || rng.random::<f64>() < ((proposed - value) / temperature).exp() {
            (lines, value) = (next, proposed);
            best = best.max(value);
        }
    }
    best
}
