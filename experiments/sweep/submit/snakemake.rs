//! Snakemake: one rule over packed shards.

use std::path::Path;

use super::{Packing, word};
use crate::plan::Plan;
use edifice_base::{Error, Result};

/// A Snakefile that runs all shards and collects, in the sweep's folder.
///
/// # Errors
/// [`Error::Option`] for a folder with braces in its name, which Snakemake cannot work in.
pub fn snakefile(
    plan: &Plan,
    sweep: &Path,
    out: &Path,
    program: &Path,
    packing: Packing,
) -> Result<String> {
    if out.to_string_lossy().contains(['{', '}']) {
        let message = "Snakemake takes braces in a path for wildcards: choose a folder without";
        return Err(Error::option("--out", message));
    }
    let task = &plan.head.task;
    let quoted = |text: String| format!("{text:?}");
    // Braces are Snakemake's own.
    let word = |path: &Path| word(path).replace('{', "{{").replace('}', "}}");
    let common = format!("{} --out {}", word(sweep), word(out));
    let run = format!(
        "{} sweep run {common} --shard {{wildcards.shard}}/{} --threads {{threads}}",
        word(program),
        packing.shards
    );
    let collect = format!("{} sweep collect {common}", word(program));
    // Marks of another plan, or of other shards, say nothing of these.
    let marks = format!("snakemake/{}-{}", plan.digest(), packing.shards);
    let mark = |name: &str| quoted(format!("{marks}/{name}"));
    Ok(format!(
        "# snakemake --snakefile SNAKEFILE --cores N, or with an executor plugin: --executor slurm --slurm-no-account\n\
         workdir: {folder}\n\n\
         shards = range({shards})\n\n\
         rule all:\n    input: {done}\n\n\
         rule shard:\n    output: touch({shard})\n    threads: {cpus}\n    resources: mem={mem}, runtime={minutes}\n    shell: {run}\n\n\
         rule collect:\n    input: expand({shard}, shard=shards)\n    output: touch({done})\n    shell: {collect}\n",
        folder = quoted(out.display().to_string()),
        shards = packing.shards,
        done = mark("collected"),
        shard = mark("shard_{shard}"),
        cpus = task.cpus,
        mem = quoted(task.mem.clone()),
        minutes = packing.limit.div_ceil(60),
        run = quoted(run),
        collect = quoted(collect),
    ))
}
