//! The plan: every task of a sweep, keyed by its content.

use std::collections::HashSet;
use std::io::Write;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::Value;
use sha2::{Digest, Sha256};

use super::definition::{Arm, ReportOptions, TaskOptions, arms, read};
use super::study::Study;
use crate::experiments::frame::{datasets, provenance};
use crate::{Error, Result, file};

/// Name of the plan in a sweep's folder.
pub const PLAN: &str = "plan.jsonl";

/// Folder of unpacked data sets in a sweep's folder.
const DATA: &str = "data";

/// A file that the study runs on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Instance {
    /// Its file name up to the first dot, with the folder where two have one name.
    pub name: String,
    /// Where it is; relative paths are relative to the sweep's folder.
    pub path: PathBuf,
    /// SHA-256 of its bytes.
    pub digest: String,
}

/// One run of one arm on one instance with one seed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Task {
    /// Hash of study, settings, instance, seed and version of the program.
    pub key: String,
    /// Index of the arm.
    pub arm: usize,
    /// Index of the instance.
    pub instance: usize,
    /// Seed as the file counts it.
    pub seed: u64,
}

/// First line of the plan: everything but the tasks.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Head {
    format: String,
    version: u32,
    /// Version of the program that made the plan.
    pub program: String,
    /// Name of the study.
    pub study: String,
    /// SHA-256 of the sweep file.
    pub sweep: String,
    /// Whether all arms meet the same chance on an instance and seed.
    pub paired_seeds: bool,
    /// What the report is about.
    pub report: ReportOptions,
    /// What a task needs.
    pub task: TaskOptions,
    /// Arms.
    pub arms: Vec<Arm>,
    /// Instances.
    pub instances: Vec<Instance>,
    /// Number of tasks.
    pub tasks: usize,
}

/// All tasks of a sweep, in the order of its results: arm by arm, instance by instance, seed by seed.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// What they have in common.
    pub head: Head,
    /// The tasks.
    pub tasks: Vec<Task>,
}

/// What is wrong with a plan.
#[derive(Debug, thiserror::Error)]
enum PlanError {
    #[error(
        "no file is called so, neither as a path nor below the study's folder of data sets ({0})"
    )]
    NoInstance(String),
    #[error("the pattern is not one: {0}")]
    Pattern(String),
    #[error("this is no plan of a sweep: {0}")]
    NotAPlan(String),
    #[error(
        "the plan was made by version {made} of the program, this is {ours}; make it anew with `edifice sweep plan`"
    )]
    Program { made: String, ours: String },
    #[error(
        "the sweep file has changed since the plan was made; run `edifice sweep plan`, which keeps the results of tasks that are still wanted"
    )]
    Changed,
    #[error("it ends after {found} of {wanted} tasks")]
    Short { found: usize, wanted: usize },
    #[error("there is no study `{0}` in this program")]
    Study(String),
}

/// The program's version, as far as it can change results.
pub fn program() -> &'static str {
    env!("CARGO_PKG_VERSION")
}

impl Plan {
    /// Makes the plan of a sweep file. Data sets that ship are unpacked below `out`.
    ///
    /// # Errors
    /// What reading the file says, [`Error::Content`] where there is no instance.
    pub fn make(sweep: &Path, out: &Path, studies: &[Study]) -> Result<Self> {
        let definition = read(sweep, studies)?;
        let study = &studies[definition.study];
        let arms = arms(sweep, &definition, study)?;
        let instances = instances(sweep, out, study, &definition.data)?;
        let mut tasks = Vec::with_capacity(arms.len() * instances.len() * definition.seeds.len());
        for (a, arm) in arms.iter().enumerate() {
            let settings = Value::Object(arm.settings.clone()).to_string();
            for (i, instance) in instances.iter().enumerate() {
                let mut common = Sha256::new();
                for part in [
                    program(),
                    study.name,
                    &settings,
                    &instance.name,
                    &instance.digest,
                ] {
                    common.update((part.len() as u64).to_le_bytes());
                    common.update(part);
                }
                common.update([u8::from(definition.paired_seeds)]);
                for &seed in &definition.seeds {
                    let mut hash = common.clone();
                    hash.update(seed.to_le_bytes());
                    let key = provenance::hex(&hash.finalize()[..12]);
                    tasks.push(Task {
                        key,
                        arm: a,
                        instance: i,
                        seed,
                    });
                }
            }
        }
        let head = Head {
            format: "edifice/sweep-plan".into(),
            version: 1,
            program: program().into(),
            study: study.name.into(),
            sweep: provenance::digest(sweep)?,
            paired_seeds: definition.paired_seeds,
            report: definition.report.clone(),
            task: definition.task.clone(),
            arms,
            instances,
            tasks: tasks.len(),
        };
        Ok(Self { head, tasks })
    }

    /// Writes the plan into the sweep's folder.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn write(&self, out: &Path) -> Result<()> {
        let mut bytes = serde_json::to_vec(&self.head).map_err(Error::method)?;
        bytes.push(b'\n');
        for task in &self.tasks {
            serde_json::to_writer(&mut bytes, task).map_err(Error::method)?;
            writeln!(bytes).map_err(Error::method)?;
        }
        file::write_atomic(&out.join(PLAN), &bytes)
    }

    /// Reads the plan of a sweep's folder, of this version of the program.
    ///
    /// # Errors
    /// [`Error::Io`]; [`Error::Input`] or [`Error::Content`] where it is none, not whole, or of another version.
    pub fn read(out: &Path) -> Result<Self> {
        let path = out.join(PLAN);
        let text = std::fs::read_to_string(&path).map_err(|e| Error::io(&path, "read", e))?;
        let mut lines = text.lines();
        let head = lines.next().unwrap_or_default();
        let not = |e: serde_json::Error| Error::content(&path, PlanError::NotAPlan(e.to_string()));
        let head: Head = serde_json::from_str(head).map_err(not)?;
        if head.program != program() {
            let (made, ours) = (head.program.clone(), program().to_owned());
            return Err(Error::content(&path, PlanError::Program { made, ours }));
        }
        let mut tasks = Vec::new();
        for (number, line) in lines.enumerate() {
            let task: Task = serde_json::from_str(line)
                .map_err(|e| Error::input(&path, format!("line {}", number + 2), e))?;
            if task.arm >= head.arms.len() || task.instance >= head.instances.len() {
                let error =
                    PlanError::NotAPlan("a task names no arm or instance of the plan".into());
                return Err(Error::input(&path, format!("line {}", number + 2), error));
            }
            tasks.push(task);
        }
        if tasks.len() != head.tasks {
            let (found, wanted) = (tasks.len(), head.tasks);
            return Err(Error::content(&path, PlanError::Short { found, wanted }));
        }
        Ok(Self { head, tasks })
    }

    /// The plan of a sweep file in a folder: read where it is there, made where it is not.
    ///
    /// # Errors
    /// As [`Plan::make`] and [`Plan::read`]; [`Error::Content`] when the file has changed since.
    pub fn of(sweep: &Path, out: &Path, studies: &[Study]) -> Result<Self> {
        if !out.join(PLAN).exists() {
            let plan = Self::make(sweep, out, studies)?;
            plan.write(out)?;
            return Ok(plan);
        }
        let plan = Self::read(out)?;
        match plan.head.sweep == provenance::digest(sweep)? {
            true => Ok(plan),
            false => Err(Error::content(sweep, PlanError::Changed)),
        }
    }

    /// The plan's study.
    ///
    /// # Errors
    /// [`Error::Method`] when this program has none of its name.
    pub fn study<'s>(&self, studies: &'s [Study]) -> Result<&'s Study> {
        let study = studies.iter().find(|study| study.name == self.head.study);
        study.ok_or_else(|| Error::method(PlanError::Study(self.head.study.clone())))
    }

    /// Where the instance of a task is.
    pub fn path(&self, out: &Path, task: &Task) -> PathBuf {
        out.join(&self.head.instances[task.instance].path)
    }
}

/// The files that match the patterns, each once, by name.
fn instances(
    sweep: &Path,
    out: &Path,
    study: &Study,
    patterns: &[String],
) -> Result<Vec<Instance>> {
    let mut paths: Vec<(PathBuf, PathBuf)> = Vec::new();
    for pattern in patterns {
        let mut found = matching(sweep, pattern)?;
        let absolute = |path: PathBuf| std::path::absolute(&path).unwrap_or(path);
        let mut found: Vec<(PathBuf, PathBuf)> = found
            .drain(..)
            .map(|p| (absolute(p.clone()), absolute(p)))
            .collect();
        if found.is_empty() {
            let folder = datasets::unpack(study.data, &out.join(DATA))?;
            let below = folder.join(pattern);
            let inside = matching(sweep, &below.to_string_lossy())?;
            let relative = |p: &PathBuf| {
                p.strip_prefix(out)
                    .map(Path::to_path_buf)
                    .unwrap_or_else(|_| p.clone())
            };
            found = inside.into_iter().map(|p| (relative(&p), p)).collect();
        }
        if found.is_empty() {
            let error = PlanError::NoInstance(format!("datasets/{}", study.data));
            return Err(Error::input(sweep, format!("data = {pattern:?}"), error));
        }
        paths.extend(found);
    }
    let mut seen = HashSet::new();
    paths.retain(|(_, at)| seen.insert(at.clone()));
    let stem = |path: &Path| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.split('.').next().unwrap_or_default().to_owned()
    };
    let mut names: Vec<String> = paths.iter().map(|(_, at)| stem(at)).collect();
    let mut once = HashSet::new();
    if !names.iter().all(|name| once.insert(name.clone())) {
        names = paths
            .iter()
            .map(|(path, _)| path.to_string_lossy().replace('\\', "/"))
            .collect();
    }
    let mut instances = Vec::new();
    for (name, (path, at)) in names.into_iter().zip(paths) {
        let digest = provenance::digest(&at)?;
        instances.push(Instance { name, path, digest });
    }
    instances.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(instances)
}

/// Files that match a pattern, in order.
fn matching(sweep: &Path, pattern: &str) -> Result<Vec<PathBuf>> {
    let bad = |e: &dyn std::fmt::Display| {
        Error::input(
            sweep,
            format!("data = {pattern:?}"),
            PlanError::Pattern(e.to_string()),
        )
    };
    let mut files = Vec::new();
    for entry in glob::glob(pattern).map_err(|e| bad(&e))? {
        let path = entry.map_err(|e| bad(&e))?;
        if path.is_file() {
            files.push(path);
        }
    }
    Ok(files)
}
