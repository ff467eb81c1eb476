//! Scripts that run a plan on a cluster: no scheduler of our own, Slurm's job arrays or Snakemake.

mod slurm;
mod snakemake;

use std::path::Path;

use super::collect::state;
use super::journal::{Keep, read_all};
use super::plan::{Plan, Task};
use edifice_base::Result;

pub use slurm::{ArrayLimit, array_limit, scripts};
pub use snakemake::snakefile;

/// The packing of a plan into jobs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Packing {
    /// Tasks that have no result yet.
    pub tasks: usize,
    /// Shards, each a job; none where nothing is left to run.
    pub shards: usize,
    /// Seconds that a job may take: three times what is expected.
    pub limit: u64,
}

/// Seconds of a task before any was measured.
const GUESS: f64 = 10.0;

/// Packs the tasks without a result into jobs of about the wanted length, by the measured mean time of a task.
///
/// # Errors
/// [`edifice_base::Error::Io`].
pub fn packing(plan: &Plan, out: &Path) -> Result<Packing> {
    let wanted = plan.head.task.pack_seconds();
    let known = read_all(out, &plan.head.program, Keep::Presence)?.entries;
    let open = |(_, task): &(usize, &Task)| !known.contains_key(&task.key);
    let tasks = plan.tasks.iter().enumerate().filter(open);
    let tasks: Vec<usize> = tasks.map(|(index, _)| index).collect();
    let seconds = state(plan, out)?.mean_seconds.unwrap_or(GUESS).max(1e-3);
    let per_job = (wanted / seconds).floor().max(1.0);
    let shards = (tasks.len() as f64 / per_job).ceil() as usize;
    // A shard is every nth task of the plan, and those without a result may all be in one.
    let mut by_shard = vec![0u32; shards];
    tasks.iter().for_each(|index| by_shard[index % shards] += 1);
    let longest = f64::from(by_shard.into_iter().max().unwrap_or(0)) * seconds;
    Ok(Packing {
        tasks: tasks.len(),
        shards,
        limit: (3.0 * longest).max(600.0).ceil() as u64,
    })
}

/// A path as one word of a shell.
pub fn word(path: &Path) -> String {
    format!("'{}'", path.display().to_string().replace('\'', "'\\''"))
}
