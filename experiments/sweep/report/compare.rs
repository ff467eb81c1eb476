//! The results of each arm, and of each against the reference.

use std::collections::{BTreeMap, BTreeSet};

use crate::plan::Plan;
use crate::record::Record;
use crate::statistics::{Interval, Ranks, Signed, bootstrap, holm, ranks, signed_rank};
use crate::study::{Better, Study};
use edifice_base::rng::stream;

/// The question of a comparison.
#[derive(Debug, Clone, PartialEq)]
pub struct Question {
    /// Metric.
    pub metric: String,
    /// The values that are better.
    pub better: Better,
    /// Index of the arm that the others are compared with.
    pub reference: usize,
}

impl Question {
    /// The plan's question: what its `[report]` says, or the study's first metric and the first arm.
    pub fn of(plan: &Plan, study: &Study) -> Self {
        let options = &plan.head.report;
        let (first, better) = study
            .metrics
            .first()
            .copied()
            .unwrap_or(("value", Better::Lower));
        let metric = options.metric.clone().unwrap_or_else(|| first.to_owned());
        let known = study.metrics.iter().find(|(name, _)| *name == metric);
        let arm = |name: &String| plan.head.arms.iter().position(|arm| arm.name == *name);
        Self {
            better: options
                .better
                .or(known.map(|(_, better)| *better))
                .unwrap_or(better),
            reference: options.reference.as_ref().and_then(arm).unwrap_or(0),
            metric,
        }
    }

    /// A value as it is minimized.
    pub fn minimized(&self, value: f64) -> f64 {
        match self.better {
            Better::Lower => value,
            Better::Higher => -value,
        }
    }
}

/// Values of the metric: `[arm][unit]`, by seed.
pub(crate) type Values = Vec<Vec<BTreeMap<u64, f64>>>;

/// The results of one arm.
#[derive(Debug, Clone, PartialEq)]
pub struct ArmResult {
    /// Mean over the units that all arms have.
    pub interval: Option<Interval>,
    /// Mean paired difference to the reference; none for the reference itself.
    pub difference: Option<Interval>,
    /// Signed-rank test of the differences.
    pub test: Option<Signed>,
    /// Its p-value after Holm's correction over all arms.
    pub adjusted: Option<f64>,
    /// Units on which the arm is better than the reference, equal, and worse.
    pub counts: (usize, usize, usize),
    /// Mean of value over bound less 1, where bounds are known.
    pub gap: Option<f64>,
    /// Tasks that failed.
    pub failed: usize,
    /// Tasks that have not run.
    pub missing: usize,
}

/// Everything that a report says.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// The question.
    pub question: Question,
    /// The results, one line for each arm.
    pub lines: Vec<ArmResult>,
    /// The unit that a comparison counts: `instances`; of a sweep over one instance its `seeds`, which number the
    /// splits of it, or its parts.
    pub unit: &'static str,
    /// Units that all arms have values of.
    pub common: Vec<usize>,
    /// Mean ranks over those.
    pub ranks: Option<Ranks>,
    /// Values.
    pub values: Values,
}

/// Compares the arms.
pub fn compare(plan: &Plan, study: &Study, records: &[Record]) -> Comparison {
    let question = Question::of(plan, study);
    let arms = plan.head.arms.len();
    let seeds: BTreeSet<u64> = records.iter().map(|record| record.seed).collect();
    let by_seed = plan.head.instances.len() == 1 && seeds.len() > 1;
    let units = match by_seed {
        true => seeds.len(),
        false => plan.head.instances.len(),
    };
    let unit = |record: &Record| match by_seed {
        true => seeds.range(..record.seed).count(),
        false => record.instance,
    };
    let mut values: Values = vec![vec![BTreeMap::new(); units]; arms];
    // Bounds are those of the first metric.
    let bounded = study
        .metrics
        .first()
        .is_some_and(|(name, _)| *name == question.metric);
    let mut gaps: Vec<Vec<f64>> = vec![Vec::new(); arms];
    let (mut failed, mut missing) = (vec![0; arms], vec![0; arms]);
    for record in records {
        let Some(outcome) = &record.outcome else {
            let counted = match record.missing {
                true => &mut missing,
                false => &mut failed,
            };
            counted[record.arm] += 1;
            continue;
        };
        let Some(&value) = outcome.metrics.get(&question.metric) else {
            continue;
        };
        values[record.arm][unit(record)].insert(record.seed, value);
        if let Some(bound) = outcome.bound.filter(|bound| bounded && *bound > 0.0) {
            gaps[record.arm].push(value / bound - 1.0);
        }
    }
    let everywhere = |i: &usize| values.iter().all(|arm| !arm[*i].is_empty());
    let common: Vec<usize> = (0..units).filter(everywhere).collect();
    let mean = |values: &BTreeMap<u64, f64>| values.values().sum::<f64>() / values.len() as f64;
    let reference = question.reference;
    let tests: Vec<Option<Signed>> = (0..arms)
        .map(|arm| {
            let difference = |&i: &usize| mean(&values[arm][i]) - mean(&values[reference][i]);
            let differences: Vec<f64> = common.iter().map(difference).collect();
            (arm != reference)
                .then(|| signed_rank(&differences))
                .flatten()
        })
        .collect();
    let adjusted = holm(
        &tests
            .iter()
            .flatten()
            .map(|test| test.p)
            .collect::<Vec<_>>(),
    );
    let mut adjusted = adjusted.into_iter();
    let mut lines = Vec::new();
    for (arm, test) in tests.into_iter().enumerate() {
        let rng = |what: &str| stream(0, what, arm as u64);
        let own = |&i: &usize| values[arm][i].values().copied().collect();
        let own: Vec<Vec<f64>> = common.iter().map(own).collect();
        let paired = |&i: &usize| -> Vec<f64> {
            let theirs = &values[reference][i];
            let pair = |(seed, value): (&u64, &f64)| theirs.get(seed).map(|other| value - other);
            values[arm][i].iter().filter_map(pair).collect()
        };
        let paired: Vec<Vec<f64>> = common.iter().map(paired).collect();
        let mut counts = (0, 0, 0);
        for &i in &common {
            let difference = question.minimized(mean(&values[arm][i]))
                - question.minimized(mean(&values[reference][i]));
            match difference.total_cmp(&0.0) {
                std::cmp::Ordering::Less => counts.0 += 1,
                _ if difference == 0.0 => counts.1 += 1,
                _ => counts.2 += 1,
            }
        }
        lines.push(ArmResult {
            interval: bootstrap(&own, &mut rng("mean")),
            difference: (arm != reference)
                .then(|| bootstrap(&paired, &mut rng("difference")))
                .flatten(),
            adjusted: test.and_then(|_| adjusted.next()),
            test,
            counts,
            gap: (!gaps[arm].is_empty())
                .then(|| gaps[arm].iter().sum::<f64>() / gaps[arm].len() as f64),
            failed: failed[arm],
            missing: missing[arm],
        });
    }
    let row = |&i: &usize| {
        (0..arms)
            .map(|arm| question.minimized(mean(&values[arm][i])))
            .collect()
    };
    let rows: Vec<Vec<f64>> = common.iter().map(row).collect();
    Comparison {
        lines,
        ranks: ranks(&rows),
        unit: if by_seed { "seeds" } else { "instances" },
        common,
        values,
        question,
    }
}
