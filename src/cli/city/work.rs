//! `edifice city work`.

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::process::{Child, Command};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use edifice_base::{Error, Progress, Result};
use edifice_experiments::city_proceduralization::country::{Plan, TASKS, work};

use crate::print::{self, Json};

/// Options.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The folder of a plan.
    folder: PathBuf,
    /// Processes that work side by side on this machine.
    #[arg(long, value_name = "N", default_value_t = 1)]
    workers: usize,
    /// Threads of each process; 0 for all cores, shared out.
    #[arg(long, value_name = "N", default_value_t = 0)]
    threads: usize,
    #[command(flatten)]
    json: Json,
}

/// Runs the command: further workers are processes of their own; what they leave open when one of them ends early is done here.
pub(super) fn run(args: &Args) -> Result<()> {
    let plan = Plan::read(&args.folder)?;
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = match args.threads {
        0 => (cores / args.workers.max(1)).max(1),
        threads => threads,
    };
    static STOP: AtomicBool = AtomicBool::new(false);
    // A second handler is refused only where one is set already.
    let _ = ctrlc::set_handler(|| STOP.store(true, Ordering::Relaxed));
    let told = AtomicU64::new(u64::MAX);
    let watch = |progress: Progress| {
        if let (TASKS, Some(most)) = (progress.stage, progress.most)
            && told.swap(progress.done, Ordering::Relaxed) != progress.done
        {
            print::message(&format!("{} of {most} tasks", progress.done));
        }
        match STOP.load(Ordering::Relaxed) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(Error::method)?;
    let others = (1..args.workers).map(|_| worker(args, threads));
    let mut others: Vec<Child> = others.collect::<Result<_>>()?;
    let ran = pool.install(|| work(&plan, &args.folder, &watch));
    for other in &mut others {
        if ran.is_err() {
            // One that has ended already cannot be stopped, and need not be.
            let _ = other.kill();
        }
        let ended = other
            .wait()
            .map_err(|e| Error::io(&args.folder, "work on", e))?;
        if ran.is_ok() && !ended.success() {
            print::message(&format!(
                "warning: a worker ended with {ended}; this one did what it left open"
            ));
        }
    }
    let ran = ran?;
    let text = format!(
        "{} tasks, {} of them by this worker; {} bytes, {:.1} s of work",
        ran.tasks, ran.finished, ran.bytes, ran.seconds
    );
    let value = serde_json::to_value(&ran).map_err(Error::method)?;
    args.json.after(&text, &value)
}

/// Starts another worker.
fn worker(args: &Args, threads: usize) -> Result<Child> {
    let program = std::env::current_exe().map_err(|e| Error::io("edifice".as_ref(), "find", e))?;
    let mut command = Command::new(&program);
    command.args(["--quiet", "city", "work"]).arg(&args.folder);
    command.args(["--threads", &threads.to_string()]);
    command.stdout(std::process::Stdio::null());
    command.spawn().map_err(|e| Error::io(&program, "start", e))
}
