//! A sweep as one file: what was asked, what was planned, what was found, and by which program; and a check of it.

use std::collections::HashSet;
use std::io::{Cursor, Read, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use zip::write::SimpleFileOptions;
use zip::{ZipArchive, ZipWriter};

use super::collect::{RESULTS, TIMES, collect};
use super::instances::belonging;
use super::journal::{Keep, read_all};
use super::plan::{Head, PLAN, Plan, Task};
use super::ro_crate::{File, METADATA, Published, metadata};
use super::run::entry;
use super::study::Study;
use edifice_base::{Error, Result, Watched, file, unwatched};
use edifice_frame::provenance::{self, Machine, hex};

/// The contents of a bundle.
#[derive(Debug, Serialize, Deserialize)]
struct Manifest {
    format: String,
    version: u32,
    program: String,
    machine: Machine,
    /// Name in the bundle and SHA-256 of each file.
    files: Vec<(String, String)>,
}

/// The faults of a bundle.
#[derive(Debug, thiserror::Error)]
enum BundleError {
    #[error("this is no bundle of a sweep: {0}")]
    NotABundle(String),
    #[error("`{0}` is not what the manifest says: the bundle was changed")]
    Changed(String),
    #[error("`{0}` leads out of the folder that it is unpacked to")]
    LeadsOut(String),
    #[error("`{0}` is not in the manifest")]
    Unlisted(String),
    #[error("its files are larger than {} GB", LARGEST >> 30)]
    TooLarge,
}

/// Most bytes that a bundle may unpack to.
const LARGEST: u64 = 8 << 30;

/// A bundle that was written.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Packed {
    /// Number of files.
    pub files: usize,
    /// SHA-256 of the bundle, by which a leaderboard names it.
    pub sha256: String,
}

/// The result of a check.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Verified {
    /// Tasks that were run again.
    pub rerun: usize,
    /// Tasks that found something else: arm, instance, seed.
    pub different: Vec<String>,
    /// Tasks of arms that are commands, which were not run.
    pub not_run: usize,
}

/// Packs a sweep's file, plan, results, times, instances and what was learnt from; with `published`, also metadata that make
/// it a Research Object Crate.
///
/// # Errors
/// [`Error::Io`].
pub fn bundle(
    plan: &Plan,
    sweep: &Path,
    out: &Path,
    to: &Path,
    published: Option<&Published>,
) -> Result<Packed> {
    collect(plan, out)?;
    let mut files: Vec<(String, PathBuf)> = vec![("sweep.toml".into(), sweep.to_path_buf())];
    for name in [PLAN, RESULTS, TIMES] {
        files.push((name.into(), out.join(name)));
    }
    for (folder, instances) in [
        ("instances", &plan.head.instances),
        ("learn", &plan.head.learn),
    ] {
        for (index, instance) in instances.iter().enumerate() {
            for path in belonging(&out.join(&instance.path))? {
                let name = path.file_name().unwrap_or_default().to_string_lossy();
                files.push((format!("{folder}/{index}/{name}"), path.clone()));
            }
        }
    }
    for (index, arm) in plan.head.arms.iter().enumerate() {
        for needed in arm.command.iter().flat_map(|command| &command.files) {
            let name = format!("files/{index}/{}", needed.name);
            files.push((name, needed.path.clone()));
        }
    }
    let (mut listed, mut sizes) = (Vec::new(), Vec::new());
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    // A fixed date: the same content is the same bytes.
    let options = SimpleFileOptions::default().last_modified_time(zip::DateTime::default());
    let fail =
        |e: &dyn std::fmt::Display| Error::content(to, BundleError::NotABundle(e.to_string()));
    for (name, path) in &files {
        let bytes = std::fs::read(path).map_err(|e| Error::io(path, "read", e))?;
        archive.start_file(name, options).map_err(|e| fail(&e))?;
        archive.write_all(&bytes).map_err(|e| fail(&e))?;
        listed.push((name.clone(), provenance::digest(path)?));
        sizes.push(bytes.len());
    }
    if let Some(published) = published {
        let files: Vec<File> = (listed.iter().zip(&sizes))
            .map(|((name, sha256), bytes)| File {
                name,
                sha256,
                bytes: *bytes,
            })
            .collect();
        let metadata = metadata(plan, &files, published);
        let text = serde_json::to_vec_pretty(&metadata).map_err(Error::method)?;
        archive
            .start_file(METADATA, options)
            .map_err(|e| fail(&e))?;
        archive.write_all(&text).map_err(|e| fail(&e))?;
        listed.push((METADATA.into(), hex(&Sha256::digest(&text))));
    }
    let packed = listed.len() + 1;
    let manifest = Manifest {
        format: "edifice/sweep-bundle".into(),
        version: 1,
        program: plan.head.program.clone(),
        machine: Machine::this(rayon::current_num_threads()),
        files: listed,
    };
    archive
        .start_file("manifest.json", options)
        .map_err(|e| fail(&e))?;
    let text = serde_json::to_vec_pretty(&manifest).map_err(Error::method)?;
    archive.write_all(&text).map_err(|e| fail(&e))?;
    let bytes = archive.finish().map_err(|e| fail(&e))?.into_inner();
    file::write_atomic(to, &bytes)?;
    Ok(Packed {
        files: packed,
        sha256: hex(&Sha256::digest(&bytes)),
    })
}

/// Unpacks a bundle into an empty folder, checks its digests, and runs `sample` of its finished tasks again, evenly spread.
/// Arms that are commands are run only with `commands`: a bundle from elsewhere may hold any program.
///
/// # Errors
/// [`Error::Content`] when it is no bundle, was changed, holds names that lead out of it, or is of other sources; [`Error::Io`].
pub fn verify(
    bundle: &Path,
    folder: &Path,
    studies: &[Study],
    sample: usize,
    commands: bool,
) -> Result<Verified> {
    let bytes = std::fs::read(bundle).map_err(|e| Error::io(bundle, "read", e))?;
    let not =
        |e: &dyn std::fmt::Display| Error::content(bundle, BundleError::NotABundle(e.to_string()));
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(|e| not(&e))?;
    let mut manifest = String::new();
    let mut entry_of = archive.by_name("manifest.json").map_err(|e| not(&e))?;
    entry_of
        .read_to_string(&mut manifest)
        .map_err(|e| not(&e))?;
    drop(entry_of);
    let manifest: Manifest = serde_json::from_str(&manifest).map_err(|e| not(&e))?;
    let listed: HashSet<&str> = manifest.files.iter().map(|(n, _)| n.as_str()).collect();
    let mut bytes = 0u64;
    for index in 0..archive.len() {
        let inside = archive.by_index(index).map_err(|e| not(&e))?;
        let name = inside.name().map_err(|e| not(&e))?.into_owned();
        let wrong = |error| Err(Error::content(bundle, error));
        if inside.enclosed_name().is_none() || name.split(['/', '\\']).any(|part| part == "..") {
            return wrong(BundleError::LeadsOut(name));
        }
        if name != "manifest.json" && !listed.contains(name.as_str()) {
            return wrong(BundleError::Unlisted(name));
        }
        bytes = bytes.saturating_add(inside.size());
        if bytes > LARGEST {
            return wrong(BundleError::TooLarge);
        }
    }
    for (name, digest) in &manifest.files {
        let mut inside = archive.by_name(name).map_err(|e| not(&e))?;
        let place = inside
            .enclosed_name()
            .ok_or_else(|| Error::content(bundle, BundleError::LeadsOut(name.clone())))?;
        let mut content = Vec::new();
        inside.read_to_end(&mut content).map_err(|e| not(&e))?;
        let path = folder.join(place);
        if let Some(parent) = path.parent() {
            std::fs::create_dir_all(parent).map_err(|e| Error::io(parent, "create", e))?;
        }
        file::write_atomic(&path, &content)?;
        if provenance::digest(&path)? != *digest {
            return Err(Error::content(bundle, BundleError::Changed(name.clone())));
        }
    }
    let mut plan = Plan::read(folder, studies)?;
    let Head {
        instances, learn, ..
    } = &mut plan.head;
    for (place, instances) in [("instances", instances), ("learn", learn)] {
        for (index, instance) in instances.iter_mut().enumerate() {
            let name = instance.path.file_name().unwrap_or_default().to_owned();
            instance.path = PathBuf::from(format!("{place}/{index}")).join(name);
        }
    }
    for (index, arm) in plan.head.arms.iter_mut().enumerate() {
        for needed in arm
            .command
            .iter_mut()
            .flat_map(|command| &mut command.files)
        {
            let place = folder.join(format!("files/{index}"));
            needed.path = place.join(Path::new(&needed.name).file_name().unwrap_or_default());
        }
    }
    rerun(&plan, folder, plan.study(studies)?, sample, commands)
}

/// Compares the results in the folder's table with those of a sample that is run again.
fn rerun(
    plan: &Plan,
    folder: &Path,
    study: &Study,
    sample: usize,
    commands: bool,
) -> Result<Verified> {
    let path = folder.join(RESULTS);
    let table = std::fs::read_to_string(&path).map_err(|e| Error::io(&path, "read", e))?;
    let again = folder.join("again");
    // A task without a result has nothing to compare with.
    let finished = finished(&table, &path)?;
    let has_result = |task: &&Task| {
        let arm = plan.head.arms[task.arm].name.clone();
        let instance = plan.head.instances[task.instance].name.clone();
        finished.contains(&(arm, instance, task.seed.to_string()))
    };
    let all: Vec<&Task> = plan.tasks.iter().filter(has_result).collect();
    let is_run = |task: &&Task| commands || plan.head.arms[task.arm].command.is_none();
    let tasks: Vec<&Task> = all.iter().copied().filter(is_run).collect();
    let chosen = sample.min(tasks.len());
    let mut different = Vec::new();
    let journal = super::journal::Journal::open(&again, (0, 1))?;
    for k in 0..chosen {
        let task = tasks[k * tasks.len() / chosen];
        if let Some(entry) = entry(plan, folder, study, task, &Watched::new(&unwatched)) {
            journal.put(&entry)?;
        }
    }
    let known = read_all(&again, &plan.head.program, Keep::Presence)?;
    let sampled = Plan {
        head: plan.head.clone(),
        tasks: plan
            .tasks
            .iter()
            .filter(|task| known.entries.contains_key(&task.key))
            .cloned()
            .collect(),
    };
    collect(&sampled, &again)?;
    let path = again.join(RESULTS);
    let found = std::fs::read_to_string(&path).map_err(|e| Error::io(&path, "read", e))?;
    let before: HashSet<&str> = table.lines().collect();
    different.extend(
        found
            .lines()
            .filter(|line| !before.contains(line))
            .map(str::to_owned),
    );
    Ok(Verified {
        rerun: sampled.tasks.len(),
        different,
        not_run: all.len() - tasks.len(),
    })
}

/// Arm, instance and seed of each task that has a result.
fn finished(table: &str, path: &Path) -> Result<HashSet<(String, String, String)>> {
    let mut finished = HashSet::new();
    for record in csv::Reader::from_reader(table.as_bytes()).records() {
        let record = record.map_err(|e| Error::content(path, e))?;
        let cell = |k: usize| record.get(k).unwrap_or_default().to_owned();
        if cell(4) != "failure" {
            finished.insert((cell(1), cell(2), cell(3)));
        }
    }
    Ok(finished)
}
