//! A document with the file that it came from.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde_json::{Value, json};

use super::difference::difference;
use super::jobs::Job;
use super::journal::{Journal, JournalEntry, Source};
use edifice_base::file::write_atomic;
use edifice_base::{Error, Result};
use edifice_editing as editing;
use edifice_editing::history::{Document, steps};
use edifice_editing::script::is_written;
use edifice_editing::work::Work;
use edifice_editing::{Applied, State};
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
    /// The content of the script when it was written last.
    known_script: Option<Vec<u8>>,
    saved_at: u64,
    milliseconds: f64,
    /// The work that is done on it.
    pub job: Option<Arc<Job>>,
    /// The origin of the document, until a journal holds it.
    source: Option<Source>,
    /// The journal, once something was done.
    journal: Option<Journal>,
    /// A warning of the document itself, not of its last edit.
    warning: Option<String>,
    /// The last two views of a city, each with its revision: the one that a page shows, and the one that it asks for.
    told: Vec<(u64, Value)>,
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
        let mut open = Self::new(start, Some(&real));
        open.source = Some(Source::File(real, bytes));
        Ok(open)
    }

    /// Opens a copy of a document that stands elsewhere, which is not written again: it is saved in the present folder.
    ///
    /// # Errors
    /// When no editor knows it.
    pub fn copy(name: &str, bytes: &[u8]) -> Result<Self> {
        let start = editing::open(Path::new(name), bytes, &Work::default())?;
        let mut open = Self::new(start, None);
        open.source = Some(Source::File(open.folder.join(name), bytes.to_vec()));
        Ok(open)
    }

    /// Opens an example that is known by its id.
    pub fn example(id: &str, start: Arc<dyn State>) -> Self {
        let mut open = Self::new(start, None);
        open.source = Some(Source::Example(id.to_owned()));
        open
    }

    /// A document that is opened again at its folder and file name, before its edits are done again.
    pub(super) fn again(start: Arc<dyn State>, source: Source, place: (PathBuf, String)) -> Self {
        let path = match &source {
            Source::File(path, _) => Some(path.as_path()),
            Source::Example(_) => None,
        };
        let mut open = Self::new(start, path);
        if open.known.is_some()
            && let Source::File(_, bytes) = &source
        {
            // The file as it was when it was opened, not as it is now.
            open.known = Some(bytes.clone());
        }
        (open.folder, open.file) = place;
        open.source = Some(source);
        open
    }

    /// Goes on with a journal.
    pub(super) fn keep_journal(&mut self, journal: Journal) {
        self.journal = Some(journal);
        self.source = None;
    }

    /// Warns of the document itself, until the next save.
    pub(super) fn warn(&mut self, warning: String) {
        self.warning = Some(warning);
    }

    /// Notes that the document as it is now was saved, without writing it.
    ///
    /// # Errors
    /// As [`State::bytes`].
    pub(super) fn was_saved(&mut self) -> Result<()> {
        self.known = Some(self.document.state().bytes()?);
        self.known_script = Some(self.document.script()?.into_bytes());
        self.saved_at = self.document.revision();
        Ok(())
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
            known_script: None,
            saved_at: 0,
            milliseconds: 0.0,
            job: None,
            source: None,
            journal: None,
            warning: None,
            told: Vec::new(),
        }
    }

    /// Does commands.
    ///
    /// # Errors
    /// As [`steps`].
    pub fn edit(&mut self, commands: &[Value]) -> Result<()> {
        let start = std::time::Instant::now();
        let steps = steps(self.document.state(), commands, &Work::default())?;
        self.take(commands, steps, start.elapsed().as_secs_f64() * 1e3, None);
        Ok(())
    }

    /// Takes the results of commands, and the milliseconds that they took; journals are in a folder, where there is one.
    pub fn take(
        &mut self,
        commands: &[Value],
        steps: Vec<Applied>,
        milliseconds: f64,
        journals: Option<&Path>,
    ) {
        self.document.take(commands, steps);
        self.milliseconds = milliseconds;
        self.note(&JournalEntry::Did(commands.to_vec()), journals);
    }

    /// Takes back the last edit.
    pub fn undo(&mut self, journals: Option<&Path>) {
        if self.document.undo() {
            self.note(&JournalEntry::Undo, journals);
        }
    }

    /// Does again what was taken back.
    pub fn redo(&mut self, journals: Option<&Path>) {
        if self.document.redo() {
            self.note(&JournalEntry::Redo, journals);
        }
    }

    /// Adds a line to the journal, which begins with the first one. A journal that cannot be written is told of, and the
    /// document goes on without.
    fn note(&mut self, line: &JournalEntry, journals: Option<&Path>) {
        let noted = match (&mut self.journal, journals) {
            (Some(journal), _) => journal.add(line),
            (None, Some(folder)) => self.begin_journal(folder, std::slice::from_ref(line)),
            (None, None) => Ok(()),
        };
        if let Err(error) = noted {
            // Half a journal would be offered as if it were whole.
            if let Some(journal) = self.journal.take() {
                journal.remove();
            }
            self.source = None;
            self.warning = Some(format!(
                "edits are not kept for the case that the studio ends, save often: {error}"
            ));
        }
    }

    /// Begins a journal with all that was done so far.
    ///
    /// # Errors
    /// When it cannot be written.
    pub(super) fn begin_journal(&mut self, folder: &Path, lines: &[JournalEntry]) -> Result<()> {
        let Some(source) = self.source.take() else {
            return Ok(());
        };
        let state = self.document.state();
        let place = (self.folder.as_path(), self.file.as_str());
        let mut journal = Journal::begin(folder, &source, state.kind(), self.stem(), place)?;
        let added = lines.iter().try_for_each(|line| journal.add(line));
        self.journal = Some(journal);
        added
    }

    /// True if something was done since it was opened or saved.
    pub fn is_unsaved(&self) -> bool {
        self.document.revision() != self.saved_at
    }

    /// Removes the journal: the document is closed, or nothing in it is unsaved.
    pub fn forget(&mut self) {
        if let Some(journal) = self.journal.take() {
            journal.remove();
        }
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
        let there = content(&path)?;
        if !overwrite && there.is_some() && there != self.known {
            return Err(SaveError::Changed(self.file.clone()));
        }
        let bytes = self.document.state().bytes()?;
        let text = self.document.script()?;
        // A script of the studio for this document, written at another time, is its own; one that somebody changed is not.
        let target = self.document.target();
        let own = |old: &Vec<u8>| {
            self.known_script.as_ref() == Some(old)
                || is_written(&String::from_utf8_lossy(old), &target)
        };
        if !overwrite && content(&beside)?.is_some_and(|old| !own(&old)) {
            return Err(SaveError::Changed(script));
        }
        // The script first: whoever has the document has what made it.
        write_atomic(&beside, text.as_bytes())?;
        write_atomic(&path, &bytes)?;
        self.known = Some(bytes);
        self.known_script = Some(text.into_bytes());
        self.saved_at = self.document.revision();
        self.warning = None;
        if self.journal.is_some() {
            self.note(&JournalEntry::Saved, None);
        }
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
            "unsaved": self.is_unsaved(), "mergesIn": state.merges_in(),
            "job": self.job.as_ref().filter(|j| !j.is_over()).map(|j| j.shown()),
        })
    }

    /// The whole document, as a page gets it.
    ///
    /// # Errors
    /// As [`State::view`].
    pub fn whole(&mut self, id: &str) -> Result<Value> {
        self.whole_for(id, None)
    }

    /// The same for a page that shows a revision: with the difference to it in place of the view, where that one was told last.
    ///
    /// # Errors
    /// As [`State::view`].
    pub fn whole_for(&mut self, id: &str, shows: Option<u64>) -> Result<Value> {
        let (undo, redo) = self.document.can();
        let state = self.document.state();
        let mut whole = self.summary(id);
        whole["undo"] = undo.into();
        whole["redo"] = redo.into();
        whole["file"] = self.file.as_str().into();
        whole["formats"] = json!(state.formats());
        let mut warnings = self.document.warnings();
        warnings.extend(self.warning.clone());
        whole["warnings"] = json!(warnings);
        whole["log"] = json!(self.document.log());
        whole["milliseconds"] = self.milliseconds.into();
        let revision = self.document.revision();
        let of = |wanted: u64| self.told.iter().find(|(r, _)| *r == wanted);
        let view = match of(revision) {
            Some((_, view)) => view.clone(),
            None => state.view()?,
        };
        match shows.and_then(of) {
            Some((_, shown)) => whole["difference"] = difference(shown, &view),
            None => whole["view"] = view.clone(),
        }
        // Views of others are short.
        if state.kind() == "city" && of(revision).is_none() {
            self.told.push((revision, view));
            if self.told.len() > 2 {
                self.told.remove(0);
            }
        }
        Ok(whole)
    }
}

/// The content of a file; `None` if there is none.
fn content(path: &Path) -> Result<Option<Vec<u8>>> {
    match std::fs::read(path) {
        Ok(bytes) => Ok(Some(bytes)),
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(e) => Err(Error::io(path, "read", e)),
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
