//! `edifice sweep`: ablations and comparisons from one file.

mod candidate;
mod examples;
mod studies;
pub(crate) mod submit;
mod verify;

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::{Args, Subcommand};
use edifice_base::{Ended, Error, Progress, Result};
use edifice_experiments::studies as all_studies;
use edifice_experiments::sweep::collect::{ArmState, RESULTS, collect, state};
use edifice_experiments::sweep::plan::{PLAN, Plan};
use edifice_experiments::sweep::ro_crate::{Published, date, is_date};
use edifice_experiments::sweep::run::{Wanted, run as run_shard, shard};
use edifice_experiments::sweep::{Study, bundle, report};

use super::print;

/// Commands of sweeps.
#[derive(Subcommand)]
pub(crate) enum Command {
    /// List the studies with every setting, its type, default and meaning
    #[command(after_help = "Example: edifice sweep studies")]
    Studies(studies::Options),
    /// List the sweep files that ship with the program (the papers' ablations), or print one
    Examples(examples::Options),
    /// Write the plan: arms, instances, tasks
    #[command(after_help = "Example: edifice sweep plan ablation.toml --out ablation")]
    Plan(Common),
    /// Run the tasks that have no result yet, here
    #[command(after_help = "Example: edifice sweep run ablation.toml --out ablation --shard 0/30")]
    Run(Run),
    /// Run the tasks that failed or have no result, here
    #[command(after_help = "Example: edifice sweep retry ablation.toml --out ablation")]
    Retry(Run),
    /// Write the scripts of a cluster, and submit them
    Submit(submit::Options),
    /// Answer one question by a study's built-in method, as a command of an arm does
    Candidate(candidate::Options),
    /// Say what is finished, failed and missing
    #[command(after_help = "Example: edifice sweep status ablation.toml --out ablation")]
    Status(Common),
    /// Write results.csv
    #[command(after_help = "Example: edifice sweep collect ablation.toml --out ablation")]
    Collect(Common),
    /// Write tables, tests and figures
    #[command(after_help = "Example: edifice sweep report ablation.toml --out ablation")]
    Report(Report),
    /// Pack file, plan, instances and results into one zip
    #[command(after_help = "Examples:
  edifice sweep bundle ablation.toml --out ablation -o ablation.zip
  edifice sweep bundle ablation.toml --out ablation -o crate.zip --ro-crate --licence https://creativecommons.org/licenses/by/4.0/")]
    Bundle(Bundle),
    /// Check a bundle: its digests, and a sample of its tasks run again
    #[command(after_help = "Example: edifice sweep verify ablation.zip --sample 1")]
    Verify(verify::Verify),
}

/// The options of all commands.
#[derive(Args)]
pub(crate) struct Common {
    /// Sweep file
    sweep: PathBuf,
    /// Folder of the sweep's plan and results
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Print one JSON object as the last line
    #[arg(long)]
    json: bool,
}

/// Options of `run` and `retry`.
#[derive(Args)]
pub(crate) struct Run {
    #[command(flatten)]
    common: Common,
    /// Run only every Nth task, from the Ith: `I/N`, counted from 0
    #[arg(long, default_value = "0/1", value_name = "I/N")]
    shard: String,
    /// Threads; 0 for one per core
    #[arg(long, default_value_t = 0)]
    threads: usize,
}

/// Options of `report`.
#[derive(Args)]
pub(crate) struct Report {
    #[command(flatten)]
    common: Common,
    /// Compare on what all arms have, though tasks are missing or failed
    #[arg(long)]
    allow_missing: bool,
    /// Put a copy beside the papers' reports, and into the index.html of that folder
    #[arg(long, value_name = "DIR")]
    into: Option<PathBuf>,
}

/// Options of `bundle`.
#[derive(Args)]
pub(crate) struct Bundle {
    #[command(flatten)]
    common: Common,
    /// File to write
    #[arg(short, value_name = "ZIP")]
    output: PathBuf,
    /// Add the metadata that make it a Research Object Crate 1.1 (ro-crate-metadata.json)
    #[arg(long)]
    ro_crate: bool,
    /// With --ro-crate, the day of publication; today (UTC) by default
    #[arg(long, value_name = "YYYY-MM-DD", requires = "ro_crate", value_parser = day)]
    published: Option<String>,
    /// With --ro-crate, the address of the licence of data and results
    #[arg(long, value_name = "URL", requires = "ro_crate")]
    licence: Option<String>,
}

/// A day as an argument.
fn day(text: &str) -> std::result::Result<String, String> {
    match is_date(text) {
        true => Ok(text.to_owned()),
        false => Err("expected a day, YYYY-MM-DD".into()),
    }
}

/// Runs a command.
pub(crate) fn run(command: Command) -> Result<()> {
    let studies = all_studies();
    match command {
        Command::Studies(options) => studies::list(&studies, &options),
        Command::Examples(options) => examples::show(&options),
        Command::Plan(common) => plan(&common, &studies),
        Command::Run(options) => tasks(&options, &studies, Wanted::Missing),
        Command::Retry(options) => tasks(&options, &studies, Wanted::MissingAndFailed),
        Command::Submit(options) => submit::submit(&options, &studies),
        Command::Candidate(options) => candidate::answer(&options, &studies),
        Command::Status(common) => status(&common, &studies),
        Command::Collect(common) => {
            let plan = Plan::current(&common.sweep, &common.out, &studies)?;
            let (rows, tasks) = collect(&plan, &common.out)?;
            print::message(&format!(
                "{rows} rows of {tasks} finished tasks in {}",
                common.out.join(RESULTS).display()
            ));
            json(
                &common,
                &serde_json::json!({ "rows": rows, "finished": tasks, "tasks": plan.tasks.len() }),
            )
        }
        Command::Report(options) => {
            let plan = Plan::current(&options.common.sweep, &options.common.out, &studies)?;
            collect(&plan, &options.common.out)?;
            let study = plan.study(&studies)?;
            let text = report::report(&plan, &options.common.out, study, options.allow_missing)?;
            print::line(text.trim_end())?;
            if let Some(into) = &options.into {
                let index = report::publish(
                    &edifice_experiments::PROGRAM,
                    &options.common.sweep,
                    &options.common.out,
                    into,
                )?;
                print::message(&format!("report in {}", index.display()));
            }
            let folder = options.common.out.join("report");
            json(&options.common, &serde_json::json!({ "folder": folder }))
        }
        Command::Bundle(options) => {
            let plan = Plan::current(&options.common.sweep, &options.common.out, &studies)?;
            let published = options.ro_crate.then(|| Published {
                date: options.published.clone().unwrap_or_else(today),
                licence: options.licence.clone(),
            });
            let packed = bundle::bundle(
                &plan,
                &options.common.sweep,
                &options.common.out,
                &options.output,
                published.as_ref(),
            )?;
            print::message(&format!(
                "{} files in {}, SHA-256 {}",
                packed.files,
                options.output.display(),
                packed.sha256
            ));
            json(&options.common, &serde_json::json!(packed))
        }
        Command::Verify(options) => verify::run(&options, &studies),
    }
}

fn json(common: &Common, value: &serde_json::Value) -> Result<()> {
    match common.json {
        true => print::line(&value.to_string()),
        false => Ok(()),
    }
}

fn plan(common: &Common, studies: &[Study]) -> Result<()> {
    let plan = Plan::make(&common.sweep, &common.out, studies)?;
    plan.write(&common.out)?;
    let state = state(&plan, &common.out)?;
    let finished: usize = state.arms.iter().map(|arm| arm.finished).sum();
    let left = plan.tasks.len() - finished;
    for arm in &plan.head.arms {
        print::line(&arm.name)?;
    }
    let time = state.mean_seconds.map_or_else(String::new, |mean| {
        format!(
            ", {} of work left by the mean of those finished",
            words(mean * left as f64)
        )
    });
    print::message(&format!(
        "{} arms x {} instances x {} seeds = {} tasks, {finished} finished before{time}; plan in {}",
        plan.head.arms.len(),
        plan.head.instances.len(),
        plan.tasks.len() / (plan.head.arms.len() * plan.head.instances.len()),
        plan.tasks.len(),
        common.out.join(PLAN).display()
    ));
    let estimate = state.mean_seconds.map(|mean| mean * left as f64);
    json(
        common,
        &serde_json::json!({ "tasks": plan.tasks.len(), "finished": finished, "seconds_left": estimate }),
    )
}

fn tasks(options: &Run, studies: &[Study], wanted: Wanted) -> Result<()> {
    let common = &options.common;
    let shard = shard(&options.shard)?;
    let plan = Plan::of(&common.sweep, &common.out, studies)?;
    let study = plan.study(studies)?;
    static STOP: AtomicBool = AtomicBool::new(false);
    // A second handler is refused only where one is set already.
    let _ = ctrlc::set_handler(|| STOP.store(true, Ordering::Relaxed));
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads)
        .build();
    let pool = pool.map_err(Error::method)?;
    let watch = |_: Progress| match STOP.load(Ordering::Relaxed) {
        true => ControlFlow::Break(()),
        false => ControlFlow::Continue(()),
    };
    let ran = pool.install(|| run_shard(&plan, &common.out, study, shard, wanted, &watch))?;
    if ran.ended == Ended::Interrupted {
        return Err(Error::Interrupted);
    }
    print::message(&format!(
        "{} tasks finished, {} failed, {} had a result before",
        ran.finished, ran.failed, ran.before
    ));
    json(
        common,
        &serde_json::json!({ "finished": ran.finished, "failed": ran.failed, "before": ran.before }),
    )
}

fn status(common: &Common, studies: &[Study]) -> Result<()> {
    let plan = Plan::current(&common.sweep, &common.out, studies)?;
    let state = state(&plan, &common.out)?;
    print::line("finished  failed  missing  arm")?;
    let mut left = 0;
    for ArmState {
        arm,
        finished,
        failed,
        missing,
    } in &state.arms
    {
        print::line(&format!("{finished:>8}{failed:>8}{missing:>9}  {arm}"))?;
        left += missing + failed;
    }
    for (reason, count) in &state.failures {
        print::message(&format!("failed {count} times: {reason}"));
    }
    for damaged in &state.damaged {
        print::message(&format!(
            "warning: {}: line {} cannot be read; its task counts as missing",
            damaged.path.display(),
            damaged.line
        ));
    }
    if state.foreign > 0 {
        print::message(&format!(
            "warning: {} results of other sources of the study do not count",
            state.foreign
        ));
    }
    if let Some(mean) = state.mean_seconds {
        print::message(&format!(
            "{} per task, {} of work left",
            words(mean),
            words(mean * left as f64)
        ));
    }
    json(
        common,
        &serde_json::json!({ "arms": state.arms, "seconds_per_task": state.mean_seconds }),
    )
}

/// A time in words.
fn words(seconds: f64) -> String {
    match seconds {
        s if s < 100.0 => format!("{s:.2} s"),
        s if s < 6000.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}

/// Today, UTC.
fn today() -> String {
    let since = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
    date(since.map_or(0, |since| since.as_secs()))
}
