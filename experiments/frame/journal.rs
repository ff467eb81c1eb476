//! Finished units of work, kept so that a run that was stopped goes on where it was.
//!
//! One JSON object a line, `{"key": ..., "value": ...}`, appended in one write when a unit ends. A
//! kill can leave half a line at the end, which is cut off on the next start. The file's name
//! carries a hash of the settings, so that other settings find nothing to reuse. A journal is locked
//! while it is open: what one process cuts off could be what another one is writing.

use std::collections::HashMap;
use std::fs::{File, OpenOptions};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use serde::{Deserialize, Serialize};

use super::lock;
use edifice_base::{Error, Result};

#[derive(Serialize, Deserialize)]
struct Entry {
    key: String,
    value: serde_json::Value,
}

/// The finished units of one artefact, or of one command that can be resumed.
pub struct Journal {
    path: PathBuf,
    done: HashMap<String, serde_json::Value>,
    file: Mutex<File>,
}

impl Journal {
    /// Opens or starts the journal at `path`, whose folder is made when missing.
    ///
    /// # Errors
    /// [`Error::Content`] when another process has it open, [`Error::Io`] otherwise.
    pub fn open(path: &Path) -> Result<Self> {
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(|e| Error::io(folder, "create", e))?;
        }
        let mut file = OpenOptions::new()
            .create(true)
            .read(true)
            .append(true)
            .open(path)
            .map_err(|e| Error::io(path, "write", e))?;
        lock::exclusive(&file, path)?;
        let mut old = Vec::new();
        file.read_to_end(&mut old)
            .map_err(|e| Error::io(path, "read", e))?;
        let (done, whole) = entries(&old);
        if whole < old.len() {
            // In place: the file that is locked is the one that is appended to.
            file.set_len(whole as u64)
                .map_err(|e| Error::io(path, "write", e))?;
        }
        Ok(Self {
            path: path.to_path_buf(),
            done,
            file: Mutex::new(file),
        })
    }

    /// The stored result of a unit; `None` when there is none of this shape.
    pub fn get<R: serde::de::DeserializeOwned>(&self, key: &str) -> Option<R> {
        R::deserialize(self.done.get(key)?).ok()
    }

    /// Stores the result of a unit.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn put<R: Serialize>(&self, key: &str, value: &R) -> Result<()> {
        let entry = Entry {
            key: key.to_string(),
            value: serde_json::to_value(value).map_err(Error::method)?,
        };
        let mut line = serde_json::to_vec(&entry).map_err(Error::method)?;
        line.push(b'\n');
        let mut file = self.file.lock().unwrap_or_else(|e| e.into_inner());
        file.write_all(&line)
            .map_err(|e| Error::io(&self.path, "write", e))
    }
}

/// The whole lines of a journal, and how many bytes they take.
fn entries(bytes: &[u8]) -> (HashMap<String, serde_json::Value>, usize) {
    let mut done = HashMap::new();
    let mut whole = 0;
    for line in bytes.split_inclusive(|&b| b == b'\n') {
        if line.last() != Some(&b'\n') {
            break;
        }
        let Ok(entry) = serde_json::from_slice::<Entry>(line) else {
            break;
        };
        done.insert(entry.key, entry.value);
        whole += line.len();
    }
    (done, whole)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_a_line_is_dropped_and_the_rest_kept() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("work/a.jsonl");
        let journal = Journal::open(&path).unwrap();
        journal.put("one", &1.5).unwrap();
        journal.put("two", &(0.1 + 0.2)).unwrap();
        drop(journal);
        let mut bytes = std::fs::read(&path).unwrap();
        bytes.extend_from_slice(b"{\"key\":\"three\",\"val");
        std::fs::write(&path, &bytes).unwrap();

        let journal = Journal::open(&path).unwrap();
        assert_eq!(journal.get::<f64>("one"), Some(1.5));
        assert_eq!(journal.get::<f64>("two"), Some(0.1 + 0.2));
        assert_eq!(journal.get::<f64>("three"), None);
        journal.put("three", &3.0).unwrap();
        drop(journal);
        let journal = Journal::open(&path).unwrap();
        assert_eq!(journal.get::<f64>("three"), Some(3.0));
    }
    #[test]
    fn a_journal_in_use_is_not_opened_again_and_loses_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.jsonl");
        std::fs::write(&path, b"{\"key\":\"zero\",\"value\":0.5}\n{\"key\":\"ha").unwrap();
        let journal = Journal::open(&path).unwrap();
        let message = Journal::open(&path).err().unwrap().to_string();
        assert!(message.contains("another run"), "{message}");
        journal.put("one", &1.5).unwrap();
        drop(journal);
        let journal = Journal::open(&path).unwrap();
        assert_eq!(journal.get::<f64>("zero"), Some(0.5));
        assert_eq!(journal.get::<f64>("one"), Some(1.5));
    }
    #[test]
    fn damaged_journals_are_read_as_far_as_they_are_whole() {
        let line = |k: usize| format!("{{\"key\":\"u{k}\",\"value\":{k}}}\n");
        let whole: String = (0..4).map(line).collect();
        for length in 0..=whole.len() {
            let (done, kept) = entries(&whole.as_bytes()[..length]);
            assert!(kept <= length && done.len() == kept / line(0).len());
        }
        for at in 0..whole.len() {
            for byte in [0, b'9', b'"', b'{', b'\n', 0xff] {
                let mut bytes = whole.clone().into_bytes();
                bytes[at] = byte;
                let (done, kept) = entries(&bytes);
                assert!(done.len() >= at / line(0).len() && kept <= bytes.len());
            }
        }
    }
}
