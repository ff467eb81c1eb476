//! The state of a sweep, and its results as tables.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use serde::Serialize;

use super::bounds;
use super::journal::{Damaged, Entry, Keep, Known, read_all};
use super::plan::Plan;
use super::record::Record;
use edifice_base::{Error, Result, csv, file};

/// Name of the table of results in a sweep's folder.
pub const RESULTS: &str = "results.csv";
/// Name of the table of measured times.
pub const TIMES: &str = "times.csv";

/// State of an arm.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct ArmState {
    /// Its name.
    pub arm: String,
    /// Tasks that found something.
    pub finished: usize,
    /// Tasks that failed.
    pub failed: usize,
    /// Tasks without a result.
    pub missing: usize,
}

/// State of a sweep.
#[derive(Debug)]
pub struct State {
    /// The state of each arm.
    pub arms: Vec<ArmState>,
    /// First message of each kind of failure, and how often it occurred.
    pub failures: BTreeMap<String, usize>,
    /// Mean processor seconds of the finished tasks.
    pub mean_seconds: Option<f64>,
    /// Lines of journals that could not be read.
    pub damaged: Vec<Damaged>,
    /// Results of other sources of the study, which do not count.
    pub foreign: usize,
}

/// The state of a plan's tasks.
///
/// # Errors
/// [`Error::Io`].
pub fn state(plan: &Plan, out: &Path) -> Result<State> {
    let Known {
        entries,
        damaged,
        foreign,
    } = read_all(out, &plan.head.program, Keep::Presence)?;
    let name = |arm: &super::definition::Arm| ArmState {
        arm: arm.name.clone(),
        ..ArmState::default()
    };
    let mut arms: Vec<ArmState> = plan.head.arms.iter().map(name).collect();
    let mut failures = BTreeMap::new();
    let (mut seconds, mut timed) = (0.0, 0);
    for task in &plan.tasks {
        let arm = &mut arms[task.arm];
        match entries.get(&task.key) {
            None => arm.missing += 1,
            Some(Entry {
                failure: Some(reason),
                ..
            }) => {
                arm.failed += 1;
                *failures.entry(reason.clone()).or_insert(0) += 1;
            }
            Some(entry) => {
                arm.finished += 1;
                seconds += entry.seconds;
                timed += 1;
            }
        }
    }
    Ok(State {
        arms,
        failures,
        mean_seconds: (timed > 0).then(|| seconds / f64::from(timed)),
        damaged,
        foreign,
    })
}

/// The results of all tasks, in the plan's order.
///
/// # Errors
/// [`Error::Io`].
pub fn records(plan: &Plan, out: &Path, keep: Keep) -> Result<Vec<Record>> {
    let mut entries = read_all(out, &plan.head.program, keep)?.entries;
    let record = |task: &super::plan::Task| {
        let entry = entries.remove(&task.key);
        let missing = entry.is_none();
        let (outcome, failure, seconds) = match entry {
            Some(entry) => (entry.outcome, entry.failure, entry.seconds),
            None => (None, Some("missing".to_owned()), 0.0),
        };
        Record {
            arm: task.arm,
            instance: task.instance,
            seed: task.seed,
            outcome,
            failure,
            missing,
            seconds,
        }
    };
    let mut records: Vec<Record> = plan.tasks.iter().map(record).collect();
    bounds::refuse(plan, &mut records);
    Ok(records)
}

/// Writes [`RESULTS`], one row per metric of each task and one per failure, and [`TIMES`]; returns the numbers of rows.
///
/// # Errors
/// [`Error::Io`].
pub fn collect(plan: &Plan, out: &Path) -> Result<(usize, usize)> {
    let records = records(plan, out, Keep::Metrics)?;
    let mut results = String::from("study,arm,instance,seed,metric,value\n");
    let mut times = String::from("arm,instance,seed,seconds\n");
    let (mut rows, mut timed) = (0, 0);
    for record in &records {
        let arm = csv::cell(&plan.head.arms[record.arm].name);
        let instance = csv::cell(&plan.head.instances[record.instance].name);
        let mut row = |metric: &str, value: String| {
            rows += 1;
            let study = &plan.head.study;
            let _ = writeln!(
                results,
                "{study},{arm},{instance},{},{metric},{value}",
                record.seed
            );
        };
        match (&record.outcome, &record.failure) {
            (Some(outcome), _) => {
                for (metric, value) in &outcome.metrics {
                    row(metric, value.to_string());
                }
                if let Some(bound) = outcome.bound {
                    row("bound", bound.to_string());
                }
                timed += 1;
                let _ = writeln!(
                    times,
                    "{arm},{instance},{},{:.6}",
                    record.seed, record.seconds
                );
            }
            (None, Some(reason)) => row("failure", csv::cell(reason).into_owned()),
            (None, None) => row("failure", "no reason was given".into()),
        }
    }
    for (name, text) in [(RESULTS, results), (TIMES, times)] {
        file::write_atomic(&out.join(name), text.as_bytes()).map_err(|e: Error| e)?;
    }
    Ok((rows, timed))
}
