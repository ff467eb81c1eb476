//! Fig. 8: a completion by policies that were optimized for the facade, and one by a fixed policy.

use serde::{Deserialize, Serialize};

use super::super::picture::panel;
use super::super::row;
use super::{facades, judged, mean_error, paper, plus_minus, split};
use edifice_base::rng::stream;
use edifice_base::unwatched;
use edifice_base::{Error, Result};
use edifice_frame::Context;
use edifice_report::{Align, Figure, Table};
use edifice_structure_completion::layout::Element;
use edifice_structure_completion::measure::agreement;
use edifice_structure_completion::policy::{Budget, CompletionProblem, Policy, grow, optimize};
use edifice_structure_completion::task::Task;

/// Facades in the picture.
const SHOWN: usize = 3;

/// The best candidate of a policy.
#[derive(Serialize, Deserialize)]
struct Found {
    score: f64,
    f1: f64,
    added: Vec<Element>,
}

/// Completes known halves by as many candidates of either kind; the best by score counts.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let items = facades(ctx)?;
    let (shown, rest) = split(&items, ctx.budget().choose(2, 10, 60));
    let model = paper(ctx, &rest)?;
    let budget = ctx
        .budget()
        .choose(Budget::SMALL, Budget::PAPER, Budget::PAPER);
    ctx.setting("candidates", budget.candidates());
    let seed = ctx.seed();
    let units: Vec<_> = shown.iter().enumerate().collect();
    let hide = |k: usize, item: &super::Item| {
        Task::Side50.hide(&item.layout, &mut stream(seed, "figure 8", k as u64))
    };
    let found: Vec<[Found; 2]> = ctx.units(
        &units,
        |(_, i)| format!("{}/{}", i.dataset, i.layout.name),
        |(k, item)| {
            let (partial, hidden) = hide(*k, item);
            let problem = CompletionProblem::new(&model, &partial);
            let optimized =
                optimize(&problem, &budget, 1, seed, &unwatched).map_err(Error::method)?;
            let best = optimized.candidates.into_iter().next();
            let best = best.map_or((f64::NEG_INFINITY, Vec::new()), |c| (c.score, c.added));
            let mut rng = stream(seed, "figure 8: fixed", *k as u64);
            let mut fixed = (f64::NEG_INFINITY, Vec::new());
            for _ in 0..budget.candidates() {
                let elements = grow(&problem, &Policy::FIXED, &mut rng);
                let score = problem.score(&elements);
                if score > fixed.0 {
                    fixed = (score, elements[partial.observed.len()..].to_vec());
                }
            }
            Ok([best, fixed].map(|(score, added)| Found {
                score,
                f1: agreement(&added, &hidden, 0.5).f1,
                added,
            }))
        },
    )?;
    let mut figure = Figure::new(
        "Known half, optimized policies, fixed policy, truth (added elements outlined)",
        4,
    )
    .cell(230.0, 230.0);
    for ((k, item), found) in units.iter().zip(&found) {
        for (method, found) in ["optimized", "fixed"].iter().zip(found) {
            for (metric, value) in [("score", found.score), ("f1", found.f1)] {
                let instance = format!("side50/{}", item.layout.name);
                ctx.observe(row(item.dataset, method, instance, None, metric, value));
            }
        }
        if *k >= SHOWN {
            continue;
        }
        let (partial, _) = hide(*k, item);
        let (w, h) = (item.layout.width, item.layout.height);
        figure = figure.panel(panel(
            item.layout.name.clone(),
            w,
            h,
            &partial.observed,
            &[],
        ));
        for (method, found) in ["optimized", "fixed"].iter().zip(found) {
            let title = format!("{method}: score {:.1}, F1 {:.2}", found.score, found.f1);
            figure = figure.panel(panel(title, w, h, &partial.observed, &found.added));
        }
        figure = figure.panel(panel("truth".into(), w, h, &item.layout.elements, &[]));
    }
    let mut table = Table::new("Known halves completed, best of as many candidates")
        .column("policy", Align::Left)
        .numbers(["score", "F1"]);
    for (i, name) in ["optimized for the facade", "fixed"].iter().enumerate() {
        let of = |value: &dyn Fn(&Found) -> f64| -> Vec<f64> {
            found.iter().map(|f| value(&f[i])).collect()
        };
        table.row([
            name.to_string(),
            plus_minus(&of(&|f| f.score)),
            plus_minus(&of(&|f| f.f1)),
        ]);
    }
    let gain: Vec<f64> = found.iter().map(|f| f[0].score - f[1].score).collect();
    let better: Vec<f64> = found.iter().map(|f| f[0].f1 - f[1].f1).collect();
    let (mean, error) = mean_error(&gain);
    ctx.figure("figure_8", &figure)?;
    ctx.table(&table);
    ctx.note(format!(
        "{} candidates each, {} facades. The optimized policies gain {mean:.2} ± {error:.2} in score, facade by facade. The paper shows one facade without numbers.",
        budget.candidates(),
        found.len()
    ));
    ctx.note(judged(
        "policies optimized for the facade complete it better than a fixed one",
        "they gain in F1",
        &better,
    ));
    Ok(())
}
