//! The report of a sweep beside the papers': `OUT/sweeps/<name>/` and a part of `OUT/index.html`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::REPORT;
use crate::collect::RESULTS;
use crate::plan::Plan;
use crate::study::Study;
use edifice_base::{Error, Result, file};
use edifice_frame::Program;
use edifice_frame::SWEEPS;
use edifice_frame::provenance::{Machine, Made, Run};
use edifice_frame::write_index;

/// Name of the one artefact of a sweep.
const ARTEFACT: &str = "report";

/// Writes `run.json` and `provenance.json` into the folder of a report: what was run, by which program.
pub(super) fn provenance(plan: &Plan, study: &Study, seconds: f64, folder: &Path) -> Result<()> {
    let head = &plan.head;
    let mut settings = BTreeMap::new();
    let mut set = |name: &str, value: serde_json::Value| settings.insert(name.to_owned(), value);
    set("tasks", head.tasks.into());
    let arm = |arm: &crate::definition::Arm| (arm.name.clone(), arm.settings.clone().into());
    set(
        "arms",
        head.arms
            .iter()
            .map(arm)
            .collect::<serde_json::Map<_, _>>()
            .into(),
    );
    let data = head.instances.iter().chain(&head.learn);
    let (commit, dirty) = study.commit();
    let made = Made {
        title: study.about.to_owned(),
        command: "edifice sweep report".to_owned(),
        seed: 0,
        budget: "sweep".to_owned(),
        settings,
        data: data.map(|i| (i.name.clone(), i.digest.clone())).collect(),
        version: head.program.clone(),
        commit,
        dirty,
        sources: String::new(),
        wall_seconds: seconds,
        machine: Machine::this(rayon::current_num_threads()),
        files: files(folder)?,
        comparisons: Vec::new(),
        skipped: None,
    };
    let run = Run {
        experiment: ".".to_owned(),
        paper: format!("Sweep of {}", head.study),
        artefacts: BTreeMap::from([(ARTEFACT.to_owned(), made)]),
        order: vec![ARTEFACT.to_owned()],
    };
    run.write(folder)
}

/// Names of what a page may show or link to, in order.
fn files(folder: &Path) -> Result<Vec<String>> {
    let fail = |e| Error::io(folder, "read", e);
    let mut names = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(fail)? {
        let name = entry.map_err(fail)?.file_name();
        let name = name.to_string_lossy().into_owned();
        let ending = name.rsplit('.').next().unwrap_or_default();
        if ["md", "csv", "tex", "svg", "png", "toml"].contains(&ending) {
            names.push(name);
        }
    }
    names.sort();
    Ok(names)
}

/// Copies the report of a sweep, its file and its results to `into/sweeps/<name of the file>`, and writes `into/index.html` anew.
/// Returns the place of that page.
///
/// # Errors
/// [`Error::Io`].
pub fn publish(program: &Program, sweep: &Path, out: &Path, into: &Path) -> Result<PathBuf> {
    let name = sweep.file_stem().unwrap_or_default();
    let slug = format!("{SWEEPS}/{}", name.to_string_lossy());
    let target = into.join(&slug);
    std::fs::create_dir_all(&target).map_err(|e| Error::io(&target, "create", e))?;
    let folder = out.join(REPORT);
    let mut sources: Vec<(String, PathBuf)> = files(&folder)?
        .into_iter()
        .map(|name| (name.clone(), folder.join(name)))
        .collect();
    sources.push((RESULTS.to_owned(), out.join(RESULTS)));
    sources.push(("sweep.toml".to_owned(), sweep.to_path_buf()));
    for (name, path) in &sources {
        let bytes = std::fs::read(path).map_err(|e| Error::io(path, "read", e))?;
        file::write_atomic(&target.join(name), &bytes)?;
    }
    let mut run = Run::read(&folder);
    run.experiment = slug;
    run.paper = format!("{}: {}", run.paper, name.to_string_lossy());
    if let Some(made) = run.artefacts.get_mut(ARTEFACT) {
        made.files = files(&target)?;
    }
    run.write(&target)?;
    write_index(program, into)
}
