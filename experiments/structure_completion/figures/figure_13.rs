//! Fig. 13: limits. Completions are regular, facades need not be.

use serde::{Deserialize, Serialize};

use super::super::picture::panel;
use super::super::{data, folds, row};
use super::{first, judged, plus_minus};
use edifice_base::Result;
use edifice_base::rng::stream;
use edifice_frame::Context;
use edifice_report::{Align, Figure, Table};
use edifice_structure_completion::layout::{Class, Element, Layout};
use edifice_structure_completion::measure::agreement;
use edifice_structure_completion::method::{Method, complete};
use edifice_structure_completion::score::{ScoreModel, Term};
use edifice_structure_completion::task::Task;

/// Facades in the picture.
const SHOWN: usize = 3;

/// Regularity and completeness of the grids (Eq. 3 and 4), 0 where typical, below where not.
fn regularity(score: &ScoreModel, layout: &Layout, elements: &[Element]) -> f64 {
    let features = score
        .evaluate([layout.width, layout.height], elements)
        .features;
    features[Term::Regularity as usize] + features[Term::Completeness as usize]
}

#[derive(Serialize, Deserialize)]
struct Found {
    f1: f64,
    regularity: f64,
    added: Vec<Element>,
}

/// Completes the least and the most regular facades of the data.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let mut items = data::items(ctx)?;
    items.retain(|i| i.layout.count(Class::Window) >= 8 && i.layout.elements.len() <= 90);
    let seed = ctx.seed();
    let all: Vec<&data::Item> = items.iter().collect();
    let whole = folds::model(&all, seed, |_| true)?;
    let Some(paper) = &whole.paper else {
        ctx.skip("no facade to learn from");
        return Ok(());
    };
    let regular = |i: &data::Item| regularity(&paper.score, &i.layout, &i.layout.elements);
    let mut order: Vec<(f64, usize)> = items.iter().map(regular).zip(0..).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    let count = ctx.budget().choose(2, 6, 30).min(items.len() / 4).max(1);
    let most = order[order.len() - count..].iter();
    let chosen: Vec<usize> = order[..count].iter().chain(most).map(|o| o.1).collect();
    // None of them is learnt from.
    let model = folds::fast_model(&all, seed, |i| !chosen.contains(&i))?;
    let hide = |index: usize| {
        Task::Side50.hide(
            &items[index].layout,
            &mut stream(seed, "figure 13", index as u64),
        )
    };
    let found: Vec<Found> = ctx.units(
        &chosen,
        |&i| format!("{}/{}/{i}", items[i].dataset, items[i].layout.name),
        |&index| {
            let (partial, hidden) = hide(index);
            let mut rng = stream(seed, "figure 13: completion", index as u64);
            let added = first(&complete(Method::Best, &partial, &model, 1, &mut rng));
            let made: Vec<Element> = partial.observed.iter().chain(&added).copied().collect();
            Ok(Found {
                f1: agreement(&added, &hidden, 0.5).f1,
                regularity: regularity(&paper.score, &items[index].layout, &made),
                added,
            })
        },
    )?;
    let mut figure = Figure::new(
        "The least regular facades: truth, observed half, completion (added elements outlined)",
        3,
    )
    .cell(240.0, 220.0);
    for (&index, found) in chosen.iter().zip(&found).take(SHOWN.min(count)) {
        let layout = &items[index].layout;
        let (w, h) = (layout.width, layout.height);
        let (partial, _) = hide(index);
        let title = format!("F1 {:.2}", found.f1);
        figure = figure
            .panel(panel(layout.name.clone(), w, h, &layout.elements, &[]))
            .panel(panel("observed".into(), w, h, &partial.observed, &[]))
            .panel(panel(title, w, h, &partial.observed, &found.added));
    }
    let mut table = Table::new("Known halves completed, by the regularity of the facade")
        .column("facades", Align::Left)
        .numbers(["F1", "regularity of the truth", "of the completion"]);
    for (k, name) in ["least regular", "most regular"].iter().enumerate() {
        let range = k * count..(k + 1) * count;
        let f1: Vec<f64> = found[range.clone()].iter().map(|f| f.f1).collect();
        let made: Vec<f64> = found[range.clone()].iter().map(|f| f.regularity).collect();
        let truth: Vec<f64> = chosen[range].iter().map(|&i| regular(&items[i])).collect();
        table.row([
            format!("{name} ({count})"),
            plus_minus(&f1),
            plus_minus(&truth),
            plus_minus(&made),
        ]);
    }
    for (&index, found) in chosen.iter().zip(&found) {
        let item = &items[index];
        let truth = regular(item);
        for (method, metric, value) in [
            ("best", "f1", found.f1),
            ("best", "regularity", found.regularity),
            ("truth", "regularity", truth),
        ] {
            let name = format!("side50/{}", item.layout.name);
            ctx.observe(row(item.dataset, method, name, None, metric, value));
        }
    }
    ctx.figure("figure_13", &figure)?;
    ctx.table(&table);
    ctx.note("Regularity is the sum of the scoring functions of Eq. 3 and 4, which is 0 for a typical facade and below for others. Out-of-scope facades are among the least regular. The paper shows three examples and says that the highest ranked completion does not match an irregular truth.");
    let least = chosen.iter().zip(&found).take(count);
    let regularized: Vec<f64> = least
        .map(|(&i, f)| f.regularity - regular(&items[i]))
        .collect();
    ctx.note(judged(
        "irregular facades are completed too regularly",
        "of the least regular ones the completion is more regular by",
        &regularized,
    ));
    Ok(())
}
