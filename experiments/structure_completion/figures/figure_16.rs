//! Fig. 16: the weights, learnt from ever fewer facades.

use rand::seq::SliceRandom;

use super::super::published::Published;
use super::super::row;
use super::facades;
use edifice_base::rng::stream;
use edifice_base::unwatched;
use edifice_base::{Error, Result};
use edifice_frame::Context;
use edifice_report::{Align, Chart, Corner, Figure, Scale, Series, Table};
use edifice_structure_completion::layout::Layout;
use edifice_structure_completion::policy::{PaperModel, WEIGHTS, weight_states};
use edifice_structure_completion::score::{TERMS, Term};

/// Facades of the whole training set, and those left out each time, in tenths of it.
const WHOLE: usize = 100;

/// Learns the weights three times for each size.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let printed = Published::read(ctx)?;
    let mut layouts: Vec<Layout> = facades(ctx)?.into_iter().map(|i| i.layout).collect();
    layouts.shuffle(&mut stream(ctx.seed(), "figure 16", 0));
    layouts.truncate(WHOLE);
    let whole = layouts.len();
    let repeats = ctx.budget().choose(1, 3, 3);
    let tenths: Vec<usize> = ctx.budget().choose(
        vec![10, 5],
        (1..=10).rev().collect(),
        (1..=10).rev().collect(),
    );
    ctx.setting("repeats", repeats);
    // The functions stay those of the whole set, so that their weights can be compared.
    let score = PaperModel::of_densities(&layouts, ctx.seed())
        .map_err(Error::method)?
        .score;
    let units: Vec<(usize, u64)> = tenths
        .iter()
        .flat_map(|t| (0..repeats).map(move |r| ((t * whole).div_ceil(10), r)))
        .collect();
    let seed = ctx.seed();
    let learnt: Vec<Vec<f64>> = ctx.units(
        &units,
        |(size, repeat)| format!("{size}/{repeat}"),
        |&(size, repeat)| {
            let mut some: Vec<&Layout> = layouts.iter().collect();
            some.shuffle(&mut stream(seed, "figure 16: subset", repeat));
            let states = weight_states(&some[..size], seed ^ repeat);
            let weights =
                PaperModel::unbiased_weights(&score, &states, &WEIGHTS, seed ^ repeat, &unwatched);
            Ok(weights.map_err(Error::method)?.to_vec())
        },
    )?;
    let sizes: Vec<usize> = units.chunks(repeats as usize).map(|u| u[0].0).collect();
    let mut figure = Figure::new("Mean and standard deviation of each weight over repeats, against the number of training facades", 5)
        .cell(190.0, 150.0);
    let mut table =
        Table::new("Mean ± standard deviation of the weights, by the number of training facades")
            .column("term", Align::Left)
            .numbers(sizes.iter().map(usize::to_string));
    for k in 0..TERMS {
        let of = |chunk: &[Vec<f64>]| {
            let values: Vec<f64> = chunk.iter().map(|w| w[k]).collect();
            let n = values.len() as f64;
            let mean = values.iter().sum::<f64>() / n;
            let square = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>();
            (mean, (square / (n - 1.0).max(1.0)).sqrt())
        };
        let all: Vec<(f64, f64)> = learnt.chunks(repeats as usize).map(of).collect();
        let at = || sizes.iter().map(|s| *s as f64).zip(&all);
        let line = Series::marked("", at().map(|(x, (m, _))| (x, *m)).collect())
            .band(at().map(|(x, (m, d))| (x, m - d, m + d)).collect());
        let name = Term::ALL[k].name();
        figure = figure.panel(
            Chart::new(name, Scale::new("facades"), Scale::new(""))
                .series(line)
                .legend(Corner::None),
        );
        let cells = all.iter().map(|(m, d)| format!("{m:.2} ± {d:.2}"));
        table.row(std::iter::once(name.to_string()).chain(cells));
        for ((size, repeat), weights) in units.iter().zip(&learnt) {
            let instance = format!("{name}/{size}");
            ctx.observe(row(
                "all",
                "paper",
                instance,
                Some(*repeat),
                "weight",
                weights[k],
            ));
        }
    }
    ctx.figure("figure_16", &figure)?;
    ctx.table(&table);
    let text = |metric: &str| printed.text("figure_16", "all", metric);
    ctx.compare(
        "facades left out each time",
        text("facades_excluded_each_time"),
        whole.div_ceil(10).to_string(),
    );
    ctx.compare("repeats", text("repeats"), repeats.to_string());
    ctx.note("The paper's curve is a picture without numbers, of nine weights learnt by Eq. 20; ours are learnt without its bias.");
    Ok(())
}
