//! Section 5.3: the number of rules over `alpha`, `b_p` and `b_h` (Eq. 12).

use super::data::{Source, sources};
use super::{data_table, row};
use edifice_base::{Error, Result};
use edifice_frame::{Budget, Context};
use edifice_optim::grid::points;
use edifice_procedural_logic::{Inference, Model, Parameters, fewest_rules, search_axes};
use edifice_report::{Figure, HeatMap};

/// The number of rules that the paper prints for every value of its ranges.
const PRINTED: f64 = 68.0;

/// Searches the grid for the fewest rules, on each set.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let axes = axes(ctx.budget());
    ctx.setting("alpha", axes[0].clone());
    ctx.setting("b_p", axes[1].clone());
    ctx.setting("b_h", axes[2].clone());
    let mut table = data_table(
        "Rules at the paper's parameters (0.6, 0.25, 0.5) and at the best found",
        &[],
        &[
            "facades",
            "binary splits",
            "n-ary splits",
            "rules",
            "compression",
            "fewest rules",
        ],
    );
    for source in sources(ctx)? {
        for (dataset, grids) in source.sets() {
            let found = fewest_rules(grids, &axes).map_err(Error::method)?;
            let evaluated: Vec<(Vec<f64>, f64)> = (points(&axes).zip(&found.trace))
                .map(|(point, step)| (point, step.cost))
                .collect();
            for (point, count) in &evaluated {
                ctx.observe(row(dataset, "inferred", name(point), "rules", *count));
            }
            let printed = Parameters::COMPRESSION;
            let model = Model::fit(grids, printed).map_err(Error::method)?;
            let inference = model.inference;
            let count = inference.rules.len() as f64;
            let ratio = inference.binary_splits as f64 / count;
            table.row([
                dataset.to_owned(),
                grids.len().to_string(),
                inference.binary_splits.to_string(),
                inference.nary_splits.to_string(),
                inference.rules.len().to_string(),
                format!("{ratio:.0} : 1"),
                format!("{} at {}", found.cost, name(&found.best)),
            ]);
            for (method, rules) in [
                ("inferred", count),
                ("binary", inference.binary_splits as f64),
                ("nary", inference.nary_splits as f64),
            ] {
                ctx.observe(row(dataset, method, "paper", "rules", rules));
            }
            ctx.observe(row(dataset, "inferred", "best", "rules", found.cost));
            if dataset == source.dataset {
                if source.is_paper() {
                    compare(ctx, &evaluated, found.cost, &inference);
                }
                if source.pictured {
                    draw(ctx, &source, &evaluated, found.cost)?;
                }
            }
        }
    }
    ctx.table(&table);
    ctx.note(
        "Counted are split rules; inserts are part of the rule that calls them. No layout was \
         regularized. The search is the grid solver of the optimizer layer.",
    );
    Ok(())
}

fn axes(budget: Budget) -> [Vec<f64>; 3] {
    match budget {
        Budget::Smoke => [vec![0.6, 1.0], vec![0.25], vec![0.5, 1.0]],
        _ => search_axes(),
    }
}

fn name(point: &[f64]) -> String {
    format!("alpha={} b_p={} b_h={}", point[0], point[1], point[2])
}

/// The points of a search with their numbers of rules.
type Evaluated = [(Vec<f64>, f64)];

/// The paper's claim about the ranges.
fn compare(ctx: &mut Context, evaluated: &Evaluated, fewest: f64, inference: &Inference) {
    let in_range = |p: &[f64]| p[0] >= 0.25 && p[1] <= 0.5 && p[2] >= 0.125;
    let named: Vec<f64> = evaluated
        .iter()
        .filter(|e| in_range(&e.0))
        .map(|e| e.1)
        .collect();
    let equal = named.iter().filter(|&&count| count == PRINTED).count();
    ctx.compare(
        "rules at (0.6, 0.25, 0.5)",
        "68",
        inference.rules.len().to_string(),
    );
    ctx.compare("fewest rules over the search", "68", format!("{fewest}"));
    ctx.compare(
        "points of the search within alpha 0.25..1, b_p 0.0625..0.5, b_h 0.125..1 with 68 rules",
        "all",
        format!("{equal} of {}", named.len()),
    );
    ctx.compare(
        "compression against the uncompressed count",
        "two orders of magnitude",
        format!(
            "{:.0} : 1",
            inference.binary_splits as f64 / inference.rules.len() as f64
        ),
    );
}

/// The number of rules over the grid, one map for each alpha.
fn draw(ctx: &mut Context, source: &Source, evaluated: &Evaluated, fewest: f64) -> Result<()> {
    let title = format!(
        "Number of rules on {} over b_p and b_h, for each alpha",
        source.dataset
    );
    let mut figure = Figure::new(title, 3);
    let values = |index: usize| {
        let mut values: Vec<f64> = evaluated.iter().map(|e| e.0[index]).collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        values
    };
    let (alphas, parental, horizontal) = (values(0), values(1), values(2));
    let highest = evaluated.iter().map(|e| e.1).fold(0.0, f64::max);
    for alpha in alphas {
        let cell = |p: f64, h: f64| {
            let at = evaluated.iter().find(|e| e.0 == [alpha, p, h]);
            at.map_or(f64::NAN, |e| e.1)
        };
        let matrix = parental
            .iter()
            .map(|&p| horizontal.iter().map(|&h| cell(p, h)).collect())
            .collect();
        let names =
            |name: &str, values: &[f64]| values.iter().map(|v| format!("{name} {v}")).collect();
        figure = figure.panel(
            HeatMap::new(format!("alpha = {alpha}"), matrix, "rules")
                .names(names("b_p", &parental), names("b_h", &horizontal))
                .range(fewest, highest.max(fewest + 1.0)),
        );
    }
    ctx.figure(&source.figure("compression"), &figure)
}
