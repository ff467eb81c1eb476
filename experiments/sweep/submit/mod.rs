//! Scripts that run a plan on a cluster: no scheduler of our own, Slurm's job arrays or Snakemake.

mod slurm;
mod snakemake;

use std::path::Path;

use super::collect::state;
use super::plan::Plan;
use crate::{Error, Result};

pub use slurm::{ArrayLimit, array_limit, scripts};
pub use snakemake::snakefile;

/// How a plan is cut into jobs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Packing {
    /// Shards, each a job.
    pub shards: usize,
    /// Seconds that a job may take: three times what is expected.
    pub limit: u64,
}

/// Seconds of a task before any was measured.
const GUESS: f64 = 10.0;

/// Packs tasks into jobs of about the wanted length, by the measured mean time of a task.
///
/// # Errors
/// [`Error::Option`] when the length is none, [`Error::Io`].
pub fn packing(plan: &Plan, out: &Path) -> Result<Packing> {
    let wanted = duration(&plan.head.task.pack)?;
    let seconds = state(plan, out)?.mean_seconds.unwrap_or(GUESS).max(1e-3);
    let per_job = (wanted / seconds).floor().max(1.0);
    let shards = (plan.tasks.len() as f64 / per_job).ceil().max(1.0);
    let longest = (plan.tasks.len() as f64 / shards).ceil() * seconds;
    Ok(Packing {
        shards: shards as usize,
        limit: (3.0 * longest).max(600.0).ceil() as u64,
    })
}

/// Seconds of `90s`, `30min`, `2h`, `1.5h`.
fn duration(text: &str) -> Result<f64> {
    let bad = || {
        Error::option(
            "pack",
            format!("`{text}` is no length of time such as 90s, 30min or 2h"),
        )
    };
    let split = text
        .find(|c: char| !c.is_ascii_digit() && c != '.')
        .ok_or_else(bad)?;
    let (number, unit) = text.split_at(split);
    let factor = match unit.trim() {
        "s" => 1.0,
        "min" => 60.0,
        "h" => 3600.0,
        _ => return Err(bad()),
    };
    let number: f64 = number.parse().map_err(|_| bad())?;
    match number > 0.0 {
        true => Ok(number * factor),
        false => Err(bad()),
    }
}

/// A path as one word of a shell.
fn word(path: &Path) -> String {
    format!("'{}'", path.display().to_string().replace('\'', "'\\''"))
}
