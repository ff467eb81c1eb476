//! Figures of a sweep's report.

use super::compare::Comparison;
use crate::plan::Plan;
use crate::record::Record;
use crate::statistics::{profile, reached};
use crate::study::{Better, Study};
use edifice_report::{Chart, Corner, Figure, Ranking, Scale, Series};

/// Critical-difference diagram; none with fewer than two arms.
pub(crate) fn ranking(plan: &Plan, comparison: &Comparison) -> Option<Figure> {
    let ranks = comparison.ranks.as_ref()?;
    let names = plan.head.arms.iter().map(|arm| arm.name.clone());
    let entries = names.zip(ranks.means.iter().copied()).collect();
    let title = format!(
        "mean rank by {} over {} {}",
        comparison.question.metric, ranks.instances, comparison.unit
    );
    let panel = Ranking::new(title, entries, ranks.critical, ranks.groups.clone());
    let height = 110.0 + 10.0 * plan.head.arms.len() as f64 + 6.0 * ranks.groups.len() as f64;
    let caption = "mean ranks; arms under one bar do not differ by Nemenyi's test at 0.05";
    Some(Figure::new(caption, 1).cell(760.0, height).panel(panel))
}

/// Performance profiles; none where larger values are better or some are not positive.
pub(crate) fn profiles(plan: &Plan, comparison: &Comparison) -> Option<Figure> {
    if comparison.question.better == Better::Higher {
        return None;
    }
    let units = comparison.values.first().map_or(0, Vec::len);
    let value = |arm: usize, i: usize| {
        let values = &comparison.values[arm][i];
        (!values.is_empty()).then(|| values.values().sum::<f64>() / values.len() as f64)
    };
    let rows: Vec<Vec<Option<f64>>> = (0..units)
        .map(|i| (0..plan.head.arms.len()).map(|arm| value(arm, i)).collect())
        .collect();
    if rows.iter().flatten().flatten().any(|value| *value < 0.0) {
        return None;
    }
    let ratios = profile(&rows);
    let finite = ratios
        .iter()
        .flatten()
        .copied()
        .filter(|ratio| ratio.is_finite());
    let most = finite.fold(1.0, f64::max);
    let mut chart = Chart::new(
        "performance profiles",
        Scale::new(format!(
            "{} over the best arm's",
            comparison.question.metric
        ))
        .range(1.0, most * 1.02 + 1e-3),
        Scale::new(format!("share of {}", comparison.unit)).range(0.0, 1.0),
    )
    .legend(Corner::Above);
    for (arm, ratios) in plan.head.arms.iter().zip(&ratios) {
        chart = chart.series(Series::steps(
            &arm.name,
            staircase(ratios, most * 1.02 + 1e-3),
        ));
    }
    Some(Figure::single(
        format!(
            "share of {} on which an arm is within a factor of the best arm",
            comparison.unit
        ),
        chart,
    ))
}

/// Best value known of each instance; none where the first metric, which traces are of, is not the one asked for, or no run has a
/// trace.
fn best_known(
    plan: &Plan,
    study: &Study,
    comparison: &Comparison,
    records: &[Record],
) -> Option<Vec<f64>> {
    let metric = &comparison.question.metric;
    let traced = |record: &Record| record.outcome.as_ref().is_some_and(|o| !o.trace.is_empty());
    let (first, _) = study.metrics.first()?;
    if first != metric
        || comparison.question.better == Better::Higher
        || !records.iter().any(traced)
    {
        return None;
    }
    let mut best = vec![f64::INFINITY; plan.head.instances.len()];
    for record in records {
        let value = record.outcome.as_ref().and_then(|o| o.metrics.get(metric));
        if let Some(value) = value {
            best[record.instance] = best[record.instance].min(*value);
        }
    }
    Some(best)
}

/// Median over the runs of an arm of the best value so far over the best known, by evaluations; none without traces, or where a best
/// value is not positive.
pub(crate) fn anytime(
    plan: &Plan,
    study: &Study,
    comparison: &Comparison,
    records: &[Record],
) -> Option<Figure> {
    let best = best_known(plan, study, comparison, records)?;
    let traces = |arm: usize| {
        let own = records.iter().filter(move |record| record.arm == arm);
        own.filter_map(|record| {
            let trace = record.outcome.as_ref()?.trace.as_slice();
            (!trace.is_empty()).then_some((trace, best[record.instance]))
        })
    };
    if best.iter().any(|value| *value <= 0.0) {
        return None;
    }
    let last = (0..plan.head.arms.len())
        .flat_map(traces)
        .flat_map(|(trace, _)| trace.last())
        .map(|[evaluations, _]| *evaluations)
        .fold(10.0, f64::max);
    let metric = &comparison.question.metric;
    let mut chart = Chart::new(
        "anytime curves",
        Scale::new("evaluations").log(),
        Scale::new(format!("{metric} over the best known")),
    )
    .legend(Corner::Above);
    for (arm, entry) in plan.head.arms.iter().enumerate() {
        let runs: Vec<(&[[f64; 2]], f64)> = traces(arm).collect();
        let median = |evaluations: f64| {
            let so_far = |(trace, best): &(&[[f64; 2]], f64)| {
                let known = trace.iter().take_while(|[at, _]| *at <= evaluations);
                known.last().map(|[_, value]| value / best)
            };
            let mut ratios: Vec<f64> = runs.iter().filter_map(so_far).collect();
            ratios.sort_by(f64::total_cmp);
            // Only from where on all runs have a value.
            (ratios.len() == runs.len()).then(|| ratios.get(ratios.len() / 2).copied())?
        };
        let at = (0..=POINTS).map(|k| last.powf(k as f64 / POINTS as f64));
        let points = at.filter_map(|x| Some((x, median(x)?))).collect();
        chart = chart.series(Series::steps(&entry.name, points));
    }
    Some(Figure::single(
        "best value so far over the best known of the instance, median of runs",
        chart,
    ))
}

/// Points of an anytime curve.
const POINTS: usize = 80;

/// Shares of runs that reached each target, by evaluations; none without traces.
pub(crate) fn targets(
    plan: &Plan,
    study: &Study,
    comparison: &Comparison,
    records: &[Record],
) -> Option<Figure> {
    let best = best_known(plan, study, comparison, records)?;
    let given = &plan.head.report.targets;
    let targets: Vec<f64> = if given.is_empty() {
        vec![1.0, 1.01, 1.05]
    } else {
        given.clone()
    };
    let mut figure = Figure::new("share of runs that reached a target, by evaluations", 2);
    for target in targets {
        let title = format!(
            "within {} % of the best known",
            (100.0 * (target - 1.0) * 100.0).round() / 100.0
        );
        let mut chart = Chart::new(
            title,
            Scale::new("evaluations").log(),
            Scale::new("share of runs").range(0.0, 1.0),
        )
        .legend(Corner::Above);
        let mut most: f64 = 10.0;
        let times: Vec<Vec<f64>> = (0..plan.head.arms.len())
            .map(|arm| {
                let runs = records
                    .iter()
                    .filter(|record| record.arm == arm && record.outcome.is_some());
                reached(runs.filter_map(|record| {
                    let outcome = record.outcome.as_ref()?;
                    Some((
                        outcome.trace.as_slice(),
                        best[record.instance] * target + 1e-9,
                    ))
                }))
            })
            .collect();
        for time in times.iter().flatten().filter(|time| time.is_finite()) {
            most = most.max(*time);
        }
        for (arm, times) in plan.head.arms.iter().zip(&times) {
            let times: Vec<f64> = times.iter().map(|time| time.max(1.0)).collect();
            chart = chart.series(Series::steps(&arm.name, staircase(&times, most)));
        }
        figure = figure.panel(chart);
    }
    Some(figure)
}

/// Points of a cumulative distribution of sorted values, up to `end`.
fn staircase(sorted: &[f64], end: f64) -> Vec<(f64, f64)> {
    let count = sorted.len().max(1) as f64;
    let mut points = vec![(1.0, 0.0)];
    for (index, value) in sorted
        .iter()
        .enumerate()
        .filter(|(_, value)| value.is_finite())
    {
        points.push((*value, (index + 1) as f64 / count));
    }
    let last = points[points.len() - 1].1;
    points.push((end, last));
    points
}
