//! Results of tasks: one file per shard, one JSON line per task, appended in one write.
//!
//! A process that is killed, or a disk that is full, leaves half a line at most, which is cut off when the file is opened again; a line that
//! was damaged otherwise is left where it is and named, and its task counts as missing.

use std::collections::{BTreeMap, HashMap};
use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use serde::{Deserialize, Serialize};

use super::study::Outcome;
use edifice_base::{Error, Result};
use edifice_frame::lock;

/// Folder of the journals in a sweep's folder.
const FOLDER: &str = "journal";

/// The end of a task.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// The task's key.
    pub key: String,
    /// Digest of the sources of the study that ran it.
    pub program: String,
    /// Its outcome; `None` if it failed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outcome: Option<Outcome>,
    /// Why it failed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failure: Option<String>,
    /// Processor seconds.
    pub seconds: f64,
}

/// The journal of one shard, open for appending.
pub struct Journal {
    path: PathBuf,
    file: Mutex<File>,
}

/// A shard that another process runs.
#[derive(Debug, thiserror::Error)]
#[error("another process runs this shard")]
struct Busy;

impl Journal {
    /// Opens the journal of a shard, `i` of `n`; cuts off half a line at its end.
    ///
    /// # Errors
    /// [`Error::Content`] when another process runs the shard, [`Error::Io`].
    pub fn open(out: &Path, shard: (usize, usize)) -> Result<Self> {
        let folder = out.join(FOLDER);
        std::fs::create_dir_all(&folder).map_err(|e| Error::io(&folder, "create", e))?;
        let path = folder.join(format!("{}-of-{}.jsonl", shard.0, shard.1));
        let io = |e| Error::io(&path, "write", e);
        let mut file = OpenOptions::new()
            .create(true)
            .read(true)
            .append(true)
            .open(&path)
            .map_err(io)?;
        lock::exclusive(&file, &path).map_err(|_| Error::content(&path, Busy))?;
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes)
            .map_err(|e| Error::io(&path, "read", e))?;
        let whole = bytes
            .iter()
            .rposition(|b| *b == b'\n')
            .map_or(0, |at| at + 1);
        if whole < bytes.len() {
            file.set_len(whole as u64).map_err(io)?;
        }
        Ok(Self {
            path,
            file: Mutex::new(file),
        })
    }

    /// Appends an entry; where that fails, none of it stays.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn put(&self, entry: &Entry) -> Result<()> {
        let mut line = serde_json::to_vec(entry).map_err(Error::method)?;
        line.push(b'\n');
        let mut file = self.file.lock().unwrap_or_else(|e| e.into_inner());
        let io = |e| Error::io(&self.path, "write", e);
        let end = file.seek(SeekFrom::End(0)).map_err(io)?;
        file.write_all(&line).map_err(|e| {
            // What was written of the line must not stand before the next one.
            let cut = file.set_len(end);
            io(cut.err().unwrap_or(e))
        })
    }
}

/// A line of a journal that is none.
#[derive(Debug, Clone, PartialEq)]
pub struct Damaged {
    /// The journal.
    pub path: PathBuf,
    /// Its line, from 1.
    pub line: usize,
}

/// Everything that is known of a sweep's tasks, by key; of several entries of a task a success counts, of several such the first.
#[derive(Debug, Default)]
pub struct Known {
    /// Entries by key.
    pub entries: HashMap<String, Entry>,
    /// Lines that could not be read.
    pub damaged: Vec<Damaged>,
    /// Entries of other sources of the study, which do not count.
    pub foreign: usize,
}

/// The part of the outcomes that is kept in memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Keep {
    /// Only the presence of an outcome.
    Presence,
    /// Metrics and bounds.
    Metrics,
    /// All outcomes, with traces.
    All,
}

/// Reads all journals of a sweep's folder, whether or not they are being written. Entries of other sources than `program` do not count.
///
/// # Errors
/// [`Error::Io`].
pub fn read_all(out: &Path, program: &str, keep: Keep) -> Result<Known> {
    let folder = out.join(FOLDER);
    let mut known = Known::default();
    let listed = match std::fs::read_dir(&folder) {
        Ok(listed) => listed,
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Ok(known),
        Err(e) => return Err(Error::io(&folder, "read", e)),
    };
    let paths: std::io::Result<Vec<PathBuf>> =
        listed.map(|entry| entry.map(|e| e.path())).collect();
    let mut paths = paths.map_err(|e| Error::io(&folder, "read", e))?;
    paths.retain(|path| path.extension().is_some_and(|e| e == "jsonl"));
    paths.sort();
    for path in paths {
        known.read(&path, program, keep)?;
    }
    Ok(known)
}

impl Known {
    fn read(&mut self, path: &Path, program: &str, keep: Keep) -> Result<()> {
        let fail = |e| Error::io(path, "read", e);
        let mut reader = BufReader::new(File::open(path).map_err(fail)?);
        let mut line = Vec::new();
        for number in 1.. {
            line.clear();
            reader.read_until(b'\n', &mut line).map_err(fail)?;
            // The last line of a journal in use may be half written.
            if line.last() != Some(&b'\n') {
                break;
            }
            match serde_json::from_slice::<Entry>(&line) {
                Ok(entry) if entry.program != program => self.foreign += 1,
                Ok(mut entry) => {
                    if let Some(outcome) = entry.outcome.as_mut().filter(|_| keep != Keep::All) {
                        outcome.trace = Vec::new();
                        if keep == Keep::Presence {
                            outcome.metrics = BTreeMap::new();
                        }
                    }
                    self.add(entry);
                }
                Err(_) => self.damaged.push(Damaged {
                    path: path.to_path_buf(),
                    line: number,
                }),
            }
        }
        Ok(())
    }

    fn add(&mut self, entry: Entry) {
        match self.entries.get(&entry.key) {
            Some(before) if before.outcome.is_some() || entry.outcome.is_none() => {}
            _ => {
                self.entries.insert(entry.key.clone(), entry);
            }
        }
    }
}
