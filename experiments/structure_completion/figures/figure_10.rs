//! Fig. 10: the more is observed, the nearer the completion is to the truth.

use rand::seq::SliceRandom;
use serde::{Deserialize, Serialize};

use super::super::picture::panel;
use super::super::{folds, row};
use super::{facades, first, mean_error, plus_minus, split};
use edifice_base::Result;
use edifice_base::rng::stream;
use edifice_frame::Context;
use edifice_report::{Align, Chart, Corner, Figure, Scale, Series, Table};
use edifice_structure_completion::layout::{Element, Layout};
use edifice_structure_completion::measure::agreement;
use edifice_structure_completion::method::{Method, complete};
use edifice_structure_completion::partial::PartialLayout;

/// Facades in the picture.
const SHOWN: usize = 3;
/// Shares of the elements that are observed.
const SHARES: [f64; 5] = [0.75, 0.5, 0.25, 0.1, 0.05];
/// Shares in the picture.
const PICTURED: usize = 4;
const METHODS: [Method; 4] = [
    Method::Best,
    Method::Lattice,
    Method::LowRank,
    Method::Mirror,
];

/// F1 by share and method, and what the default method adds.
#[derive(Serialize, Deserialize)]
struct Found {
    f1: Vec<Vec<f64>>,
    added: Vec<Vec<Element>>,
}

/// A layout of which the first elements of a random order are observed; what is hidden.
fn observe(layout: &Layout, share: f64, seed: u64, k: u64) -> (PartialLayout, Vec<Element>) {
    let mut elements = layout.elements.clone();
    elements.shuffle(&mut stream(seed, "figure 10", k));
    let count = (share * elements.len() as f64).round().max(1.0) as usize;
    let hidden = elements.split_off(count.min(elements.len()));
    let partial = PartialLayout {
        width: layout.width,
        height: layout.height,
        observed: elements,
        unknown: None,
        forbidden: Vec::new(),
    };
    (partial, hidden)
}

/// Observes ever fewer of the same elements.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let items = facades(ctx)?;
    let (shown, rest) = split(&items, ctx.budget().choose(3, 16, 100));
    let model = folds::fast_model(&rest, ctx.seed(), |_| true)?;
    let seed = ctx.seed();
    let units: Vec<_> = shown.iter().enumerate().collect();
    let found: Vec<Found> = ctx.units(
        &units,
        |(_, i)| format!("{}/{}", i.dataset, i.layout.name),
        |(k, item)| {
            let (mut f1, mut added) = (Vec::new(), Vec::new());
            for share in SHARES {
                let (partial, hidden) = observe(&item.layout, share, seed, *k as u64);
                let mut of_share = Vec::new();
                for method in METHODS {
                    let mut rng = stream(seed, "figure 10: completion", *k as u64);
                    let own = first(&complete(method, &partial, &model, 1, &mut rng));
                    of_share.push(agreement(&own, &hidden, 0.5).f1);
                    if method == Method::Best {
                        added.push(own);
                    }
                }
                f1.push(of_share);
            }
            Ok(Found { f1, added })
        },
    )?;
    let mut figure = Figure::new(
        "Truth, and completions of ever fewer observed elements (added ones outlined)",
        PICTURED + 1,
    )
    .cell(200.0, 210.0);
    for ((k, item), found) in units.iter().zip(&found).take(SHOWN) {
        let (w, h) = (item.layout.width, item.layout.height);
        let name = item.layout.name.clone();
        figure = figure.panel(panel(name, w, h, &item.layout.elements, &[]));
        for (s, share) in SHARES.into_iter().enumerate().take(PICTURED) {
            let (partial, _) = observe(&item.layout, share, seed, *k as u64);
            let title = format!("{:.0} % seen: F1 {:.2}", 100.0 * share, found.f1[s][0]);
            figure = figure.panel(panel(title, w, h, &partial.observed, &found.added[s]));
        }
    }
    let mut table = Table::new("F1 of the hidden elements by the share that is observed")
        .column("method", Align::Left)
        .numbers(SHARES.map(|s| format!("{:.0} %", 100.0 * s)));
    let share = Scale::new("share of the elements that is observed");
    let mut chart = Chart::new("", share, Scale::new("F1").range(0.0, 1.0)).legend(Corner::Above);
    for (m, method) in METHODS.iter().enumerate() {
        let of = |s: usize| -> Vec<f64> { found.iter().map(|f| f.f1[s][m]).collect() };
        let all: Vec<Vec<f64>> = (0..SHARES.len()).map(of).collect();
        let cells = all.iter().map(|v| plus_minus(v));
        table.row(std::iter::once(method.name().to_string()).chain(cells));
        let points: Vec<(f64, (f64, f64))> = SHARES
            .iter()
            .zip(&all)
            .map(|(s, v)| (*s, mean_error(v)))
            .collect();
        let line = points.iter().map(|(s, (mean, _))| (*s, *mean)).collect();
        let band = points
            .iter()
            .map(|(s, (m, e))| (*s, m - e, m + e))
            .collect();
        chart = chart.series(Series::marked(method.name(), line).band(band));
        for ((_, item), f) in units.iter().zip(&found) {
            for (s, share) in SHARES.iter().enumerate() {
                let instance = format!("{share}/{}", item.layout.name);
                ctx.observe(row(
                    item.dataset,
                    method.name(),
                    instance,
                    None,
                    "f1",
                    f.f1[s][m],
                ));
            }
        }
    }
    ctx.figure("figure_10", &figure)?;
    ctx.figure(
        "figure_10_curve",
        &Figure::single(
            "F1 against the share that is observed, with standard errors",
            chart,
        )
        .cell(520.0, 320.0),
    )?;
    ctx.table(&table);
    ctx.note(format!("{} facades; the elements that are observed at one share are observed at all larger ones. The paper shows three examples without numbers.", found.len()));
    Ok(())
}
