//! `edifice city submit`.

use std::path::{Path, PathBuf};

use edifice_base::{Error, Result, file};
use edifice_experiments::city_proceduralization::country::{Jobs, Plan, slurm, snakefile};
use edifice_experiments::sweep::submit::array_limit;

use crate::print::{self, Json};
use crate::sweep::submit::{Engine, sbatch};

/// Options.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The folder of a plan, which all machines share.
    folder: PathBuf,
    /// Who runs the workers.
    #[arg(long, value_enum)]
    engine: Engine,
    /// Number of workers, each a job [default: one for each tile, at most 64]
    #[arg(long, value_name = "N")]
    workers: Option<usize>,
    /// Processors of each worker.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..))]
    cpus: u16,
    /// Minutes after which a worker is stopped; submitted again, the work goes on.
    #[arg(long, value_name = "N", default_value_t = 720, value_parser = clap::value_parser!(u32).range(1..))]
    minutes: u32,
    /// Write the script and start nothing.
    #[arg(long)]
    dry_run: bool,
    #[command(flatten)]
    json: Json,
}

/// Most workers that are started without being asked for.
const MOST: usize = 64;

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    let plan = Plan::read(&args.folder)?;
    let absolute = |path: &Path| std::path::absolute(path).map_err(|e| Error::io(path, "find", e));
    let folder = absolute(&args.folder)?;
    let program = std::env::current_exe().map_err(|e| Error::io("edifice".as_ref(), "find", e))?;
    let jobs = Jobs {
        workers: args.workers.unwrap_or(plan.tiles.len().clamp(1, MOST)),
        cpus: args.cpus.into(),
        minutes: args.minutes.into(),
    };
    if jobs.workers == 0 {
        return Err(Error::option("--workers", "expected at least 1"));
    }
    let (name, text) = match args.engine {
        Engine::Slurm => {
            let limit = array_limit();
            if jobs.workers >= limit.size {
                let text = format!(
                    "Slurm takes arrays of fewer than {} jobs here (MaxArraySize)",
                    limit.size
                );
                return Err(Error::option("--workers", text));
            }
            ("workers.sh", slurm(&plan, &folder, &program, jobs)?)
        }
        Engine::Snakemake => ("Snakefile", snakefile(&plan, &folder, &program, jobs)?),
    };
    let path = folder.join(name);
    file::write_atomic(&path, text.as_bytes())?;
    match (args.engine, args.dry_run) {
        (_, true) => {}
        (Engine::Slurm, false) => {
            sbatch(&path, None)?;
        }
        (Engine::Snakemake, false) => print::message(
            "run snakemake with the file, for example: snakemake --cores 2 --snakefile Snakefile",
        ),
    }
    let text = format!("{}: {} workers", path.display(), jobs.workers);
    let value = serde_json::json!({ "file": path, "workers": jobs.workers });
    args.json.after(&text, &value)
}
