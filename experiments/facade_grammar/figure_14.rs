//! Fig. 14: cost and time against iterations.

use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::sync::{Mutex, PoisonError};

use cpu_time::ThreadTime;
use serde::{Deserialize, Serialize};

use super::runs::{Solver, mean};
use super::{BEST, PAPER, data};
use edifice_base::{Error, Progress, Result};
use edifice_facade_grammar::{Method, Settings, infer};
use edifice_frame::Context;
use edifice_report::{Chart, Corner, Figure, Row, Scale, Series};
use edifice_shape::Facade;

/// State of a run after some iterations.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
struct Point {
    iteration: u64,
    /// Lowest cost so far.
    best: f64,
    /// Seconds since the point before this one, per iteration.
    pace: f64,
}

/// Facades of the paper's middle sizes, the smallest first.
pub(crate) const FACADES: [&str; 3] = ["tenement_1", "office_1", "boulevard_1"];

/// Best cost so far and seconds per iteration of three methods on three facades.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    let (few, many) = super::iterations(ctx.budget());
    let seeds = ctx.budget().choose(1, 3, 10);
    let count = ctx.budget().choose(1, 3, 3);
    let every = (many / 20).max(1);
    ctx.setting("iterations", many);
    ctx.setting("seeds", seeds);
    ctx.setting("every", every);
    let folder = data::folder(ctx)?.join("layouts");
    let facades: Result<Vec<Facade>> = FACADES[..count]
        .iter()
        .map(|name| edifice_io::facade_json::read(&folder.join(format!("{name}.facade.json"))))
        .collect();
    let facades = facades?;
    let methods = [BEST, PAPER, Method::Importance];
    let mut units = Vec::new();
    for f in 0..facades.len() {
        for method in methods {
            units.extend((0..seeds).map(|run| (f, method, ctx.seed() + run)));
        }
    }
    let name = |method| Solver::Infer(method, many).name();
    let traces = ctx.units(
        &units,
        |(f, method, seed)| format!("{}/{}/{seed}", facades[*f].name, name(*method)),
        |&(f, method, seed)| trace(&facades[f], method, many, every, seed),
    )?;
    let mut figure = Figure::new("cost against iterations", 3).cell(560.0, 360.0);
    let mut time = Figure::new("time against iterations", 3).cell(560.0, 360.0);
    for (f, facade) in facades.iter().enumerate() {
        let mut cost = Chart::new(
            format!("{} ({} terminals)", facade.name, facade.regions.len()),
            Scale::new("iterations"),
            Scale::new("lowest cost so far"),
        )
        .legend(Corner::Above);
        let mut pace = Chart::new(
            format!("{}, time", facade.name),
            Scale::new("iterations"),
            Scale::new("ms per iteration").log(),
        )
        .legend(Corner::Above);
        for method in methods {
            let mine: Vec<&Vec<Point>> = units
                .iter()
                .zip(&traces)
                .filter(|((g, m, _), _)| *g == f && *m == method)
                .map(|(_, trace)| trace)
                .collect();
            let (line, band, times) = curves(&mine, every, many);
            cost = cost.series(Series::line(name(method), line).band(band));
            pace = pace.series(Series::line(name(method), times));
        }
        figure = figure.panel(cost);
        time = time.panel(pace);
    }
    ctx.figure("figure_14", &figure)?;
    ctx.figure_of_times("figure_14", &time)?;
    for ((f, method, seed), trace) in units.iter().zip(&traces) {
        observe(ctx, &facades[*f].name, name(*method), *seed, trace);
    }
    ends(ctx, &units, &traces, few);
    ctx.note(
        "The paper measures every 500 iterations on one facade of Fig. 5. Its time per iteration falls because exploitation is \
         faster than exploration. `adp_best` starts with the Lagrangian bound, which its first step stands for, \
         then makes a walk by shortest paths and a round of annealing for every eight iterations of the others, so that it ends early; its cost then stays. Bands run from the lowest to the highest seed.",
    );
    Ok(())
}

/// Sets the first part of a run beside the last.
fn ends(ctx: &mut Context, units: &[(usize, Method, u64)], traces: &[Vec<Point>], few: u64) {
    let of = |method: Method, pick: &dyn Fn(&Vec<Point>) -> Option<f64>| -> f64 {
        let mine = units
            .iter()
            .zip(traces)
            .filter(|((_, m, _), _)| *m == method);
        mean(&mine.filter_map(|(_, t)| pick(t)).collect::<Vec<_>>())
    };
    let early = |t: &Vec<Point>| cost_at(t, few);
    let late = |t: &Vec<Point>| t.last().map(|p| p.best);
    for method in [BEST, PAPER, Method::Importance] {
        ctx.compare(
            format!("{method}: mean cost at {few} iterations and at the end"),
            "falls for ADP, hardly for IS",
            format!("{:.1}, {:.1}", of(method, &early), of(method, &late)),
        );
    }
    let start = |t: &Vec<Point>| t.first().map(|p| 1e3 * p.pace);
    let end = |t: &Vec<Point>| t.last().map(|p| 1e3 * p.pace);
    ctx.compare_times(
        "adp-paper: ms per iteration at the start and at the end",
        "falls",
        format!("{:.3}, {:.3}", of(PAPER, &start), of(PAPER, &end)),
    );
}

/// Runs and notes the state at regular intervals of iterations.
fn trace(
    facade: &Facade,
    method: Method,
    iterations: u64,
    every: u64,
    seed: u64,
) -> Result<Vec<Point>> {
    let settings = Settings {
        method,
        iterations,
        seed,
        ..Settings::default()
    };
    let points = Mutex::new(Vec::new());
    let now = || ThreadTime::now().as_duration();
    let last = Mutex::new((now(), 0u64, f64::INFINITY));
    let watch = |progress: Progress| {
        let Some(best) = progress.best else {
            return ControlFlow::Continue(());
        };
        let mut clock = last.lock().unwrap_or_else(PoisonError::into_inner);
        clock.2 = clock.2.min(best);
        clock.1 += 1;
        if clock.1 % every == 0 {
            let mut seen = points.lock().unwrap_or_else(PoisonError::into_inner);
            seen.push(Point {
                iteration: clock.1,
                best: clock.2,
                pace: (now() - clock.0).as_secs_f64() / every as f64,
            });
            clock.0 = now();
        }
        ControlFlow::Continue(())
    };
    infer(std::slice::from_ref(facade), &settings, &watch).map_err(Error::method)?;
    let mut points = points.into_inner().unwrap_or_else(PoisonError::into_inner);
    let (since, made, best) = last.into_inner().unwrap_or_else(PoisonError::into_inner);
    if !made.is_multiple_of(every) {
        // A run that ended early, with the proof that nothing is cheaper.
        points.push(Point {
            iteration: made,
            best,
            pace: (now() - since).as_secs_f64() / (made % every) as f64,
        });
    }
    Ok(points)
}

type Curve = Vec<(f64, f64)>;

/// The lowest cost that a run had found after so many iterations: that of a run which ended before stays what it was. Of a run
/// whose first point comes later it is that of the first point.
fn cost_at(trace: &[Point], iteration: u64) -> Option<f64> {
    let before = trace.iter().rfind(|p| p.iteration <= iteration);
    before.or(trace.first()).map(|p| p.best)
}

/// Mean cost, its band over the seeds, and mean milliseconds per iteration, at every iteration that a run has a point of and at
/// the last. At each of them all runs are averaged; the time of the steps before an early end, fewer than `every`, is left out.
fn curves(
    traces: &[&Vec<Point>],
    every: u64,
    iterations: u64,
) -> (Curve, Vec<(f64, f64, f64)>, Curve) {
    let points = || traces.iter().flat_map(|t| t.iter());
    // All runs have a first point from here on.
    let first = traces.iter().filter_map(|t| t.first()).map(|p| p.iteration);
    let first = first.max().unwrap_or(iterations);
    let marks: BTreeSet<u64> = points().map(|p| p.iteration).chain([iterations]).collect();
    let (mut line, mut band, mut times) = (Vec::new(), Vec::new(), Vec::new());
    for &mark in marks.range(first.min(iterations)..) {
        let x = mark as f64;
        let costs: Vec<f64> = traces.iter().filter_map(|t| cost_at(t, mark)).collect();
        let range = costs
            .iter()
            .fold((f64::INFINITY, 0.0_f64), |(l, h), &c| (l.min(c), h.max(c)));
        line.push((x, mean(&costs)));
        band.push((x, range.0, range.1));
    }
    for &mark in marks.iter().filter(|m| m.is_multiple_of(every)) {
        let here = points().filter(|p| p.iteration == mark);
        let paces: Vec<f64> = here.map(|p| 1e3 * p.pace).collect();
        if !paces.is_empty() {
            times.push((mark as f64, mean(&paces)));
        }
    }
    (line, band, times)
}

fn observe(ctx: &mut Context, facade: &str, method: String, seed: u64, trace: &[Point]) {
    for point in trace {
        for (metric, value, unit) in [
            ("cost", point.best, ""),
            ("seconds_per_iteration", point.pace, "s"),
        ] {
            ctx.observe(Row {
                dataset: "shipped".into(),
                method: method.clone(),
                instance: format!("{facade}@{}", point.iteration),
                seed: Some(seed),
                metric: metric.into(),
                value,
                unit: unit.into(),
                ..Row::default()
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(points: &[(u64, f64)]) -> Vec<Point> {
        let point = |&(iteration, best)| Point {
            iteration,
            best,
            pace: 0.001,
        };
        points.iter().map(point).collect()
    }

    #[test]
    fn the_lowest_cost_so_far_never_rises() {
        // One run ended early with a cheap facade, one goes on: the averages are of both everywhere.
        let runs = [run(&[(3, 10.0)]), run(&[(5, 50.0), (10, 40.0), (15, 40.0)])];
        let (line, band, times) = curves(&runs.iter().collect::<Vec<_>>(), 5, 20);
        assert_eq!(
            line,
            [(5.0, 30.0), (10.0, 25.0), (15.0, 25.0), (20.0, 25.0)]
        );
        assert!(line.windows(2).all(|pair| pair[0].1 >= pair[1].1));
        assert!(
            band.iter()
                .all(|&(_, low, high)| low == 10.0 && high >= 40.0)
        );
        assert_eq!(times.len(), 3);
        let mean_at = |few| {
            mean(
                &runs
                    .iter()
                    .filter_map(|t| cost_at(t, few))
                    .collect::<Vec<_>>(),
            )
        };
        assert_eq!([mean_at(1), mean_at(8), mean_at(20)], [30.0, 30.0, 25.0]);
    }
}
