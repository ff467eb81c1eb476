//! Working through the tasks of a plan, beside other workers.

use std::path::Path;
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

use super::plan::Plan;
use super::task::{Place, Task};
use edifice_base::{Error, Progress, Result, Watch, Watched, file};
use edifice_frame::lock::Lock;
use edifice_frame::memory;

/// The time between two looks for a task while others work on what is needed.
const PAUSE: Duration = Duration::from_millis(50);

/// The stage of [`work`] in which progress counts the tasks that are finished.
pub const TASKS: &str = "tasks";

/// The state of a plan when a worker ends.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Ran {
    /// Tasks that this worker finished.
    pub finished: usize,
    /// All tasks.
    pub tasks: usize,
    /// Bytes of dictionary and grammars; none before all are there.
    pub bytes: u64,
    /// Seconds of all tasks, whoever did them.
    pub seconds: f64,
    /// The largest peak of resident memory of a worker, in megabytes, where the system tells.
    pub peak_megabytes: Option<f64>,
}

/// The time and memory of a task.
#[derive(Serialize, Deserialize)]
struct Took {
    seconds: f64,
    peak_megabytes: Option<f64>,
}

/// Does tasks until all are finished, by this worker or by others: one that another process has claimed is waited for, and done here when
/// that process ends without it.
///
/// # Errors
/// The first task that fails ends the worker; [`Error::Interrupted`] when `watch` stops it.
pub fn work(plan: &Plan, out: &Path, watch: &Watch) -> Result<Ran> {
    let place = Place::new(plan, out);
    let claims = place.work.join("claims");
    let times = place.work.join("times");
    for folder in [&claims, &times] {
        std::fs::create_dir_all(folder).map_err(|e| Error::io(folder, "create", e))?;
    }
    let tasks = place.tasks();
    let watched = Watched::new(watch);
    let mut finished = 0;
    let mut open = tasks.clone();
    loop {
        open.retain(|&task| !place.output(task).exists());
        if open.is_empty() {
            return ran(&place, &tasks, &times, finished);
        }
        let done = (tasks.len() - open.len()) as u64;
        if !watched.goes_on(Progress::of(TASKS, done, tasks.len() as u64)) {
            return Err(Error::Interrupted);
        }
        match claimed(&place, &open, &claims)? {
            None => std::thread::sleep(PAUSE),
            Some((task, claim)) => {
                let start = Instant::now();
                let ended = place.run(task, &watched.inner());
                // A task that was stopped may have failed for that reason.
                if watched.is_stopped() {
                    return Err(Error::Interrupted);
                }
                ended?;
                let took = Took {
                    seconds: start.elapsed().as_secs_f64(),
                    peak_megabytes: memory::peak_megabytes(),
                };
                let bytes = serde_json::to_vec(&took).map_err(Error::method)?;
                file::write_atomic(&time(&place, &times, task), &bytes)?;
                drop(claim);
                finished += 1;
            }
        }
    }
}

/// The first open task whose needs are met and that no other process has.
fn claimed(place: &Place, open: &[Task], claims: &Path) -> Result<Option<(Task, Lock)>> {
    for &task in open {
        let needs = place.needs(task);
        if needs.iter().any(|n| open.contains(n)) {
            continue;
        }
        let path = claims.join(format!("{}.lock", place.name(task)));
        let Some(claim) = Lock::claim(&path)? else {
            continue;
        };
        // It may have been finished just before.
        if !place.output(task).exists() {
            return Ok(Some((task, claim)));
        }
    }
    Ok(None)
}

fn time(place: &Place, times: &Path, task: Task) -> std::path::PathBuf {
    times.join(format!("{}.json", place.name(task)))
}

fn ran(place: &Place, tasks: &[Task], times: &Path, finished: usize) -> Result<Ran> {
    let mut ran = Ran {
        finished,
        tasks: tasks.len(),
        bytes: 0,
        seconds: 0.0,
        peak_megabytes: None,
    };
    for &task in tasks {
        if matches!(task, Task::Merge | Task::Code(_)) {
            let path = place.output(task);
            let size = std::fs::metadata(&path).map_err(|e| Error::io(&path, "read", e))?;
            ran.bytes += size.len();
        }
        // A worker that was killed just after its result has left no time.
        let took = std::fs::read(time(place, times, task)).ok();
        let took = took.and_then(|bytes| serde_json::from_slice::<Took>(&bytes).ok());
        if let Some(took) = took {
            ran.seconds += took.seconds;
            let peaks = ran.peak_megabytes.into_iter().chain(took.peak_megabytes);
            ran.peak_megabytes = peaks.reduce(f64::max);
        }
    }
    Ok(ran)
}
