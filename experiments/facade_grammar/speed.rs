//! Cost per iteration against terminals: how the method grows.

use cpu_time::ThreadTime;

use serde::{Deserialize, Serialize};

use super::{BEST, PAPER};
use edifice_base::unwatched;
use edifice_base::{Error, Result};
use edifice_facade_grammar::{Method, Settings, infer};
use edifice_frame::Context;
use edifice_generators_facade_grammar as made;
use edifice_grammar::derive;
use edifice_report::{Chart, Corner, Figure, Row, Scale, Series};

/// Times of one facade, processor seconds.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
struct Times {
    terminals: usize,
    /// Per iteration.
    iteration: f64,
    /// Before the first iteration: indexing and symmetry detection.
    setup: f64,
    /// Deriving the grammar.
    derive: f64,
    /// A whole run.
    run: f64,
}

/// Times made facades of 50 to 20,000 terminals.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let sizes: &[usize] = ctx.budget().choose(
        &[60, 120],
        &[50, 100, 200, 500, 1_000, 2_000, 5_000, 10_000, 20_000],
        &[50, 100, 200, 500, 1_000, 2_000, 5_000, 10_000, 20_000],
    );
    let iterations = ctx.budget().choose(20, 200, 1_000);
    ctx.setting("iterations", iterations);
    ctx.setting("sizes", sizes.to_vec());
    let seed = ctx.seed();
    let mut units = Vec::new();
    for method in [BEST, PAPER] {
        units.extend(sizes.iter().map(|&size| (method, size)));
    }
    let found = ctx.units(
        &units,
        |(method, size)| format!("{}/{size}", name(*method)),
        |&(method, size)| {
            let layout = made::sized(seed, size).map_err(Error::method)?;
            let settings = |iterations| Settings {
                method,
                iterations,
                seed,
                ..Settings::default()
            };
            let timed = |iterations| {
                let start = ThreadTime::now();
                let found = infer(
                    std::slice::from_ref(&layout.facade),
                    &settings(iterations),
                    &unwatched,
                );
                found
                    .map(|outcome| (outcome.grammar, start.elapsed().as_secs_f64()))
                    .map_err(Error::method)
            };
            // Two lengths tell setup and iterations apart.
            let (_, short) = timed(iterations / 10)?;
            let (grammar, long) = timed(iterations)?;
            let iteration = (long - short).max(0.0) / (iterations - iterations / 10) as f64;
            let start = ThreadTime::now();
            derive(&grammar, 0).map_err(Error::method)?;
            Ok(Times {
                terminals: layout.facade.regions.len(),
                iteration,
                setup: (short - iteration * (iterations / 10) as f64).max(0.0),
                derive: start.elapsed().as_secs_f64(),
                run: long,
            })
        },
    )?;
    let of = |method| -> Vec<&Times> {
        let mine = units.iter().zip(&found).filter(|((m, _), _)| *m == method);
        mine.map(|(_, times)| times).collect()
    };
    let line = |method, value: fn(&Times) -> f64| -> Vec<(f64, f64)> {
        let point = |t: &&Times| (t.terminals as f64, 1e3 * value(t));
        of(method).iter().map(point).collect()
    };
    let chart = |title: String| {
        Chart::new(title, Scale::new("terminals").log(), Scale::new("ms").log())
            .legend(Corner::Above)
    };
    let walk = chart("One iteration".into())
        .series(Series::marked(name(PAPER), line(PAPER, |t| t.iteration)));
    let setup = chart("Before and after".into())
        .series(Series::marked(
            "symmetry detection",
            line(PAPER, |t| t.setup),
        ))
        .series(Series::marked("derivation", line(PAPER, |t| t.derive)));
    let run = chart(format!("Whole run, {iterations} iterations"))
        .series(Series::marked(name(BEST), line(BEST, |t| t.run)))
        .series(Series::marked(name(PAPER), line(PAPER, |t| t.run)));
    for times in of(PAPER) {
        observe(ctx, PAPER, times, "seconds_per_iteration", times.iteration);
        observe(ctx, PAPER, times, "seconds_setup", times.setup);
        observe(ctx, PAPER, times, "seconds_derive", times.derive);
    }
    for method in [BEST, PAPER] {
        for times in of(method) {
            observe(ctx, method, times, "seconds_run", times.run);
        }
    }
    let figure = Figure::new("time against terminals", 3)
        .cell(420.0, 380.0)
        .panel(walk)
        .panel(setup)
        .panel(run);
    ctx.figure_of_times("speed", &figure)?;
    ctx.note(
        "Not in the paper, which prints 35.5 s for 10,000 iterations on its ten facades on average (582 terminals). Facades are made by \
         the generator with as many floors and columns as the size asks for. The setup is what two runs of different length have in common. `adp` has no time per iteration: it stops when its grammar is proven optimal. \
         All times are processor time of one thread.",
    );
    Ok(())
}

/// The name in tables, which is older than the method's own.
fn name(method: Method) -> String {
    match method {
        BEST => "adp".into(),
        other => other.to_string(),
    }
}

fn observe(ctx: &mut Context, method: Method, times: &Times, metric: &str, seconds: f64) {
    ctx.observe(Row {
        dataset: "made".into(),
        method: name(method),
        instance: times.terminals.to_string(),
        seed: Some(ctx.seed()),
        metric: metric.into(),
        value: seconds,
        unit: "s".into(),
        ..Row::default()
    });
}
