//! Fig. 14: simulated annealing on the score finds nothing meaningful.

use serde::{Deserialize, Serialize};

use super::super::picture::panel;
use super::super::{folds, row};
use super::{facades, first, judged, plus_minus, split};
use edifice_base::Result;
use edifice_base::rng::stream;
use edifice_frame::Context;
use edifice_report::{Align, Figure, Table};
use edifice_structure_completion::layout::Element;
use edifice_structure_completion::measure::agreement;
use edifice_structure_completion::method::{Method, complete};
use edifice_structure_completion::policy::{CompletionProblem, paper_model};
use edifice_structure_completion::task::Task;

/// Facades in the picture.
const SHOWN: usize = 3;
const METHODS: [Method; 3] = [Method::Annealing, Method::Paper, Method::Best];

#[derive(Serialize, Deserialize)]
struct Found {
    /// Score of the truth, then of each method.
    scores: Vec<f64>,
    f1: Vec<f64>,
    added: Vec<Vec<Element>>,
}

/// Completes known halves by annealing, by the paper's policies and by the default method.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let items = facades(ctx)?;
    let (shown, rest) = split(&items, ctx.budget().choose(1, 10, 60));
    let model = folds::model(&rest, ctx.seed(), |_| true)?;
    let Some(paper) = paper_model(&model) else {
        ctx.skip("no facade to learn from");
        return Ok(());
    };
    let seed = ctx.seed();
    let units: Vec<_> = shown.iter().enumerate().collect();
    let hide = |k: usize, item: &super::Item| {
        Task::Side50.hide(&item.layout, &mut stream(seed, "figure 14", k as u64))
    };
    let found: Vec<Found> = ctx.units(
        &units,
        |(_, i)| format!("{}/{}", i.dataset, i.layout.name),
        |(k, item)| {
            let (partial, hidden) = hide(*k, item);
            let problem = CompletionProblem::new(&paper, &partial);
            let mut found = Found {
                scores: vec![problem.score(&item.layout.elements)],
                f1: Vec::new(),
                added: Vec::new(),
            };
            for method in METHODS {
                let mut rng = stream(seed, "figure 14: completion", *k as u64);
                let added = first(&complete(method, &partial, &model, 1, &mut rng));
                let made: Vec<Element> = partial.observed.iter().chain(&added).copied().collect();
                found.scores.push(problem.score(&made));
                found.f1.push(agreement(&added, &hidden, 0.5).f1);
                found.added.push(added);
            }
            Ok(found)
        },
    )?;
    let mut figure = Figure::new(
        "Truth, observations, simulated annealing, the paper's policies, default method",
        5,
    )
    .cell(200.0, 210.0);
    for ((k, item), found) in units.iter().zip(&found).take(SHOWN) {
        let (w, h) = (item.layout.width, item.layout.height);
        let (partial, _) = hide(*k, item);
        let title = format!("score {:.1}", found.scores[0]);
        figure = figure
            .panel(panel(title, w, h, &item.layout.elements, &[]))
            .panel(panel("observed".into(), w, h, &partial.observed, &[]));
        for (m, method) in METHODS.iter().enumerate() {
            let (score, f1) = (found.scores[m + 1], found.f1[m]);
            let title = format!("{}: {score:.1}, F1 {f1:.2}", method.name());
            figure = figure.panel(panel(title, w, h, &partial.observed, &found.added[m]));
        }
    }
    let mut table = Table::new("Known halves completed")
        .column("method", Align::Left)
        .numbers(["F1", "score", "score above the truth's"]);
    for m in 0..=METHODS.len() {
        let scores: Vec<f64> = found.iter().map(|f| f.scores[m]).collect();
        let above = found.iter().filter(|f| f.scores[m] > f.scores[0]).count();
        let share = format!("{:.0} %", 100.0 * above as f64 / found.len().max(1) as f64);
        let (name, f1, share) = match m.checked_sub(1) {
            None => ("truth", "–".into(), "–".into()),
            Some(i) => {
                let f1: Vec<f64> = found.iter().map(|f| f.f1[i]).collect();
                (METHODS[i].name(), plus_minus(&f1), share)
            }
        };
        table.row([name.to_string(), f1, plus_minus(&scores), share]);
        for ((_, item), f) in units.iter().zip(&found) {
            let instance = format!("side50/{}", item.layout.name);
            if let Some(i) = m.checked_sub(1) {
                ctx.observe(row(
                    item.dataset,
                    name,
                    instance.clone(),
                    None,
                    "f1",
                    f.f1[i],
                ));
            }
            ctx.observe(row(
                item.dataset,
                name,
                instance,
                None,
                "score",
                f.scores[m],
            ));
        }
    }
    ctx.figure("figure_14", &figure)?;
    ctx.table(&table);
    ctx.note("Annealing adds, deletes and moves single elements, 100,000 evaluations; the policies make 10,000 candidates. The scores are those of the paper's model as it is learnt here. The paper shows two examples without numbers.");
    // In the order of the methods.
    let better: Vec<f64> = found.iter().map(|f| f.f1[1] - f.f1[0]).collect();
    ctx.note(judged(
        "annealing by single moves fails where the policies complete",
        "the policies gain in F1",
        &better,
    ));
    Ok(())
}
