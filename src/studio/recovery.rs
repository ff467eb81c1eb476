//! Unsaved work of a studio that ended: found at the start, offered, opened again or thrown away.

use std::path::Path;
use std::time::SystemTime;

use serde_json::{Value, json};

use super::journal::{ENDING, Found, Head, Journal, JournalEntry, Source, Start, state_of};
use super::{Open, private};
use edifice_base::{Error, Result};
use edifice_editing as editing;
use edifice_editing::examples::example;
use edifice_editing::history::steps;
use edifice_editing::work::Work;
use edifice_io as io;

/// Unsaved work that can be opened again.
pub(crate) struct Offered {
    found: Found,
}

/// Why unsaved work cannot be opened again.
#[derive(Debug, thiserror::Error)]
enum RecoveryError {
    /// The file that it began from is another one.
    #[error("{0} has changed since it was edited, and was too large for a copy")]
    Changed(String),
}

/// The unsaved work in a folder; journals in which all is saved are removed.
pub(crate) fn offered(folder: &Path) -> Vec<Offered> {
    let paths = private::files(folder, ENDING);
    let found = paths.iter().filter_map(|path| Journal::take(path));
    let (unsaved, saved): (Vec<_>, Vec<_>) = found.partition(Found::has_unsaved);
    for found in saved {
        found.journal.remove();
    }
    unsaved.into_iter().map(|found| Offered { found }).collect()
}

impl Offered {
    /// The name that it is asked for by.
    pub(crate) fn id(&self) -> String {
        self.found.journal.id()
    }

    /// The entry of a page's list.
    pub(crate) fn shown(&self) -> Value {
        let head = &self.found.head;
        let since = |t: SystemTime| SystemTime::now().duration_since(t).ok();
        let age = self.found.changed.and_then(since);
        json!({
            "id": self.id(), "kind": head.kind, "name": head.name, "file": head.file, "edits": self.found.edits(),
            "seconds": age.map(|a| a.as_secs()),
        })
    }

    /// Forgets it for good.
    pub(crate) fn discard(self) {
        self.found.journal.remove();
    }

    /// Opens the document and does again what was done to it. What cannot be done again ends it there, with the reason; the
    /// journal is then left as it is, for the program that can.
    ///
    /// # Errors
    /// With the offer itself, when the document cannot be opened or the work was stopped.
    pub(crate) fn open(self, work: &Work) -> std::result::Result<Open, (Box<Self>, Error)> {
        let (mut open, refused) = match self.again(work) {
            Ok(done) => done,
            Err(error) => return Err((Box::new(self), error)),
        };
        match refused {
            None => open.keep_journal(self.found.journal),
            Some((done, reason)) => {
                let folder = self.found.journal.folder();
                let begun = open.begin_journal(&folder, &self.found.lines[..done]);
                open.warn(match begun {
                    Ok(()) => reason,
                    Err(error) => format!("{reason}; further edits are not kept: {error}"),
                });
            }
        }
        Ok(open)
    }

    fn again(&self, work: &Work) -> Result<(Open, Option<(usize, String)>)> {
        let head = &self.found.head;
        let (start, source) = self.start(head, work)?;
        let place = (head.folder.clone(), head.file.clone());
        let mut open = Open::again(start, source, place);
        let count = self.found.lines.len();
        for (k, line) in self.found.lines.iter().enumerate() {
            let part = k as f64 / count as f64;
            work.tell("doing the edits again", Some(part))?;
            match line {
                JournalEntry::Undo => _ = open.document.undo(),
                JournalEntry::Redo => _ = open.document.redo(),
                JournalEntry::Saved => open.was_saved()?,
                JournalEntry::Did(commands) => match steps(open.document.state(), commands, work) {
                    Ok(steps) => open.document.take(commands, steps),
                    Err(error) if work.is_stopped() => return Err(error),
                    Err(error) => {
                        let text = format!(
                            "only the first {k} of {count} steps could be done again, the next is refused: {error}"
                        );
                        return Ok((open, Some((k, text))));
                    }
                },
            }
        }
        Ok((open, None))
    }

    /// The state that the document began from.
    fn start(
        &self,
        head: &Head,
        work: &Work,
    ) -> Result<(std::sync::Arc<dyn editing::State>, Source)> {
        match &head.start {
            Start::Example(id) => Ok((example(id, work)?, Source::Example(id.clone()))),
            Start::File { path, state, kept } => {
                let copy = self.found.journal.copy();
                let bytes = io::read_bytes(if *kept { &copy } else { path })?;
                // A city of triangles is read again from its own path.
                let by_path = head.kind == "city" && !path.to_string_lossy().ends_with(".json");
                if (by_path || !kept) && state_of(path)? != *state {
                    let name = path.display().to_string();
                    return Err(Error::method(RecoveryError::Changed(name)));
                }
                let start = editing::open(path, &bytes, work)?;
                Ok((start, Source::File(path.clone(), bytes)))
            }
        }
    }
}
