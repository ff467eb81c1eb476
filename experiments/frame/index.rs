//! `OUT/index.html`, the first page of a report.

use std::path::{Path, PathBuf};

use super::Program;
use super::document::readable;
use super::documents;
use super::lock::Lock;
use super::provenance::{Comparison, Made, RUN, Run};
use edifice_base::{Error, Result};
use edifice_report::{self as report, Beside, Page, Section};

/// Folder of sweeps under the report.
pub const SWEEPS: &str = "sweeps";

/// Writes `OUT/index.html` over every paper found there, and then every sweep, so that those run one by one add up.
pub fn write_index(program: &Program, out: &Path) -> Result<PathBuf> {
    // Of two runs that end at once, the second writes the page that has both.
    let _lock = Lock::wait(out)?;
    let mut folders = made_in(out)?;
    let sweeps = out.join(SWEEPS);
    if sweeps.is_dir() {
        folders.extend(made_in(&sweeps)?);
    }
    let pages: Vec<Page> = folders
        .iter()
        .map(|folder| page(program, folder, &Run::read(folder)))
        .collect();
    let path = out.join("index.html");
    edifice_base::file::write_atomic(&path, report::index(&pages).as_bytes())?;
    Ok(path)
}

/// Folders of reports, by name.
fn made_in(folder: &Path) -> Result<Vec<PathBuf>> {
    let fail = |e| Error::io(folder, "read", e);
    let mut folders = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(fail)? {
        let path = entry.map_err(fail)?.path();
        if path.join(RUN).is_file() {
            folders.push(path);
        }
    }
    folders.sort();
    Ok(folders)
}

/// False for what is too large to keep in the repository: scenes, tables of single elements, and tables of real data. No page links
/// them, so that it is the same there and where they were made.
fn is_kept(made: &Made, file: &str) -> bool {
    let real = made.data.keys().any(|name| name.starts_with("DATA/"));
    let large = ["benchmark.csv", "completion.csv"].contains(&file);
    !(file.ends_with(".glb") || large || real && file.ends_with(".csv"))
}

/// One paper's part of the index.
fn page(program: &Program, folder: &Path, run: &Run) -> Page {
    let sections = run.order.iter().filter_map(|name| {
        let made = run.artefacts.get(name)?;
        let markdown = std::fs::read_to_string(folder.join(format!("{name}.md"))).ok()?;
        let linked = |file: &String| is_kept(made, file) && folder.join(file).is_file();
        let (files, absent) = made.files.iter().cloned().partition(linked);
        Some(Section {
            name: name.clone(),
            heading: format!("{}: {}", readable(name), made.title),
            markdown,
            files,
            absent,
            command: made.command.clone(),
            studio: documents::command(program, &run.experiment, name, folder),
            beside: made.comparisons.iter().map(beside).collect(),
            skipped: made.skipped.clone(),
            // The same wherever it is made again; commit, sources, time and machine are in `provenance.json`.
            made: format!(
                "{}, version {}{}",
                match made.budget.as_str() {
                    "sweep" => "sweep, processor time".to_owned(),
                    budget => format!("seed {}, budget {budget}", made.seed),
                },
                made.version,
                match made.machine.optimized {
                    true => "",
                    false => ", unoptimized build",
                },
            ),
        })
    });
    Page {
        slug: run.experiment.clone(),
        paper: run.paper.clone(),
        sections: sections.collect(),
    }
}

fn beside(comparison: &Comparison) -> Beside {
    Beside {
        quantity: comparison.quantity.clone(),
        printed: comparison.printed.clone(),
        ours: comparison.ours.clone(),
    }
}
