//! A document with the file that it came from.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde_json::{Value, json};

use super::jobs::Job;
use edifice_base::file::write_atomic;
use edifice_base::{Error, Result};
use edifice_editing as editing;
use edifice_editing::history::{Document, steps};
use edifice_editing::work::Work;
use edifice_editing::{State, Step};
use edifice_io as io;

/// An open document.
pub struct Open {
    /// Its history.
    pub document: Document,
    /// Folder that it is saved in.
    folder: PathBuf,
    /// Name of the file it is saved as.
    file: String,
    /// The content of the file when it was read or written last; `None` before it is saved.
    known: Option<Vec<u8>>,
    saved_at: u64,
    milliseconds: f64,
    /// The work that is done on it.
    pub job: Option<Arc<Job>>,
}

/// Why a document is not saved.
#[derive(Debug, thiserror::Error)]
pub enum SaveError {
    /// The studio may not write.
    #[error("the studio was started with --read-only")]
    ReadOnly,
    /// A file is there that is not this document's.
    #[error(
        "{0} exists and was changed by another program, or is another file; save again to replace it"
    )]
    Changed(String),
    /// A link is there.
    #[error(
        "{0} is a link to another place: nothing is written through it; remove the link, or open the file that it leads to"
    )]
    Link(String),
    /// The file cannot be written.
    #[error(transparent)]
    File(#[from] Error),
}

impl Open {
    /// Opens a file. One that is named by a link is the file that it leads to.
    ///
    /// # Errors
    /// When it cannot be read, or no editor knows it.
    pub fn file(path: &Path) -> Result<Self> {
        let bytes = io::read_bytes(path)?;
        let start = editing::open(path, &bytes, &Work::default())?;
        let real = std::fs::canonicalize(path).map_err(|e| Error::io(path, "read", e))?;
        Ok(Self::new(start, Some(&real)))
    }

    /// A document; it is saved beside its file, or in the present folder.
    pub fn new(start: Arc<dyn State>, path: Option<&Path>) -> Self {
        let folder = path.and_then(Path::parent).map(Path::to_path_buf);
        let own = path.and_then(|p| p.file_name()?.to_str());
        // What was read from another format is saved beside it, under a name of its own.
        let own = own.filter(|name| name.ends_with(start.ending()));
        let file = own.map_or_else(|| file_name(start.as_ref()), str::to_owned);
        let known = own.and(path).and_then(|p| std::fs::read(p).ok());
        // The present folder, as it is now: a link put in its place later leads nowhere.
        let present = || std::env::current_dir().and_then(std::fs::canonicalize);
        Self {
            document: Document::new(start),
            folder: folder.unwrap_or_else(|| present().unwrap_or_default()),
            file,
            known,
            saved_at: 0,
            milliseconds: 0.0,
            job: None,
        }
    }

    /// Does commands.
    ///
    /// # Errors
    /// As [`steps`].
    pub fn edit(&mut self, commands: &[Value]) -> Result<()> {
        let start = std::time::Instant::now();
        let steps = steps(self.document.state(), commands, &Work::default())?;
        self.take(commands, steps, start.elapsed().as_secs_f64() * 1e3);
        Ok(())
    }

    /// Takes the results of commands, and the milliseconds that they took.
    pub fn take(&mut self, commands: &[Value], steps: Vec<Step>, milliseconds: f64) {
        self.document.take(commands, steps);
        self.milliseconds = milliseconds;
    }

    /// Writes the file and the script beside it; their names.
    ///
    /// # Errors
    /// [`SaveError`].
    pub fn save(&mut self, overwrite: bool) -> Result<[String; 2], SaveError> {
        let script = format!("{}.sh", self.stem());
        let (path, beside) = (self.folder.join(&self.file), self.folder.join(&script));
        for place in [&path, &beside] {
            own_place(&self.folder, place)?;
        }
        let there = match std::fs::read(&path) {
            Ok(bytes) => Some(bytes),
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => None,
            Err(e) => return Err(Error::io(&path, "read", e).into()),
        };
        if !overwrite && there.is_some() && there != self.known {
            return Err(SaveError::Changed(self.file.clone()));
        }
        let bytes = self.document.state().bytes()?;
        let text = self.document.script()?;
        // The script first: whoever has the document has what made it.
        write_atomic(&beside, text.as_bytes())?;
        write_atomic(&path, &bytes)?;
        self.known = Some(bytes);
        self.saved_at = self.document.revision();
        Ok([self.file.clone(), script])
    }

    /// The file's name without the ending of its kind.
    pub fn stem(&self) -> &str {
        let ending = self.document.state().ending();
        self.file.strip_suffix(ending).unwrap_or(&self.file)
    }

    /// The entry of the document in a list of documents.
    pub fn summary(&self, id: &str) -> Value {
        let state = self.document.state();
        json!({
            "id": id, "kind": state.kind(), "name": self.stem(), "revision": self.document.revision(),
            "unsaved": self.document.revision() != self.saved_at,
            "job": self.job.as_ref().filter(|j| !j.is_over()).map(|j| j.shown()),
        })
    }

    /// The whole document, as a page gets it.
    ///
    /// # Errors
    /// As [`State::view`].
    pub fn whole(&self, id: &str) -> Result<Value> {
        let (undo, redo) = self.document.can();
        let state = self.document.state();
        let mut whole = self.summary(id);
        whole["undo"] = undo.into();
        whole["redo"] = redo.into();
        whole["file"] = self.file.as_str().into();
        whole["formats"] = json!(state.formats());
        whole["warnings"] = json!(self.document.warnings());
        whole["log"] = json!(self.document.log());
        whole["milliseconds"] = self.milliseconds.into();
        whole["view"] = state.view()?;
        Ok(whole)
    }
}

/// Refuses to write through a link: in the file's place, or where its folder was.
fn own_place(folder: &Path, place: &Path) -> Result<(), SaveError> {
    let name = |p: &Path| {
        p.file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned()
    };
    let is_link = std::fs::symlink_metadata(place).is_ok_and(|m| m.file_type().is_symlink());
    if is_link {
        return Err(SaveError::Link(name(place)));
    }
    match std::fs::canonicalize(folder) {
        Ok(real) if real != folder => Err(SaveError::Link(name(folder))),
        // A folder that is gone is told of by the write.
        _ => Ok(()),
    }
}

/// A name for the file of a document that has none: nothing in it leads out of a folder.
fn file_name(state: &dyn State) -> String {
    let usual = |c: char| {
        if c.is_alphanumeric() || "-_".contains(c) {
            c
        } else {
            '_'
        }
    };
    let stem: String = state.name().chars().take(80).map(usual).collect();
    let stem = if stem.is_empty() {
        "untitled".to_owned()
    } else {
        stem
    };
    format!("{stem}{}", state.ending())
}
