//! Runs experiments and writes their artefacts.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::Ordering;
use std::time::Instant;

use clap::Parser;
use serde_json::{Value, json};

use super::context::{Context, DATASETS, STOP, WORK};
use super::estimate::{readable_seconds, say_how_long, seconds_before};
use super::index::write_index;
use super::lock::Lock;
use super::options::{Args, Options};
use super::place::suggestion;
use super::progress::{line, result};
use super::provenance::{Machine, Made, Run};
use super::verify::say_which_are_older;
use super::{Artefact, Experiment, Program};
use edifice_base::{Error, Result};
use edifice_report as report;

/// The outcome of a run.
#[derive(Debug, Clone, Default)]
pub struct Report {
    /// The report's first page.
    pub index: PathBuf,
    /// Artefacts made, as `paper/artefact`.
    pub made: Vec<String>,
    /// Artefacts that could not be made here, with the reason.
    pub skipped: Vec<(String, String)>,
    /// Artefacts that failed, with the error.
    pub failed: Vec<(String, String)>,
    /// Seconds from start to end.
    pub seconds: f64,
}

/// An artefact failed.
#[derive(Debug, thiserror::Error)]
#[error("{failed} of {all} artefacts failed")]
struct Failed {
    failed: usize,
    all: usize,
}

impl Report {
    /// The closing summary, line by line.
    pub fn summary(&self) -> Vec<String> {
        let mut lines = vec![format!(
            "{} artefacts made in {:.1} s, {} left out, {} failed",
            self.made.len(),
            self.seconds,
            self.skipped.len(),
            self.failed.len()
        )];
        let named = |(name, why): &(String, String), what| format!("  {name} {what}: {why}");
        lines.extend(self.skipped.iter().map(|entry| named(entry, "left out")));
        lines.extend(self.failed.iter().map(|entry| named(entry, "failed")));
        lines.push(format!("Report: {}", self.index.display()));
        lines
    }

    /// The same for programs.
    fn value(&self) -> Value {
        let named = |entries: &[(String, String)], why: &str| -> Vec<Value> {
            let entry = |(name, text): &(String, String)| json!({ "artefact": name, (why): text });
            entries.iter().map(entry).collect()
        };
        json!({
            "made": self.made, "skipped": named(&self.skipped, "reason"), "failed": named(&self.failed, "error"),
            "index": self.index, "seconds": self.seconds,
        })
    }

    /// The report, or an error when an artefact failed.
    ///
    /// # Errors
    /// [`Error::Method`] that counts the failures.
    pub fn check(self) -> Result<Self> {
        match self.failed.len() {
            0 => Ok(self),
            failed => Err(Error::method(Failed {
                failed,
                all: failed + self.made.len(),
            })),
        }
    }
}

/// Runs the experiments and writes the report.
///
/// A failing artefact does not stop the others; see [`Report::check`]. The journals of the artefacts
/// asked for are removed only when all of these are done.
///
/// # Errors
/// [`Error::Option`] for an unknown artefact, [`Error::Content`] when another run writes into the same
/// folder, [`Error::Io`] when the report cannot be written, [`Error::Interrupted`] after Ctrl-C.
pub fn run(
    program: &Program,
    experiments: &[&'static Experiment],
    options: &Options,
) -> Result<Report> {
    let chosen = choose(experiments, &options.only)?;
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads)
        .build()
        .map_err(Error::method)?;
    let start = Instant::now();
    let mut report = Report::default();
    // All folders before any work, so that a second run on one of them says so at once.
    let mut locks = Vec::new();
    for (experiment, _) in &chosen {
        let folder = options.out.join(experiment.slug);
        std::fs::create_dir_all(&folder).map_err(|e| Error::io(&folder, "create", e))?;
        locks.push(Lock::take(&folder)?);
    }
    say_how_long(&chosen, options);
    for (experiment, artefacts) in &chosen {
        let folder = options.out.join(experiment.slug);
        let before = Run::read(&folder);
        for artefact in artefacts {
            let name = format!("{}/{}", experiment.slug, artefact.name);
            let took = seconds_before(&before, artefact, options);
            let took = took.map_or_else(String::new, |s| {
                format!(" ({} last time)", readable_seconds(s))
            });
            line(&format!("{name}: {}{took}", artefact.title));
            match pool.install(|| make(program, experiment, artefact, &folder, options)) {
                Ok(None) => report.made.push(name),
                Ok(Some(reason)) => report.skipped.push((name, reason)),
                Err(Error::Interrupted) => return Err(Error::Interrupted),
                Err(error) => {
                    line(&format!("{name} failed: {error}"));
                    report.failed.push((name, error.to_string()));
                }
            }
        }
    }
    report.index = write_index(program, &options.out)?;
    if report.failed.is_empty() {
        for (experiment, artefacts) in &chosen {
            remove_work(&options.out.join(experiment.slug).join(WORK), artefacts)?;
        }
    }
    report.seconds = start.elapsed().as_secs_f64();
    Ok(report)
}

/// The artefacts asked for, by experiment.
fn choose(
    experiments: &[&'static Experiment],
    only: &[String],
) -> Result<Vec<(&'static Experiment, Vec<&'static Artefact>)>> {
    let all = || experiments.iter().flat_map(|e| e.artefacts);
    if let Some(unknown) = only.iter().find(|name| all().all(|a| a.name != **name)) {
        let known: Vec<_> = all().map(|a| a.name).collect();
        return Err(Error::option(
            "--only",
            format!(
                "no artefact {unknown:?}{}; known are {}",
                suggestion(unknown, known.iter().copied()),
                known.join(", ")
            ),
        ));
    }
    let wanted = |a: &&'static Artefact| only.is_empty() || only.iter().any(|n| n == a.name);
    Ok(experiments
        .iter()
        .map(|e| (*e, e.artefacts.iter().filter(wanted).collect()))
        .filter(|(_, artefacts): &(_, Vec<_>)| !artefacts.is_empty())
        .collect())
}

/// Makes one artefact with all its files; returns the reason when it was left out.
fn make(
    program: &Program,
    experiment: &'static Experiment,
    artefact: &'static Artefact,
    folder: &Path,
    options: &Options,
) -> Result<Option<String>> {
    let start = Instant::now();
    let mut ctx = Context::new(
        options,
        experiment.slug,
        artefact.name,
        artefact.title,
        folder.to_path_buf(),
    );
    (artefact.run)(&mut ctx)?;
    if ctx.skipped.is_none() {
        let csv = format!("{}.csv", artefact.name);
        report::write_rows(&folder.join(&csv), &ctx.rows)?;
        ctx.files.insert(0, csv);
    }
    let times = ctx.times.write(folder)?;
    if let Some(page) = times.first() {
        // A table of them alone is a file that not every report keeps.
        let named = match page.ends_with(".md") {
            true => format!("[{page}]({page})"),
            false => format!("`{page}`"),
        };
        ctx.document.block(format!(
            "Times and memory, which differ from run to run: {named}."
        ));
    }
    ctx.files.extend(times);
    let page = format!("{}.md", artefact.name);
    let text = ctx
        .document
        .markdown(&ctx.comparisons, ctx.skipped.as_deref());
    edifice_base::file::write_atomic(&folder.join(&page), text.as_bytes())?;
    ctx.files.insert(0, page);

    let mut run = Run::read(folder);
    run.experiment = experiment.slug.to_string();
    run.paper = experiment.paper.to_string();
    run.order = experiment.artefacts.iter().map(|a| a.name.into()).collect();
    let made = Made {
        title: artefact.title.to_string(),
        command: options.command(experiment.slug, artefact.name),
        seed: options.seed,
        budget: options.budget.name().to_owned(),
        settings: ctx.settings,
        data: ctx.data,
        version: env!("CARGO_PKG_VERSION").to_string(),
        commit: program.sources.commit.map(str::to_owned),
        dirty: program.sources.dirty,
        sources: program.sources.of_paper(experiment.slug),
        wall_seconds: start.elapsed().as_secs_f64(),
        machine: Machine::this(rayon::current_num_threads()),
        files: ctx.files,
        comparisons: ctx.comparisons,
        skipped: ctx.skipped.clone(),
    };
    run.artefacts.insert(artefact.name.to_string(), made);
    run.write(folder)?;
    Ok(ctx.skipped)
}

/// Removes the journals of finished artefacts, whatever their settings, and the unpacked data sets. The
/// journals of other artefacts stay for the runs that go on with them.
fn remove_work(folder: &Path, artefacts: &[&'static Artefact]) -> Result<()> {
    let there = |result: std::io::Result<()>, path: &Path| match result {
        Err(e) if e.kind() != ErrorKind::NotFound => Err(Error::io(path, "remove", e)),
        _ => Ok(()),
    };
    let unpacked = folder.join(DATASETS);
    there(std::fs::remove_dir_all(&unpacked), &unpacked)?;
    let mut left = 0;
    for entry in std::fs::read_dir(folder).into_iter().flatten() {
        let path = entry.map_err(|e| Error::io(folder, "read", e))?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let owner = name.split('-').next();
        if artefacts.iter().any(|a| owner == Some(a.name)) {
            there(std::fs::remove_file(&path), &path)?;
        } else {
            left += 1;
        }
    }
    match left {
        0 => there(std::fs::remove_dir(folder), folder),
        _ => Ok(()),
    }
}

/// Options of a paper's own binary.
#[derive(Parser)]
#[command(version)]
struct Cli {
    #[command(flatten)]
    args: Args,
}

/// The `main` of a paper's own binary.
pub fn main(program: &Program, experiment: &'static Experiment) -> ExitCode {
    let args = Cli::parse().args;
    match run_to_end(program, &[experiment], args) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            line(&format!("error: {error}"));
            ExitCode::FAILURE
        }
    }
}

/// Runs with Ctrl-C caught, and prints the summary to standard error.
///
/// # Errors
/// As [`run`] and [`Report::check`].
pub fn run_to_end(
    program: &Program,
    experiments: &[&'static Experiment],
    args: Args,
) -> Result<()> {
    let json = args.json;
    let options = args.check()?;
    if options.verify {
        let chosen = choose(experiments, &options.only)?;
        return say_which_are_older(program, &chosen, &options, json);
    }
    // A second Ctrl-C stops at once: nothing finished is lost either way.
    let _ = ctrlc::set_handler(|| {
        if STOP.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
        line("stopping after the units under way; Ctrl-C again stops at once");
    });
    let report = run(program, experiments, &options)?;
    for text in report.summary() {
        line(&text);
    }
    if json {
        result(&report.value())?;
    }
    report.check().map(|_| ())
}
