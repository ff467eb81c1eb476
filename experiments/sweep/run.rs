//! Running a shard of a plan on this machine.

use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use cpu_time::ThreadTime;
use rayon::prelude::*;

use super::command;
use super::given::Given;
use super::instances::changed;
use super::journal::{Entry, Journal, Keep, read_all};
use super::plan::{Plan, Task};
use super::study::Study;
use edifice_base::rng::stream;
use edifice_base::{Ended, Error, Progress, Result, Watch, Watched};
use edifice_frame::Progress as Bar;

/// The tasks of a shard that are run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wanted {
    /// Tasks without a result.
    Missing,
    /// Tasks without a result, and those that failed.
    MissingAndFailed,
}

/// The counts of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Ran {
    /// Tasks that were run and found something.
    pub finished: usize,
    /// Tasks that were run and failed.
    pub failed: usize,
    /// Tasks of the shard that had a result before.
    pub before: usize,
    /// The way in which the run ended.
    pub ended: Ended,
}

/// A shard that there is not.
#[derive(Debug, thiserror::Error)]
#[error("shards are counted from 0: `i/n` with i below n")]
struct NoShard;

/// An instance that is not what it was.
#[derive(Debug, thiserror::Error)]
#[error("the file has changed since the plan was made, or is gone; run `edifice sweep plan`")]
struct Changed;

/// Reads `i/n`.
///
/// # Errors
/// [`Error::Option`].
pub fn shard(text: &str) -> Result<(usize, usize)> {
    let bad = || Error::option("--shard", NoShard.to_string());
    let (i, n) = text.split_once('/').ok_or_else(bad)?;
    match (i.parse(), n.parse()) {
        (Ok(i), Ok(n)) if i < n => Ok((i, n)),
        _ => Err(bad()),
    }
}

/// Runs the tasks of a shard on all threads; every `n`th task belongs to it, from the `i`th. `watch` is told of each task, and
/// from inside long ones; when it stops the run, the tasks in hand are given up, and what is finished is kept.
///
/// # Errors
/// [`Error::Io`] when a result cannot be kept, [`Error::Content`] when an instance has changed since the plan was made. A task
/// that fails is a result.
pub fn run(
    plan: &Plan,
    out: &Path,
    study: &Study,
    shard: (usize, usize),
    wanted: Wanted,
    watch: &Watch,
) -> Result<Ran> {
    let journal = Journal::open(out, shard)?;
    // Results are filed under what the files were when the plan was made.
    let files = plan.head.instances.iter().chain(&plan.head.learn);
    if let Some(path) = changed(files, out)? {
        return Err(Error::content(&path, Changed));
    }
    for command in plan.head.arms.iter().filter_map(|arm| arm.command.as_ref()) {
        if let Some(path) = command.changed()? {
            return Err(Error::content(path, Changed));
        }
    }
    let known = read_all(out, &plan.head.program, Keep::Presence)?.entries;
    let ours: Vec<&Task> = plan.tasks.iter().skip(shard.0).step_by(shard.1).collect();
    let open = |task: &&&Task| match known.get(&task.key) {
        None => true,
        Some(entry) => entry.outcome.is_none() && wanted == Wanted::MissingAndFailed,
    };
    let tasks: Vec<&Task> = ours.iter().filter(open).copied().collect();
    let before = ours.len() - tasks.len();
    let bar = Bar::new(&plan.head.study, ours.len() as u64, before as u64);
    let watched = Watched::new(watch);
    let (finished, failed) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let outcome: Result<()> = tasks.par_iter().try_for_each(|task| {
        let done = finished.load(Ordering::Relaxed) + failed.load(Ordering::Relaxed);
        let told = Progress::of("tasks", done as u64, tasks.len() as u64);
        if !watched.goes_on(told) {
            return Ok(());
        }
        let Some(entry) = entry(plan, out, study, task, &watched) else {
            return Ok(());
        };
        journal.put(&entry)?;
        let counted = if entry.outcome.is_some() {
            &finished
        } else {
            &failed
        };
        counted.fetch_add(1, Ordering::Relaxed);
        bar.step();
        Ok(())
    });
    outcome?;
    Ok(Ran {
        finished: finished.into_inner(),
        failed: failed.into_inner(),
        before,
        ended: watched.ended(),
    })
}

/// Runs one task; `None` if it was stopped before it was finished.
pub fn entry(
    plan: &Plan,
    out: &Path,
    study: &Study,
    task: &Task,
    watched: &Watched,
) -> Option<Entry> {
    let arm = &plan.head.arms[task.arm];
    let database = match study.learns {
        true => plan.database(out, task),
        false => Vec::new(),
    };
    let given = Given {
        path: &plan.path(out, task),
        database: &database,
        seed: chance(plan, task),
        watched,
    };
    let (found, seconds) = match &arm.command {
        None => {
            let start = ThreadTime::now();
            let found = study.run(&arm.settings, &given);
            (found, start.elapsed().as_secs_f64())
        }
        Some(command) => {
            let about = command::Circumstances {
                settings: &arm.settings,
                seed: given.seed,
                memory: &plan.head.task.mem,
                watched,
            };
            let seconds = std::cell::Cell::new(0.0);
            let found = study.run_foreign(&arm.settings, &given, &|posed, output| {
                let (answer, took) =
                    command::timed(|| command::ask(command, posed, output, &about));
                seconds.set(took);
                answer
            });
            (found, seconds.get())
        }
    };
    if watched.is_stopped() || matches!(found, Err(Error::Interrupted)) {
        return None;
    }
    let (outcome, failure) = match found {
        Ok(outcome) => (Some(outcome), None),
        Err(error) => (None, Some(error.to_string())),
    };
    Some(Entry {
        key: task.key.clone(),
        program: plan.head.program.clone(),
        outcome,
        failure,
        seconds,
    })
}

/// The seed that a task hands on: the same for all arms where they are paired.
fn chance(plan: &Plan, task: &Task) -> u64 {
    use rand::RngExt;
    match plan.head.paired_seeds {
        true => task.seed,
        false => stream(task.seed, &plan.head.arms[task.arm].name, 0).random(),
    }
}
