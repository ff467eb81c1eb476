//! The journal of a document: all that was done to it, on disk before it is answered (`edifice/studio-journal` in `FORMATS.md`).
//!
//! A document that is edited gets a file in the folder of the studio's state: a first line that says what it began from, then a
//! line for every edit, undo, redo and save. Each line is one write, so that a program that is killed leaves whole lines and at
//! most a part of the last one. The file goes when the document is closed, and at the end of a studio that has nothing unsaved.
//! What is left is offered at the next start ([`super::recovery`]).

use std::fs::File;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::private;
use edifice_base::{Error, Result};

/// Ending of the names of journals.
pub(crate) const ENDING: &str = ".journal.jsonl";
/// Ending of the copies of the files that documents began from.
const START: &str = ".start";
const FORMAT: &str = "edifice/studio-journal";
const VERSION: u32 = 1;
/// Largest file of which a copy is kept, in bytes.
const MOST_KEPT: usize = 16 << 20;

/// The first line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Head {
    format: String,
    version: u32,
    /// Kind of document.
    pub kind: String,
    /// Name of the document.
    pub name: String,
    /// Folder that it is saved in.
    pub folder: PathBuf,
    /// Name of the file that it is saved as.
    pub file: String,
    /// The origin of the document.
    pub start: Start,
}

/// The origin of a document.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Start {
    /// An example by its id.
    Example(String),
    /// A file.
    File {
        /// Its path.
        path: PathBuf,
        /// Its length in bytes and the seconds since 1970 of its last change.
        state: (u64, f64),
        /// True if a copy of it stands beside the journal.
        kept: bool,
    },
}

/// The content of a further line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum JournalEntry {
    /// Commands that were done at once.
    Did(Vec<Value>),
    /// An edit was taken back.
    Undo,
    /// An edit was done again.
    Redo,
    /// The document was saved.
    Saved,
}

/// The origin of a document, with the content of its file.
#[derive(Debug, Clone)]
pub(crate) enum Source {
    /// An example by its id.
    Example(String),
    /// A file, and what was read of it.
    File(PathBuf, Vec<u8>),
}

/// A journal that is written.
pub(crate) struct Journal {
    path: PathBuf,
    file: File,
}

/// A journal that was read.
pub(crate) struct Found {
    /// The journal, to go on with.
    pub journal: Journal,
    /// Its first line.
    pub head: Head,
    /// The other lines.
    pub lines: Vec<JournalEntry>,
    /// The last change of the journal.
    pub changed: Option<SystemTime>,
}

/// Length and time of change of a file, as [`Start::File`] remembers them.
pub(crate) fn state_of(path: &Path) -> Result<(u64, f64)> {
    let meta = std::fs::metadata(path).map_err(|e| Error::io(path, "read", e))?;
    let changed = meta.modified().ok();
    let since = changed.and_then(|t| t.duration_since(SystemTime::UNIX_EPOCH).ok());
    Ok((meta.len(), since.map_or(0.0, |d| d.as_secs_f64())))
}

impl Journal {
    /// Begins a journal in a folder.
    ///
    /// # Errors
    /// When it cannot be written for this user alone.
    pub(crate) fn begin(
        folder: &Path,
        source: &Source,
        kind: &str,
        name: &str,
        place: (&Path, &str),
    ) -> Result<Self> {
        private::make_folder(folder).map_err(|e| Error::io(folder, "create", e))?;
        let path = folder.join(format!("{}{ENDING}", private::random_name(8)?));
        let file = private::make_file(&path).map_err(|e| Error::io(&path, "create", e))?;
        let mut journal = Self { path, file };
        match journal.first(source, kind, name, place) {
            Ok(()) => Ok(journal),
            Err(error) => {
                journal.remove();
                Err(error)
            }
        }
    }

    fn first(
        &mut self,
        source: &Source,
        kind: &str,
        name: &str,
        (folder, file): (&Path, &str),
    ) -> Result<()> {
        let start = match source {
            Source::Example(id) => Start::Example(id.clone()),
            Source::File(path, bytes) => {
                let kept = bytes.len() <= MOST_KEPT;
                if kept {
                    let copy = self.copy();
                    let fail = |e| Error::io(&copy, "write", e);
                    let mut file = private::make_file(&copy).map_err(fail)?;
                    file.write_all(bytes).map_err(fail)?;
                }
                Start::File {
                    path: path.clone(),
                    state: state_of(path).unwrap_or_default(),
                    kept,
                }
            }
        };
        self.line(&Head {
            format: FORMAT.into(),
            version: VERSION,
            kind: kind.into(),
            name: name.into(),
            folder: folder.to_path_buf(),
            file: file.into(),
            start,
        })
    }

    /// Adds a line.
    ///
    /// # Errors
    /// When it cannot be written.
    pub(crate) fn add(&mut self, line: &JournalEntry) -> Result<()> {
        self.line(line)
    }

    fn line(&mut self, value: &impl Serialize) -> Result<()> {
        let mut text = serde_json::to_string(value).map_err(Error::method)?;
        text.push('\n');
        let written = self.file.write_all(text.as_bytes());
        written.map_err(|e| Error::io(&self.path, "write", e))
    }

    /// Place of the copy of the file that the document began from.
    pub(crate) fn copy(&self) -> PathBuf {
        let name = self.path.file_name().unwrap_or_default().to_string_lossy();
        let stem = name.strip_suffix(ENDING).unwrap_or(&name);
        self.path.with_file_name(format!("{stem}{START}"))
    }

    /// The folder that it is in.
    pub(crate) fn folder(&self) -> PathBuf {
        self.path.parent().unwrap_or(Path::new("")).to_path_buf()
    }

    /// Its name, by which it is asked for.
    pub(crate) fn id(&self) -> String {
        let name = self.path.file_name().unwrap_or_default().to_string_lossy();
        name.strip_suffix(ENDING).unwrap_or(&name).to_owned()
    }

    /// Removes it with what it kept.
    pub(crate) fn remove(self) {
        // What cannot be removed is offered once more.
        let _ = std::fs::remove_file(self.copy());
        let _ = std::fs::remove_file(&self.path);
    }

    /// Takes up a journal that no running studio holds; `None` if one does, if it cannot be read, or if it is of a later
    /// version. What stands behind the last whole line is cut off.
    pub(crate) fn take(path: &Path) -> Option<Found> {
        let mut file = private::take_file(path)?;
        let mut text = Vec::new();
        file.read_to_end(&mut text).ok()?;
        let whole = text
            .iter()
            .rposition(|b| *b == b'\n')
            .map_or(0, |at| at + 1);
        let changed = file.metadata().and_then(|m| m.modified()).ok();
        let mut lines = text[..whole].split_inclusive(|b| *b == b'\n');
        let head = lines.next().map(serde_json::from_slice::<Head>);
        let journal = Self {
            path: path.to_path_buf(),
            file,
        };
        let Some(head) = head else {
            // Killed before its first line was whole: nothing was done.
            journal.remove();
            return None;
        };
        let head = head.ok()?;
        if head.format != FORMAT || head.version != VERSION {
            return None;
        }
        let lines: std::result::Result<Vec<JournalEntry>, _> =
            lines.map(serde_json::from_slice).collect();
        let lines = lines.ok()?;
        if whole < text.len() {
            journal.file.set_len(whole as u64).ok()?;
        }
        Some(Found {
            journal,
            head,
            lines,
            changed,
        })
    }
}

impl Found {
    /// True if there is something in it that was not saved.
    pub(crate) fn has_unsaved(&self) -> bool {
        self.lines.last().is_some_and(|l| *l != JournalEntry::Saved)
    }

    /// Number of edits.
    pub(crate) fn edits(&self) -> usize {
        let did = |l: &&JournalEntry| matches!(l, JournalEntry::Did(_));
        self.lines.iter().filter(did).count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn begun(folder: &Path) -> Journal {
        let source = Source::Example("four".into());
        Journal::begin(folder, &source, "completion", "four", (folder, "f.json")).unwrap()
    }

    #[test]
    fn half_a_line_at_the_end_is_dropped() {
        let folder = tempfile::tempdir().unwrap();
        let mut journal = begun(folder.path());
        let lines = [
            JournalEntry::Did(vec![json!({"do": "edit"})]),
            JournalEntry::Undo,
            JournalEntry::Redo,
        ];
        for line in &lines {
            journal.add(line).unwrap();
        }
        journal.file.write_all(b"{\"did\":[{\"d").unwrap();
        let path = journal.path.clone();
        // A running studio keeps its journal.
        assert!(Journal::take(&path).is_none());
        drop(journal);
        for _ in 0..2 {
            let found = Journal::take(&path).unwrap();
            assert_eq!(found.lines, lines);
            assert!(found.has_unsaved());
            assert_eq!(found.edits(), 1);
        }
    }

    #[test]
    fn what_was_saved_is_not_offered() {
        let folder = tempfile::tempdir().unwrap();
        let mut journal = begun(folder.path());
        journal.add(&JournalEntry::Did(Vec::new())).unwrap();
        journal.add(&JournalEntry::Saved).unwrap();
        let path = journal.path.clone();
        drop(journal);
        assert!(!Journal::take(&path).unwrap().has_unsaved());
    }
}
