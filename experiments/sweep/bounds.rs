//! Results that contradict a proof: a value of the first metric that is better than a bound that another task of the same question proved.
//!
//! Such a result is no record but a fault, of the method, of the proof, or of a journal that was written by hand; its task counts as failed. If
//! the proof is at fault, the message still names both.

use std::collections::BTreeMap;

use super::plan::Plan;
use super::record::Record;
use super::study::Better;

/// Share by which a value may pass a bound: rounding of sums.
const SLACK: f64 = 1e-9;

/// Turns every record that contradicts a proven bound into a failure.
pub(crate) fn refuse(plan: &Plan, records: &mut [Record]) {
    let Some((metric, better)) = &plan.head.first else {
        return;
    };
    let passes = |value: f64, bound: f64| {
        let slack = SLACK * bound.abs().max(1.0);
        match better {
            Better::Lower => value < bound - slack,
            Better::Higher => value > bound + slack,
        }
    };
    let question = |record: &Record| {
        let settings = &plan.head.arms[record.arm].settings;
        let decides = |name: &str| match &plan.head.question {
            Some(names) => names.iter().any(|known| known == name),
            None => true,
        };
        let kept: Vec<String> = settings
            .iter()
            .filter(|(name, _)| decides(name))
            .map(|(name, value)| format!("{name}={value}"))
            .collect();
        (record.instance, kept)
    };
    // The strongest bound of each question, and the arm that proved it.
    let mut proven: BTreeMap<(usize, Vec<String>), (f64, usize)> = BTreeMap::new();
    for record in records.iter() {
        let bound = record.outcome.as_ref().and_then(|o| o.bound);
        if let Some(bound) = bound.filter(|bound| bound.is_finite()) {
            let best = proven
                .entry(question(record))
                .or_insert((bound, record.arm));
            if passes(best.0, bound) {
                *best = (bound, record.arm);
            }
        }
    }
    for record in records {
        let Some(&(bound, arm)) = proven.get(&question(record)) else {
            continue;
        };
        let value = record.outcome.as_ref().and_then(|o| o.metrics.get(metric));
        if let Some(&value) = value.filter(|value| passes(**value, bound)) {
            let arm = &plan.head.arms[arm].name;
            record.failure = Some(format!(
                "{metric} {value} is better than the bound {bound} that arm `{arm}` proved: one of them is wrong"
            ));
            record.outcome = None;
        }
    }
}
