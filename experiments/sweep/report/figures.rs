//! Figures of a sweep's report.

use super::compare::Comparison;
use crate::experiments::sweep::collect::Record;
use crate::experiments::sweep::plan::Plan;
use crate::experiments::sweep::statistics::{profile, reached};
use crate::experiments::sweep::study::Better;
use crate::report::{Chart, Corner, Figure, Ranking, Scale, Series};

/// Critical-difference diagram; none with fewer than two arms.
pub fn ranking(plan: &Plan, comparison: &Comparison) -> Option<Figure> {
    let ranks = comparison.ranks.as_ref()?;
    let names = plan.head.arms.iter().map(|arm| arm.name.clone());
    let entries = names.zip(ranks.means.iter().copied()).collect();
    let title = format!(
        "mean rank by {} over {} instances",
        comparison.question.metric, ranks.instances
    );
    let panel = Ranking::new(title, entries, ranks.critical, ranks.groups.clone());
    let height = 110.0 + 10.0 * plan.head.arms.len() as f64 + 6.0 * ranks.groups.len() as f64;
    let caption = "mean ranks; arms under one bar do not differ by Nemenyi's test at 0.05";
    Some(Figure::new(caption, 1).cell(760.0, height).panel(panel))
}

/// Performance profiles; none where larger values are better or some are not positive.
pub fn profiles(plan: &Plan, comparison: &Comparison) -> Option<Figure> {
    if comparison.question.better == Better::Higher {
        return None;
    }
    let instances = plan.head.instances.len();
    let value = |arm: usize, i: usize| {
        let values = &comparison.values[arm][i];
        (!values.is_empty()).then(|| values.values().sum::<f64>() / values.len() as f64)
    };
    let rows: Vec<Vec<Option<f64>>> = (0..instances)
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
        Scale::new("share of instances").range(0.0, 1.0),
    )
    .legend(Corner::Above);
    for (arm, ratios) in plan.head.arms.iter().zip(&ratios) {
        chart = chart.series(Series::steps(
            &arm.name,
            staircase(ratios, most * 1.02 + 1e-3),
        ));
    }
    Some(Figure::single(
        "share of instances on which an arm is within a factor of the best arm",
        chart,
    ))
}

/// Shares of runs that reached each target after so many evaluations; none without traces.
pub fn targets(plan: &Plan, comparison: &Comparison, records: &[Record]) -> Option<Figure> {
    let traced = |record: &&Record| record.outcome.as_ref().is_some_and(|o| !o.trace.is_empty());
    if comparison.question.better == Better::Higher || !records.iter().any(|r| traced(&r)) {
        return None;
    }
    let mut best = vec![f64::INFINITY; plan.head.instances.len()];
    for arm in &comparison.values {
        for (best, values) in best.iter_mut().zip(arm) {
            *best = values.values().copied().fold(*best, f64::min);
        }
    }
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
