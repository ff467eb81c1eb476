//! Fig. 17 and 18: completions by the paper's method with one scoring function left out.

use serde::{Deserialize, Serialize};

use super::super::picture::panel;
use super::super::row;
use super::{Item, TRUE, facades, paper, plus_minus, split, verdict};
use edifice_base::rng::{Stream, stream};
use edifice_base::unwatched;
use edifice_base::{Error, Result};
use edifice_frame::Context;
use edifice_report::{Align, Figure, Table, Tiles};
use edifice_structure_completion::layout::{Element, Layout};
use edifice_structure_completion::measure::agreement;
use edifice_structure_completion::partial::PartialLayout;
use edifice_structure_completion::policy::{Budget, CompletionProblem, PaperModel, optimize};
use edifice_structure_completion::score::{TERMS, Term};
use edifice_structure_completion::task::Task;

/// Facades in the picture of Fig. 17.
const SHOWN: usize = 3;

/// A completion; of each left-out term, and at last of all terms.
#[derive(Serialize, Deserialize)]
struct Found {
    f1: f64,
    added: Vec<Element>,
}

fn title(left_out: usize) -> String {
    match Term::ALL.get(left_out) {
        Some(term) => format!("without {}", term.name()),
        None => "all terms".into(),
    }
}

/// The random numbers that decide which part of a layout is hidden: the same in these figures and in sweeps, whatever
/// other facades are completed.
pub(crate) fn drawn(layout: &Layout, seed: u64) -> Stream {
    stream(seed, &format!("figure 18, {}", layout.name), 0)
}

fn hide(item: &Item, seed: u64) -> (PartialLayout, Vec<Element>) {
    Task::Side50.hide(&item.layout, &mut drawn(&item.layout, seed))
}

fn complete(
    item: &Item,
    left_out: usize,
    model: &PaperModel,
    budget: &Budget,
    seed: u64,
) -> Result<Found> {
    let (partial, hidden) = hide(item, seed);
    let left_out: Vec<usize> = (left_out < TERMS).then_some(left_out).into_iter().collect();
    let added = without(&partial, &left_out, model, budget, seed)?;
    Ok(Found {
        f1: agreement(&added, &hidden, 0.5).f1,
        added,
    })
}

/// The elements that the paper's method adds when some scoring functions, by index, weigh nothing.
pub(crate) fn without(
    partial: &PartialLayout,
    left_out: &[usize],
    model: &PaperModel,
    budget: &Budget,
    seed: u64,
) -> Result<Vec<Element>> {
    let mut problem = CompletionProblem::new(model, partial);
    for &term in left_out {
        if let Some(weight) = problem.weights.get_mut(term) {
            *weight = 0.0;
        }
    }
    let found = optimize(&problem, budget, 1, seed, &unwatched).map_err(Error::method)?;
    let best = found.candidates.into_iter().next();
    Ok(best.map_or(Vec::new(), |c| c.added))
}

fn shown(item: &Item, seed: u64, title: String, added: &[Element]) -> Tiles {
    let (partial, _) = hide(item, seed);
    let (w, h) = (item.layout.width, item.layout.height);
    panel(title, w, h, &partial.observed, added)
}

/// Fig. 17: with and without the symmetry term.
pub(crate) fn figure_17(ctx: &mut Context) -> Result<()> {
    let symmetry = Term::Symmetry as usize;
    let (_, items, found) = measure(ctx, &[TERMS, symmetry])?;
    let seed = ctx.seed();
    let mut figure = Figure::new(
        "Known half, all terms, without facade symmetry, truth (added elements outlined)",
        4,
    )
    .cell(220.0, 220.0);
    for (item, found) in items.iter().zip(&found).take(SHOWN) {
        let (w, h) = (item.layout.width, item.layout.height);
        figure = figure.panel(shown(item, seed, item.layout.name.clone(), &[]));
        for (f, name) in found.iter().zip(["all terms", "without symmetry"]) {
            let title = format!("{name}: F1 {:.2}", f.f1);
            figure = figure.panel(shown(item, seed, title, &f.added));
        }
        figure = figure.panel(panel("truth".into(), w, h, &item.layout.elements, &[]));
    }
    ctx.figure("figure_17", &figure)?;
    table(ctx, &[TERMS, symmetry], &items, &found);
    Ok(())
}

/// Fig. 18: each term left out.
pub(crate) fn figure_18(ctx: &mut Context) -> Result<()> {
    // All terms first.
    let terms: Vec<usize> = std::iter::once(TERMS).chain(0..TERMS).collect();
    let (_, items, found) = measure(ctx, &terms)?;
    let seed = ctx.seed();
    let mut figure = Figure::new("Known half of one facade completed with all terms, and with each left out, F1 (added elements outlined)", 6)
        .cell(205.0, 210.0);
    if let (Some(item), Some(found)) = (items.first(), found.first()) {
        let (w, h) = (item.layout.width, item.layout.height);
        figure = figure.panel(panel("truth".into(), w, h, &item.layout.elements, &[]));
        for (f, &left_out) in found.iter().zip(&terms) {
            let name = title(left_out).replace("without", "no");
            let title = format!("{name}: {:.2}", f.f1);
            figure = figure.panel(shown(item, seed, title, &f.added));
        }
    }
    ctx.figure("figure_18", &figure)?;
    table(ctx, &terms, &items, &found);
    Ok(())
}

/// Completes facades with each of some terms left out (`TERMS`: none).
fn measure(ctx: &mut Context, terms: &[usize]) -> Result<(PaperModel, Vec<Item>, Vec<Vec<Found>>)> {
    let items = facades(ctx)?;
    let (chosen, rest) = split(&items, ctx.budget().choose(1, 12, 40));
    let model = paper(ctx, &rest)?;
    let budget = ctx
        .budget()
        .choose(Budget::SMALL, Budget::PAPER, Budget::PAPER);
    ctx.setting("candidates", budget.candidates());
    let seed = ctx.seed();
    let units: Vec<(&Item, usize)> = chosen
        .iter()
        .flat_map(|item| terms.iter().map(move |&t| (*item, t)))
        .collect();
    let found: Vec<Found> = ctx.units(
        &units,
        |(i, t)| format!("{}/{}/{}", i.dataset, i.layout.name, title(*t)),
        |&(item, left_out)| complete(item, left_out, &model, &budget, seed),
    )?;
    let mut found = found.into_iter();
    let rows = chosen
        .iter()
        .map(|_| found.by_ref().take(terms.len()).collect())
        .collect();
    Ok((model, chosen.into_iter().cloned().collect(), rows))
}

fn table(ctx: &mut Context, terms: &[usize], items: &[Item], found: &[Vec<Found>]) {
    let mut table =
        Table::new("F1 of hidden elements, known halves completed by the paper's method")
            .column("score", Align::Left)
            .numbers(["F1", "less than with all terms", "the claim that it helps"]);
    let mut helping = 0;
    for (i, &left_out) in terms.iter().enumerate() {
        let f1: Vec<f64> = found.iter().map(|f| f[i].f1).collect();
        let loss: Vec<f64> = found.iter().map(|f| f[0].f1 - f[i].f1).collect();
        let (loss, claim) = match i {
            0 => ("–".into(), "–"),
            _ => (plus_minus(&loss), verdict(&loss)),
        };
        helping += usize::from(claim == TRUE);
        table.row([title(left_out), plus_minus(&f1), loss, claim.to_owned()]);
        for (item, value) in items.iter().zip(&f1) {
            let instance = format!("{}/side50/{}", title(left_out), item.layout.name);
            ctx.observe(row(item.dataset, "paper", instance, None, "f1", *value));
        }
    }
    ctx.table(&table);
    ctx.note(format!("{} facades; the weight of the term is 0, the others stay. The paper shows pictures and says that leaving out any term reduces the overall quality: of {} that are left out here, {helping} reduce it by more than two standard errors.", items.len(), terms.len() - 1));
}
