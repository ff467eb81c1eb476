//! The plan: every task of a sweep, keyed by its content.

use std::io::Write;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::Value;
use sha2::{Digest, Sha256};

use super::command::Command;
use super::definition::{Arm, Definition, ReportOptions, TaskOptions, arms, read};
use super::instances::{Instance, files};
use super::study::{Better, Study};
use edifice_base::{Error, Result, file};
use edifice_frame::lock::Lock;
use edifice_frame::provenance;

/// Name of the plan in a sweep's folder.
pub const PLAN: &str = "plan.jsonl";

/// One run of one arm on one instance with one seed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Task {
    /// Hash of study, settings, command, instance, what is learnt from, seed and sources of the study.
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
    /// Digest of the sources of the study when the plan was made.
    pub program: String,
    /// Name of the study.
    pub study: String,
    /// SHA-256 of the sweep file.
    pub sweep: String,
    /// True if all arms meet the same chance on an instance and seed.
    pub paired_seeds: bool,
    /// The options of the report.
    pub report: ReportOptions,
    /// The needs of a task.
    pub task: TaskOptions,
    /// Arms.
    pub arms: Vec<Arm>,
    /// Instances.
    pub instances: Vec<Instance>,
    /// Files that are learnt from; none where the study does not learn, or learns from the other instances.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub learn: Vec<Instance>,
    /// The first metric and the values of it that are better, which bounds are about.
    #[serde(default)]
    pub first: Option<(String, Better)>,
    /// Names of the settings that make the question, as far as the study tells them from those of its methods.
    #[serde(default)]
    pub question: Option<Vec<String>>,
    /// Number of tasks.
    pub tasks: usize,
}

/// All tasks of a sweep, in the order of its results: arm by arm, instance by instance, seed by seed.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// The part that all tasks have in common.
    pub head: Head,
    /// The tasks.
    pub tasks: Vec<Task>,
}

/// The faults of a plan.
#[derive(Debug, thiserror::Error)]
enum PlanError {
    #[error(
        "the study learns from other files than the instance: name several instances, or files by `learn`"
    )]
    NothingToLearn,
    #[error("this is no plan of a sweep: {0}")]
    NotAPlan(String),
    #[error(
        "the plan was made with other sources of its study ({made}, these are {ours}); make it anew with `edifice sweep plan`"
    )]
    Program { made: String, ours: String },
    #[error(
        "the sweep file has changed since the plan was made; run `edifice sweep plan`, which keeps the results of tasks that are still wanted"
    )]
    Changed,
    #[error("there is no plan here; run `edifice sweep plan` or `edifice sweep run`")]
    NoPlan,
    #[error("it ends after {found} of {wanted} tasks")]
    Short { found: usize, wanted: usize },
    #[error("there is no study `{0}` in this program")]
    Study(String),
}

impl Plan {
    /// Makes the plan of a sweep file. Data sets that ship are unpacked below `out`, which is made where it is not there; another process that does
    /// the same is waited for. What is refused leaves no folder behind.
    ///
    /// # Errors
    /// Those of reading the file; [`Error::Content`] if there is no instance.
    pub fn make(sweep: &Path, out: &Path, studies: &[Study]) -> Result<Self> {
        let definition = read(sweep, studies)?;
        let study = &studies[definition.study];
        let arms = arms(sweep, &definition, study)?;
        let fresh = !out.exists();
        std::fs::create_dir_all(out).map_err(|e| Error::io(out, "create", e))?;
        let lock = Lock::wait(out)?;
        let planned = Self::planned(sweep, out, study, &definition, arms);
        drop(lock);
        if fresh && planned.is_err() {
            // The reason of the refusal is what counts, not what could not be removed.
            let _ = std::fs::remove_dir_all(out);
        }
        planned
    }

    /// The plan of a sweep whose arms are known.
    fn planned(
        sweep: &Path,
        out: &Path,
        study: &Study,
        definition: &Definition,
        arms: Vec<Arm>,
    ) -> Result<Self> {
        let instances = files(sweep, out, study, &definition.data)?;
        let mut learn = files(sweep, out, study, &definition.learn)?;
        learn.retain(|file| instances.iter().all(|instance| instance.path != file.path));
        if study.learns && learn.is_empty() && instances.len() < 2 {
            return Err(Error::content(sweep, PlanError::NothingToLearn));
        }
        let database = match study.learns {
            true => learnt_from(if learn.is_empty() { &instances } else { &learn }),
            false => String::new(),
        };
        let mut tasks = Vec::with_capacity(arms.len() * instances.len() * definition.seeds.len());
        for (a, arm) in arms.iter().enumerate() {
            let settings = Value::Object(arm.settings.clone()).to_string();
            let command = arm
                .command
                .as_ref()
                .map_or_else(String::new, Command::identity);
            for (i, instance) in instances.iter().enumerate() {
                let mut common = Sha256::new();
                for part in [
                    study.sources(),
                    study.name,
                    &settings,
                    &command,
                    &instance.name,
                    &instance.digest,
                    &database,
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
            program: study.sources().into(),
            study: study.name.into(),
            sweep: provenance::digest(sweep)?,
            paired_seeds: definition.paired_seeds,
            report: definition.report.clone(),
            task: definition.task.clone(),
            arms,
            instances,
            learn,
            first: (study.metrics.first()).map(|(name, better)| ((*name).to_owned(), *better)),
            question: (!study.asks.is_empty())
                .then(|| study.asks.iter().map(|name| (*name).to_owned()).collect()),
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

    /// Reads the plan of a sweep's folder, of the study's sources as they are.
    ///
    /// # Errors
    /// [`Error::Io`]; [`Error::Input`] or [`Error::Content`] where it is none, not whole, or of other sources.
    pub fn read(out: &Path, studies: &[Study]) -> Result<Self> {
        let path = out.join(PLAN);
        let text = std::fs::read_to_string(&path).map_err(|e| match e.kind() {
            std::io::ErrorKind::NotFound => Error::content(out, PlanError::NoPlan),
            _ => Error::io(&path, "read", e),
        })?;
        let mut lines = text.lines();
        let head = lines.next().unwrap_or_default();
        let not = |e: serde_json::Error| Error::content(&path, PlanError::NotAPlan(e.to_string()));
        let head: Head = serde_json::from_str(head).map_err(not)?;
        let study = studies.iter().find(|study| study.name == head.study);
        let study = study.ok_or_else(|| Error::method(PlanError::Study(head.study.clone())))?;
        if head.program != study.sources() {
            let (made, ours) = (head.program.clone(), study.sources().to_owned());
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
        Self::current(sweep, out, studies)
    }

    /// The plan in a folder, which is that of the sweep file as it stands.
    ///
    /// # Errors
    /// As [`Plan::read`]; [`Error::Content`] when the file has changed since.
    pub fn current(sweep: &Path, out: &Path, studies: &[Study]) -> Result<Self> {
        let plan = Self::read(out, studies)?;
        match plan.head.sweep == provenance::digest(sweep)? {
            true => Ok(plan),
            false => Err(Error::content(sweep, PlanError::Changed)),
        }
    }

    /// A short hash of all tasks.
    pub fn digest(&self) -> String {
        let mut hash = Sha256::new();
        self.tasks.iter().for_each(|task| hash.update(&task.key));
        provenance::hex(&hash.finalize()[..6])
    }

    /// The plan's study.
    ///
    /// # Errors
    /// [`Error::Method`] when this program has none of its name.
    pub fn study<'s>(&self, studies: &'s [Study]) -> Result<&'s Study> {
        let study = studies.iter().find(|study| study.name == self.head.study);
        study.ok_or_else(|| Error::method(PlanError::Study(self.head.study.clone())))
    }

    /// The path of a task's instance.
    pub fn path(&self, out: &Path, task: &Task) -> PathBuf {
        out.join(&self.head.instances[task.instance].path)
    }

    /// The paths of the files that a task may learn from, if its study learns.
    pub fn database(&self, out: &Path, task: &Task) -> Vec<PathBuf> {
        let head = &self.head;
        let place = |file: &Instance| out.join(&file.path);
        if !head.learn.is_empty() {
            return head.learn.iter().map(place).collect();
        }
        let others = head.instances.iter().enumerate();
        others
            .filter(|(index, _)| *index != task.instance)
            .map(|(_, file)| place(file))
            .collect()
    }
}

/// Names and digests of files that are learnt from, as one text.
fn learnt_from(files: &[Instance]) -> String {
    let lines = files.iter().map(|f| format!("{} {}\n", f.name, f.digest));
    lines.collect()
}
