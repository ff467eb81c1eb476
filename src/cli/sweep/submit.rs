//! `edifice sweep submit`.

use std::path::{Path, PathBuf};
use std::process::Command;

use clap::{Args, ValueEnum};
use edifice_base::{Error, Result, file};
use edifice_experiments::sweep::submit::{array_limit, packing, scripts, snakefile};
use edifice_experiments::sweep::{Plan, Study};

use super::super::print;
use super::Common;

/// Who runs the jobs.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Engine {
    /// Slurm's job arrays
    Slurm,
    /// Snakemake
    Snakemake,
}

/// Options of `submit`.
#[derive(Args)]
#[command(
    after_help = "Example: edifice sweep submit ablation.toml --out ablation --engine slurm --dry-run"
)]
pub(crate) struct Options {
    #[command(flatten)]
    common: Common,
    /// Who runs the jobs
    #[arg(long, value_enum)]
    engine: Engine,
    /// Write the scripts and start nothing
    #[arg(long)]
    dry_run: bool,
}

/// Writes the scripts, and starts them.
pub(super) fn submit(options: &Options, studies: &[Study]) -> Result<()> {
    let common = &options.common;
    let plan = Plan::of(&common.sweep, &common.out, studies)?;
    let absolute = |path: &Path| std::path::absolute(path).map_err(|e| Error::io(path, "find", e));
    let (sweep, out) = (absolute(&common.sweep)?, absolute(&common.out)?);
    let program = std::env::current_exe().map_err(|e| Error::io("edifice".as_ref(), "find", e))?;
    let packing = packing(&plan, &out)?;
    if packing.shards == 0 {
        print::message("every task has a result: nothing to submit");
        let nothing: [&Path; 0] = [];
        return super::json(
            common,
            &serde_json::json!({ "tasks": 0, "jobs": 0, "files": nothing }),
        );
    }
    let mut written: Vec<PathBuf> = Vec::new();
    let mut write = |name: &str, text: &str| {
        let path = out.join(name);
        written.push(path.clone());
        file::write_atomic(&path, text.as_bytes())
    };
    match options.engine {
        Engine::Slurm => {
            let limit = array_limit();
            if !limit.asked {
                print::message(
                    "note: no answer from scontrol; arrays are split at Slurm's default MaxArraySize of 1001",
                );
            }
            for (name, text) in scripts(&plan, &sweep, &out, &program, packing, limit.size) {
                write(&name, &text)?;
            }
        }
        Engine::Snakemake => write(
            "Snakefile",
            &snakefile(&plan, &sweep, &out, &program, packing)?,
        )?,
    }
    for path in &written {
        print::line(&path.display().to_string())?;
    }
    print::message(&format!(
        "{} tasks in {} jobs",
        packing.tasks, packing.shards
    ));
    if !options.dry_run {
        match options.engine {
            Engine::Slurm => sbatch_all(&written)?,
            Engine::Snakemake => print::message(
                "run snakemake with the file above, for example: snakemake --cores 2 --snakefile Snakefile",
            ),
        }
    }
    super::json(
        common,
        &serde_json::json!({ "tasks": packing.tasks, "jobs": packing.shards, "files": written }),
    )
}

/// Submits the arrays, then what collects when they have ended.
fn sbatch_all(scripts: &[PathBuf]) -> Result<()> {
    let Some((last, arrays)) = scripts.split_last() else {
        return Ok(());
    };
    let ids = arrays.iter().map(|script| sbatch(script, None));
    let ids = ids.collect::<Result<Vec<_>>>()?;
    sbatch(last, Some(&format!("afterany:{}", ids.join(":"))))?;
    Ok(())
}

/// Submits a script, one that waits for others where there is a dependency; gives the number of the job.
pub(crate) fn sbatch(script: &Path, dependency: Option<&str>) -> Result<String> {
    let mut command = Command::new("sbatch");
    command.arg("--parsable");
    command.args(dependency.map(|d| format!("--dependency={d}")));
    let output = command
        .arg(script)
        .output()
        .map_err(|e| Error::io("sbatch".as_ref(), "run", e))?;
    if !output.status.success() {
        return Err(Error::method(format!(
            "sbatch refused {}: {}",
            script.display(),
            String::from_utf8_lossy(&output.stderr).trim()
        )));
    }
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let id = text.trim().split(';').next().unwrap_or_default().to_owned();
    print::message(&format!("submitted {} as job {id}", script.display()));
    Ok(id)
}
