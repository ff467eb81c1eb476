//! Fig. 11: what is observed lies in two regions apart.

use serde::{Deserialize, Serialize};

use super::super::picture::panel;
use super::super::{folds, row};
use super::{facades, first, plus_minus, split};
use edifice_base::Result;
use edifice_base::rng::stream;
use edifice_frame::Context;
use edifice_report::{Align, Figure, Table};
use edifice_shape::Rect;
use edifice_structure_completion::layout::{Element, Layout};
use edifice_structure_completion::measure::agreement;
use edifice_structure_completion::method::{Method, complete};
use edifice_structure_completion::partial::PartialLayout;

/// Facades in the picture.
const SHOWN: usize = 3;
const METHODS: [Method; 5] = [
    Method::Best,
    Method::Lattice,
    Method::LowRank,
    Method::Mirror,
    Method::Nearest,
];

/// The upper left and the lower right, 0.45 of the width and half of the height each, are known.
fn apart(layout: &Layout) -> (PartialLayout, Vec<Element>) {
    let (w, h) = (layout.width, layout.height);
    let (across, up) = (0.55 * w, 0.5 * h);
    let unknown = vec![
        Rect::new(0.45 * w, up, across, up),
        Rect::new(0.0, 0.0, across, up),
    ];
    PartialLayout::hiding(layout, unknown)
}

#[derive(Serialize, Deserialize)]
struct Found {
    f1: Vec<f64>,
    added: Vec<Element>,
}

/// Completes between two known regions.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let items = facades(ctx)?;
    let (shown, rest) = split(&items, ctx.budget().choose(3, 16, 100));
    let model = folds::fast_model(&rest, ctx.seed(), |_| true)?;
    let seed = ctx.seed();
    let found: Vec<Found> = ctx.units(
        &shown,
        |i| format!("{}/{}", i.dataset, i.layout.name),
        |item| {
            let (partial, hidden) = apart(&item.layout);
            let answers = METHODS.map(|method| {
                let mut rng = stream(seed, &format!("figure 11/{}", item.layout.name), 0);
                first(&complete(method, &partial, &model, 1, &mut rng))
            });
            let f1 = answers.iter().map(|a| agreement(a, &hidden, 0.5).f1);
            Ok(Found {
                f1: f1.collect(),
                added: answers[0].clone(),
            })
        },
    )?;
    let mut figure = Figure::new(
        "Truth, two known regions, completion (added elements outlined)",
        3,
    )
    .cell(240.0, 230.0);
    for (item, found) in shown.iter().zip(&found).take(SHOWN) {
        let (w, h) = (item.layout.width, item.layout.height);
        let (partial, _) = apart(&item.layout);
        let name = item.layout.name.clone();
        let title = format!("F1 {:.2}", found.f1[0]);
        figure = figure
            .panel(panel(name, w, h, &item.layout.elements, &[]))
            .panel(panel("observed".into(), w, h, &partial.observed, &[]))
            .panel(panel(title, w, h, &partial.observed, &found.added));
    }
    let mut table = Table::new("F1 of the elements outside two known regions")
        .column("method", Align::Left)
        .numbers(["F1"]);
    for (m, method) in METHODS.iter().enumerate() {
        let all: Vec<f64> = found.iter().map(|f| f.f1[m]).collect();
        table.row([method.name().to_string(), plus_minus(&all)]);
        for (item, value) in shown.iter().zip(&all) {
            let name = item.layout.name.clone();
            ctx.observe(row(item.dataset, method.name(), name, None, "f1", *value));
        }
    }
    ctx.figure("figure_11", &figure)?;
    ctx.table(&table);
    ctx.note(format!(
        "{} facades. The paper shows two examples without numbers.",
        found.len()
    ));
    Ok(())
}
