//! Slurm: job arrays, split at the site's limit.

use std::path::Path;
use std::process::Command;

use super::{Packing, word};
use crate::plan::Plan;

/// Most elements of an array, and whether Slurm was asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ArrayLimit {
    /// `MaxArraySize`: indices stay below it.
    pub size: usize,
    /// True if `scontrol` said so; otherwise it is Slurm's default.
    pub asked: bool,
}

/// The site's `MaxArraySize`, or Slurm's default of 1001.
pub fn array_limit() -> ArrayLimit {
    let asked = Command::new("scontrol")
        .args(["show", "config"])
        .output()
        .ok()
        .and_then(|output| {
            let text = String::from_utf8_lossy(&output.stdout).into_owned();
            let line = text
                .lines()
                .find(|line| line.trim_start().starts_with("MaxArraySize"))?;
            line.split('=').nth(1)?.trim().parse().ok()
        });
    ArrayLimit {
        size: asked.unwrap_or(1001),
        asked: asked.is_some(),
    }
}

/// The scripts of a plan, each an array of at most `limit` jobs, and last the one that collects when all have ended, whether or not
/// some failed. Names and contents; they are submitted in order, the last with `--dependency=afterany` on the others.
pub fn scripts(
    plan: &Plan,
    sweep: &Path,
    out: &Path,
    program: &Path,
    packing: Packing,
    limit: usize,
) -> Vec<(String, String)> {
    let task = &plan.head.task;
    let most = limit.max(2) - 1;
    let starts: Vec<usize> = (0..packing.shards).step_by(most).collect();
    let mut scripts = Vec::new();
    let head = |name: &str, more: &str| {
        format!(
            "#!/bin/sh\n#SBATCH --job-name=edifice-{name}\n#SBATCH --nodes=1\n#SBATCH --ntasks=1\n#SBATCH --cpus-per-task={}\n#SBATCH --mem={}\n{more}set -e\n",
            task.cpus, task.mem
        )
    };
    let common = format!("{} --out {}", word(sweep), word(out));
    for (number, &start) in starts.iter().enumerate() {
        let count = most.min(packing.shards - start);
        let minutes = packing.limit.div_ceil(60);
        let array = format!(
            "#SBATCH --array=0-{}\n#SBATCH --time={minutes}\n#SBATCH --requeue\n#SBATCH --output={}\n",
            count - 1,
            word(&out.join("slurm-%A-%a.log"))
        );
        let body = format!(
            "exec {} sweep run {common} --shard $((SLURM_ARRAY_TASK_ID + {start}))/{} --threads \"$SLURM_CPUS_PER_TASK\"\n",
            word(program),
            packing.shards
        );
        scripts.push((format!("array_{number}.sh"), head("sweep", &array) + &body));
    }
    let log = format!(
        "#SBATCH --time=60\n#SBATCH --output={}\n",
        word(&out.join("slurm-collect-%j.log"))
    );
    let body = format!("exec {} sweep collect {common}\n", word(program));
    scripts.push(("collect.sh".into(), head("collect", &log) + &body));
    scripts
}
