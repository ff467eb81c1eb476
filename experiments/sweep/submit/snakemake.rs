//! Snakemake: one rule over packed shards.

use std::path::Path;

use super::{Packing, word};
use crate::experiments::sweep::plan::Plan;

/// A Snakefile that runs all shards and collects.
pub fn snakefile(
    plan: &Plan,
    sweep: &Path,
    out: &Path,
    program: &Path,
    packing: Packing,
) -> String {
    let task = &plan.head.task;
    let quoted = |text: String| format!("{text:?}");
    let common = format!("{} --out {}", word(sweep), word(out));
    let run = format!(
        "{} sweep run {common} --shard {{wildcards.shard}}/{} --threads {{threads}}",
        word(program),
        packing.shards
    );
    let collect = format!("{} sweep collect {common}", word(program));
    let mark = |name: &str| quoted(out.join("snakemake").join(name).display().to_string());
    format!(
        "# snakemake --snakefile SNAKEFILE --cores N, or with an executor plugin: --executor slurm --slurm-no-account\n\
         shards = range({shards})\n\n\
         rule all:\n    input: {done}\n\n\
         rule shard:\n    output: touch({shard})\n    threads: {cpus}\n    resources: mem={mem}, runtime={minutes}\n    shell: {run}\n\n\
         rule collect:\n    input: expand({shard}, shard=shards)\n    output: touch({done})\n    shell: {collect}\n",
        shards = packing.shards,
        done = mark("collected"),
        shard = mark("shard_{shard}"),
        cpus = task.cpus,
        mem = quoted(task.mem.clone()),
        minutes = packing.limit.div_ceil(60),
        run = quoted(run),
        collect = quoted(collect),
    )
}
