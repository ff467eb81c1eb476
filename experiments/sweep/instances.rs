//! The files that a sweep runs on.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::study::Study;
use edifice_base::{Error, Result};
use edifice_datasets as datasets;
use edifice_frame::provenance;

/// Folder of unpacked data sets in a sweep's folder.
const DATA: &str = "data";

/// A file that the study runs on, with those beside it that have its name up to the first dot: `one.facade.json` and
/// `one.grammar.json` belong together.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Instance {
    /// Its file name up to the first dot, with the folder where two have one name.
    pub name: String,
    /// Its path; relative paths are relative to the sweep's folder.
    pub path: PathBuf,
    /// SHA-256 of its bytes and of those of the files that belong to it.
    pub digest: String,
}

/// The faults of a pattern.
#[derive(Debug, thiserror::Error)]
enum InstanceError {
    #[error(
        "no file is called so, neither as a path nor below the study's folder of data sets ({0})"
    )]
    NoInstance(String),
    #[error("the pattern is not one: {0}")]
    Pattern(String),
}

/// The files that match the patterns, each once, by name. Data sets that ship are unpacked below `out`.
///
/// # Errors
/// [`Error::Input`] with the pattern that matches none, [`Error::Io`].
pub fn files(
    sweep: &Path,
    out: &Path,
    study: &Study,
    patterns: &[String],
) -> Result<Vec<Instance>> {
    // As it is written in the plan, and as it is found from here.
    let mut paths: BTreeMap<PathBuf, PathBuf> = BTreeMap::new();
    for pattern in patterns {
        let absolute = |path: PathBuf| std::path::absolute(&path).unwrap_or(path);
        let mut found: Vec<(PathBuf, PathBuf)> = matching(sweep, pattern)?
            .into_iter()
            .map(|p| (absolute(p.clone()), absolute(p)))
            .collect();
        if found.is_empty() {
            let folder = datasets::unpack(study.data, &out.join(DATA))?;
            let below = folder.join(pattern);
            let inside = matching(sweep, &below.to_string_lossy())?;
            let relative = |p: &PathBuf| {
                p.strip_prefix(out)
                    .map_or_else(|_| p.clone(), Path::to_path_buf)
            };
            found = inside.into_iter().map(|p| (relative(&p), p)).collect();
        }
        if found.is_empty() {
            let error = InstanceError::NoInstance(format!("datasets/{}", study.data));
            return Err(Error::input(sweep, format!("data = {pattern:?}"), error));
        }
        paths.extend(found.into_iter().map(|(path, at)| (at, path)));
    }
    let short: Vec<String> = paths.keys().map(|at| stem(at)).collect();
    let distinct = short.iter().collect::<BTreeSet<_>>().len() == short.len();
    let mut instances = Vec::with_capacity(paths.len());
    let mut neighbours = Neighbours::default();
    for ((at, path), short) in paths.into_iter().zip(short) {
        let name = match distinct {
            true => short,
            false => path.to_string_lossy().replace('\\', "/"),
        };
        let digest = neighbours.digest(&at)?;
        instances.push(Instance { name, path, digest });
    }
    instances.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(instances)
}

/// A file's name up to the first dot.
fn stem(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    name.split('.').next().unwrap_or_default().to_owned()
}

/// Files of folders by the stem of their names.
#[derive(Default)]
struct Neighbours(BTreeMap<PathBuf, BTreeMap<String, Vec<PathBuf>>>);

impl Neighbours {
    /// Files that belong to a file, itself included, in order of name.
    fn of(&mut self, path: &Path) -> Result<&[PathBuf]> {
        let folder = path.parent().unwrap_or(Path::new("")).to_path_buf();
        if !self.0.contains_key(&folder) {
            let fail = |e| Error::io(&folder, "read", e);
            let mut by_stem: BTreeMap<String, Vec<PathBuf>> = BTreeMap::new();
            for entry in std::fs::read_dir(&folder).map_err(fail)? {
                let path = entry.map_err(fail)?.path();
                if path.is_file() {
                    by_stem.entry(stem(&path)).or_default().push(path);
                }
            }
            by_stem.values_mut().for_each(|files| files.sort());
            self.0.insert(folder.clone(), by_stem);
        }
        let found = self.0.get(&folder).and_then(|f| f.get(&stem(path)));
        Ok(found.map_or(&[], Vec::as_slice))
    }

    fn digest(&mut self, path: &Path) -> Result<String> {
        let mut hash = Sha256::new();
        for file in self.of(path)? {
            hash.update(file.file_name().unwrap_or_default().as_encoded_bytes());
            hash.update([0]);
            hash.update(provenance::digest(file)?);
        }
        Ok(provenance::hex(&hash.finalize()))
    }
}

/// A file and those that belong to it, in order of name.
///
/// # Errors
/// [`Error::Io`].
pub fn belonging(path: &Path) -> Result<Vec<PathBuf>> {
    Ok(Neighbours::default().of(path)?.to_vec())
}

/// The first of some files that is not what it was.
///
/// # Errors
/// [`Error::Io`].
pub fn changed<'a>(
    files: impl Iterator<Item = &'a Instance>,
    out: &Path,
) -> Result<Option<PathBuf>> {
    let mut neighbours = Neighbours::default();
    for file in files {
        let path = out.join(&file.path);
        if !path.is_file() || neighbours.digest(&path)? != file.digest {
            return Ok(Some(path));
        }
    }
    Ok(None)
}

/// Files that match a pattern, in order.
fn matching(sweep: &Path, pattern: &str) -> Result<Vec<PathBuf>> {
    let bad = |e: &dyn std::fmt::Display| {
        let error = InstanceError::Pattern(e.to_string());
        Error::input(sweep, format!("data = {pattern:?}"), error)
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
