//! Fig. 5: computing time and number of rules against the number of facades.

use std::time::Instant;

use super::data::{Source, sources};
use super::{data_table, row};
use edifice_base::rng::stream;
use edifice_base::{Error, Result};
use edifice_frame::memory::peak_megabytes;
use edifice_frame::{Budget, Context};
use edifice_procedural_logic::{
    Alphabet, Canvas, Coefficients, Inference, NaryTree, Parameters, learn_affinity, parse,
};
use edifice_report::{Chart, Corner, Figure, Scale, Series, Table};
use edifice_shape::LabelGrid;
use rand::RngExt;

const PARAMETERS: Parameters = Parameters::COMPRESSION;

/// Rules and time of each stage, and the time of resampled sets up to a city.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let mut figure = Figure::new("Rules against the number of facades", 3);
    let mut table = data_table(
        "The whole inference, resampled to larger sets",
        &[],
        &["facades", "rules"],
    )
    .times([
        "seconds, 1 thread",
        "seconds, all threads",
        "ms per facade, 1 thread",
        "peak memory, MB",
    ]);
    let mut times = Figure::new("Computing time against the number of facades", 3);
    for source in sources(ctx)? {
        for (dataset, grids) in source.sets() {
            let mut alphabet = Alphabet::default();
            let coefficients = learn_affinity(grids, &mut alphabet, &PARAMETERS).normalized();
            figure = figure.panel(rules(ctx, dataset, grids, &alphabet, &coefficients)?);
            if dataset == source.dataset {
                times = times.panel(seconds(ctx, dataset, grids, &alphabet, &coefficients)?);
                resampled(ctx, &source, &alphabet, &coefficients, &mut table)?;
            }
        }
    }
    ctx.figure("figure_5", &figure)?;
    ctx.figure_of_times("figure_5", &times)?;
    ctx.table(&table);
    ctx.note(
        "Facades are added in the order of their names, the shipped houses first as they are, then at other \
         sizes, which bring no new rule. Rules are split rules; seconds are those of one thread, from the picture \
         in memory (of the real sets every pixel, of the shipped ones the cells between cut lines) to rules and \
         their statistics, the least of several runs. Reading files is not counted. Peak memory is that of the \
         whole process.",
    );
    Ok(())
}

/// The number of rules after each facade, for each stage.
fn rules(
    ctx: &mut Context,
    dataset: &str,
    grids: &[LabelGrid],
    alphabet: &Alphabet,
    coefficients: &Coefficients,
) -> Result<Chart> {
    let mut inference = Inference::default();
    let mut curves = [Vec::new(), Vec::new(), Vec::new()];
    let mut alphabet = alphabet.clone();
    for (index, grid) in grids.iter().enumerate() {
        let labels = alphabet.intern_all(&grid.labels);
        let tree = parse(&Canvas::from_grid(grid, labels), coefficients, &PARAMETERS);
        inference.add(&tree.map_err(Error::method)?);
        let n = (index + 1) as f64;
        let counts = [
            inference.binary_splits as f64,
            inference.nary_splits as f64,
            inference.rules.len() as f64,
        ];
        for ((curve, method), count) in curves.iter_mut().zip(STAGES).zip(counts) {
            curve.push((n, count));
            ctx.observe(row(
                dataset,
                method,
                (index + 1).to_string(),
                "rules",
                count,
            ));
        }
    }
    if dataset == "ecp2011" {
        let after = |n: usize| curves[2].get(n - 1).map_or(f64::NAN, |point| point.1);
        ctx.compare(
            "new rules per facade, first 20 and the rest",
            "a clear drop in rule growth after about 20 facades",
            format!(
                "{:.2}, {:.2}",
                after(20) / 20.0,
                (inference.rules.len() as f64 - after(20)) / (grids.len() as f64 - 20.0).max(1.0)
            ),
        );
        let once = inference
            .rules
            .rules()
            .iter()
            .filter(|rule| rule.uses == 1)
            .count();
        ctx.compare(
            "rules used once",
            "continual growth: exceptions are the rule",
            format!("{once} of {}", inference.rules.len()),
        );
    }
    let mut chart = Chart::new(
        format!("{dataset}: rules"),
        Scale::new("facades"),
        Scale::new("rules").log(),
    )
    .legend(Corner::Above);
    for (curve, method) in curves.into_iter().zip(STAGES) {
        chart = chart.series(Series::line(method, curve));
    }
    Ok(chart)
}

/// The stages of the inference.
const STAGES: [&str; 3] = ["binary", "nary", "inferred"];

/// Seconds for the first n facades, for each stage.
fn seconds(
    ctx: &mut Context,
    dataset: &str,
    grids: &[LabelGrid],
    alphabet: &Alphabet,
    coefficients: &Coefficients,
) -> Result<Chart> {
    let repeats = ctx.budget().choose(1, 25, 50);
    let mut chart = Chart::new(
        format!("{dataset}: seconds, one thread"),
        Scale::new("facades"),
        Scale::new("seconds").from_zero(),
    )
    .legend(Corner::Above);
    for (stage, method) in STAGES.into_iter().enumerate() {
        let mut curve = Vec::new();
        for tenth in 1..=10 {
            let count = (grids.len() * tenth / 10).max(1);
            let mut least = f64::INFINITY;
            for _ in 0..repeats {
                let start = Instant::now();
                run_stage(&grids[..count], alphabet, coefficients, stage)?;
                least = least.min(start.elapsed().as_secs_f64());
            }
            curve.push((count as f64, least));
            let mut observation = row(dataset, method, count.to_string(), "seconds", least);
            observation.unit = "s".into();
            ctx.observe(observation);
        }
        if dataset == "ecp2011" && stage == 2 {
            let (count, least) = curve[curve.len() - 1];
            ctx.compare_times(
                "computing time per facade, one core",
                "32 ms",
                format!("{:.3} ms", 1000.0 * least / count),
            );
        }
        chart = chart.series(Series::marked(method, curve));
    }
    Ok(chart)
}

fn run_stage(
    grids: &[LabelGrid],
    alphabet: &Alphabet,
    coefficients: &Coefficients,
    stage: usize,
) -> Result<()> {
    let mut inference = Inference::default();
    let mut alphabet = alphabet.clone();
    for grid in grids {
        let labels = alphabet.intern_all(&grid.labels);
        let tree = parse(&Canvas::from_grid(grid, labels), coefficients, &PARAMETERS);
        let tree = tree.map_err(Error::method)?;
        match stage {
            0 => drop(std::hint::black_box(tree)),
            1 => drop(std::hint::black_box(NaryTree::from_binary(&tree))),
            _ => drop(std::hint::black_box(inference.add(&tree))),
        }
    }
    Ok(())
}

/// The whole inference on facades drawn with replacement, up to the size of a city.
fn resampled(
    ctx: &mut Context,
    source: &Source,
    alphabet: &Alphabet,
    coefficients: &Coefficients,
    table: &mut Table,
) -> Result<()> {
    let sizes: &[usize] = match ctx.budget() {
        Budget::Smoke => &[100],
        _ => &[1_000, 10_000, 100_000],
    };
    for &size in sizes {
        let mut taken = [0.0; 2];
        let mut rules = 0;
        for (threads, seconds) in [1, 0].into_iter().zip(&mut taken) {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .map_err(Error::method)?;
            let mut rng = stream(ctx.seed(), "resampled", size as u64);
            let draws = (0..size).map(|_| &source.grids[rng.random_range(0..source.grids.len())]);
            let draws: Vec<&LabelGrid> = draws.collect();
            let mut inference = Inference::default();
            let start = Instant::now();
            pool.install(|| {
                inference.add_all(
                    draws,
                    &mut alphabet.clone(),
                    coefficients,
                    &PARAMETERS,
                    |_| {},
                )
            })
            .map_err(Error::method)?;
            *seconds = start.elapsed().as_secs_f64();
            rules = inference.rules.len();
        }
        let memory = peak_megabytes();
        table.row([
            source.dataset.to_owned(),
            size.to_string(),
            rules.to_string(),
            format!("{:.3}", taken[0]),
            format!("{:.3}", taken[1]),
            format!("{:.4}", 1000.0 * taken[0] / size as f64),
            memory.map_or_else(String::new, |m| format!("{m:.0}")),
        ]);
        for (method, value) in [
            ("inferred_1_thread", taken[0]),
            ("inferred_all_threads", taken[1]),
        ] {
            let mut observation = row(source.dataset, method, size.to_string(), "seconds", value);
            observation.unit = "s".into();
            ctx.observe(observation);
        }
    }
    Ok(())
}
