//! Scripts that start the workers of a plan on a cluster: a job array of Slurm, or Snakemake. All workers are alike; each takes the
//! tasks that no other has claimed, so that one that is killed and started again loses its task alone.

use std::path::Path;

use edifice_base::{Error, Result};
use edifice_sweep::submit::word;

use super::plan::Plan;

/// Workers and what each may use.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Jobs {
    /// Number of workers, each a job.
    pub workers: usize,
    /// Processors of each.
    pub cpus: usize,
    /// Minutes after which a worker is stopped.
    pub minutes: u64,
}

/// Bytes that a worker takes besides those of the plan's arithmetic: the program, and buffers of reading and writing.
const PROGRAM: u64 = 500_000_000;

/// Megabytes that a worker may use: any may get the largest tile, and the merge.
fn megabytes(plan: &Plan) -> Result<u64> {
    let memory = plan.memory()?;
    Ok((memory.tile.max(memory.merge) + PROGRAM).div_ceil(1_000_000))
}

/// The script of a job array of Slurm.
///
/// # Errors
/// As [`Plan::memory`].
pub fn slurm(plan: &Plan, folder: &Path, program: &Path, jobs: Jobs) -> Result<String> {
    Ok(format!(
        "#!/bin/sh\n#SBATCH --job-name=edifice-city\n#SBATCH --nodes=1\n#SBATCH --ntasks=1\n#SBATCH --cpus-per-task={}\n#SBATCH --mem={}M\n\
         #SBATCH --array=0-{}\n#SBATCH --time={}\n#SBATCH --requeue\n#SBATCH --output={}\nset -e\n\
         exec {} --quiet city work {} --threads \"$SLURM_CPUS_PER_TASK\"\n",
        jobs.cpus,
        megabytes(plan)?,
        jobs.workers.max(1) - 1,
        jobs.minutes,
        word(&folder.join("slurm-%A-%a.log")),
        word(program),
        word(folder),
    ))
}

/// A Snakefile, each worker a job of one rule.
///
/// # Errors
/// [`Error::Option`] for a folder with braces in its name, which Snakemake cannot work in; as [`Plan::memory`].
pub fn snakefile(plan: &Plan, folder: &Path, program: &Path, jobs: Jobs) -> Result<String> {
    if folder.to_string_lossy().contains(['{', '}']) {
        let message = "Snakemake takes braces in a path for wildcards: choose a folder without";
        return Err(Error::option("DIR", message));
    }
    let quoted = |text: String| format!("{text:?}");
    // Braces are Snakemake's own.
    let word = |path: &Path| word(path).replace('{', "{{").replace('}', "}}");
    let work = format!(
        "{} --quiet city work {} --threads {{threads}}",
        word(program),
        word(folder)
    );
    // Marks of another plan say nothing of this one.
    let mark = |name: &str| quoted(format!("snakemake/{}/worker_{name}", plan.key));
    Ok(format!(
        "# snakemake --snakefile SNAKEFILE --cores N, or with an executor plugin: --executor slurm --slurm-no-account\n\
         workdir: {folder}\n\n\
         rule all:\n    input: expand({worker}, worker=range({workers}))\n\n\
         rule worker:\n    output: touch({worker})\n    threads: {cpus}\n    resources: mem_mb={megabytes}, runtime={minutes}\n    shell: {work}\n",
        folder = quoted(folder.display().to_string()),
        worker = mark("{worker}"),
        workers = jobs.workers.max(1),
        cpus = jobs.cpus,
        megabytes = megabytes(plan)?,
        minutes = jobs.minutes,
        work = quoted(work),
    ))
}
