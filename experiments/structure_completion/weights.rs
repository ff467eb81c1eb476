//! Known weights recovered from layouts drawn from the model of ten terms.

use serde::{Deserialize, Serialize};

use super::published::Published;
use super::row;
use edifice_base::rng::stream;
use edifice_base::unwatched;
use edifice_base::{Error, Result};
use edifice_frame::Context;
use edifice_model::factor_graph::Settings;
use edifice_report::{Align, BarGroup, Bars, Figure, Scale, Table};
use edifice_structure_completion::layout::Layout;
use edifice_structure_completion::policy::{PaperModel, WEIGHTS, weight_states};
use edifice_structure_completion::score::{ScoreModel, Sites, TERMS, Term};

/// Sweeps of the chain from a random state to a layout.
const SWEEPS: usize = 40;
/// Numbers of layouts.
const SIZES: [usize; 2] = [100, 300];
/// Candidates of which Eq. 20's completion is the best.
const CANDIDATES: usize = 20;

/// The ways in which negatives are made.
const SAMPLERS: [&str; 3] = [
    "block resampled",
    "Eq. 20, best of 20",
    "Eq. 20, one candidate",
];
/// Names of these in the CSV.
const METHODS: [&str; 3] = ["block", "eq_20_best", "eq_20_one"];

/// Learnt weights.
#[derive(Serialize, Deserialize)]
struct Learnt(Vec<f64>);

/// Draws a facade's layout from the model.
fn draw(score: &ScoreModel, states: &[Sites], repeat: u64, index: usize, seed: u64) -> Sites {
    let name = format!("weights: draws {repeat}");
    let mut rng = stream(seed, &name, index as u64);
    let state = &states[index % states.len()];
    state.draw(score, &score.weights, SWEEPS, &mut rng)
}

fn rmse(weights: &[f64], truth: &[f64; TERMS]) -> f64 {
    let square = |(a, b): (&f64, &f64)| (a - b).powi(2);
    (weights.iter().zip(truth).map(square).sum::<f64>() / TERMS as f64).sqrt()
}

/// Learns from layouts drawn with the weights that the facades of the data have.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let printed = Published::read(ctx)?;
    let items = super::figures::facades(ctx)?;
    let layouts: Vec<&Layout> = items.iter().take(100).map(|i| &i.layout).collect();
    let sizes = ctx.budget().choose([15, 25], SIZES, SIZES);
    let repeats = ctx.budget().choose(1, 1, 5);
    let rounds = ctx.budget().choose(5, 50, 200);
    ctx.setting("sweeps", SWEEPS);
    ctx.setting("rounds", rounds);
    let seed = ctx.seed();
    let owned: Vec<Layout> = layouts.iter().map(|l| (*l).clone()).collect();
    let mut model = PaperModel::of_densities(&owned, seed).map_err(Error::method)?;
    let states = weight_states(&layouts, seed);
    let truth = PaperModel::unbiased_weights(&model.score, &states, &WEIGHTS, seed, &unwatched);
    let truth = truth.map_err(Error::method)?;
    model.score.weights = truth;
    let spread = truth.iter().copied().fold(f64::NEG_INFINITY, f64::max)
        - truth.iter().copied().fold(f64::INFINITY, f64::min);
    // To convergence, with hardly a prior.
    let settings = Settings {
        rounds,
        rate: 0.5,
        penalty: 1e-4,
        newton: true,
        ..WEIGHTS
    };
    let mut units = Vec::new();
    for (s, &size) in sizes.iter().enumerate() {
        for repeat in 0..repeats {
            for sampler in 0..SAMPLERS.len() {
                // Eq. 20 does not get better with more layouts or draws: once is enough.
                if sampler == 0 || (repeat == 0 && s == 0) {
                    units.push((size, repeat, sampler));
                }
            }
        }
    }
    let learnt: Vec<Learnt> = ctx.units(
        &units,
        |(size, repeat, sampler)| format!("{size}/{repeat}/{}", METHODS[*sampler]),
        |&(size, repeat, sampler)| {
            let drawn = (0..size).map(|i| draw(&model.score, &states, repeat, i, seed));
            let drawn: Vec<Sites> = drawn.collect();
            let weights = if sampler == 0 {
                PaperModel::unbiased_weights(&model.score, &drawn, &settings, seed, &unwatched)
            } else {
                let layouts = drawn
                    .iter()
                    .enumerate()
                    .map(|(i, s)| s.layout(i.to_string()));
                let layouts: Vec<Layout> = layouts.filter(|l| l.elements.len() > 1).collect();
                let candidates = if sampler == 1 { CANDIDATES } else { 1 };
                model.printed_weights(&layouts, candidates, &settings, seed, &unwatched)
            };
            Ok(Learnt(weights.map_err(Error::method)?.to_vec()))
        },
    )?;
    let mut table = Table::new("Root mean square error of the recovered weights")
        .column("negatives", Align::Left)
        .numbers([
            "layouts",
            "data sets",
            "RMSE",
            "over the weights' spread",
            "worst",
        ]);
    for (m, sampler) in SAMPLERS.iter().enumerate() {
        for size in sizes {
            let of = units
                .iter()
                .zip(&learnt)
                .filter(|(u, _)| u.0 == size && u.2 == m);
            let all: Vec<f64> = of.map(|(_, w)| rmse(&w.0, &truth)).collect();
            if all.is_empty() {
                continue;
            }
            let mean = all.iter().sum::<f64>() / all.len() as f64;
            let worst = all.iter().copied().fold(0.0, f64::max);
            table.row([
                sampler.to_string(),
                size.to_string(),
                all.len().to_string(),
                format!("{mean:.3}"),
                format!("{:.3}", mean / spread),
                format!("{:.3}", worst / spread),
            ]);
            for (repeat, value) in all.iter().enumerate() {
                for (metric, value) in [("rmse", *value), ("rmse_over_spread", value / spread)] {
                    let instance = format!("layouts/{size}");
                    ctx.observe(row(
                        "drawn",
                        METHODS[m],
                        instance,
                        Some(repeat as u64),
                        metric,
                        value,
                    ));
                }
            }
        }
    }
    let names: Vec<String> = Term::ALL.map(|t| t.name().to_string()).to_vec();
    let mut each = Table::new("Weights")
        .column("term", Align::Left)
        .numbers(["true"]);
    let mut bars = Bars::new("", "", Scale::new("weight"), names.clone())
        .group("true", truth.iter().map(|w| Some(*w)).collect());
    let mut columns: Vec<Vec<(f64, f64)>> = Vec::new();
    for (m, sampler) in SAMPLERS.iter().enumerate() {
        let size = if m == 0 { sizes[1] } else { sizes[0] };
        let of = || {
            units
                .iter()
                .zip(&learnt)
                .filter(|(u, _)| u.0 == size && u.2 == m)
        };
        let stats = |k: usize| {
            let values: Vec<f64> = of().map(|(_, w)| w.0[k]).collect();
            let n = values.len().max(1) as f64;
            let mean = values.iter().sum::<f64>() / n;
            let square = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>();
            (mean, (square / (n - 1.0).max(1.0)).sqrt())
        };
        let column: Vec<(f64, f64)> = (0..TERMS).map(stats).collect();
        each = each.numbers([format!("{sampler}, {size} layouts")]);
        // Those of Eq. 20 run off the scale.
        if m == 0 {
            bars = bars.group_with_errors(BarGroup {
                name: format!("{sampler}, {size} layouts"),
                values: column.iter().map(|c| Some(c.0)).collect(),
                errors: column.iter().map(|c| c.1).collect(),
            });
        }
        columns.push(column);
    }
    for (k, name) in names.iter().enumerate() {
        let cells = columns
            .iter()
            .map(|c| format!("{:.2} ± {:.2}", c[k].0, c[k].1));
        each.row(
            [name.clone(), format!("{:.2}", truth[k])]
                .into_iter()
                .chain(cells),
        );
        ctx.observe(row(
            "drawn",
            "truth",
            name.clone(),
            None,
            "weight",
            truth[k],
        ));
    }
    ctx.figure(
        "weights",
        &Figure::single(
            "True weights, and those recovered with blocks resampled (bars: standard deviation over data sets)",
            bars,
        )
        .cell(900.0, 340.0),
    )?;
    ctx.table(&table);
    ctx.table(&each);
    ctx.compare(
        "share of the elements that a negative removes",
        printed.text("weights", "all", "removed_share"),
        "0.1",
    );
    ctx.note(format!("The true weights are those that the data's facades have; their spread is the greatest less the least, {spread:.2}. Layouts are drawn by {SWEEPS} sweeps over all attributes from a random state. Eq. 20 takes the completion of the layout without a tenth of its elements as the negative, which is no sample of the model: its weights do not come back."));
    Ok(())
}
