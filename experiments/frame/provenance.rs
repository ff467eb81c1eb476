//! The provenance of a result: `run.json`, which is the same wherever it is made again, and `provenance.json`, which is not.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use edifice_base::{Error, Result};

/// Name of the file of what is the same wherever it is made again.
pub const RUN: &str = "run.json";

/// Name of the file of what differs from one run to the next.
const PROVENANCE: &str = "provenance.json";

/// Provenance of the artefacts of one paper, `OUT/<paper>/run.json` and `provenance.json`.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Run {
    /// Slug of the paper.
    pub experiment: String,
    /// Authors, year and title.
    pub paper: String,
    /// Name of each artefact and how it was made last.
    pub artefacts: BTreeMap<String, Made>,
    /// Names of the artefacts in the order of the report.
    pub order: Vec<String>,
}

/// The way in which an artefact was made. Commit, sources, time and machine stand in `provenance.json`; a `run.json` of before, which has them
/// itself, is read too.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Made {
    /// Its subject.
    pub title: String,
    /// The command that makes it again; `DATA` stands for the folder of the real data.
    pub command: String,
    /// The seed.
    pub seed: u64,
    /// `smoke`, `default` or `paper`.
    pub budget: String,
    /// Every setting.
    pub settings: BTreeMap<String, serde_json::Value>,
    /// SHA-256 of each data file or folder read.
    pub data: BTreeMap<String, String>,
    /// Version of the crate.
    pub version: String,
    /// The commit that the program was built from; `None` without version control.
    #[serde(default, skip_serializing)]
    pub commit: Option<String>,
    /// True if files of the sources differed from that commit.
    #[serde(default, skip_serializing)]
    pub dirty: Option<bool>,
    /// Digest of the sources that it depends on ([`Sources::of_paper`](super::Sources::of_paper)); empty where none was recorded.
    #[serde(default, skip_serializing)]
    pub sources: String,
    /// Seconds from start to end, units taken from the journal not counted.
    #[serde(default, skip_serializing)]
    pub wall_seconds: f64,
    /// The machine: cores, threads used, system.
    #[serde(default, skip_serializing)]
    pub machine: Machine,
    /// Files written, relative to the paper's folder.
    pub files: Vec<String>,
    /// Quantities beside what the paper printed.
    pub comparisons: Vec<Comparison>,
    /// Why nothing was made, when nothing was.
    pub skipped: Option<String>,
}

/// Builds and machines of the artefacts of one paper, `provenance.json`.
#[derive(Debug, Serialize, Deserialize)]
struct Provenance {
    format: String,
    version: u32,
    artefacts: BTreeMap<String, Build>,
}

/// The build and the machine that made an artefact.
#[derive(Debug, Serialize, Deserialize)]
struct Build {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    commit: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    dirty: Option<bool>,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    sources: String,
    wall_seconds: f64,
    machine: Machine,
}

/// A machine, as far as it matters for times.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Machine {
    /// Logical cores.
    pub cores: usize,
    /// Threads that ran units.
    pub threads: usize,
    /// Operating system and processor family.
    pub system: String,
    /// True if the build is optimized.
    pub optimized: bool,
}

impl Machine {
    /// This machine.
    pub fn this(threads: usize) -> Self {
        Self {
            cores: std::thread::available_parallelism().map_or(1, usize::from),
            threads,
            system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            optimized: !cfg!(debug_assertions),
        }
    }
}

/// A quantity, what the paper printed, what this run found.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Comparison {
    /// Name of the quantity.
    pub quantity: String,
    /// The paper's number as printed.
    pub printed: String,
    /// The number that this run found.
    pub ours: String,
}

impl Run {
    /// Reads what a folder holds; missing files, or those of another version, are an empty run.
    pub fn read(folder: &Path) -> Self {
        let mut run: Self = read(&folder.join(RUN)).unwrap_or_default();
        if let Some(provenance) = read::<Provenance>(&folder.join(PROVENANCE)) {
            for (name, build) in provenance.artefacts {
                if let Some(made) = run.artefacts.get_mut(&name) {
                    (made.commit, made.dirty) = (build.commit, build.dirty);
                    if !build.sources.is_empty() {
                        made.sources = build.sources;
                    }
                    (made.wall_seconds, made.machine) = (build.wall_seconds, build.machine);
                }
            }
        }
        run
    }

    /// Writes both files.
    pub fn write(&self, folder: &Path) -> Result<()> {
        let build = |made: &Made| Build {
            commit: made.commit.clone(),
            dirty: made.dirty,
            sources: made.sources.clone(),
            wall_seconds: made.wall_seconds,
            machine: made.machine.clone(),
        };
        let artefacts = self.artefacts.iter();
        let provenance = Provenance {
            format: "edifice/provenance".to_owned(),
            version: 1,
            artefacts: artefacts
                .map(|(n, made)| (n.clone(), build(made)))
                .collect(),
        };
        write(&folder.join(PROVENANCE), &provenance)?;
        write(&folder.join(RUN), self)
    }
}

fn read<T: serde::de::DeserializeOwned>(path: &Path) -> Option<T> {
    let bytes = std::fs::read(path).ok()?;
    serde_json::from_slice(&bytes).ok()
}

fn write(path: &Path, value: &impl Serialize) -> Result<()> {
    let mut bytes = serde_json::to_vec_pretty(value).map_err(Error::method)?;
    bytes.push(b'\n');
    edifice_base::file::write_atomic(path, &bytes)
}

/// SHA-256 of a file, or of the names and contents of all files below a folder, in order of name.
pub fn digest(path: &Path) -> Result<String> {
    let mut hash = Sha256::new();
    add(&mut hash, path, path)?;
    Ok(hex(&hash.finalize()))
}

/// Lower-case hexadecimal.
pub fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|b| format!("{b:02x}")).collect()
}

fn add(hash: &mut Sha256, root: &Path, path: &Path) -> Result<()> {
    let fail = |e| Error::io(path, "read", e);
    if path.is_dir() {
        let entries: std::io::Result<Vec<_>> = std::fs::read_dir(path)
            .map_err(fail)?
            .map(|entry| entry.map(|e| e.path()))
            .collect();
        let mut entries = entries.map_err(fail)?;
        entries.sort();
        return entries.iter().try_for_each(|entry| add(hash, root, entry));
    }
    if path != root {
        let name = path.strip_prefix(root).unwrap_or(path);
        hash.update(name.to_string_lossy().as_bytes());
        hash.update([0]);
    }
    hash.update(std::fs::read(path).map_err(fail)?);
    Ok(())
}
